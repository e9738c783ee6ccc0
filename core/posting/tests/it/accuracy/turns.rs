//! Turns on the spot, wrapped axes, the pole.

use super::*;

/// A pass round a cone: C turns on and on.
fn cone(turns: f64, count: u32, step: f64) -> Vec<Stop> {
    (0..=count)
        .map(|index| {
            let share = f64::from(index) / f64::from(count);
            let (sine, cosine) = libm::sincos(share * turns * std::f64::consts::TAU);
            let tip = V::new(5.0 * cosine, 5.0 * sine, step * share);
            let axis = V::new(0.6 * cosine, 0.6 * sine, 1.0).normalize();
            stop(tip, axis, (index > 0).then_some(1000.0))
        })
        .collect()
}

/// An axis that is shown over one turn takes the shorter way in every block: with points left out and coarse
/// tolerances too, that is the way that the CL file means.
#[test]
fn a_wrapped_axis_goes_the_way_that_is_meant() {
    for tcp in ["post", "control"] {
        for range in ["[0, 360]", "[-180, 180]"] {
            for tolerance in [0.005, 0.5, 20.0] {
                for config in &CONFIGS {
                    for count in [24, 90, 700] {
                        let c = format!("cyclic = true\nrange = {range}");
                        let more = format!(
                            "[accuracy]\ntolerance = {tolerance}\naxis_tolerance = 10\nrapid_tolerance = 100\ncorner = 90\n{config}\n[solution]\npole = \"exact\""
                        );
                        let bench = Bench::new(&usual(false, tcp, &c, &more), 4, 0.0);
                        let stops = cone(3.0, count, 10.0);
                        let (cl, lines) = text(&stops);
                        let run = bench.run_with(&cl, &mut Shape::Fine, false).good("a cone");
                        let what = format!("{tcp}, {range}, {tolerance}, {config:?}, {count}");
                        let mut total = 0.0;
                        let c = bench.place("C");
                        for block in blocks(&bench, &run) {
                            let way: f64 = block.to[c] - block.from[c];
                            assert!(way.abs() < 3.0, "{what}: {way}");
                            total += way;
                        }
                        let turns = total.abs() / std::f64::consts::TAU;
                        assert!((turns - 3.0).abs() < 0.01, "{what}: {turns} turns");
                        let given = Given {
                            tables: 2,
                            usual: true,
                            tcp,
                            along: 0.0,
                            radius: 0.0,
                            decimals: 4,
                            tolerance,
                            axis_tolerance: 10.0,
                            pole: "blend",
                            corner: 10.0,
                        };
                        if tolerance < 0.1 {
                            hold(&bench, &given, &stops, &lines, &run, 20, config)
                                .unwrap_or_else(|fault| panic!("{what}: {fault}"));
                        }
                    }
                }
            }
        }
    }
}

/// Where the tip stands still the feed is taken along the axes, whatever blocks the turn is made of. (Put off the
/// path, the ends of balanced blocks made the tip seem to move, and the axes turn in no time.)
#[test]
fn a_turn_on_the_spot_keeps_its_pace() {
    let lean = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(0.0, -sine, cosine)
    };
    let stops = [
        stop(V::zeros(), lean(10.0), None),
        stop(V::zeros(), lean(14.0), Some(100.0)),
        stop(V::new(5.0, 0.0, 0.0), lean(14.0), Some(100.0)),
    ];
    let mut times = Vec::new();
    for config in CONFIGS {
        let more = format!("[accuracy]\ntolerance = 0.02\naxis_tolerance = 5\n{config}");
        let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
        let run = bench.run_with(&text(&stops).0, &mut Shape::Fine, false).good(config);
        let a = bench.place("A");
        for block in &blocks(&bench, &run) {
            let turn = (block.to[a] - block.from[a]).abs().to_degrees();
            if let (Some(Feed::InverseTime(feed)), true) = (block.feed, turn > 0.0) {
                assert!(turn * feed <= 100.0, "{config}: {} degrees a minute", turn * feed);
            }
        }
        times.push(run.report.unwrap().cutting_time_s);
    }
    for time in &times {
        assert!((time / times[0] - 1.0).abs() < 0.01, "{times:?}");
    }
}

/// Points so close that the tip stands still between them, while the axes turn: left out or not, that takes its time.
#[test]
fn a_turn_in_tiny_steps_keeps_its_pace() {
    let lean = |degrees: f64| {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        V::new(0.0, -sine, cosine)
    };
    let mut stops = vec![stop(V::zeros(), lean(10.0), None)];
    for index in 1..=20 {
        let tip = V::new(0.0015 * f64::from(index), 0.0, 0.0);
        stops.push(stop(tip, lean(10.0 + f64::from(index)), Some(100.0)));
    }
    for tcp in ["post", "control"] {
        let mut times = Vec::new();
        for config in CONFIGS {
            let more = format!("[accuracy]\ntolerance = 0.2\naxis_tolerance = 5\n{config}");
            let bench = Bench::new(&usual(true, tcp, "cyclic = true", &more), 4, 100.0);
            let run = bench.run_with(&text(&stops).0, &mut Shape::Fine, false).good(config);
            times.push(run.report.unwrap().cutting_time_s);
        }
        for time in &times {
            assert!((time / times[0] - 1.0).abs() < 0.01, "{tcp}: {times:?}");
        }
    }
}

/// A nutating head whose second axis ends just past the pole can go through only by turning C half round there.
/// Whatever the placement, what bisection makes is made.
#[test]
fn a_pass_through_a_pole_is_made_by_every_placement() {
    let mut refused = Vec::new();
    for tcp in ["post", "control"] {
        for beside in [0.0f64, 0.001, 0.01, 0.1] {
            for count in [1, 5, 60] {
                let stops: Vec<Stop> = (0..=count)
                    .map(|index| {
                        let s = -1.0 + 2.0 * f64::from(index) / f64::from(count);
                        let axis = V::new(
                            libm::tan((5.0 * s).to_radians()),
                            libm::tan(beside.to_radians()),
                            1.0,
                        );
                        let axis = leaned(axis.normalize(), V::z(), 0.7);
                        let tip = V::new(40.0 * s, 10.0, 5.0 * s * s);
                        stop(tip, axis, (index > 0).then_some(1000.0))
                    })
                    .collect();
                let (cl, lines) = text(&stops);
                for pole in ["exact", "blend"] {
                    let mut made = Vec::new();
                    for config in CONFIGS {
                        let machine = format!(
                            "name = \"nutating\"\nchain = \"[w C' b X Y Z A t]\"\n[tool]\ngauge = [0, 0, 500]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ncyclic = true\nmax_feed = 9000\n[axis.A]\nrotary = [0, 1, 1]\npoint = [0, 0, 680]\ntravel = [-120, 0.2]\nmax_feed = 5400\n{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n[solution]\npole = \"{pole}\"\n[accuracy]\ntolerance = 0.005\naxis_tolerance = 0.05\n{config}"
                        );
                        let bench = Bench::new(&machine, 3, 0.0);
                        let run = bench.run_with(&cl, &mut Shape::Fine, false);
                        made.push(run.report.is_some());
                        if run.report.is_none() {
                            refused.push(format!(
                                "{tcp}, {pole}, {beside}, {count}, {config:?}: {}",
                                run.told()
                            ));
                            continue;
                        }
                        let given = Given {
                            tables: 1,
                            usual: true,
                            tcp: ["post", "control"][usize::from(tcp == "control")],
                            along: 0.0,
                            radius: 0.0,
                            decimals: 3,
                            tolerance: 0.005,
                            axis_tolerance: 0.05,
                            pole: "blend",
                            corner: 10.0,
                        };
                        hold(&bench, &given, &stops, &lines, &run, 12, config).unwrap_or_else(
                            |fault| panic!("{tcp}, {pole}, {beside}, {count}, {config:?}: {fault}"),
                        );
                    }
                    assert!(made[0], "{tcp}, {pole}, {beside}, {count}");
                }
            }
        }
    }
    assert!(refused.is_empty(), "{} refused\n{}", refused.len(), refused.join("\n"));
}

/// Where the control keeps the tip it measures the tip's words, not the way of the point above it: on the spot the
/// feed is that of the rotary axes, and the block takes the time that the summary says.
#[test]
fn a_turn_on_the_spot_is_told_in_what_the_control_measures() {
    for along in [0.0, 0.2, 30.0] {
        let machine = usual(
            true,
            "control",
            "cyclic = true",
            "[accuracy]\ntolerance = 1\naxis_tolerance = 5",
        );
        let machine = machine.replace(
            "gauge = [0, 0, 0]",
            &format!("gauge = [0, 0, 0]\ncontrol_point = {{ along = {along} }}"),
        );
        let bench = Bench::new(&machine, 4, 100.0);
        let lean = |degrees: f64| {
            let (sine, cosine) = libm::sincos(degrees.to_radians());
            V::new(0.0, -sine, cosine)
        };
        let stops = [stop(V::zeros(), lean(10.0), None), stop(V::zeros(), lean(10.3), Some(100.0))];
        let run = bench.run(&text(&stops).0).good("a turn");
        let made = blocks(&bench, &run);
        let turn: f64 = made[0].to[bench.place("A")] - made[0].from[bench.place("A")];
        let Some(Feed::PerMinute(feed)) = made[0].feed else {
            panic!("{:?}", made[0].feed);
        };
        let seconds = turn.abs().to_degrees() / feed * 60.0;
        let told = run.report.unwrap().cutting_time_s;
        assert!(
            (seconds / told - 1.0).abs() < 0.05,
            "{along}: F{feed}, {seconds} s, told {told} s"
        );
    }
}

/// A control that shows C over one turn takes the shorter way between two words, and none between equal ones: what it
/// does then is on the path, over the pole and beside it, with points left out and without.
#[test]
fn an_axis_shown_over_one_turn_never_goes_the_other_way() {
    let (rounds, mut rng) = randomised(80, 91);
    let (mut programs, mut faults) = (0, Vec::new());
    for round in rounds {
        let given = Given {
            tables: 0,
            usual: true,
            tcp: ["post", "control"][rng.pick(2)],
            along: 0.0,
            radius: 0.0,
            decimals: 4,
            tolerance: 0.01,
            axis_tolerance: 0.1,
            pole: ["exact", "blend"][rng.pick(2)],
            corner: [10.0, 180.0][rng.pick(2)],
        };
        let config = CONFIGS[round % CONFIGS.len()];
        let prefer = ["", "prefer = { A = \"positive\" }\n"][rng.pick(2)];
        let more = format!(
            "[solution]\npole = \"{}\"\n{prefer}[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1\nrapid_tolerance = 0.5\ncorner = {}\n{config}",
            given.pole, given.corner
        );
        let c =
            ["cyclic = true\nrange = [0, 360]", "cyclic = true\nrange = [-180, 180]"][rng.pick(2)];
        let bench = Bench::new(&usual(rng.pick(2) == 0, given.tcp, c, &more), 4, 100.0);
        let mut tip = V::zeros();
        let mut azimuth = rng.range(-3.0, 3.0);
        let stops: Vec<Stop> = (0..8)
            .map(|index| {
                let tilt = [0.0, 0.02, 0.3, 0.6][rng.pick(4)] * rng.range(0.5, 1.0);
                azimuth += [0.1, 1.5, std::f64::consts::PI][rng.pick(3)];
                let (sine, cosine) = libm::sincos(azimuth);
                let axis = V::new(tilt * cosine, tilt * sine, 1.0).normalize();
                let rapid = index == 0 || rng.pick(5) == 0;
                let next = stop(tip, axis, (!rapid).then_some(1000.0));
                tip += V::new(rng.range(1.0, 20.0), rng.range(-1.0, 1.0), 0.0);
                next
            })
            .collect();
        let (cl, lines) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false);
        if run.report.is_none() {
            faults.push(format!("round {round}, {config:?}: {}", run.told()));
            continue;
        }
        programs += 1;
        if let Err(fault) = hold(&bench, &given, &stops, &lines, &run, 40, config) {
            faults.push(format!("round {round}, {config:?}, {given:?}: {fault}"));
        }
    }
    println!("{programs} programs");
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}
