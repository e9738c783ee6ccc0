//! Planned feeds, by the printed words alone: what is asked of a circle and of a line has closed forms, and a plan never
//! changes the path, nor makes it faster than the CL file asks for.

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_plugin::Feed;
use post_posting::PostingRequest;
use post_testkit::{Rng, at_least, randomised};
use post_testruns::posted::{Asked, Bench, Run, cl, point, post};

type V = Vector3<f64>;

const LENGTH: f64 = 100.0;

/// Three axes of 500 mm/s², and two that turn in a table.
fn machine(tcp: &str, more: &str) -> String {
    let mut text =
        "name = \"planned\"\nchain = \"[w C' A' b X Y Z t]\"\n[tool]\ngauge = [0, 0, 0]\n"
            .to_owned();
    for (name, direction) in [("A", "[1, 0, 0]"), ("C", "[0, 0, 1]")] {
        writeln!(
            text,
            "[axis.{name}]\nrotary = {direction}\npoint = [0, 0, -20]\ncyclic = true\nmax_feed = 7200\nmax_accel = 600"
        )
        .unwrap();
    }
    for (name, direction) in [("X", "[1, 0, 0]"), ("Y", "[0, 1, 0]"), ("Z", "[0, 0, 1]")] {
        writeln!(
            text,
            "[axis.{name}]\nlinear = {direction}\ntravel = [-5000, 5000]\nmax_feed = 20000\nmax_accel = 500\n[servo.{name}.transfer]\nnumerator = [50]\ndenominator = [1, 50]"
        )
        .unwrap();
    }
    writeln!(
        text,
        "[control]\ndialect = \"recorder\"\ntcp = \"{tcp}\"\nfeed = \"per-minute\"\nfeed_length = \"linear\"\n[accuracy]\ntolerance = 0.01\n{more}"
    )
    .unwrap();
    text
}

fn run(bench: &Bench, text: &str, plans: bool) -> Run {
    let job = PostingRequest { tool_length: Some(LENGTH), plans, ..PostingRequest::default() };
    post(&bench.machine, 3, text, job, &mut post_testruns::posted::Samples).good(text)
}

fn feed(asked: &Asked) -> f64 {
    match asked.feed {
        Some(Feed::PerMinute(feed)) => feed,
        _ => panic!("no feed a minute: {asked:?}"),
    }
}

/// Cuts of a program: all but its first position.
fn cuts(run: &Run) -> Vec<&Asked> {
    run.motions().into_iter().filter(|asked| asked.kind == "Linear").collect()
}

/// A circle of this radius, its chords so long, an upright tool.
fn circle(radius: f64, chord: f64, feed: f64) -> String {
    let count = (std::f64::consts::TAU * radius / chord) as usize;
    let points: Vec<_> = (0..=count)
        .map(|index| {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * index as f64 / count as f64);
            let tip = V::new(radius * cosine, radius * sine, 0.0);
            point(tip, V::z(), index == 0)
        })
        .collect();
    cl(&points, feed)
}

/// The feeds in the middle of a program, where neither its start nor its end matters.
fn middle(run: &Run) -> Vec<f64> {
    let cuts = cuts(run);
    let feeds = cuts.iter().map(|asked| feed(asked));
    feeds.skip(cuts.len() / 3).take(cuts.len() / 3).collect()
}

/// On a circle each axis is accelerated by `v² / R`.
#[test]
fn a_circle_is_as_fast_as_its_acceleration_allows() {
    for (radius, chord) in [(5.0, 0.1), (20.0, 0.5), (60.0, 1.0)] {
        let bench = Bench::new(&machine("post", ""), 3, LENGTH);
        let found = run(&bench, &circle(radius, chord, 18000.0), true);
        let wanted = 60.0 * (500.0 * radius).sqrt();
        let feeds = middle(&found);
        let mean = feeds.iter().sum::<f64>() / feeds.len() as f64;
        assert!((mean / wanted - 1.0).abs() < 0.08, "R {radius}: {mean} for {wanted}");
        let most = feeds.iter().fold(0.0, |most: f64, feed| most.max(*feed));
        // Where both axes share it the tool may go faster, by the fourth root of two.
        assert!(most < 1.19 * wanted, "R {radius}: {most} for {wanted}");
    }
}

/// `T = 2 sqrt(R² - (R - δ)²) / v` of the chord of one period.
#[test]
fn the_chord_error_of_a_period_limits_a_circle() {
    let plan = "[plan]\nchord_error = 0.0002\n[motion]\nperiod = 0.01\n";
    let bench = Bench::new(&machine("control", plan), 3, LENGTH);
    let found = run(&bench, &circle(20.0, 0.5, 18000.0), true);
    let wanted = 60.0 * 2.0 * (2.0 * 20.0 * 0.0002f64).sqrt() / 0.01;
    for feed in middle(&found) {
        assert!((feed / wanted - 1.0).abs() < 0.05, "{feed} for {wanted}");
    }
}

/// `v = sqrt(2 a s)` from rest and to it, in steps below it.
#[test]
fn a_line_is_gone_from_rest_to_rest_in_steps() {
    let bench = Bench::new(&machine("post", ""), 3, LENGTH);
    let points = [point(V::zeros(), V::z(), true), point(V::new(100.0, 0.0, 0.0), V::z(), false)];
    let found = run(&bench, &cl(&points, 6000.0), true);
    let cuts = cuts(&found);
    assert!(cuts.len() > 8, "{}", cuts.len());
    // The ends of pieces are rounded to 0.001 mm.
    let planned = |x: f64| 60.0 * (1000.0 * (x.min(100.0 - x) + 1e-3)).sqrt().min(100.0);
    let mut from = 0.0;
    let mut seconds = 0.0;
    for (index, cut) in cuts.iter().enumerate() {
        let to = cut.words[0];
        let [slow, fast] = [planned(from).min(planned(to)), planned(from).max(planned(to))];
        let at_rest = index == 0 || index + 1 == cuts.len();
        let most = if at_rest { fast } else { slow };
        assert!(feed(cut) <= most * 1.02, "{from} to {to}: {} over {most}", feed(cut));
        seconds += 60.0 * (to - from) / feed(cut);
        from = to;
    }
    assert_eq!(from, 100.0);
    // By the plan 0.2 s longer than at 100 mm/s all the way: each end is 10 mm long.
    assert!(seconds > 1.2 && seconds < 1.2 * 1.04, "{seconds}");
}

/// A path over part and axes: smooth, with corners, short and long legs, turns on the spot.
fn path(rng: &mut Rng) -> String {
    let mut points = Vec::new();
    let (mut tip, mut heading, mut lean) = (rng.point(30.0), rng.direction(), 0.2);
    for index in 0..60 {
        points.push((tip, lean, 0.02 * f64::from(index), index == 0 || rng.pick(25) == 0));
        if rng.pick(8) == 0 {
            heading = rng.direction();
        }
        if rng.pick(12) != 0 {
            tip += heading * rng.order(-1.5, 1.3);
        }
        lean = (lean + rng.range(-0.02, 0.02)).clamp(0.05, 0.6);
    }
    let points: Vec<_> = points
        .into_iter()
        .map(|(tip, lean, turn, rapid)| {
            let (sine, cosine) = libm::sincos(turn);
            let axis = V::new(libm::sin(lean) * cosine, libm::sin(lean) * sine, libm::cos(lean));
            point(tip, axis, rapid)
        })
        .collect();
    cl(&points, rng.order(2.5, 4.0))
}

#[test]
fn a_plan_leaves_the_path_as_it_is_and_makes_no_block_faster() {
    let (rounds, mut rng) = randomised(24_u16, 131);
    let mut pieces = 0;
    for round in rounds {
        let tcp = ["post", "control"][usize::from(round % 2)];
        let solver = ["", "[plan]\nsolver = \"jerk\"\ncontour_error = 0.005\n"][rng.pick(2)];
        let bench = Bench::new(&machine(tcp, solver), 3, LENGTH);
        let text = path(&mut rng);
        let planned = run(&bench, &text, true);
        let report = planned.report.as_ref().unwrap();
        let plan = report.plan.as_ref().unwrap();
        assert!(report.tip_deviation_mm.value <= bench.machine.accuracy.tolerance, "{text}");
        assert_eq!(plan.blocks_unplanned, 0, "{}\n{text}", planned.told());
        pieces += plan.blocks_added;
        // Each CL point is come to by the same words as without a plan, blocks in between are on the way.
        let plain = run(&bench, &text, false);
        let last = |run: &Run| -> Vec<(u64, Vec<f64>)> {
            let motions = run.motions();
            let ends = motions.iter().enumerate().filter(|(index, asked)| {
                motions.get(index + 1).is_none_or(|next| next.line != asked.line)
            });
            ends.map(|(_, asked)| (asked.line, asked.words.clone())).collect()
        };
        let [with, without] = [last(&planned), last(&plain)];
        assert_eq!(with, without, "{text}");
        let motions = planned.motions();
        for pair in motions.windows(2) {
            if pair[1].kind != "Linear" {
                continue;
            }
            let asked: f64 = {
                let line = text.lines().nth(pair[1].line as usize - 2).unwrap();
                let number = line.trim_start_matches("FEDRAT/").trim_end_matches(",MMPM");
                number.parse().unwrap_or(f64::INFINITY)
            };
            let [from, to] = [&pair[0].words, &pair[1].words].map(|words| bench.joints(words));
            let ends = [from, to].map(|joints| bench.reference.forward(&joints).0);
            let way = (ends[1] - ends[0]).norm();
            // Where the tip makes most of the way F is its feed; the words are rounded to 0.001 mm.
            if tcp == "control" && way > 0.1 {
                assert!(
                    feed(pair[1]) <= asked * (1.0 + 1e-9),
                    "{} over {asked}\n{text}",
                    feed(pair[1])
                );
            }
        }
        // Once more is the same.
        assert_eq!(run(&bench, &text, true).asked, planned.asked);
    }
    assert!(pieces > at_least(100), "{pieces}");
}

/// A cut between two rapids, too short for samples of its own: it is planned from rest to rest, `T = 2 sqrt(s / a)`.
#[test]
fn a_short_cut_between_rapids_is_planned() {
    let bench = Bench::new(&machine("post", ""), 3, LENGTH);
    for length in [0.01, 0.1, 0.5] {
        let stops = [(0.0, true), (length, false), (50.0, true)];
        let points = stops.map(|(x, rapid)| point(V::new(x, 0.0, 0.0), V::z(), rapid));
        let found = run(&bench, &cl(&points, 6000.0), true);
        let plan = found.report.as_ref().unwrap().plan.as_ref().unwrap();
        let wanted = 2.0 * libm::sqrt(length / 500.0);
        println!("{length} mm: {} s, by hand {wanted} s", plan.planned_s);
        assert_eq!(plan.blocks_unplanned, 0, "{}", found.told());
        assert!((plan.planned_s / wanted - 1.0).abs() < 0.05, "{} {wanted}", plan.planned_s);
    }
}

/// CL points that lie closer together than they are exact: no plan of them is written that is slower than none.
#[test]
fn points_a_micron_apart_keep_their_feed() {
    let mut rng = Rng::new(26);
    let bench = Bench::new(&machine("control", ""), 4, LENGTH);
    let points: Vec<_> = (0..400)
        .map(|index| {
            let way = f64::from(index) * 0.001;
            let noise = |rng: &mut Rng| (rng.range(-0.5, 0.5) * 1e3).round() * 1e-6;
            let tip = V::new(way, noise(&mut rng), noise(&mut rng));
            let lean = 0.3 + way + 1e-3 * rng.range(-1.0, 1.0);
            let (sine, cosine) = libm::sincos(lean);
            point(tip, V::new(sine, 0.0, cosine), index == 0)
        })
        .collect();
    let text = cl(&points, 1200.0);
    let found = run(&bench, &text, true);
    let plan = found.report.as_ref().unwrap().plan.as_ref().unwrap().clone();
    let slowest = cuts(&found).iter().map(|asked| feed(asked)).fold(f64::INFINITY, f64::min);
    println!("{plan:?}, slowest F{slowest}");
    assert!(slowest > 0.5, "F{slowest}");
    assert!(plan.planned_s < 3600.0, "{} s", plan.planned_s);
    let told =
        found.findings.iter().any(|finding| finding.message.contains("slower than standing still"));
    assert_eq!(told, plan.blocks_too_slow > 0);
}
