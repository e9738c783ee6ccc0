//! Lathes with a C axis and no Y: two linear axes, which the work spindle carries round the part.

use super::*;

/// What a program may miss by, mm, and what rounded words add where a chord ends.
const TOLERANCE: f64 = 0.01;

/// A lathe, and the same numbers once more for the isometries.
struct Lathe {
    machine: Machine,
    reference: Reference,
    /// Linear positions with the tip as near to the part origin as it comes, X and Z.
    zero: [f64; 2],
}

/// A lathe with its axes a little askew, C on a line of its own, X to `least`; the plane of X and Z passes the line of C by
/// `beside` mm.
fn lathe(rng: &mut Rng, least: f64, beside: f64) -> Lathe {
    let c = [rng.range(-5.0, 5.0), rng.range(-5.0, 5.0), 0.0];
    let x = Vector3::new(1.0, rng.range(-0.02, 0.02), rng.range(-0.02, 0.02)).normalize();
    let z = Vector3::z();
    let mount = [rng.range(-20.0, 20.0), rng.range(-20.0, 20.0), rng.range(0.0, 100.0)];
    let across = x.cross(&z).normalize();
    let gauge = Vector3::from(c) + across * beside + z * 200.0;
    let text = format!(
        r#"
name = "lathe"
chain = "[w C' b Z X (S) t]"
[workpiece]
mount = {mount:?}
[tool]
gauge = [{}, {}, {}]
axis = [0, 0, 1]
[axis.C]
rotary = [0, 0, 1]
point = {c:?}
cyclic = true
max_feed = 36000
[axis.X]
linear = [{}, {}, {}]
travel = [{least}, 400]
max_feed = 20000
[axis.Z]
linear = [0, 0, 1]
travel = [-500, 500]
max_feed = 20000
[control]
dialect = "recorder"
tcp = "post"
[accuracy]
tolerance = {TOLERANCE}
"#,
        gauge.x, gauge.y, gauge.z, x.x, x.y, x.z
    );
    let machine = load(Source { name: "lathe".to_owned(), text }, &[], &mut |_| Err(String::new()))
        .unwrap_or_else(|faults| panic!("{faults:#?}"));
    let turn = Joint { rotary: true, direction: z, point: Vector3::from(c) };
    let slide =
        |direction: Vector3<f64>| Joint { rotary: false, direction, point: Vector3::zeros() };
    let mount = Vector3::from(mount);
    let way = mount - gauge;
    // Least squares of two directions that are not square to one another.
    let (xz, wx, wz) = (x.dot(&z), way.dot(&x), way.dot(&z));
    let square = 1.0 - xz * xz;
    let zero = [(wx - xz * wz) / square, (wz - xz * wx) / square];
    let joints = vec![turn, slide(z), slide(x)];
    Lathe { machine, reference: Reference { joints, mount, tip: gauge, axis: z }, zero }
}

impl Lathe {
    /// The tip where the words X, Z, C say.
    fn tip(&self, words: &[f64]) -> Vector3<f64> {
        let mut joints = Joints::default();
        joints[0] = words[2].to_radians();
        joints[1] = words[1] + self.zero[1];
        joints[2] = words[0] + self.zero[0];
        self.reference.forward(&joints).0
    }

    fn run(&self, points: &[Point]) -> Run {
        let job = PostingRequest { tool_length: Some(0.0), ..PostingRequest::default() };
        run(&self.machine, &cl(points, 1000.0), job)
    }

    /// The line of C, part frame.
    fn centre(&self) -> Vector3<f64> {
        let c = self.reference.joints[0].point - self.reference.mount;
        Vector3::new(c.x, c.y, 0.0)
    }
}

/// Samples every cut against its chord, and looks where every move ends; the farthest of both, mm.
fn judge(lathe: &Lathe, points: &[Point], run: &Run) -> [f64; 2] {
    let (mut off, mut ends) = (0.0f64, 0.0f64);
    let mut last: Option<&[f64]> = None;
    for (index, target) in points.iter().enumerate() {
        let blocks = run.asked.iter();
        let blocks = blocks.filter(|asked| asked.line == line(index) && !asked.words.is_empty());
        for block in blocks {
            if let (Some(from), false, Some(before)) = (last, target.rapid, index.checked_sub(1)) {
                for step in 0..=40 {
                    let t = f64::from(step) / 40.0;
                    let pairs = from.iter().zip(&block.words);
                    let words: Vec<f64> = pairs.map(|(a, b)| a * (1.0 - t) + b * t).collect();
                    off = off.max(distance(lathe.tip(&words), points[before].tip, target.tip));
                }
            }
            last = Some(&block.words);
        }
        let end = last.expect("a position");
        ends = ends.max((lathe.tip(end) - target.tip).norm());
    }
    [off, ends]
}

/// Points some millimetres apart around `centre`, every ninth at rapid; through `keep` mm about it no cut leads.
fn wander(rng: &mut Rng, centre: Vector3<f64>, keep: f64) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    while points.len() < 40 {
        let rapid = points.len().is_multiple_of(9);
        let mut tip = centre + Vector3::new(rng.range(-60.0, 60.0), rng.range(-60.0, 60.0), 0.0);
        tip.z = if rapid { 20.0 } else { rng.range(-3.0, 3.0) };
        if let Some(last) = points.last() {
            let level = |v: Vector3<f64>| Vector3::new(v.x, v.y, 0.0);
            if distance(level(centre), level(last.tip), level(tip)) < keep {
                continue;
            }
            // Straight out, as tools are drawn back: what else a rapid out of the part asks for is asked for.
            if rapid {
                tip = Vector3::new(last.tip.x, last.tip.y, 20.0);
            }
        }
        points.push(posted::point(tip, Vector3::z(), rapid));
    }
    points
}

/// Far apart as the points are, every block keeps to the chord, and what is certified is no less than what it strays by.
fn check(what: &str, lathe: &Lathe, points: &[Point]) {
    let run = lathe.run(points);
    let Some(report) = &run.report else {
        panic!("{what}: {:#?}", run.findings);
    };
    let [off, ends] = judge(lathe, points, &run);
    assert!(off <= TOLERANCE + 1e-9, "{what}: {off}");
    assert!(ends <= TOLERANCE + 1e-9, "{what}: {ends}");
    let certified = report.tip_deviation_mm.value;
    assert!(off <= certified + 1e-9 && certified <= TOLERANCE, "{what}: {off} {certified}");
}

#[test]
fn chords_on_a_face_are_kept_by_x_and_c() {
    let (rounds, mut rng) = randomised(12, 4);
    for round in rounds {
        for (least, beside, keep) in [(-400.0, 0.0, 0.0), (-0.5, 0.0, 0.0), (-400.0, 3.0, 3.5)] {
            let lathe = lathe(&mut rng, least, beside);
            let points = wander(&mut rng, lathe.centre(), keep);
            check(&format!("{round} {least} {beside}"), &lathe, &points);
        }
    }
}

/// Through the centre line the tool goes on to X below zero, or, where X ends there, stands while C turns by half a turn.
#[test]
fn a_cut_through_the_centre_goes_on_or_turns_on_the_spot() {
    let mut rng = seeded(7);
    for least in [-400.0, -0.5] {
        let lathe = lathe(&mut rng, least, 0.0);
        let (sine, cosine) = libm::sincos(rng.range(0.0, 6.0));
        let at =
            |radius: f64, z: f64| lathe.centre() + Vector3::new(radius * cosine, radius * sine, z);
        let points: Vec<Point> = [(30.0, 10.0), (30.0, -1.0), (-25.0, -1.0), (-25.0, 10.0)]
            .into_iter()
            .enumerate()
            .map(|(index, (radius, z))| posted::point(at(radius, z), Vector3::z(), index == 0))
            .collect();
        check(&format!("{least}"), &lathe, &points);
        let run = lathe.run(&points).good("a cut through the centre");
        let cut: Vec<&Asked> =
            run.motions().into_iter().filter(|asked| asked.line == line(2)).collect();
        let before = run.motions().into_iter().rfind(|asked| asked.line == line(1));
        let turned = cut.last().expect("a cut").words[2] - before.expect("a plunge").words[2];
        match least < -1.0 {
            true => assert!(cut.len() == 1 && turned.abs() < 0.01, "{cut:#?}"),
            false => assert!(cut.len() == 3 && (turned.abs() - 180.0).abs() < 0.01, "{cut:#?}"),
        }
    }
}

/// A hole beside the plane that X and Z move the tip in is refused with the distance, one within tolerance of it is made and
/// counted.
#[test]
fn what_lies_off_the_plane_is_counted_or_refused() {
    let mut rng = seeded(11);
    let lathe = lathe(&mut rng, -400.0, 2.0);
    // Inside the ring that the plane passes the line of C at, nothing is reached.
    let hole = |radius: f64| {
        [10.0, -5.0].map(|z| {
            posted::point(lathe.centre() + Vector3::new(radius, 0.0, z), Vector3::z(), z > 0.0)
        })
    };
    let run = lathe.run(&hole(2.0 - 0.004));
    let certified = run.report.as_ref().map(|report| report.tip_deviation_mm.value);
    let within = certified.is_some_and(|certified| (0.0039..TOLERANCE).contains(&certified));
    assert!(within, "{certified:?} {:#?}", run.findings);
    let run = lathe.run(&hole(1.0));
    assert!(run.report.is_none());
    let refused = run.findings.iter().find(|finding| finding.code == "out-of-reach");
    let message = &refused.expect("a refusal").message;
    assert!(message.contains("no nearer than 1.0000 mm"), "{message}");
}
