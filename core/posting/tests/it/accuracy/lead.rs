//! A leading edge: within a move it is wanted along the direction of motion, laid across the tool axis of the instant.
//! The printed words are walked with a forward product of isometries, densely, and held against that.

use super::*;

/// A knife on a gantry head, upright and square or of random directions and lines.
fn knife(rng: &mut Rng, usual: bool, more: &str) -> String {
    let (mut c, mut b, mut a) = (V::z(), V::y(), V::z());
    let mut edge = V::x();
    if !usual {
        while a.cross(&b).norm() < 0.5 || b.cross(&c).norm() < 0.5 {
            (c, b, a) = (rng.direction(), rng.direction(), rng.direction());
        }
        // The blade axis need not be the tool axis, nor the edge that of a square machine.
        if rng.pick(2) == 0 {
            a = V::z();
            (c, b) = (V::z(), V::new(0.0, 1.0, rng.range(-0.3, 0.3)));
        }
        edge = post_testmachines::across(rng, V::z());
    }
    let mut out = format!(
        "name = \"knife\"\nchain = \"[w b X Y Z C B A t]\"\n[tool]\ngauge = [0, 0, 600]\naxis = [0, 0, 1]\nedge = {}\n",
        list(edge)
    );
    for (name, direction) in [("C", c), ("B", b), ("A", a)] {
        let point = V::new(rng.range(-20.0, 20.0), rng.range(-20.0, 20.0), 760.0);
        out += &endless(name, direction, point);
    }
    format!("{out}{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"post\"\n{more}")
}

/// Where a heading lies across an axis.
fn laid(heading: V, axis: V) -> V {
    (heading - axis * axis.dot(&heading)).normalize()
}

/// The largest angle between the edge and where it is wanted, over all cuts with a way, and what is certified, radians.
/// The share of a cut is read off the tip, which is off along the path by its tolerance at most.
///
/// At every bend the knife is turned on the spot, so that each cut has one heading.
fn off(bench: &Bench, stops: &[Stop], lines: &[u64], run: &Run) -> (f64, f64) {
    let report = run.report.as_ref().expect("a program");
    let certified = report.axis_deviation_deg.value.to_radians();
    let edge = bench.machine.edge.expect("an edge");
    let mut most = 0.0f64;
    for block in blocks(bench, run).iter().filter(|block| !block.rapid) {
        let leg = lines.partition_point(|known| *known < block.lines[1]).max(1) - 1;
        let (first, last) = (&stops[leg], &stops[leg + 1]);
        let way = last.tip - first.tip;
        let (from, to) = (block.at(bench, 0.0).0, block.at(bench, 1.0).0);
        if (to - from).norm() < 0.02 {
            continue;
        }
        for step in 0..=40 {
            let t = f64::from(step) / 40.0;
            let (tip, axis) = block.at(bench, t);
            let share = ((tip - first.tip).dot(&way) / way.norm_squared()).clamp(0.0, 1.0);
            let wanted = slerp(first.axis.normalize(), last.axis.normalize(), share);
            let reached = block.rotation(bench, t) * edge;
            most = most.max(angle(reached, laid(way, wanted)));
            // Across the axis where it really stands: what that is off by is laid aside with it.
            let lean = libm::sin(angle(way.normalize(), axis));
            let real = angle(reached, laid(way, axis));
            assert!(
                real <= certified + angle(axis, wanted) / lean + 1e-4,
                "edge {}° off the direction of motion, certified {}°",
                real.to_degrees(),
                certified.to_degrees()
            );
        }
    }
    (most, certified)
}

/// Moves with a bend at each point, the axis leaning anyhow.
fn bends(rng: &mut Rng) -> Vec<Stop> {
    let mut tip = V::new(rng.range(-50.0, 50.0), rng.range(-50.0, 50.0), 0.0);
    let mut heading = rng.range(-3.0, 3.0);
    (0..6)
        .map(|index| {
            let lean = leaned(V::z(), V::x(), rng.range(-0.5, 0.5));
            let axis = leaned(lean, V::y(), rng.range(-0.5, 0.5));
            let next = stop(tip, axis, (index > 0).then_some(1000.0));
            let (sine, cosine) = libm::sincos(heading);
            tip += V::new(cosine, sine, rng.range(-0.2, 0.2)) * rng.range(10.0, 60.0);
            heading += [-1.0, 1.0][rng.pick(2)] * rng.range(0.5, 2.5);
            next
        })
        .collect()
}

#[test]
fn the_edge_is_where_the_certificate_says() {
    let (rounds, mut rng) = randomised(120, 61);
    let (mut made, mut closest) = (0, f64::INFINITY);
    for round in rounds {
        let tolerance = rng.order(-1.3, 0.0);
        let more = format!(
            "[solution]\nedge = \"travel\"\ncorner = 1\npole = \"exact\"\n[accuracy]\ntolerance = 0.001\naxis_tolerance = {tolerance}\nrapid_tolerance = 5\n{}",
            CONFIGS[[0, 1, 2, 4, 6][round % 5]]
        );
        let bench = Bench::new(&knife(&mut rng, round % 3 == 0, &more), 5, 100.0);
        let stops = bends(&mut rng);
        let (cl, lines) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false);
        if run.report.is_none() {
            // A random head may not reach it.
            continue;
        }
        made += 1;
        let (off, certified) = off(&bench, &stops, &lines, &run);
        assert!(
            off <= certified + 5e-4,
            "round {round}: the edge is {}° off, certified {}°",
            off.to_degrees(),
            certified.to_degrees()
        );
        closest = closest.min(certified / off);
    }
    println!("{made} programs, certified at least {closest} of what is sampled");
    assert!(made > at_least(60), "{made}");
}

/// The stock knife, its axis going over from leaning to Y to leaning to X along one move.
#[test]
fn a_heading_is_laid_across_the_axis_of_the_instant() {
    let more = "[solution]\nedge = \"travel\"\ncorner = 15\n[accuracy]\ntolerance = 0.001\naxis_tolerance = 0.1\n";
    let bench = Bench::new(&knife(&mut post_testkit::Rng::new(62), true, more), 4, 100.0);
    let lean = |x: f64, y: f64| V::new(x, y, 1.0).normalize();
    let stops = [
        stop(V::new(0.0, 0.0, 20.0), lean(0.3, 0.5), None),
        stop(V::new(50.0, 0.0, 0.0), lean(-0.6, 0.0), Some(1000.0)),
        stop(V::new(50.0, 50.0, 0.0), lean(0.2, 0.6), Some(1000.0)),
    ];
    let (cl, lines) = text(&stops);
    let run = bench.run(&cl).good("a knife");
    let (off, certified) = off(&bench, &stops, &lines, &run);
    println!(
        "the edge is {:.3}° off its direction, certified {:.3}°",
        off.to_degrees(),
        certified.to_degrees()
    );
    assert!(off <= certified + 1e-3 && certified.to_degrees() <= 0.1);
}

/// At corners a knife with [rewind] is drawn back, which counts, and on the way out nothing turns; a short way out that
/// the decimals of the file lay aside of the tool axis has no direction either.
#[test]
fn drawing_back_counts_and_turns_nothing() {
    let more = "[rewind]\ndistance = 20\n[solution]\nedge = \"travel\"\ncorner = 15\n[accuracy]\ntolerance = 0.05\naxis_tolerance = 0.1\n";
    let bench = Bench::new(&knife(&mut post_testkit::Rng::new(62), true, more), 4, 100.0);
    let axis = V::new(0.1, 0.2, 1.0).normalize();
    let cut = |tip: V| stop(tip, axis, Some(1000.0));
    let corner = V::new(50.0, 50.0, 0.0);
    let stops = [
        stop(axis * 30.0, axis, None),
        cut(V::zeros()),
        cut(V::new(50.0, 0.0, 0.0)),
        cut(corner),
        cut(corner + axis * 0.05 + V::new(-0.001, 0.001, 0.0)),
        stop(corner + axis * 30.0, axis, None),
    ];
    let run = bench.run(&text(&stops).0).good("a knife");
    assert_eq!(run.report.as_ref().map(|report| report.rewinds), Some(1));
    let [c, b, a] = ["C", "B", "A"].map(|name| bench.place(name));
    let mut ways_out = 0;
    for block in blocks(&bench, &run) {
        let [(from, axis), (to, _)] = [block.at(&bench, 0.0), block.at(&bench, 1.0)];
        let way = to - from;
        if way.dot(&axis) > 0.99 * way.norm() && way.norm() > 0.01 {
            ways_out += 1;
            for joint in [c, b, a] {
                assert_eq!(block.from[joint], block.to[joint], "{from:?} to {to:?}");
            }
        }
    }
    assert_eq!(ways_out, 3);
}
