//! Cuts that travel does not let end: turned back in a rapid, outside the part, or refused.

use super::*;

/// A tool that leans by `tilt` degrees and goes round once every 360 steps of a degree, from `from` to `to` degrees.
fn orbit(tilt: f64, from: i32, to: i32, rapid: impl Fn(i32) -> bool) -> Vec<Point> {
    (from..=to)
        .map(|step| {
            let lean = f64::from(step);
            let (sine, cosine) = libm::sincos(lean.to_radians());
            let tip = Vector3::new(60.0 * cosine, 60.0 * sine, 0.05 * lean);
            point(tip, leaning(tilt, lean), rapid(step))
        })
        .collect()
}

/// C would pass its travel: off the part it is turned back.
#[test]
fn a_rapid_turns_the_axis_back() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: "[-200, 400]".to_owned(),
                // One side of the tilting axis alone.
                second: [-1.0, 120.0],
                ..Given::default()
            };
            let bench = bench(class, &given);
            // Off the part between 300° and 305°, and on round to 700°.
            let points = orbit(30.0, 0, 700, |step| step == 0 || (300..=305).contains(&step));
            let what = format!("{}, {tcp}", class.name);
            let run = bench.run(&cl(&points, 1000.0)).good(&what);
            let report = run.report.as_ref().expect("a report");
            assert_eq!((report.branch_changes, report.rewinds), (1, 0), "{what}");
            let (tip, axis) = strays(&bench, &points, &run);
            assert!(tip < 0.005 + 1e-9 && axis < 0.05 + 1e-9, "{what}: {tip} {axis}");
            let c: Vec<f64> = run
                .motions()
                .iter()
                .map(|asked| bench.joints(&asked.words)[bench.place("C")].to_degrees())
                .collect();
            assert!(c.iter().all(|c| (-200.0..=400.0).contains(c)), "{what}");
            // The large turn is made in rapids alone.
            for (pair, c) in run.motions().windows(2).zip(c.windows(2)) {
                assert!(pair[1].kind == "Rapid" || (c[1] - c[0]).abs() < 10.0, "{what}");
            }
        }
    }
}

/// A turn off the part leaves the travel of no axis on its way.
#[test]
fn a_rapid_turn_stays_inside_travel() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: "[-200, 400]".to_owned(),
                second: [-1.0, 120.0],
                ..Given::default()
            };
            let bench = bench(class, &given);
            let points = orbit(30.0, 0, 700, |step| step == 0 || (300..=305).contains(&step));
            let run = bench.run(&cl(&points, 1000.0)).good(class.name);
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{}, {tcp}: {axis} by {over}", class.name);
        }
    }
}

/// A long cut without a rapid is refused without `[rewind]`, and the refusal says what was tried.
#[test]
fn without_a_rewind_the_cut_is_refused_and_says_why() {
    for class in &CLASSES {
        let given =
            Given { c: "[-200, 400]".to_owned(), second: [-1.0, 120.0], ..Given::default() };
        let bench = bench(class, &given);
        let points = orbit(30.0, 0, 700, |step| step == 0);
        let run = bench.run(&cl(&points, 1000.0));
        assert!(run.report.is_none());
        let finding = &run.findings[0];
        let told = format!("{}: {}", class.name, finding.message);
        assert_eq!(finding.code, "jump", "{told}");
        // How far C is ahead of the lean.
        let solver = bench.machine.solver(class.length).expect("a form");
        let begin = stands(&bench, &solver, &points[0]);
        let ahead = begin[0][bench.place("C")].to_degrees();
        let place = finding.place.as_ref().expect("a place");
        let index = ((place.line - line(0)) / 2) as usize;
        assert_eq!(place.line, line(index));
        let passes = libm::remainder(ahead + index as f64 - 401.0, 360.0);
        assert!(passes.abs() < 1.0, "{told}: at point {index}, C ahead by {ahead}");
        for word in ["C to 40", "travel -200.000° to 400.000°", "cannot go on from"] {
            assert!(told.contains(word), "{told}");
        }
        assert!(told.contains(class.second), "{told}");
        assert!(finding.help.as_ref().is_some_and(|help| help.contains("[rewind]")));
    }
}

/// One cause, one error: behind it the path goes on as if it began there.
#[test]
fn a_refused_cut_is_told_once() {
    let given = Given { c: "[-200, 400]".to_owned(), second: [-1.0, 120.0], ..Given::default() };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&orbit(30.0, 0, 700, |step| step == 0), 1000.0));
    assert_eq!(run.findings.len(), 1, "{}", run.told());
}

/// A block's time as its control understands it, minutes; none at rapid.
fn minutes(bench: &Bench, from: &Asked, to: &Asked) -> Option<f64> {
    let way = |linear: bool| {
        let steps = bench.order.iter().enumerate();
        steps
            .filter(|(_, place)| bench.reference.joints[**place].rotary != linear)
            .map(|(word, _)| (to.words[word] - from.words[word]).abs())
            .fold(0.0, |sum: f64, step| libm::hypot(sum, step))
    };
    match to.feed? {
        Feed::InverseTime(feed) => Some(1.0 / feed),
        Feed::PerMinute(feed) if way(true) > 1e-9 => Some(way(true) / feed),
        Feed::PerMinute(feed) => Some(way(false) / feed),
        Feed::PerRevolution(_) => None,
    }
}

/// With `[rewind]` the tool is drawn back along its axis, turned with its tip held, and brought back to where it was.
#[test]
fn a_rewind_draws_back_turns_and_returns() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            for (retract, plane) in [("distance = 25", None), ("plane = 90", Some(90.0))] {
                for feeds in ["", "retract_feed = 4000\nturn_feed = 1800\nplunge_feed = 300"] {
                    let given = Given {
                        tcp,
                        c: "[-200, 400]".to_owned(),
                        second: [-1.0, 120.0],
                        more: format!("[rewind]\n{retract}\n{feeds}"),
                        ..Given::default()
                    };
                    let bench = bench(class, &given);
                    let points = orbit(30.0, 0, 700, |step| step == 0);
                    let what = format!("{}, {tcp}, {retract}, {feeds}", class.name);
                    let run = bench.run(&cl(&points, 1000.0)).good(&what);
                    let report = run.report.as_ref().expect("a report");
                    assert_eq!(report.rewinds, 1, "{what}");
                    let turning = rewound(&what, &bench, &points, &run, plane, !feeds.is_empty());
                    let (over, axis) = left_travel(&bench, &run);
                    println!(
                        "    turned at {turning:.0} degrees a minute; outside travel by {over:.3} {axis}"
                    );
                }
            }
        }
    }
}

/// The run of one machine that rewinds.
fn rewinding(class: &Class<'_>, tcp: &str, rewind: &str) -> (Bench, Vec<Point>, Run) {
    let given = Given {
        tcp,
        c: "[-200, 400]".to_owned(),
        second: [-1.0, 120.0],
        more: format!("[rewind]\n{rewind}"),
        ..Given::default()
    };
    let bench = bench(class, &given);
    let points = orbit(30.0, 0, 700, |step| step == 0);
    let run = bench.run(&cl(&points, 1000.0)).good(class.name);
    (bench, points, run)
}

/// While it is turned, no axis leaves its travel.
#[test]
fn a_rewind_stays_inside_travel() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let (bench, _, run) = rewinding(class, tcp, "distance = 25");
            let (over, axis) = left_travel(&bench, &run);
            assert!(over < 1e-6, "{}, {tcp}: {axis} by {over}", class.name);
        }
    }
}

/// It is turned as fast as the machine file says.
#[test]
fn a_rewind_turns_at_its_feed() {
    for class in &CLASSES {
        for tcp in ["post", "control"] {
            let rewind = "distance = 25\nretract_feed = 4000\nturn_feed = 1800\nplunge_feed = 300";
            let (bench, points, run) = rewinding(class, tcp, rewind);
            let feed = rewound(class.name, &bench, &points, &run, None, true);
            assert!((1700.0..1810.0).contains(&feed), "{}, {tcp}: {feed}", class.name);
        }
    }
}

/// Checks the blocks of the only rewind of a run; gives the feed of the turn, degrees a minute.
fn rewound(
    what: &str,
    bench: &Bench,
    points: &[Point],
    run: &Run,
    plane: Option<f64>,
    feeds: bool,
) -> f64 {
    let motions = run.motions();
    let rotary = |words: &[f64]| -> Vec<f64> {
        let joints = bench.joints(words);
        bench.rotary().iter().map(|place| joints[*place].to_degrees()).collect()
    };
    let turn = |from: &[f64], to: &[f64]| -> f64 {
        let (from, to) = (rotary(from), rotary(to));
        from.iter().zip(&to).map(|(a, b)| (a - b).abs()).sum()
    };
    // Its blocks belong to the point where it begins and ends: the tip comes there, leaves it, and comes back.
    let index = (0..points.len())
        .find(|index| {
            let blocks = motions.iter().filter(|asked| asked.line == line(*index));
            blocks.clone().any(|asked| {
                (bench.at(&asked.words, &asked.words, 0.0).0 - points[*index].tip).norm() > 10.0
            })
        })
        .unwrap_or_else(|| panic!("{what}: no rewind"));
    let (tip, axis) = (points[index].tip, points[index].axis.normalize());
    let blocks: Vec<usize> =
        (0..motions.len()).filter(|place| motions[*place].line == line(index)).collect();
    let at = |place: usize| bench.at(&motions[place].words, &motions[place].words, 0.0);
    let first = blocks
        .iter()
        .copied()
        .find(|place| (at(*place).0 - tip).norm() > 10.0)
        .expect("the way out");
    let begin = first - 1;
    assert!((at(begin).0 - tip).norm() < 0.002, "{what}: it does not begin at the point");
    let last = *blocks.last().expect("blocks");
    assert!((at(last).0 - tip).norm() < 0.002, "{what}: it does not end at the point");
    assert!(angle(at(last).1, axis).to_degrees() < 0.05, "{what}");
    // As far as it is drawn back.
    let away = match plane {
        None => tip + axis * 25.0,
        Some(height) => tip + axis * ((height - tip.z) / axis.z),
    };
    // Out, turn and back, told apart by where their blocks end.
    let turned: Vec<usize> = (first..=last)
        .filter(|place| turn(&motions[*place - 1].words, &motions[*place].words) > 1e-3)
        .collect();
    let (turn_first, turn_last) = (turned[0], turned[turned.len() - 1]);
    assert!(turn_first > first, "{what}: it turns on its way out");
    assert!(turn_last < last, "{what}: it turns on its way back");
    assert!(
        (at(turn_first - 1).0 - away).norm() < 0.002,
        "{what}: {:?} {away:?}",
        at(turn_first - 1)
    );
    let whole = turn(&motions[begin].words, &motions[last].words);
    assert!((whole - 360.0).abs() < 0.01, "{what}: turned by {whole}");
    let mut time = [0.0f64; 3];
    let mut way = [0.0f64; 3];
    let mut lowest = f64::INFINITY;
    let mut strayed = [0.0f64; 3];
    for place in first..=last {
        let (from, to) = (motions[place - 1], motions[place]);
        let stage = if place < turn_first { 0 } else { usize::from(place > turn_last) + 1 };
        assert_eq!(
            to.kind,
            if feeds || stage == 2 { "Linear" } else { "Rapid" },
            "{what} stage {stage}"
        );
        time[stage] += minutes(bench, from, to).unwrap_or(0.0);
        way[stage] += (at(place).0 - at(place - 1).0).norm();
        for step in 0..=20 {
            let (reached, _) = bench.at(&from.words, &to.words, f64::from(step) / 20.0);
            lowest = lowest.min((reached - tip).dot(&axis));
            let off = match stage {
                1 => (reached - away).norm(),
                _ => distance(reached, tip, away),
            };
            strayed[stage] = strayed[stage].max(off);
        }
    }
    assert!(lowest > -0.002, "{what}: the tip goes below its start by {lowest}");
    // Off the part the tolerance of a rapid will do; back it comes as a cut does.
    assert!(strayed[0] < 0.5 + 1e-6 && strayed[1] < 0.5 + 1e-6, "{what}: {strayed:?}");
    assert!(strayed[2] < 0.005 + 1e-6, "{what}: {strayed:?}");
    way[1] = whole;
    let feed = [0, 1, 2].map(|stage| way[stage] / time[stage]);
    eprintln!("{what}: {} blocks, strays {strayed:.3?} mm, feeds {feed:.0?}", last - begin);
    let asked =
        if feeds { [4000.0, f64::INFINITY, 300.0] } else { [f64::INFINITY, f64::INFINITY, 1000.0] };
    for stage in [0, 2] {
        if asked[stage] < f64::INFINITY {
            assert!(
                feed[stage] < 1.01 * asked[stage] && feed[stage] > 0.98 * asked[stage],
                "{what}: feed {} of stage {stage}, asked {}",
                feed[stage],
                asked[stage]
            );
        }
    }
    feed[1]
}

/// No more rewinds than the travel asks for, however many turns the cut has.
#[test]
fn a_cut_of_many_turns_rewinds_no_more_than_it_must() {
    // From 0 to 400, and then 360° at a time; or 1440° at a time.
    for (c, rewinds) in [("[-200, 400]", 4), ("[-720, 720]", 1), ("[-350, 350]", 5)] {
        for tcp in ["post", "control"] {
            let given = Given {
                tcp,
                c: c.to_owned(),
                second: [-1.0, 120.0],
                more: "[rewind]\ndistance = 25".to_owned(),
                ..Given::default()
            };
            let bench = bench(&CLASSES[0], &given);
            let points = orbit(30.0, 0, 1800, |step| step == 0);
            let run = bench.run(&cl(&points, 1000.0)).good(c);
            let report = run.report.as_ref().expect("a report");
            println!(
                "C {c}, {tcp}: {} rewinds, rotary way {:.0}°",
                report.rewinds,
                rotary_way(&bench, &run)
            );
            assert_eq!(report.rewinds, rewinds, "C {c}, {tcp}");
        }
    }
}

/// A rewind turns no farther back than the rest of the cut asks for.
#[test]
fn a_rewind_turns_back_no_farther_than_it_must() {
    let given = Given {
        tcp: "control",
        c: "[-720, 720]".to_owned(),
        second: [-1.0, 120.0],
        more: "[rewind]\ndistance = 25\n[solution]\nstart = { C = -720 }".to_owned(),
        ..Given::default()
    };
    let bench = bench(&CLASSES[0], &given);
    let run = bench.run(&cl(&orbit(30.0, 0, 1500, |step| step == 0), 1000.0));
    let way = rotary_way(&bench, &run.good("rewind"));
    assert!((way - 1860.0).abs() < 1.0, "{way}");
}
