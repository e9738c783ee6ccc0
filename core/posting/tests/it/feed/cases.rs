//! Single cases, their numbers worked out by hand.

use post_machine::description::{Source, load};
use post_plugin::{Capabilities, Feed};
use post_posting::PostingRequest;
use post_testruns::posted::{Bench, Recorder, Run, Samples, watched};

/// A fork head of 500 mm; `more` goes to `[control]`.
pub fn fork(tcp: &str, more: &str) -> String {
    format!(
        "name = \"fork\"
chain = \"[w b X Y Z C B t]\"
[tool]
gauge = [0, 0, 0]
[axis.X]
linear = [1, 0, 0]
travel = [-1000, 1000]
max_feed = 30000
[axis.Y]
linear = [0, 1, 0]
travel = [-750, 750]
max_feed = 30000
[axis.Z]
linear = [0, 0, 1]
travel = [-950, 50]
max_feed = 2000
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 7200
[axis.B]
rotary = [0, 1, 0]
point = [0, 0, 500]
travel = [-105, 105]
max_feed = 3600
[control]
dialect = \"recorder\"
tcp = \"{tcp}\"
{more}
[accuracy]
tolerance = 0.005
axis_tolerance = 0.5
rapid_tolerance = 100
"
    )
}

/// `B` at -10° and 10°, the tip at rest or not.
fn swing(x: f64, z: f64, pace: &str) -> String {
    let (sine, cosine) = libm::sincos(10f64.to_radians());
    format!(
        "UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/3000,RPM,CLW\nRAPID\nGOTO/0,0,{z},{},0,{cosine}\n{pace}\n\
         GOTO/{x},0,{z},{sine},0,{cosine}\nFINI\n",
        -sine
    )
}

fn feed_of(run: &Run) -> f64 {
    match run.motions().last().and_then(|asked| asked.feed) {
        Some(Feed::PerMinute(feed)) => feed,
        other => panic!("{other:?}: {}", run.told()),
    }
}

/// The depth axis goes up by 500·(1 - cos 10°) = 7.596 mm and down again, at 500·sin 10°·20° = 30.307 mm a block at
/// the ends of it: with 2000 mm/min the block takes 0.015153 min, and the tip goes 100 mm in it.
#[test]
fn a_fork_swings_its_depth_axis() {
    let bench = Bench::new(&fork("control", ""), 4, 0.0);
    let run = bench.run(&swing(100.0, -10.0, "FEDRAT/8000,MMPM"));
    let feed = feed_of(&run);
    assert!(feed <= 6599.1 && feed > 0.995 * 6599.1, "{feed}");
    let report = run.report.expect("a good run");
    assert_eq!(report.blocks_limited, 1);
    let z = report.axes.iter().find(|axis| axis.name == "Z").unwrap();
    assert!((z.max - z.min - 7.596).abs() < 1e-3 && (z.way - 15.192).abs() < 2e-3, "{z:?}");
    // The tip lies 500 mm below the head's turning point: Z is at its highest with the fork upright, 60 mm of the tip
    // and the end of travel at 50.
    let run = bench.run(&swing(100.0, 55.0, "FEDRAT/8000,MMPM"));
    assert!(run.report.is_none());
    let told = run.told();
    let wanted = "over-travel: between the words of this block Z would be 55.000 mm, its limit is 50.000 mm, passed by 5.000 mm: \
                  the control keeps the tip on its line while B turns from -10.000° to 10.000°";
    assert!(told.contains(wanted), "{told}");
    // No rotary axis turns the part: the mount that brings Z to its end is known, a little more for the bound.
    let mut helps = run.findings.iter().filter_map(|finding| finding.help.as_ref());
    assert!(
        helps.any(|help| help.starts_with("--mount 0,0,-5.001 brings Z to this limit")),
        "{:?}",
        run.findings
    );
    assert!(bench.run(&swing(100.0, 49.9, "FEDRAT/8000,MMPM")).report.is_some());
}

/// A disc's centre 100 mm above the tip: the feed is the tip's, and the axes are judged by what the control makes of
/// it. With the tip going 10 mm in 20° of B at 3600°/min the feed is 10 mm in 1/180 min.
#[test]
fn the_feed_is_the_tips_whatever_is_guided() {
    let with = |along: f64| {
        let text = fork("control", "").replace(
            "gauge = [0, 0, 0]",
            &format!("gauge = [0, 0, 0]\ncontrol_point = {{ along = {along} }}"),
        );
        let text = text
            .replace("max_feed = 2000\n", "max_feed = 20000\n")
            .replace("max_feed = 30000", "max_feed = 90000")
            .replace("\ntolerance = 0.005", "\ntolerance = 10");
        feed_of(&Bench::new(&text, 4, 0.0).run(&swing(10.0, -10.0, "FEDRAT/5000,MMPM")))
    };
    let (tip, above) = (with(0.0), with(100.0));
    assert!((tip - above).abs() < 1e-9, "{tip} {above}");
    assert!((1795.0..=1800.0).contains(&tip), "{tip}");
}

/// Eqs. 4 and 5 of the prediction paper (Zhang, Chen 2025): the control divides the root of the squares of the tip's way
/// and of the turns in radians by F. B turns by 20° while the tip goes 0.5 mm: F is by `hypot(0.5, 0.349…)/0.5` above the
/// feed of the tip.
#[test]
fn a_control_may_count_turns_along_with_the_tip() {
    let text = fork("control", "tcp_feed_length = \"combined\"")
        .replace("max_feed = 3600", "max_feed = 3600\nfeed_diameter = 2")
        .replace("max_feed = 2000", "max_feed = 30000");
    let run = Bench::new(&text, 4, 0.0).run(&swing(0.5, -10.0, "FEDRAT/50,MMPM"));
    let wanted = 50.0 * libm::hypot(0.5, 20f64.to_radians()) / 0.5;
    assert!((feed_of(&run) - (wanted * 10.0).floor() / 10.0).abs() < 1e-9);
    let time = run.report.unwrap().cutting_time_s;
    assert!((time - 0.6).abs() < 0.6 * 0.1 / wanted, "{time}");
}

/// Three axes and no turn: 30 mm along X and 40 along Y are 50 for the tip, 50 as a root of squares, and 40 for a
/// control that looks at the longest way.
#[test]
fn the_length_of_the_control_counts_where_nothing_turns() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/3000,RPM,CLW\nRAPID\nGOTO/0,0,-10\nFEDRAT/1000,MMPM\nGOTO/30,40,-10\nFINI\n";
    for (length, wanted) in [("linear", 1000.0), ("combined", 1000.0), ("longest", 800.0)] {
        let more = format!("feed_length = \"{length}\"");
        let run = Bench::new(&fork("post", &more), 3, 0.0).run(cl);
        assert_eq!(feed_of(&run), wanted, "{length}");
        let time = run.report.unwrap().cutting_time_s;
        assert!((time - 3.0).abs() < 1e-9, "{length}: {time}");
    }
    // Y leans by 60 µm a mm towards X: the words are 30 - 40·60e-6 and 40 long.
    let leaning = fork("post", "").replace("linear = [0, 1, 0]", "linear = [0.00006, 1, 0]");
    let run = Bench::new(&leaning, 3, 0.0).run(cl);
    let words = &run.motions().last().unwrap().words;
    let root = libm::hypot(words[0], words[1]);
    let wanted = (root / 50.0 * 10_000.0).floor() / 10.0;
    assert!(
        (feed_of(&run) - wanted).abs() <= 0.1 + 1e-9 && wanted < 1000.0,
        "{} {wanted}",
        feed_of(&run)
    );
}

/// The recorder prints feeds with one decimal, and inverse times with four.
#[test]
fn a_feed_below_the_least_printed_is_not_raised_in_silence() {
    let cl = |feed: &str, x: f64| {
        format!(
            "UNITS/MM\nLOADTL/1\nSPINDL/3000,RPM,CLW\nRAPID\nGOTO/0,0,-10\nFEDRAT/{feed},MMPM\nGOTO/{x},0,-10\nFINI\n"
        )
    };
    let bench = Bench::new(&fork("post", ""), 3, 0.0);
    // A thousandth of a mm a minute for 0.05 mm: 50 minutes, 0.02 of the block a minute.
    let run = bench.run(&cl("0.001", 0.05)).good("a slow feed");
    let feed = run.motions().last().unwrap().feed;
    assert_eq!(feed, Some(Feed::InverseTime(0.02)));
    assert!((run.report.unwrap().cutting_time_s - 3000.0).abs() < 1e-6);
    // No word for 10 million minutes.
    let run = bench.run(&cl("0.00001", 100.0));
    assert_eq!(feed_of(&run), 0.1);
    let wanted = "low-feed: the feed of a block is below F0.1, the least that the dialect recorder prints, and F0.1 is written: \
                  the lowest would be F0.00001, on CL line 7";
    assert!(run.told().contains(wanted), "{}", run.told());
    let report = run.report.unwrap();
    assert!((report.cutting_time_s - 60_000.0).abs() < 1e-6, "{}", report.cutting_time_s);
}

/// Nobody knows how the tool comes to the first position: no axis may be too fast, whatever the direction.
#[test]
fn a_first_approach_keeps_the_largest_feeds() {
    let cl = "UNITS/MM\nLOADTL/1\nSPINDL/3000,RPM,CLW\nFEDRAT/50000,MMPM\nGOTO/0,0,-10\nGOTO/0,0,-11\nFINI\n";
    for tcp in ["control", "post"] {
        for mode in ["per-minute", "inverse-time"] {
            let run = Bench::new(&fork(tcp, &format!("feed = \"{mode}\"")), 3, 0.0).run(cl);
            let first = run.motions()[0];
            assert_eq!(
                (first.kind, first.feed),
                ("Position", Some(Feed::PerMinute(2000.0))),
                "{tcp} {mode}"
            );
        }
    }
}

/// B turns by 20° in a rapid: at its largest feed in 1/180 min, in which Z would have to go at 30.307·180 = 5455 mm/min.
#[test]
fn rapids_that_are_too_fast_are_named_or_fed() {
    let cl = swing(1.0, -10.0, "RAPID");
    let run = Bench::new(&fork("control", ""), 4, 0.0).run(&cl);
    assert_eq!(run.motions().last().unwrap().kind, "Rapid");
    let fast = run.report.unwrap().fast_rapids;
    assert_eq!((fast.count, fast.axis.as_str(), fast.line), (1, "Z", 8));
    assert!((fast.factor - 2.728).abs() < 0.01, "{fast:?}");
    // As a feed move it takes 0.015153 min for 1 mm of the tip.
    let run = Bench::new(&fork("control", "rapid = \"linear\""), 4, 0.0).run(&cl);
    let feed = feed_of(&run);
    assert!(feed <= 65.99 && feed > 65.0, "{feed}");
    let report = run.report.unwrap();
    assert_eq!((report.fast_rapids.count, report.cutting_time_s), (0, 0.0));
    assert!((report.time_s - 60.0 / feed).abs() < 1e-9);
    // Where the post keeps the tip the axes go evenly, and B is the slowest of them: 1/180 min.
    let run = Bench::new(&fork("post", "rapid = \"linear\""), 4, 0.0).run(&cl);
    for asked in &run.motions()[1..] {
        let Some(Feed::InverseTime(feed)) = asked.feed else {
            panic!("{asked:?}");
        };
        assert!(feed <= 180.0 + 1e-6, "{feed}");
    }
    let run = Bench::new(&fork("post", ""), 4, 0.0).run(&cl);
    assert!(run.motions()[1..].iter().all(|asked| asked.feed.is_none()));
    assert_eq!(run.report.unwrap().fast_rapids.count, 0);
    // A rapid along a straight line stays one.
    let upright =
        "UNITS/MM\nLOADTL/1\nSPINDL/3000,RPM,CLW\nRAPID\nGOTO/0,0,-10\nRAPID\nGOTO/0,9,-10\nFINI\n";
    let run = Bench::new(&fork("post", "rapid = \"linear\""), 4, 0.0).run(upright);
    assert_eq!(run.motions().last().unwrap().kind, "Rapid");
}

/// A control that looks at the axes of the program alone while it keeps the tip.
#[test]
fn a_dialect_says_that_joints_may_be_too_fast_in_a_rapid() {
    let last = |machine: &str| {
        let bench = Bench::new(machine, 4, 0.0);
        let mut recorder = Recorder::new(&bench.machine, 4);
        recorder.capabilities = Capabilities::TCP_RAPIDS_PASS;
        let job = PostingRequest { tool_length: Some(0.0), ..PostingRequest::default() };
        let cl = swing(1.0, -10.0, "RAPID");
        let run = watched(&bench.machine, recorder, &cl, job, &mut Samples, &mut []);
        (run.motions().last().unwrap().kind, run.report.unwrap().fast_rapids.count)
    };
    assert_eq!(last(&fork("control", "")), ("Linear", 0));
    assert_eq!(last(&fork("control", "rapid = \"rapid\"")), ("Rapid", 1));
    // The axes of the program are all there are.
    assert_eq!(last(&fork("post", "")), ("Rapid", 0));
    // There is no feed to write.
    let unknown = fork("control", "").replace("max_feed = 2000\n", "");
    assert_eq!(last(&unknown).0, "Rapid");
}

#[test]
fn rapids_are_fed_where_every_axis_has_a_largest_feed_alone() {
    let text = fork("control", "rapid = \"linear\"").replace("max_feed = 2000\n", "");
    let source = Source { name: "machine.toml".to_owned(), text };
    let faults = load(source, &[], &mut |_| Err(String::new())).expect_err("no feed for Z");
    assert!(
        faults.iter().any(
            |fault| fault.code == "machine-feed" && fault.message.contains("Z has no max_feed")
        )
    );
}

/// Where a dialect says that its control divides along all axes together, that is the default: 10 mm and 20° of B.
#[test]
fn a_dialect_says_along_what_a_feed_counts() {
    let feed = |more: &str, writes: Capabilities| {
        let text = fork("post", &format!("feed = \"per-minute\"\n{more}"));
        let text = text.replace("\ntolerance = 0.005", "\ntolerance = 10");
        let text = text.replace("max_feed = 2000\n", "max_feed = 20000\n");
        let bench = Bench::new(&text, 4, 0.0);
        let mut recorder = Recorder::new(&bench.machine, 4);
        recorder.capabilities = writes;
        let job = PostingRequest { tool_length: Some(0.0), ..PostingRequest::default() };
        let cl = swing(10.0, -10.0, "FEDRAT/300,MMPM");
        feed_of(&watched(&bench.machine, recorder, &cl, job, &mut Samples, &mut []))
    };
    let linear = feed("", Capabilities::NONE);
    let combined = feed("", Capabilities::FEED_ALL_AXES);
    assert!(combined > linear + 1.0, "{combined} {linear}");
    assert_eq!(combined, feed("feed_length = \"combined\"", Capabilities::NONE));
    assert_eq!(linear, feed("feed_length = \"linear\"", Capabilities::FEED_ALL_AXES));
}
