//! Random machines and paths: what is certified holds, and is close.

use super::*;

const PROFILES: [Profile; 9] = [
    Profile::Smooth,
    Profile::Corners,
    Profile::Dense,
    Profile::Uneven,
    Profile::Kinks,
    Profile::Turns,
    Profile::Pole,
    Profile::Across,
    Profile::Mixed,
];

/// Random machines, random paths, every way of error control.
#[test]
fn every_block_stays_within_what_is_certified() {
    let (rounds, mut rng) = randomised(160, 1);
    let mut faults: Vec<String> = Vec::new();
    let (mut programs, mut skipped) = (0, 0);
    let mut sums = [0usize; CONFIGS.len()];
    let mut missed = 0.0f64;
    for round in rounds.clone() {
        let profile = PROFILES[round % PROFILES.len()];
        let given = given(&mut rng);
        let given = Given { usual: given.usual || profile == Profile::Across, ..given };
        let machine = machine(&mut rng, &given);
        let samples = if round % 40 == 0 { 10_000 } else { 60 };
        let count = if samples > 100 { 5 } else { 24 };
        let bench = bench_of(&machine, &given, CONFIGS[0]);
        let stops = path(&mut rng, &bench, profile, count);
        let (cl, lines) = text(&stops);
        let mut made: [Option<Found>; CONFIGS.len()] = Default::default();
        for (which, config) in CONFIGS.iter().enumerate() {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false);
            let what = format!("round {round}, {profile:?}, {}, {config:?}", given.tcp);
            if run.report.is_none() {
                if which == 0 {
                    skipped += 1;
                    break;
                }
                faults.push(format!("{what}: refused: {}", run.told()));
                continue;
            }
            programs += 1;
            match hold(&bench, &given, &stops, &lines, &run, samples, config) {
                Ok(found) => {
                    made[which] = Some(found);
                    sums[which] += found.blocks;
                    missed = missed.max(found.missed / given.tolerance);
                }
                Err(fault) => faults.push(format!("{what}: {fault}; {given:?}")),
            }
        }
        // Left out or not, the program takes the same time. A point that is put in may lean by the tolerance of the tool axis;
        // where another point than the tip is guided the tip goes there and back.
        let lean = 2.0 * given.along.abs() * given.axis_tolerance.to_radians() / (1000.0 / 60.0);
        let made: Vec<Found> = made.iter().flatten().copied().collect();
        let put_in = |found: &Found| found.blocks.saturating_sub(stops.len() - 1) as f64;
        for found in &made {
            let apart = (found.time - made[0].time).abs();
            let allowed = 0.02 * made[0].time + lean * (put_in(found) + put_in(&made[0]));
            let turns = profile == Profile::Turns && given.along != 0.0;
            if apart > allowed && !turns {
                let times: Vec<f64> = made.iter().map(|found| found.time).collect();
                faults.push(format!("round {round}, {profile:?}: s {times:?}"));
                break;
            }
        }
    }
    println!("{programs} programs, {skipped} refused from the start");
    for (config, sum) in CONFIGS.iter().zip(sums) {
        println!("{config:?}: {sum} blocks");
    }
    println!("missed {missed} of the tolerance");
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
    assert!(skipped * 5 < rounds.end, "{skipped}");
}

/// On small moves what is certified is hardly more than what is sampled.
#[test]
fn the_certificate_is_close() {
    let (rounds, mut rng) = randomised(150, 41);
    let mut worst = [0.0f64; 2];
    let mut counted = 0;
    for round in rounds {
        let given = Given {
            radius: 0.0,
            tcp: "post",
            decimals: 7,
            tolerance: 5.0,
            axis_tolerance: 5.0,
            pole: "exact",
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let bench = bench_of(&machine, &given, CONFIGS[round % 8]);
        let profile = [Profile::Smooth, Profile::Uneven, Profile::Kinks][round % 3];
        // Two points: nothing can be left out.
        let stops = path(&mut rng, &bench, profile, 2);
        let (cl, _) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false).good("a move");
        let report = run.report.as_ref().unwrap();
        let path = wanted(&stops, given.along);
        let blocks = blocks(&bench, &run);
        assert_eq!(blocks.len(), 1);
        let [tip, axis] = strays(&bench, &blocks[0], &path);
        let certified =
            [report.tip_deviation_mm.value, report.axis_deviation_deg.value.to_radians()];
        assert!(tip <= certified[0] + 1e-8, "{tip} over {certified:?}");
        assert!(axis <= certified[1] + 1e-9, "{axis} over {certified:?}");
        let turns = (0..bench.reference.joints.len())
            .filter(|joint| bench.reference.joints[*joint].rotary)
            .map(|joint| (blocks[0].to[joint] - blocks[0].from[joint]).abs());
        if turns.fold(0.0, f64::max) < 0.03 {
            counted += 1;
            if tip > 1e-4 {
                worst[0] = worst[0].max(certified[0] / tip);
            }
            if axis > 1e-5 {
                worst[1] = worst[1].max(certified[1] / axis);
            }
        }
    }
    println!("certified at most {worst:?} of the sampled, {counted} small moves");
    assert!(worst[0] < 1.05 && worst[1] < 1.05 && counted > at_least(50), "{worst:?}");
}

/// Where the control keeps the tip, the point above it swings with the tool axis, which may bend more than any
/// direction across it that the cutting edge has.
#[test]
fn a_point_above_a_tip_that_the_control_keeps_is_bounded() {
    let (rounds, mut rng) = randomised(200, 47);
    let mut most = 0.0f64;
    for _ in rounds {
        let along = rng.range(50.0, 100.0);
        let text_of = usual(
            true,
            "control",
            "cyclic = true",
            "[accuracy]\ntolerance = 5\naxis_tolerance = 20\n[solution]\npole = \"exact\"",
        )
        .replace(
            "gauge = [0, 0, 0]",
            &format!("gauge = [0, 0, 0]\ncontrol_point = {{ along = {along}, radius = 0.001 }}"),
        );
        let bench = Bench::new(&text_of, 6, 100.0);
        let lean = |a: f64, c: f64| {
            let mut joints = Joints::default();
            joints[bench.place("A")] = a;
            joints[bench.place("C")] = c;
            bench.reference.forward(&joints).1
        };
        let (a, c) = (rng.range(0.05, 0.4), rng.range(-2.0, 2.0));
        let turns = [rng.range(0.0, 0.1), rng.range(0.0, 0.1)];
        let stops = [
            stop(V::zeros(), lean(a, c), None),
            stop(V::new(3.0, 1.0, 0.0), lean(a + turns[0], c + turns[1]), Some(100.0)),
        ];
        let run = bench.run(&text(&stops).0).good("a lean");
        let certified = run.report.as_ref().unwrap().tip_deviation_mm.value;
        let path = wanted(&stops, along);
        let made = blocks(&bench, &run);
        let [sampled, _] = strays(&bench, &made[0], &path);
        most = most.max(sampled / certified);
    }
    println!("a point above the tip: sampled at most {most} of the certified");
    assert!(most <= 1.0, "{most}");
}

/// Runs longer than what waits at a time are held like short ones.
#[test]
fn long_runs_are_held() {
    let (rounds, mut rng) = randomised(6, 59);
    for round in rounds {
        let given = Given {
            decimals: 4,
            tolerance: 0.01,
            axis_tolerance: 0.2,
            pole: "exact",
            corner: 10.0,
            ..given(&mut rng)
        };
        let machine = machine(&mut rng, &given);
        let first = bench_of(&machine, &given, CONFIGS[0]);
        let profile = [Profile::Smooth, Profile::Dense, Profile::Mixed][round % 3];
        let stops = path(&mut rng, &first, profile, 900);
        let (cl, lines) = text(&stops);
        for config in [CONFIGS[0], CONFIGS[4], CONFIGS[6]] {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false);
            if run.report.is_none() && config == CONFIGS[0] {
                break;
            }
            let run = run.good(config);
            let found = hold(&bench, &given, &stops, &lines, &run, 12, config)
                .unwrap_or_else(|fault| panic!("{profile:?}, {config:?}: {fault}, {given:?}"));
            println!("{profile:?}, {config:?}: {} blocks", found.blocks);
        }
    }
}

/// A knife whose edge leads along a curve: with points left out, axis and edge both stay within what is certified of
/// what the CL file asks for thereabouts.
#[test]
fn a_leading_edge_stays_within_what_is_certified() {
    let axes = [("C", V::z(), 0.0), ("B", V::y(), 160.0), ("A", V::z(), 0.0)];
    for config in CONFIGS {
        for (tcp, bend) in [("post", 0.02f64), ("post", 0.002), ("control", 0.01)] {
            let mut machine =
                "name = \"knife\"\nchain = \"[w b X Y Z C B A t]\"\n[tool]\ngauge = [0, 0, 0]\nedge = [1, 0, 0]\n"
                    .to_owned();
            for (name, direction, height) in axes {
                writeln!(
                    machine,
                    "[axis.{name}]\nrotary = [{}, {}, {}]\npoint = [0, 0, {height}]\ntravel = [-700, 700]\nmax_feed = 1e6",
                    direction.x, direction.y, direction.z
                )
                .unwrap();
            }
            write!(
                machine,
                "{LINEAR}[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\n[solution]\nedge = \"cl\"\n[accuracy]\ntolerance = 0.02\naxis_tolerance = 0.2\n{config}"
            )
            .unwrap();
            let bench = Bench::new(&machine, 4, 50.0);
            let mut cl = "UNITS/MM\nMULTAX/ON\nFEDRAT/1000,MMPM\n".to_owned();
            let (mut path, mut edges) = (Vec::new(), Vec::new());
            let mut tip = V::zeros();
            for index in 0..120 {
                let turn = bend * f64::from(index);
                let (sine, cosine) = libm::sincos(turn);
                let way = V::new(cosine, sine, 0.0);
                let axis = leaned(V::z(), way, 0.35 + 0.1 * sine);
                let edge = (way - axis * axis.dot(&way)).normalize();
                writeln!(
                    cl,
                    "GOTO/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9},{:.9},{:.9},{:.9}",
                    tip.x, tip.y, tip.z, axis.x, axis.y, axis.z, edge.x, edge.y, edge.z
                )
                .unwrap();
                path.push((tip, axis));
                edges.push(edge);
                tip += way * 0.7;
            }
            cl += "FINI\n";
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(config);
            let report = run.report.as_ref().unwrap();
            if config.contains("reduce") && bend < 0.02 {
                assert!(report.points_dropped > 20, "{config}: {}", report.points_dropped);
            }
            let (bound, turn) = (
                report.tip_deviation_mm.value + 1e-5,
                report.axis_deviation_deg.value.to_radians() + 1e-7,
            );
            let mut walk = Walk::new(&path);
            for block in blocks(&bench, &run) {
                for step in 0..=40 {
                    let t = f64::from(step) / 40.0;
                    let last = block.lines[1] as usize - 5;
                    walk.reach(block.at(&bench, t), last, bound, turn)
                        .unwrap_or_else(|off| panic!("{config}: {off:?} in {block:?}"));
                    let edge = block.rotation(&bench, t) * V::x();
                    // The tip says where it is to its tolerance, and no better.
                    let (leg, at) = walk.at();
                    let apart = (0..=20)
                        .map(|look| at + 2.0 * bound / 0.7 * f64::from(look) / 20.0)
                        .map(|at| {
                            let (leg, at) = if at > 1.0 && leg + 2 < path.len() {
                                (leg + 1, at - 1.0)
                            } else {
                                (leg, at.min(1.0))
                            };
                            angle(edge, slerp(edges[leg], edges[leg + 1], at))
                        })
                        .fold(f64::INFINITY, f64::min);
                    assert!(
                        apart <= turn + 1e-6,
                        "{config}, {tcp}, {bend}: the edge is off by {}°, certified {}°",
                        apart.to_degrees(),
                        turn.to_degrees()
                    );
                }
            }
            assert!(walk.at().0 + 2 == path.len(), "{config}");
        }
    }
}
