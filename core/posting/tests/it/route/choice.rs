//! Measures and sides, as published, and what looking ahead gains.

use super::*;

/// The rotary values, degrees, at which a CL line is arrived at: C and the other axis.
pub(super) fn angles(bench: &Bench, run: &Run, line: u64) -> [f64; 2] {
    let joints = bench.joints(run.arrival(line).expect("a position"));
    let c = bench.place("C");
    let other = bench.rotary().into_iter().find(|place| *place != c);
    [joints[c], joints[other.expect("another axis")]].map(f64::to_degrees)
}

pub(super) fn close(a: [f64; 2], b: [f64; 2]) -> bool {
    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 2e-3)
}

/// The line of B in a head inclined so that B 45 and B -45 lay the tool 160° apart about C.
pub(super) fn inclined() -> String {
    let (tan_10, tan_22) = (libm::tan(10f64.to_radians()), libm::tan(22.5f64.to_radians()));
    let tilt = libm::acos(tan_10 / tan_22);
    format!("[0, {}, {}]", libm::sin(tilt), libm::cos(tilt))
}

/// PostWorks' published example: the rotary axes may move by (50, 90) or by (110, 0) degrees; root of squares,
/// largest axis, sum and one named axis choose the sets 1, 1, 2, 2.
#[test]
fn the_four_measures_choose_as_published() {
    let direction = inclined();
    let class = Class { direction: &direction, ..CLASSES[3] };
    for (rule, set) in [("travel", 1), ("largest-axis", 1), ("time", 2), ("axis:B", 2)] {
        let given = Given {
            feeds: [10_000.0; 5],
            more: format!("[solution]\nrule = \"{rule}\"\nstart = {{ C = 20, B = -45 }}"),
            ..Given::default()
        };
        let bench = bench(&class, &given);
        // Where the machine points with C 70 and B 45, which C -90 and B -45 do as well.
        let mut joints = Joints::default();
        joints[bench.place("C")] = 70f64.to_radians();
        joints[bench.place("B")] = 45f64.to_radians();
        let axis = bench.reference.forward(&joints).1;
        let run = bench.run(&cl(&[point(Vector3::zeros(), axis, true)], 1000.0));
        let run = run.good(rule);
        let stands = angles(&bench, &run, line(0));
        let moves = [stands[0] - 20.0, stands[1] + 45.0];
        let expected = if set == 1 { [50.0, 90.0] } else { [-110.0, 0.0] };
        assert!(close(moves, expected), "{rule}: moves by {moves:?}");
    }
}

/// Heidenhain's table for PLANE SPATIAL with SPB+45 on a machine with A and C, from A0 C0.
#[test]
fn sides_are_chosen_as_heidenhain_s_table_has_it() {
    let tool = Rotation3::from_axis_angle(&Vector3::y_axis(), 45f64.to_radians()) * Vector3::z();
    let table = [
        ("", [-120.0, 120.0], Some([90.0, 45.0])),
        ("prefer = { A = \"positive\" }", [-120.0, 120.0], Some([90.0, 45.0])),
        ("prefer = { A = \"negative\" }", [-120.0, 120.0], Some([-90.0, -45.0])),
        ("require = { A = \"negative\" }", [-120.0, 120.0], Some([-90.0, -45.0])),
        ("require = { A = \"positive\" }", [-120.0, 120.0], Some([90.0, 45.0])),
        ("", [-90.0, 10.0], Some([-90.0, -45.0])),
        ("prefer = { A = \"positive\" }", [-90.0, 10.0], Some([-90.0, -45.0])),
        ("require = { A = \"positive\" }", [-90.0, 10.0], None),
    ];
    for (side, travel, expected) in table {
        for rule in ["time", "travel", "largest-axis", "axis:C"] {
            let given = Given {
                second: travel,
                more: format!("[solution]\nrule = \"{rule}\"\n{side}"),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let run = bench.run(&cl(&[point(Vector3::zeros(), tool, true)], 1000.0));
            match expected {
                Some(expected) => {
                    let run = run.good(side);
                    let stands = angles(&bench, &run, line(0));
                    assert!(close(stands, expected), "{side} {travel:?} {rule}: {stands:?}");
                }
                None => {
                    assert!(run.report.is_none());
                    assert_eq!(run.findings[0].code, "over-travel", "{}", run.told());
                }
            }
        }
    }
}

/// A preferred side is taken off the part where travel lets it be, at any cost, and never in a cut.
#[test]
fn a_preferred_side_is_soft() {
    let points = [
        point(Vector3::zeros(), leaning(45.0, 0.0), true),
        point(Vector3::new(10.0, 0.0, 0.0), leaning(20.0, 0.0), false),
        point(Vector3::new(20.0, 0.0, 0.0), leaning(20.0, 0.0), false),
        point(Vector3::new(20.0, 0.0, 50.0), leaning(20.0, 0.0), true),
        point(Vector3::new(30.0, 0.0, 0.0), leaning(25.0, 0.0), false),
    ];
    // At 45° the negative side is outside travel; at 20° it is not, but only the rapid may change to it.
    let given = Given {
        second: [-30.0, 120.0],
        more: "[solution]\nprefer = { A = \"negative\" }".to_owned(),
        ..Given::default()
    };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&points, 1000.0)).good("prefer");
    let tilts: Vec<f64> = (0..5).map(|index| angles(&bench, &run, line(index))[1]).collect();
    for (tilt, expected) in tilts.iter().zip([45.0, 20.0, 20.0, -20.0, -25.0]) {
        assert!((tilt - expected).abs() < 2e-3, "{tilts:?}");
    }
    assert_eq!(run.report.expect("a report").branch_changes, 1);
    // Required, there is no way.
    let given = Given {
        second: [-30.0, 120.0],
        more: "[solution]\nrequire = { A = \"negative\" }".to_owned(),
        ..Given::default()
    };
    let refused = self::bench(&CLASSES[0], &given).run(&cl(&points, 1000.0));
    assert!(refused.report.is_none());
    assert_eq!(refused.findings[0].code, "over-travel", "{}", refused.told());
}

/// The axes go to the solution nearest to where they start, on the turn where they start.
#[test]
fn a_start_is_gone_on_from() {
    let axis = leaning(30.0, 0.0);
    for (start, expected) in [
        ("C = 0, A = 0", [0.0, 30.0]),
        ("C = 0, A = 30", [0.0, 30.0]),
        ("C = 120, A = -60", [180.0, -30.0]),
        ("C = 170, A = 0", [180.0, -30.0]),
        ("C = 300, A = 10", [360.0, 30.0]),
        ("C = 720, A = 10", [720.0, 30.0]),
        ("C = -200, A = -10", [-180.0, -30.0]),
    ] {
        let given = Given {
            feeds: [10_000.0; 5],
            more: format!("[solution]\nstart = {{ {start} }}"),
            ..Given::default()
        };
        let bench = bench(&CLASSES[0], &given);
        let run = bench.run(&cl(&[point(Vector3::zeros(), axis, true)], 1000.0));
        let stands = angles(&bench, &run.good(start), line(0));
        assert!(close(stands, expected), "{start}: {stands:?}");
    }
}

/// With `look_ahead = 1` the nearest solution is taken each time: it may turn more in the end, and may come to where
/// it cannot go on, where looking ahead finds the way.
#[test]
fn looking_ahead_is_better_than_taking_the_nearest() {
    // The second tilt is possible on one side of A alone.
    let mut points = vec![point(Vector3::zeros(), leaning(45.0, 85.0), true)];
    for step in 1..=6 {
        let x = 5.0 * f64::from(step);
        points.push(point(Vector3::new(x, 0.0, 0.0), leaning(45.0, 85.0 + f64::from(step)), false));
    }
    points.push(point(Vector3::new(30.0, 0.0, 80.0), leaning(70.0, 91.0), true));
    points.push(point(Vector3::new(40.0, 0.0, 0.0), leaning(72.0, 91.0), false));
    let way = |look_ahead: u32, second: [f64; 2], points: &[Point]| {
        let given = Given {
            second,
            more: format!("[solution]\nlook_ahead = {look_ahead}"),
            ..Given::default()
        };
        let bench = bench(&CLASSES[0], &given);
        let run = bench.run(&cl(points, 1000.0));
        let way = run.report.as_ref().map(|_| rotary_way(&bench, &run));
        (way, run)
    };
    let (greedy, run) = way(1, [-120.0, 50.0], &points);
    assert_eq!(run.good("greedy").report.expect("a report").branch_changes, 1);
    let (ahead, run) = way(2000, [-120.0, 50.0], &points);
    assert_eq!(run.good("ahead").report.expect("a report").branch_changes, 0);
    let (greedy, ahead) = (greedy.expect("a way"), ahead.expect("a way"));
    println!("rotary way: {greedy:.1}° taking the nearest, {ahead:.1}° looking ahead");
    assert!(ahead < 40.0 && greedy > 250.0, "{greedy} {ahead}");

    // The same in one cut: the nearest side of A ends at 50°.
    let cut: Vec<Point> = points
        .iter()
        .enumerate()
        .map(|(index, old)| point(old.tip, old.axis, index == 0))
        .collect();
    let (greedy, run) = way(1, [-120.0, 50.0], &cut);
    assert!(greedy.is_none());
    assert_eq!(run.findings[0].code, "jump", "{}", run.told());
    assert!(way(2000, [-120.0, 50.0], &cut).0.is_some());
}

/// The sample of an ultrasonic knife on the trunnion table: refused taking the nearest, posted looking ahead.
#[test]
fn the_knife_is_posted_looking_ahead() {
    let read = |path: &str| {
        std::fs::read_to_string(repository().join(path)).expect("a file of the repository")
    };
    let (machine, text) = (read("machines/ac-trunnion.toml"), read("tests/samples/knife.ncl"));
    for (look_ahead, possible) in [(1, false), (50, true), (2000, true)] {
        let machine = format!("{machine}\n[solution]\nlook_ahead = {look_ahead}\n");
        let bench = Bench::new(&machine, 3, 0.0);
        let run = bench.run(&text);
        assert_eq!(run.report.is_some(), possible, "{look_ahead}: {}", run.told());
        if let Some(report) = &run.report {
            println!(
                "knife, look_ahead {look_ahead}: {} blocks, rotary way {:.0}°, {} branch changes",
                report.blocks,
                rotary_way(&bench, &run),
                report.branch_changes
            );
        } else {
            assert_eq!(run.findings[0].code, "jump", "{}", run.told());
        }
    }
}
