//! The order of the path: tip and path can be gone along together, never back, and each block stays within what is
//! certified for it. The truth is the Fréchet distance, found in the free-space diagram.

use post_posting::{BlockKind, MotionBlock, Observer, PostingRequest};
use post_testmachines::frechet::{frechet, keeps_within};
use post_testruns::posted::{Recorder, watched};

use super::*;

/// Pieces that a block's curve is looked at in.
const PIECES: usize = 24;

/// All blocks of a program.
#[derive(Default)]
struct Seen(Vec<MotionBlock>);

impl Observer for Seen {
    fn block(&mut self, block: &MotionBlock) {
        self.0.push(*block);
    }
}

/// The way of the control point, as a polyline, and what is certified for each piece of it, mm; what the polyline
/// itself misses is added to that.
fn curve(bench: &Bench, blocks: &[MotionBlock]) -> (Vec<V>, Vec<f64>) {
    let along = bench.machine.control_point.along;
    let keeps = bench.machine.control.tcp == post_machine::description::Tcp::Control;
    let (mut curve, mut certified) = (Vec::new(), Vec::new());
    for pair in blocks.windows(2) {
        let [from, to] = pair else { continue };
        assert_ne!(to.kind, BlockKind::Position);
        let at = |t: f64| {
            let (mut tip, axis) = bench.reference.forward(&between(&from.joints, &to.joints, t));
            if keeps {
                tip = from.tip * (1.0 - t) + to.tip * t;
            }
            tip + axis * along
        };
        let even = |step: usize| at(step as f64 / PIECES as f64);
        if curve.is_empty() {
            curve.push(at(0.0));
        }
        for step in 0..PIECES {
            let [first, last] = [even(step), even(step + 1)];
            let middle = at((step as f64 + 0.5) / PIECES as f64);
            let missed = 2.0 * (middle - (first + last) / 2.0).norm();
            certified.push(to.deviation.tip + missed + 1e-9);
            curve.push(last);
        }
    }
    (curve, certified)
}

/// The order of a program's blocks against a path; an error says by how much the whole is farther off than certified.
fn in_order(bench: &Bench, stops: &[Stop], cl: &str, decimals: u8) -> Result<usize, String> {
    let mut seen = Seen::default();
    let length = if bench.place("X") < bench.place("A") { 120.0 } else { 0.0 };
    let job = PostingRequest { tool_length: Some(length), ..PostingRequest::default() };
    let dialect = Recorder::new(&bench.machine, decimals);
    let run = watched(&bench.machine, dialect, cl, job, &mut Shape::Fine, &mut [&mut seen]);
    let Some(report) = &run.report else {
        return Ok(0);
    };
    let path: Vec<V> =
        wanted(stops, bench.machine.control_point.along).into_iter().map(|(tip, _)| tip).collect();
    let (curve, certified) = curve(bench, &seen.0);
    if keeps_within(&curve, &certified, &path) {
        return Ok(seen.0.len());
    }
    Err(format!(
        "{} blocks are {} mm off, certified {} mm",
        seen.0.len(),
        frechet(&curve, &path, 1e3),
        report.tip_deviation_mm.value
    ))
}

/// A path that reverses, loops and winds: steps of the size of the tolerance, along a line, in a plane, in space.
fn winding(rng: &mut Rng, tolerance: f64) -> Vec<Stop> {
    let space = 1 + rng.pick(3);
    let mut tip = rng.point(20.0);
    let mut way = V::x();
    let (mut axis, about) = (rng.direction() * 0.3 + V::z(), rng.direction());
    let leans = if rng.pick(2) == 0 { 0.0 } else { rng.order(-4.0, -2.0) };
    let turn = rng.range(0.0, 3.2);
    let backs = 1 + rng.pick(4);
    (0..14)
        .map(|index| {
            tip += way * tolerance * rng.order(-1.0, 1.0);
            axis = leaned(axis.normalize(), about, leans * rng.range(-1.0, 1.0));
            if rng.pick(backs + 1) == 0 {
                way = -way;
            }
            if space > 1 {
                let about = if space == 2 { V::z() } else { rng.direction() };
                way = leaned(way, about, rng.range(-turn, turn)).normalize();
            }
            stop(tip, axis.normalize(), (index > 0).then_some(1000.0))
        })
        .collect()
}

/// Random paths, left out points or not, every placement, every `corner`: the certificate of each block holds in the
/// order of the path.
#[test]
fn the_certificate_keeps_the_order_of_the_path() {
    let (rounds, mut rng) = randomised(400, 53);
    let mut faults = Vec::new();
    let mut blocks = [0usize; CONFIGS.len()];
    for round in rounds {
        let given = Given {
            tolerance: rng.order(-2.0, 0.3),
            axis_tolerance: 2.0,
            pole: "exact",
            radius: 0.0,
            corner: [10.0, 60.0, 120.0, 180.0, 180.0][rng.pick(5)],
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let stops = winding(&mut rng, given.tolerance);
        let (cl, _) = text(&stops);
        let which = [4, 5, 6, 6, 2][round % 5];
        let bench = bench_of(&machine, &given, CONFIGS[which]);
        match in_order(&bench, &stops, &cl, given.decimals) {
            Ok(count) => blocks[which] += count,
            Err(fault) => faults.push(format!(
                "round {round}, {:?}, corner {}, tolerance {}: {fault}",
                CONFIGS[which], given.corner, given.tolerance
            )),
        }
    }
    println!("blocks {blocks:?}");
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}

/// Forward to 9.67 and back to 7.326: whatever goes forward alone is 1.172 mm off somewhere.
#[test]
fn a_path_that_reverses_is_not_gone_forward_alone() {
    for placement in ["bisect", "fewest"] {
        let more = format!(
            "[accuracy]\ntolerance = 1.0\naxis_tolerance = 1\ncorner = 180\nreduce = true\nplacement = \"{placement}\""
        );
        let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 3, 120.0);
        let stops: Vec<Stop> = [0.0, 5.145, 7.904, 9.67, 7.326, 10.002]
            .iter()
            .enumerate()
            .map(|(index, x)| stop(V::new(*x, 0.0, 0.0), V::z(), (index > 0).then_some(1000.0)))
            .collect();
        let (cl, _) = text(&stops);
        in_order(&bench, &stops, &cl, 3).unwrap_or_else(|fault| panic!("{placement}: {fault}"));
    }
}

/// The least of the greatest distances between fine samples by dynamic programming (Eiter and Mannila 1994): the
/// Fréchet distance to within the step of the samples.
fn discrete(a: &[V], b: &[V]) -> f64 {
    let mut row = vec![f64::INFINITY; b.len()];
    for (i, p) in a.iter().enumerate() {
        let mut corner = f64::INFINITY;
        for (j, q) in b.iter().enumerate() {
            let before = if i == 0 && j == 0 {
                0.0
            } else {
                let beside = if j > 0 { row[j - 1] } else { f64::INFINITY };
                row[j].min(beside).min(corner)
            };
            corner = row[j];
            row[j] = before.max((p - q).norm());
        }
    }
    row[b.len() - 1]
}

fn fine(path: &[V], count: usize) -> Vec<V> {
    let legs = path.windows(2);
    let places = legs.flat_map(|leg| {
        (0..count).map(|step| leg[0] + (leg[1] - leg[0]) * (step as f64 / count as f64))
    });
    places.chain(path.last().copied()).collect()
}

/// The judge is judged: the diagram against brute force, and against the example worked out by hand.
#[test]
fn the_free_space_diagram_agrees_with_brute_force() {
    let (rounds, mut rng) = randomised(60, 71);
    for round in rounds {
        let [path, curve] = [2 + rng.pick(5), 2 + rng.pick(5)]
            .map(|count| (0..count).map(|_| rng.point(5.0)).collect::<Vec<V>>());
        let exact = frechet(&curve, &path, 40.0);
        let brute = discrete(&fine(&curve, 60), &fine(&path, 60));
        // Neighbouring samples are no farther apart than this.
        let step = 10.0 * libm::sqrt(3.0) / 60.0;
        assert!(
            exact <= brute + 1e-6 && brute <= exact + step,
            "round {round}: {exact}, by brute force {brute}"
        );
    }
    let at = |x: f64| V::new(x, 0.0, 0.0);
    let path = [0.0, 5.145, 7.904, 9.67, 7.326, 10.002].map(at);
    let apart = frechet(&[at(0.0), at(10.002)], &path, 10.0);
    assert!((apart - (9.67 - 7.326) / 2.0).abs() < 1e-6, "{apart}");
}
