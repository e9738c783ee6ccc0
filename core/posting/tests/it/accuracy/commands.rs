//! What stands between the points, and moves with a time of their own.

use super::*;

/// A dense circle arc from `from` on, `count` points 0.05 mm apart.
fn arc(from: usize, count: usize) -> Vec<Stop> {
    (from..from + count)
        .map(|index| {
            let (sine, cosine) = libm::sincos(index as f64 * 1e-3);
            stop(V::new(50.0 * cosine, 50.0 * sine, 0.0), V::z(), Some(1000.0))
        })
        .collect()
}

/// On a way out that nobody has ended it on, the control would go aside: no program.
#[test]
fn cutter_compensation_ends_before_the_tool_leaves_the_part() {
    let more = "[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1";
    let bench = Bench::new(&usual(true, "post", "cyclic = true", more), 4, 100.0);
    for ends in [true, false] {
        let mut stops = arc(0, 300);
        stops[0].feed = None;
        stops[0].before = "LOADTL/1\nSPINDL/3000,RPM,CLW\n".to_owned();
        stops[100].before = "CUTCOM/LEFT,11\n".to_owned();
        if ends {
            stops[200].before = "CUTCOM/OFF\n".to_owned();
        }
        let (cl, _) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false);
        assert_eq!(run.report.is_some(), ends);
        let told = run.findings.iter();
        let told = told.filter(|finding| finding.message.contains("with cutter compensation on"));
        assert_eq!(told.count(), usize::from(!ends));
    }
}

/// The control offsets the points that it is given: under cutter radius compensation each of them is one of the CL
/// file, and none is missing; before and behind it they are left out.
#[test]
fn under_cutter_compensation_every_point_stays() {
    for config in CONFIGS {
        let more = format!("[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1\n{config}");
        let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
        let mut stops = arc(0, 300);
        stops[0].feed = None;
        stops[0].before = "LOADTL/1\nSPINDL/3000,RPM,CLW\n".to_owned();
        stops[100].before = "CUTCOM/LEFT,11\n".to_owned();
        stops[200].before = "CUTCOM/OFF\n".to_owned();
        let (cl, lines) = text(&stops);
        let run = bench.run_with(&cl, &mut Shape::Fine, false).good("compensated");
        for index in 99..200 {
            let of: Vec<_> = run
                .motions()
                .into_iter()
                .filter(|asked| asked.line == lines[index])
                .cloned()
                .collect();
            assert_eq!(of.len(), 1, "{config}: point {index}");
            let tip = V::new(of[0].words[0], of[0].words[1], of[0].words[2]);
            assert!((tip - stops[index].tip).norm() < 2e-4, "{config}: point {index}");
        }
        // The words that switch it stand between the same points as in the CL file.
        let places: Vec<usize> =
            (0..run.asked.len()).filter(|place| run.asked[*place].kind == "Compensate").collect();
        assert_eq!(places.len(), 2);
        for (place, index) in places.iter().zip([100, 200]) {
            assert_eq!(run.asked[place - 1].line, lines[index - 1], "{config}");
            assert!(run.asked[place + 1].line >= lines[index], "{config}");
        }
        let report = run.report.unwrap();
        assert_eq!(report.points_dropped > 0, config.contains("reduce"));
    }
}

/// Every kind of command stands behind the point that it stands behind in the CL file, and that point is met.
#[test]
fn commands_stay_between_their_points() {
    for command in [
        "COOLNT/ON",
        "COOLNT/OFF",
        "SPINDL/2000,RPM,CLW",
        "SPINDL/OFF",
        "PPRINT/HERE",
        "INSERT HERE",
        "DELAY/2",
        "STOP",
        "OPSTOP",
        "LOADTL/2",
        "GOHOME",
    ] {
        for config in CONFIGS {
            let more = format!("[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.1\n{config}");
            let bench = Bench::new(&usual(true, "post", "cyclic = true", &more), 4, 100.0);
            let mut stops = arc(0, 200);
            stops[0].feed = None;
            stops[77].before = format!("{command}\n");
            let (cl, lines) = text(&stops);
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(command);
            let place = (0..run.asked.len())
                .rfind(|place| {
                    let asked = &run.asked[*place];
                    asked.words.is_empty() && asked.line == lines[77] - 1
                })
                .unwrap_or_else(|| panic!("{command} is not carried out"));
            let before = run.asked[..place].iter().rfind(|asked| !asked.words.is_empty());
            let before = before.expect("a motion");
            assert_eq!(before.line, lines[76], "{command}, {config}");
            let tip = V::new(before.words[0], before.words[1], before.words[2]);
            assert!((tip - stops[76].tip).norm() < 2e-4, "{command}, {config}: {tip}");
            assert!(
                run.asked[place..]
                    .iter()
                    .filter(|asked| !asked.words.is_empty())
                    .all(|asked| asked.line >= lines[77]),
                "{command}, {config}"
            );
        }
    }
}

/// A move that has a time of its own takes it, in however many blocks, and is put together with none.
#[test]
fn moves_with_a_time_of_their_own_keep_it() {
    let (rounds, mut rng) = randomised(20, 53);
    let given = Given {
        tables: 2,
        usual: true,
        tcp: "post",
        along: 0.0,
        radius: 0.0,
        decimals: 4,
        tolerance: 0.005,
        axis_tolerance: 1.0,
        pole: "exact",
        corner: 10.0,
    };
    for _ in rounds {
        let machine = machine(&mut rng, &given);
        let stops = path(&mut rng, &bench_of(&machine, &given, ""), Profile::Smooth, 12);
        let (cl, lines) = text(&stops);
        let cl = cl.replace("FEDRAT/1000,MMPM", "FEDRAT/INVERS,4");
        for config in CONFIGS {
            let bench = bench_of(&machine, &given, config);
            let run = bench.run_with(&cl, &mut Shape::Fine, false).good(config);
            for line in &lines[1..] {
                let time: f64 = run
                    .asked
                    .iter()
                    .filter(|asked| asked.line == *line)
                    .filter_map(|asked| match asked.feed {
                        Some(Feed::InverseTime(feed)) => Some(1.0 / feed),
                        _ => None,
                    })
                    .sum();
                assert!((time * 4.0 - 1.0).abs() < 1e-4, "{config}: {time}");
            }
        }
    }
}

/// Where one of two axes at most moves in a block, no block that is made of several legs or balanced about one moves
/// both.
#[test]
fn axes_that_exclude_one_another_never_move_together() {
    for tcp in ["post", "control"] {
        for config in CONFIGS {
            let more = format!(
                "[solution]\nexclusive = [[\"A\", \"C\"]]\npole = \"exact\"\n[accuracy]\ntolerance = 0.01\naxis_tolerance = 0.5\n{config}"
            );
            let bench = Bench::new(&usual(false, tcp, "cyclic = true", &more), 4, 0.0);
            let (a, c) = (bench.place("A"), bench.place("C"));
            // By turns A and C, the tip going on evenly.
            let mut angles = [0.5f64, 0.3];
            let stops: Vec<Stop> = (0..60)
                .map(|index| {
                    if index > 0 {
                        angles[index / 4 % 2] += 0.01;
                    }
                    let mut joints = Joints::default();
                    (joints[a], joints[c]) = (angles[0], angles[1]);
                    // As printed, so that the other axis does not move by a rounding error.
                    for joint in [a, c] {
                        joints[joint] =
                            (libm::rint(joints[joint].to_degrees() * 10.0) / 10.0).to_radians();
                    }
                    let axis = bench.reference.forward(&joints).1;
                    let tip = V::new(index as f64, 0.1 * index as f64, 0.0);
                    stop(tip, axis, (index > 0).then_some(1000.0))
                })
                .collect();
            let run = bench.run_with(&text(&stops).0, &mut Shape::Fine, false);
            let run = run.good(config);
            for block in blocks(&bench, &run) {
                let moves = |joint: usize| (block.to[joint] - block.from[joint]).abs() > 1e-9;
                assert!(!(moves(a) && moves(c)), "{config}: {block:?}");
            }
        }
    }
}

/// Pieces shorter than the words' decimals have no pace of their own: a move of 20 µm that turns by 6° takes the same
/// time however many pieces it is cut into; in one piece that of its bow besides.
#[test]
fn pieces_of_a_short_move_are_paced_as_the_move_is() {
    let cl = "UNITS/MM\nLOAD/TOOL,1\nSPINDL/1000,CLW\nRAPID\nGOTO/0,0,50,0.3,0,0.9539392\nFEDRAT/250,MMPM\n\
        GOTO/0,0,0,0.3,0,0.9539392\nGOTO/0.02,0,0,0.3984011,0,0.9172114\nGOTO/10,0,0,0.3984011,0,0.9172114\n";
    let machine = "name = \"head\"\nchain = \"[w b X Y Z C A t]\"\n[tool]\ngauge = [0, 0, 0]\n\
        [axis.X]\nlinear = [1, 0, 0]\ntravel = [-900, 900]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-900, 900]\n\
        [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-900, 900]\n\
        [axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\ntravel = [-360, 360]\nmax_feed = 7200\n\
        [axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0, 150]\ntravel = [-110, 110]\nmax_feed = 7200\n\
        [control]\ndialect = \"own\"\ntcp = \"post\"\n[accuracy]\n";
    let mut times = Vec::new();
    for config in [
        "tolerance = 5",
        "placement = \"bisect\"",
        "placement = \"even\"",
        "placement = \"fewest\"",
        "method = \"compensate\"",
    ] {
        let run = Bench::new(&format!("{machine}{config}\n"), 3, 100.0).run(cl).good(config);
        times.push(run.report.as_ref().map_or(0.0, |report| report.cutting_time_s));
    }
    let [whole, pieces @ ..] = &times[..] else { panic!("{times:?}") };
    for time in pieces {
        assert!((time - pieces[0]).abs() < 1e-3, "{times:?}");
    }
    // In one piece the tip bows aside by 0.24 mm, and goes out and back at the feed: 0.48 mm at 250 mm/min.
    let bow = whole - pieces[0];
    assert!((0.09..0.12).contains(&bow), "{times:?}");
}
