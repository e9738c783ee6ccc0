//! What an examiner of `post lint`, `read` and `predict` found, each on the program that he found it with.

use std::fs;
use std::path::Path;

use post_testkit::assert_contains;
use serde_json::Value;

use crate::common::{post_in, read_json, root, sample};

/// A folder with programs.
fn folder(programs: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in programs {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Posts a sample on a machine as `part.nc`.
fn posted(folder: &Path, name: &str, words: &[&str]) {
    let input = root().join(sample(name));
    let mut all = vec!["-q", "-o", "part.nc", input.to_str().unwrap()];
    all.extend(words);
    let run = post_in(folder, &all);
    assert_eq!(run.code, 0, "{words:?}: {}", run.err);
}

/// Positions of the machine are where they are, wherever the part sits.
#[test]
fn machine_positions_beyond_travel_are_told_where_nobody_says_where_the_part_sits() {
    let fanuc = |z: f64, x: f64| {
        format!("%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z{z:.1}\nG53 G0 X{x:.1}\nM30\n%\n")
    };
    let siemens = |z: f64, x: f64| {
        format!("G90 G71 G17 G40 G94\nG500\n\nG0 SUPA Z{z:.1} D0\nG0 SUPA X{x:.1} D0\nM30\n")
    };
    for (machine, dialect) in
        [("vmc", "fanuc"), ("router", "fanuc"), ("grbl-router", "fanuc"), ("vmc", "siemens")]
    {
        let text = |z, x| if dialect == "fanuc" { fanuc(z, x) } else { siemens(z, x) };
        let folder = folder(&[("far.nc", &text(500.0, 5000.0)), ("near.nc", &text(-5.0, 50.0))]);
        let dialect = format!("control.dialect=\"{dialect}\"");
        let verb = |verb: &str, file: &str| {
            post_in(folder.path(), &[verb, file, "-m", machine, "--set", &dialect])
        };
        for what in ["lint", "read"] {
            let far = verb(what, "far.nc");
            assert_eq!(far.code, 1, "{what} {machine} {dialect}: {}{}", far.out, far.err);
            assert_contains(
                &far.err,
                &[
                    "error[over-travel]: Z would be at 500.000",
                    "X would be at 5000.000",
                    "2 errors",
                ],
            );
            assert_contains(&far.err, &["far.nc:4", "far.nc:5"]);
            let near = verb(what, "near.nc");
            assert_eq!(near.code, 0, "{what} {machine} {dialect}: {}{}", near.out, near.err);
            assert!(!near.err.contains("over-travel"), "{}", near.err);
        }
    }
}

/// Programs of a few bytes whose time at the machine is days.
const LONG: [(&str, &str); 4] = [
    ("far.nc", "G0 X1.0 Y2.0\nG1 X1000000. F100.0\n"),
    ("slow.nc", "G0 X1.0 Y2.0\nG1 X3.0 F0.001\n"),
    ("wait.nc", "G0 X1.0 Y2.0\nG4 P999999999\nG1 X2. F100.\n"),
    ("turn.nc", "G0 X1.0 Y2.0\nG1 C1000000000. F1000.\n"),
];

/// Of motion and rest at one speed the time is known without a set-point; what would need a hundred million is refused.
#[test]
fn a_block_of_days_is_timed_at_once_and_no_set_points_are_made_of_it() {
    let folder = folder(&LONG);
    let hours = [166.67, 33.33, 277.78, 16666.67];
    for ((name, _), hours) in LONG.iter().zip(hours) {
        let machine = ["-m", "ac-trunnion", "--tool-length", "100"];
        let linted =
            post_in(folder.path(), &[&["lint", name, "--json", "-"], &machine[..]].concat());
        let found: Value = serde_json::from_str(&linted.out).unwrap();
        let seconds = found["predicted_s"].as_f64().unwrap();
        assert!((seconds / 3600.0 - hours).abs() < 0.01, "{name}: {seconds} s");
        let predicted = post_in(folder.path(), &[&["predict", name], &machine[..]].concat());
        assert_eq!(predicted.code, 1, "{}", predicted.out);
        let told = ["error[too-long]: this block takes ", "2 h 46 min at most", "help: ", ".nc:2"];
        assert_contains(&predicted.err, &told);
    }
    let travel =
        post_in(folder.path(), &["lint", "far.nc", "-m", "ac-trunnion", "--tool-length", "100"]);
    assert_contains(&travel.err, &["error[over-travel]: X would be at 1000000.000"]);
    // The bound is one of set-points: with a longer period a longer block is predicted.
    fs::write(folder.path().join("rest.nc"), "G0 X1.0\nG4 X10001.0\nG1 X2. F100.\n").unwrap();
    let words = ["predict", "rest.nc", "-m", "ac-trunnion", "--tool-length", "100"];
    for (period, code) in [("0.001", 1), ("0.01", 0)] {
        let run = post_in(folder.path(), &[&words[..], &["--period", period]].concat());
        assert_eq!(run.code, code, "{period}: {}", run.err);
    }
}

/// Each wait is short enough, and all of them are not.
#[test]
fn waits_of_hours_one_behind_the_other_are_not_predicted() {
    let folder = folder(&[(
        "waits.nc",
        "G0 X1.0 Y2.0\n#1=0\nWHILE [#1 LT 1000] DO1\n#1=#1+1\nG4 X9000.\nEND1\n",
    )]);
    let machine = ["-m", "ac-trunnion", "--tool-length", "100", "--period", "0.1"];
    let run = post_in(folder.path(), &[&["predict", "waits.nc"], &machine[..]].concat());
    assert_eq!(run.code, 1, "{}", run.out);
    let told = [
        "error[too-long]: the waits up to here take 10 h 00 min",
        "8 h 00 min at most",
        "waits.nc:5",
    ];
    assert_contains(&run.err, &told);
}

#[test]
fn posting_ends_at_once_where_a_block_takes_days() {
    let cl = "PARTNO/A\nUNITS/MM\nLOADTL/1\nSPINDL/8000,RPM,CLW\nFEDRAT/0.1,MMPM\nRAPID\nGOTO/0,0,50,0,0,1\n\
        GOTO/1,0,50,0,0,1\nGOTO/100,0,50,0,0,1\nFINI\n";
    let folder = folder(&[("slow.cls", cl)]);
    let words = ["slow.cls", "-m", "ac-trunnion", "--tool-length", "100", "-o", "slow.nc"];
    let run = post_in(folder.path(), &[&words[..], &["--predict"]].concat());
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(&run.err, &["error[too-long]", "16 h 29 min", "nothing was written"]);
    let run = post_in(folder.path(), &[&words[..], &["--plan"]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn a_turn_of_millions_of_degrees_is_not_cut_into_chords() {
    let text = "G21 G90\nG0 X1.0 Y2.0\nM3 S1000\nG43 H1 Z100.\nG1 C1000000000. F1000.\nM30\n";
    let folder = folder(&[("turn.nc", text)]);
    let run = post_in(
        folder.path(),
        &[
            "convert",
            "turn.nc",
            "--from",
            "ac-trunnion",
            "--to",
            "dmu50",
            "--tool-length",
            "100",
            "-o",
            "to.h",
        ],
    );
    assert_eq!(run.code, 1, "{}", run.out);
    assert_contains(&run.err, &["line 5 of the program turns", "100000 pieces", "decimal point"]);
    assert!(!folder.path().join("to.h").exists());
}

/// What lint says without set-points is what `post predict` finds with them.
#[test]
fn the_time_that_is_told_is_that_of_the_prediction() {
    for (machine, name) in [
        ("ac-trunnion", "blade.cls"),
        ("bc-fork", "wedge.ncl"),
        ("dmu50", "facets.apt"),
        ("vmc", "plate.ncl"),
    ] {
        let folder = folder(&[]);
        posted(folder.path(), name, &["-m", machine, "--tool-length", "100"]);
        let on = ["-m", machine, "--tool-length", "100"];
        post_in(folder.path(), &[&["lint", "part.nc", "--json", "lint.json"], &on[..]].concat());
        let run = post_in(
            folder.path(),
            &[&["predict", "part.nc", "--summary", "p.json"], &on[..]].concat(),
        );
        assert_eq!(run.code, 0, "{machine}: {}", run.err);
        let told = read_json(&folder.path().join("lint.json"))["predicted_s"].as_f64().unwrap();
        let found = read_json(&folder.path().join("p.json"))["time"]["cycle_s"].as_f64().unwrap();
        assert!((told - found).abs() < 1e-9 * found, "{machine}: {told} s, {found} s");
    }
}

/// A tool that leans comes in across its axis, as high up as it was changed, with the length in the next block.
#[test]
fn programs_of_heads_that_lean_call_their_lengths_in_time() {
    for machine in ["bc-fork", "disc-cutter", "head-table-sr", "ultrasonic-knife", "vertical-lathe"]
    {
        let folder = folder(&[]);
        posted(folder.path(), "wedge.ncl", &["-m", machine, "--tool-length", "100"]);
        let run =
            post_in(folder.path(), &["lint", "part.nc", "-m", machine, "--tool-length", "100"]);
        assert_eq!(run.code, 0, "{machine}: {}", run.err);
        // Without the table of lengths the block that calls one is refused: it called it all the same.
        let run = post_in(folder.path(), &["lint", "part.nc", "-m", machine]);
        assert!(!run.err.contains("error[length]"), "{machine}: {}", run.err);
        // And where none is called it is told still.
        let text = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        let bare = text.replace("G43 H2 ", "");
        assert_ne!(bare, text);
        fs::write(folder.path().join("part.nc"), bare).unwrap();
        let run =
            post_in(folder.path(), &["lint", "part.nc", "-m", machine, "--tool-length", "100"]);
        assert_contains(
            &run.err,
            &["[length]: tool 2 comes down, and no length of it is in force"],
        );
    }
}

#[test]
fn a_time_that_cannot_be_predicted_is_one_warning() {
    let folder = folder(&[]);
    let machine = ["-m", "lathe-xzc-polar", "--tool-length", "100"];
    let words = [&machine[..], &["--tool", "1", "--spindle", "3000", "--feed", "500"]].concat();
    posted(folder.path(), "lever.apt", &words);
    let lint = ["lint", "part.nc", "--json", "found.json"];
    let run = post_in(folder.path(), &[&lint[..], &machine[..]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(&run.err, &["warning[mode]: how long it takes is not predicted", "part.nc:"]);
    assert_contains(&run.out, &["time at the stated feeds"]);
    let found = read_json(&folder.path().join("found.json"));
    assert_eq!(found["findings"].as_array().unwrap().len(), 1, "{found:#}");
    let run = post_in(
        folder.path(),
        &[&lint[..], &machine[..], &["--ignore", "mode", "--strict"]].concat(),
    );
    assert_eq!((run.code, run.err.as_str()), (0, ""), "{}", run.out);
    assert_contains(&run.out, &["1 mode"]);
}

/// A program that cannot be read is told apart from one in which something is wrong, and keeps nothing of the others back.
#[test]
fn the_others_are_looked_over_where_a_program_cannot_be_read() {
    let good = "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z-5.\nM30\n%\n";
    let bad = good.replace("Z-5.", "Z500.");
    let folder = folder(&[("good.nc", good), ("bad.nc", &bad)]);
    fs::create_dir(folder.path().join("folder")).unwrap();
    let run = post_in(
        folder.path(),
        &[
            "lint",
            "bad.nc",
            "nosuch.nc",
            "folder",
            "good.nc",
            "-m",
            "vmc",
            "--json",
            "j.json",
            "--sarif",
            "s.json",
        ],
    );
    assert_eq!(run.code, 2, "{}", run.err);
    assert_contains(
        &run.err,
        &["error[over-travel]", "nosuch.nc: ", "folder is a folder", "3 errors"],
    );
    assert!(
        !run.err.contains("nothing was written") && !run.err.contains("CL file"),
        "{}",
        run.err
    );
    assert_contains(&run.out, &["bad.nc, ", "good.nc, "]);
    let found = read_json(&folder.path().join("j.json"));
    let codes: Vec<_> =
        found.as_array().unwrap().iter().map(|one| &one["findings"][0]["code"]).collect();
    assert_eq!(
        codes,
        ["over-travel", "input", "input", ""]
            .map(|code| match code {
                "" => Value::Null,
                code => code.into(),
            })
            .iter()
            .collect::<Vec<_>>()
    );
    let log = read_json(&folder.path().join("s.json"));
    let ended = &log["runs"][0]["invocations"][0];
    assert_eq!(ended["executionSuccessful"], false);
    assert_eq!(ended["toolExecutionNotifications"].as_array().unwrap().len(), 2);
    assert_eq!(log["runs"][0]["results"].as_array().unwrap().len(), 1);
    for (names, code) in [(&["good.nc"][..], 0), (&["bad.nc"], 1), (&["nosuch.nc"], 2)] {
        let run = post_in(folder.path(), &[&["lint", "-m", "vmc"], names].concat());
        assert_eq!(run.code, code, "{names:?}: {}", run.err);
        assert!(!run.err.contains("nothing was written"), "{}", run.err);
    }
}

/// A stock takes the place of the guess only where a cutter is drawn that can be held against it.
#[test]
fn of_a_stock_without_a_cutter_it_is_said_that_nothing_is_proven() {
    let deep = super::GOOD.replace("Z2.\nG1 Z-5. F300.\nX40.", "Z2.\nG0 Z-5.\nG1 X40. F300.");
    let stock = "[stock]\nblock = [[3, 3, -20], [57, 37, 0]]\n";
    let (_folder, _, found) = super::linted(&deep, stock, &[]);
    let told = super::told(&found);
    assert!(told.contains(&("rapid".to_owned(), 25)), "{found:#}");
    assert!(told.contains(&("clearance-body".to_owned(), 0)), "{found:#}");
    assert!(found.to_string().contains("no cutter is drawn"), "{found:#}");
    let cutter = format!("cutter = [[0, 3], [60, 3]]\n{stock}");
    let deep = deep.replace("T2 M6", "T3 M6").replace("G43 H2", "G43 H3");
    let (_folder, _, found) = super::linted(&deep, &cutter, &[]);
    let told = found.to_string();
    assert!(told.contains("of cutters that are not drawn: cutter T1\""), "{found:#}");
}

/// A feed of 0 is seen while the control keeps the tip, and behind a block that is not understood and says no feed.
#[test]
fn cuts_without_a_feed_are_seen_wherever_they_stand() {
    let tcp = "G21 G17 G40 G49 G80 G90 G94\nT1 M6\nS6000 M3\nG54\nM428\nG0 X0 Y0 A0 C0\nG43 H1 Z50\nM8\nZ2\nG1 Z-5\n\
        X1 A1\nX2 A2\nG0 Z50\nM9\nM5\nM429\nG53 G0 Z0\nM30\n";
    let mill = |odd: &str| {
        format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS6000 M3\nG54\n{odd}\nG0 X0. Y0.\nG43 H1 Z50.\nM8\nG0 Z2.\n\
             G1 Z-5. F0\nX20.\nG0 Z50.\nM9\nM5\nG49\nG53 G0 Z0.\nM30\n%\n"
        )
    };
    let [odd, feeds] = ["G0 B0.", "G1 B0. F500."].map(mill);
    let folder = folder(&[("tcp.ngc", tcp), ("odd.nc", &odd), ("feeds.nc", &feeds)]);
    let lint = |name: &str, machine: &str| {
        post_in(folder.path(), &["lint", name, "-m", machine, "--tool-length", "50"])
    };
    let says = "cuts without a feed: F is missing, or 0";
    let run = lint("tcp.ngc", "xyzac-trt");
    assert!(run.code == 1 && run.err.contains(says), "{}", run.err);
    let run = lint("odd.nc", "vmc");
    assert!(run.err.contains("B is no axis") && run.err.contains(says), "{}", run.err);
    let run = lint("feeds.nc", "vmc");
    assert!(run.err.contains("B is no axis") && !run.err.contains(says), "{}", run.err);
}

/// A rapid that ends inside the raw part is told, whether a cutter is drawn or not.
#[test]
fn rapids_into_the_raw_part_are_told_without_a_cutter() {
    let into = |z: &str| {
        format!(
            "%\nO1\nG21 G17 G40 G80 G90 G94\nG53 G0 Z0.\nT1 M6\nS6000 M3\nG54\nG0 X0. Y0.\nG43 H1 Z50.\nM8\nG0 Z{z}\n\
             G1 Z-6. F500.\nX60.\nY40.\nG0 Z50.\nM9\nM5\nG49\nG53 G0 Z0.\nM30\n%\n"
        )
    };
    let [deep, above] = ["-5.", "2."].map(into);
    let folder = folder(&[("deep.nc", &deep), ("above.nc", &above)]);
    let says = "a rapid ends inside the raw part ([stock]), where nothing was cut before";
    for (name, told) in [("deep.nc", true), ("above.nc", false)] {
        let stock = "stock.block=[[-5, -5, -20], [65, 45, 0]]";
        let all = ["lint", name, "-m", "vmc", "--tool-length", "100", "--set", stock];
        let run = post_in(folder.path(), &all);
        assert_eq!(run.err.contains(says), told, "{name}: {}", run.err);
    }
}
