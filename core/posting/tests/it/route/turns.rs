//! Axes that turn on and on, axes shown over one turn, long cuts, windows of any length.

use super::*;

/// A spiral of twenty thousand points turns an endless C on and on. How far is looked ahead makes no difference where
/// nothing is eased, and next to none where a window ends in the middle of a stretch that is.
#[test]
fn an_endless_axis_turns_on_and_on() {
    for class in &CLASSES {
        for sway in [15.0, 19.9] {
            let points: Vec<Point> = (0..20_000)
                .map(|index| {
                    let lean = 3.0 * f64::from(index);
                    let (sine, cosine) = libm::sincos(lean.to_radians());
                    let radius = 20.0 + 0.002 * f64::from(index);
                    let tip =
                        Vector3::new(radius * cosine, radius * sine, 0.001 * f64::from(index));
                    let tilt = 20.0 + sway * libm::sin(f64::from(index) * 0.0007);
                    point(tip, leaning(tilt, lean), index == 0)
                })
                .collect();
            let text = cl(&points, 3000.0);
            let run = |look_ahead: u32| {
                let given = Given {
                    tcp: "control",
                    more: format!("[solution]\nlook_ahead = {look_ahead}"),
                    ..Given::default()
                };
                let bench = bench(class, &given);
                let run = bench.run(&text).good(class.name);
                let end = bench.joints(run.arrival(line(19_999)).expect("a position"));
                let way = rotary_way(&bench, &run);
                (run, end[bench.place("C")].to_degrees(), way)
            };
            let (short, c, short_way) = run(200);
            let (long, _, long_way) = run(2000);
            let report = short.report.as_ref().expect("a report");
            println!(
                "{}: C comes to {c:.0}°, {} blocks, {} eased; rotary way {short_way:.1}° and {long_way:.1}°",
                class.name, report.blocks, report.points_eased
            );
            assert!((c - 60_000.0).abs() < 400.0, "{}: C at {c}", class.name);
            assert_eq!((report.branch_changes, report.rewinds), (0, 0));
            if sway < 18.0 {
                assert_eq!(report.points_eased, 0);
                assert!(short.asked == long.asked, "{}: 200 and 2000 differ", class.name);
            } else {
                assert!((short_way / long_way - 1.0).abs() < 1e-3, "{short_way} {long_way}");
            }
        }
    }
}

/// One long cut, clear of the pole: it arrives where the axes come to when the path is followed step by step, however
/// far they turn.
#[test]
fn long_cuts_arrive_where_the_axes_come_to() {
    let (rounds, mut rng) = randomised(800, 51);
    let mut faults = Faults::default();
    let mut far = 0;
    for round in rounds {
        let class = &CLASSES[round % 4];
        let given = Given { tcp: ["post", "control"][rng.pick(2)], ..Given::default() };
        let bench = bench(class, &given);
        let most = if class.name == "nutating head" { 85.0 } else { 160.0 };
        let clear =
            |axis: Vector3<f64>| (4.0..most).contains(&angle(axis, Vector3::z()).to_degrees());
        let (from, to) = loop {
            let from = rng.direction();
            let about = Unit::new_normalize(across(&mut rng, from));
            let to = Rotation3::from_axis_angle(&about, rng.range(1.0, 3.0)) * from;
            if (0..=40).all(|step| clear(slerp(from, to, f64::from(step) / 40.0))) {
                break (from, to);
            }
        };
        let points = [point(rng.point(50.0), from, true), point(rng.point(50.0), to, false)];
        let run = bench.run(&cl(&points, 1000.0));
        faults.runs += 1;
        let what = format!(
            "round {round}, {}, {}, from {:.4?} to {:.4?}",
            class.name,
            given.tcp,
            points[0].axis.as_slice(),
            points[1].axis.as_slice()
        );
        if run.report.is_none() {
            faults.tolerance.push(format!("{what}: {}", run.told()));
            continue;
        }
        let begin = bench.joints(run.arrival(line(0)).expect("a position"));
        let end = bench.joints(run.arrival(line(1)).expect("a position"));
        let solver = bench.machine.solver(class.length).expect("a form");
        let steps: Vec<Point> = (0..=200)
            .map(|step| {
                let t = f64::from(step) / 200.0;
                Point {
                    tip: points[0].tip * (1.0 - t) + points[1].tip * t,
                    axis: slerp(points[0].axis.normalize(), points[1].axis.normalize(), t),
                    rapid: false,
                }
            })
            .collect();
        let mut at = begin;
        for pair in steps.windows(2) {
            at = followed(&bench, &solver, (&pair[0], &at), &pair[1]).expect("a way").0;
        }
        let off =
            bench.rotary().iter().map(|place| (at[*place] - end[*place]).abs()).fold(0.0, f64::max);
        let turn = bench
            .rotary()
            .iter()
            .map(|place| (at[*place] - begin[*place]).abs())
            .fold(0.0, f64::max);
        far += usize::from(turn > std::f64::consts::PI);
        if off > 1e-3 {
            faults.travel.push(format!(
                "{what}: ends {:.1}° off, after a turn by {:.1}°",
                off.to_degrees(),
                turn.to_degrees()
            ));
        }
        let (tip, axis) = strays(&bench, &points, &run);
        if tip > 0.005 + 1e-6 || axis > 0.05 + 1e-6 {
            faults.tolerance.push(format!("{what}: tip {tip}, axis {axis}"));
        }
    }
    println!(
        "{} long cuts, {far} of them turn an axis by more than half a turn; {} end elsewhere",
        faults.runs,
        faults.travel.len()
    );
    for fault in faults.travel.iter().take(5) {
        println!("{fault}");
    }
    told(&faults.tolerance, faults.runs);
}

/// Between two points that an axis can stand at its travel may end: the side on which it does not is taken.
#[test]
fn a_side_whose_travel_ends_between_two_points_is_not_taken() {
    let points = [
        point(Vector3::zeros(), leaning(95.0, -28.0), true),
        point(Vector3::new(40.0, 0.0, 0.0), leaning(95.0, 28.0), false),
    ];
    for (start, tilt) in [("A = -95", [-95.3, 120.0]), ("A = 95", [-120.0, 95.3])] {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                second: tilt,
                more: format!("[solution]\nstart = {{ {start} }}"),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let run = bench.run(&cl(&points, 1000.0)).good(&format!("{start}, {tcp}"));
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{start}, {tcp}: {axis} by {over}");
        }
    }
}

/// A control that shows C over one turn takes the shorter way: every word is within that turn, and every block's
/// shorter way is the one that is meant.
#[test]
fn an_axis_shown_over_one_turn_goes_the_way_that_is_meant() {
    let (rounds, mut rng) = randomised(200, 61);
    let mut stages = 0;
    let mut refused = Vec::new();
    for round in rounds {
        let class = &CLASSES[round % 4];
        let range = [[0.0, 360.0], [-180.0, 180.0]][rng.pick(2)];
        let given = Given {
            tcp: ["post", "control"][rng.pick(2)],
            more: "[solution]\npole = \"blend\"".to_owned(),
            ..Given::default()
        };
        let plain = bench(class, &given);
        let shown =
            plain.text.replace("cyclic = true", &format!("cyclic = true\nrange = {range:?}"));
        let bench = Bench::new(&shown, 3, class.length);
        let points = short(&mut rng, class);
        let text = cl(&points, 1000.0);
        let (endless, run) = (plain.run(&text), bench.run(&text));
        if endless.report.is_some() != run.report.is_some() {
            let at = run.findings.iter().find_map(|finding| finding.place.as_ref());
            let line = at.map_or(0, |place| place.line);
            refused.push(format!(
                "round {round}, {}, {}, {range:?}, refused at line {line}: {}\n{:?} to {:?} on an endless axis\n{text}",
                class.name,
                given.tcp,
                run.told(),
                endless.arrival(line - 2),
                endless.arrival(line)
            ));
            continue;
        }
        if run.report.is_none() {
            continue;
        }
        let place = bench.order.iter().position(|place| *place == bench.place("C")).expect("C");
        let motions = run.motions();
        let mut c = endless.motions()[0].words[place];
        for (index, asked) in motions.iter().enumerate() {
            let word = asked.words[place];
            assert!(word >= range[0] && word < range[1], "{word} {range:?}");
            if index > 0 {
                let way = turned(motions[index - 1].words[place].to_radians(), word.to_radians());
                assert!(way.abs().to_degrees() < 179.0, "{way}");
                c += way.to_degrees();
            }
            // Counted by the shorter ways, C is at every CL point where the endless one is.
            if motions.get(index + 1).is_none_or(|next| next.line != asked.line) {
                let meant = endless.arrival(asked.line).expect("a position")[place];
                assert!((c - meant).abs() < 0.01, "round {round}, {}: {c} for {meant}", class.name);
            }
        }
        stages += motions.len() - endless.motions().len().min(motions.len());
    }
    println!("{stages} blocks more than on an endless axis");
    told(&refused, 200);
}

/// The cheapest way through a path, by the cheapest way to every way of standing at every point.
fn cheapest(bench: &Bench, solver: &Solver, points: &[Point]) -> f64 {
    let mut states: Vec<(f64, Joints)> = Vec::new();
    for (index, target) in points.iter().enumerate() {
        let mut next: Vec<(f64, Joints)> = Vec::new();
        if index == 0 {
            let start = bench.machine.solution.start;
            for joints in stands(bench, solver, target) {
                next.push((cost(bench, &start, &joints, false), joints));
            }
        } else if target.rapid {
            for joints in stands(bench, solver, target) {
                let ways =
                    states.iter().map(|(so_far, at)| so_far + cost(bench, at, &joints, true));
                next.push((ways.fold(f64::INFINITY, f64::min), joints));
            }
        } else {
            for (so_far, at) in &states {
                let end = followed(bench, solver, (&points[index - 1], at), target);
                if let Some((joints, false)) = end {
                    next.push((so_far + cost(bench, at, &joints, true), joints));
                }
            }
        }
        states = next;
    }
    states.iter().map(|(cost, _)| *cost).fold(f64::INFINITY, f64::min)
}

/// Longer paths and short windows: what is chosen hangs together at every point, looking ahead over the whole path
/// costs what the cheapest way costs, and looking less far costs more at most.
#[test]
fn a_window_of_any_length_gives_a_path_that_hangs_together() {
    let (rounds, mut rng) = randomised(80, 71);
    let (mut posted, mut refused, mut lost) = (0, 0, 0);
    let mut dearer: std::collections::BTreeMap<u32, f64> = std::collections::BTreeMap::new();
    for round in rounds {
        let class = &CLASSES[round % 4];
        let c = turns(&mut rng);
        let tilt = [[-175.0, 175.0], [-100.0, 40.0], [-30.0, 120.0]][rng.pick(3)];
        // Pieces of short paths, one after the other.
        let mut points: Vec<Point> = Vec::new();
        while points.len() < 45 {
            points.extend(short(&mut rng, class));
        }
        let text = cl(&points, 1000.0);
        let mut best = None;
        for look_ahead in [2000, 46, 45, 30, 13, 7, 4, 3, 2, 1] {
            let given = Given {
                c: format!("{c:?}"),
                second: tilt,
                accuracy: "tolerance = 0.05\naxis_tolerance = 0.05\nrapid_tolerance = 1000000",
                more: format!("[solution]\nlook_ahead = {look_ahead}"),
                decimals: 7,
                ..Given::default()
            };
            let bench = bench(class, &given);
            let solver = bench.machine.solver(class.length).expect("a closed form");
            let best = *best.get_or_insert_with(|| cheapest(&bench, &solver, &points));
            let run = bench.run(&text);
            let what = format!("round {round}, {}, look_ahead {look_ahead}", class.name);
            if run.report.is_none() {
                if look_ahead == 2000 {
                    refused += 1;
                    assert!(best.is_infinite(), "{what}: {}", run.told());
                } else {
                    lost += usize::from(best.is_finite());
                }
                continue;
            }
            assert!(best.is_finite(), "{what}: posted, and there is no way");
            posted += 1;
            let mut at = bench.machine.solution.start;
            let mut sum = 0.0;
            for (index, target) in points.iter().enumerate() {
                let next = bench.joints(run.arrival(line(index)).expect("a position"));
                assert!(
                    inside(
                        &bench,
                        &std::array::from_fn(|place| {
                            // To the decimals.
                            (next[place] * 1e6).round() / 1e6
                        })
                    ),
                    "{what}: {next:?}"
                );
                if index > 0 && !target.rapid {
                    let from = (&points[index - 1], &at);
                    let (end, _) = followed(&bench, &solver, from, target).expect("a way");
                    for place in bench.rotary() {
                        assert!(
                            (end[place] - next[place]).abs() < 1e-5,
                            "{what}: point {index} jumps"
                        );
                    }
                }
                sum += cost(&bench, &at, &next, index > 0);
                at = next;
            }
            let over = sum / best - 1.0;
            assert!(over > -1e-6, "{what}: costs {sum}, less than {best}");
            if look_ahead == 2000 {
                assert!(over < 1e-6, "{what}: costs {sum}, the cheapest way {best}");
            }
            let most = dearer.entry(look_ahead).or_insert(0.0);
            *most = most.max(over);
        }
    }
    println!("{posted} posted, {refused} refused, {lost} more where the window was too short");
    println!("dearer than the cheapest way at most, by look_ahead: {dearer:.3?}");
    assert!(posted > at_least(200));
}

/// A portal without Z, its Z made by two swinging arms: there is no closed form, and every block of a program holds
/// tip and axis all the same.
#[test]
fn a_machine_without_a_closed_form_makes_its_program() {
    let text = r#"
name = "two slides, three turns"
chain = "[w b X Y C B A t]"
tool = { gauge = [0, 0, -50] }
control = { dialect = "recorder", tcp = "post" }
[axis]
X = { linear = [1, 0, 0], travel = [-1000, 1000] }
Y = { linear = [0, 1, 0], travel = [-1000, 1000] }
C = { rotary = [0, 0, 1], point = [0, 0, 0], travel = [-400, 400] }
B = { rotary = [0, 1, 0], point = [0, 0, 400], travel = [-170, 170] }
A = { rotary = [0.1, 1, 0.05], point = [0, 5, 150], travel = [-170, 170] }
[solution]
start = { B = 30, A = -30 }
[accuracy]
tolerance = 0.01
axis_tolerance = 0.05
rapid_tolerance = 0.5
"#;
    let bench = Bench::new(text, 4, 0.0);
    assert!(!bench.machine.solver(0.0).expect("a form").closed_form());
    let (rounds, mut rng) = randomised(30, 81);
    let (mut posted, mut refused) = (0, 0);
    let mut faults = Faults::default();
    for round in rounds {
        // A walk of the axes, so that every point can be reached.
        let mut q = Joints::default();
        let slope: Joints = std::array::from_fn(|_| rng.range(-1.0, 1.0));
        let points: Vec<Point> = (0..25)
            .map(|index| {
                let s = 0.2 + 0.01 * f64::from(index);
                for (place, value) in q.iter_mut().enumerate().take(5) {
                    *value = match place {
                        0 | 1 => 100.0 * slope[place] * s,
                        2 => slope[2] * s,
                        3 => 0.5 + slope[3] * s * 0.5,
                        _ => -0.6 + slope[4] * s * 0.5,
                    };
                }
                let (tip, axis) = bench.reference.forward(&q);
                point(tip, axis, index == 0)
            })
            .collect();
        let run = bench.run(&cl(&points, 1000.0));
        faults.runs += 1;
        if run.report.is_none() {
            refused += 1;
            faults.needless.push(format!("round {round}: {}", run.told()));
            continue;
        }
        posted += 1;
        let (tip, axis) = strays(&bench, &points, &run);
        if tip > 0.01 + 1e-6 || axis > 0.05 + 1e-6 {
            faults.tolerance.push(format!("round {round}: tip {tip}, axis {axis}"));
        }
        let (over, axis) = left_travel(&bench, &run);
        if over > 1e-6 {
            faults.tolerance.push(format!("round {round}: {axis} outside travel by {over}"));
        }
    }
    println!("without a closed form: {posted} posted, {refused} refused");
    for fault in faults.needless.iter().take(6) {
        println!("{fault}");
    }
    told(&faults.tolerance, faults.runs);
    told(&faults.needless, faults.runs);
}
