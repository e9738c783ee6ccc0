//! Programs that must not run are not written: cutters without tools, cuts without a spindle, lengths that nobody gave,
//! files that end too early.

use crate::common::{Run, command, read_json, run};

use std::fs;

use serde_json::{Value, json};

const HEAD: &str = "UNITS/MM\n";
const TAIL: &str = "FINI\n";

/// Posts a text, to standard output; the summary if there is a program.
fn posted(machine: &str, with: &[&str], text: &str) -> (Run, Value) {
    let folder = tempfile::tempdir().unwrap();
    let summary = folder.path().join("s.json");
    let mut all = vec!["-q", "-m", machine, "-o", "-", "--summary"];
    all.push(summary.to_str().unwrap());
    all.extend(with);
    all.push("-");
    let done = run(command().args(all), text.as_bytes());
    let summary = if summary.is_file() { read_json(&summary) } else { Value::Null };
    (done, summary)
}

const LONG: [&str; 2] = ["--tool-length", "100"];

fn on_vmc(with: &[&str], text: &str) -> Run {
    posted("vmc", &[&LONG, with].concat(), text).0
}

#[track_caller]
fn told(run: &Run, code: i32, parts: &[&str]) {
    assert_eq!(run.code, code, "{}", run.err);
    assert_eq!(run.out.is_empty(), code != 0);
    for part in parts {
        assert!(run.err.contains(part), "`{part}` is not in:\n{}", run.err);
    }
}

/// The lines of a program that have one of the words, without block numbers.
fn lines<'t>(program: &'t str, words: &[&str]) -> Vec<&'t str> {
    let has = |line: &&str| words.iter().any(|word| line.contains(word));
    program.lines().filter(has).collect()
}

const CUT: &str = "RAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\n";

#[test]
fn several_cutters_are_several_tools() {
    let text = format!(
        "{HEAD}CUTTER/10,0\nSPINDL/3000,CLW\n{CUT}CUTTER/10,5\n{CUT}CUTTER/10,0\n{CUT}CUTTER/4\n{CUT}{TAIL}"
    );
    for with in [&["--set", "control.dialect=heidenhain"], &["--tool", "1"]] {
        let done = on_vmc(with, &text);
        told(
            &done,
            1,
            &[
                "error[cutter]",
                "input:10",
                "2 more like it",
                "--tool-from-cutter",
                "--allow CUTTER",
            ],
        );
    }
    let numbered = on_vmc(&["--tool-from-cutter"], &text);
    told(&numbered, 0, &[]);
    let changes: Vec<&str> =
        numbered.out.split_whitespace().filter(|word| word.starts_with('T')).collect();
    // The first cutter comes back as the first tool.
    assert_eq!(changes, ["T1", "T2", "T1", "T3"], "{}", numbered.out);
    let one = on_vmc(&["--tool", "1", "--allow", "CUTTER"], &text);
    told(&one, 0, &["CUTTER, met 3 times, is cut with the tool before"]);
    // The same number for two cutters is a slip of the CAM system, most likely.
    let twice =
        format!("{HEAD}CUTTER/10\nLOADTL/1\nSPINDL/3000,CLW\n{CUT}CUTTER/6\nLOADTL/1\n{CUT}{TAIL}");
    told(&on_vmc(&[], &twice), 1, &["error[cutter]", "input:12", "tool 1 is still in the spindle"]);
    told(&on_vmc(&[], &twice.replace("CUTTER/6\nLOADTL/1", "CUTTER/6\nLOADTL/2")), 0, &[]);
    // A file that loads its tools numbers them itself.
    let loads = text.replace("CUTTER/4\n", "CUTTER/4\nLOADTL/7\n");
    told(&on_vmc(&["--tool-from-cutter"], &loads), 1, &["error[tool]", "loads its tools itself"]);
}

#[test]
fn a_cut_with_a_spindle_that_stands_is_refused() {
    let text = format!("{HEAD}LOADTL/1\n{CUT}LOADTL/2\n{CUT}{TAIL}");
    told(&on_vmc(&[], &text), 1, &["error[spindle]", "input:6", "--spindle RPM", "--spindle off"]);
    let turning = on_vmc(&["--spindle", "6000"], &text);
    told(&turning, 0, &[]);
    let found = lines(&turning.out, &["S6000", " M6"]).len();
    assert_eq!(found, 4, "{}", turning.out);
    let standing = on_vmc(&["--spindle", "off"], &text);
    told(&standing, 0, &[]);
    assert!(lines(&standing.out, &["M3"]).iter().all(|line| line.contains("M30")));
    // A tool for which the file has a speed keeps it, the others get theirs.
    let half = text.replace("LOADTL/2\n", "LOADTL/2\nSPINDL/800,CLW\n");
    let half = on_vmc(&["--spindle", "6000"], &half);
    let speeds = [lines(&half.out, &["S6000"]).len(), lines(&half.out, &["S800"]).len()];
    assert_eq!(speeds, [1, 1], "{}", half.out);
    // Switched off, and cut on.
    let off = format!("{HEAD}LOADTL/1\nSPINDL/800,CLW\n{CUT}SPINDL/OFF\nGOTO/5,0,10\n{TAIL}");
    told(&on_vmc(&[], &off), 1, &["error[spindle]", "input:9", "switched the spindle off"]);
    // A knife turns nothing.
    let text = fs::read_to_string("tests/machines/ultrasonic-knife.ncl").unwrap();
    let knife = posted("ultrasonic-knife", &["--tool-length", "50"], &text).0;
    told(&knife, 0, &[]);
    assert!(!knife.err.contains("spindle"), "{}", knife.err);
}

#[test]
fn speeds_outside_the_range_of_the_spindle_are_refused() {
    let text = |speed: &str| format!("{HEAD}LOADTL/1\nSPINDL/{speed},CLW\n{CUT}{TAIL}");
    let with = ["--set", "spindle.min_speed=60", "--set", "spindle.max_speed=12000"];
    told(&on_vmc(&with, &text("12000")), 0, &[]);
    told(&on_vmc(&with, &text("60")), 0, &[]);
    told(
        &on_vmc(&with, &text("12001")),
        1,
        &["error[spindle-speed]", "input:3", "12001 rpm", "12000 rpm"],
    );
    told(
        &on_vmc(&with, &text("59")),
        1,
        &["error[spindle-speed]", "59 rpm", "60 rpm", "min_speed"],
    );
    // A surface speed is a speed too: 400 m/min on 6 mm.
    let surface = text("SMM,400").replace("LOADTL", "CUTTER/6\nLOADTL");
    told(&on_vmc(&with, &surface), 1, &["error[spindle-speed]", "21220"]);
    let told_one = [&with[..], &["--spindle", "20000"]].concat();
    told(
        &on_vmc(&told_one, &text("800").replace("SPINDL/800,CLW\n", "")),
        1,
        &["error[spindle-speed]"],
    );
    // A head has a spindle of its own: the speed is that of the tool that it swaps in.
    let text_of_heads = fs::read_to_string("tests/machines/head-change.ncl").unwrap();
    let slow = ["--set", "head.ANGLE.spindle.max_speed=4000"];
    let done = posted("head-change", &[&LONG[..], &slow].concat(), &text_of_heads).0;
    told(&done, 1, &["error[spindle-speed]", "input:19", "6000 rpm", "4000 rpm"]);
    for (set, why) in [("spindle.min_speed=-1", "-1 rpm"), ("spindle.max_speed=0", "0 rpm")] {
        told(&on_vmc(&["--set", set], &text("800")), 1, &["error[machine-spindle]", why]);
    }
    let crossed = ["--set", "spindle.min_speed=100", "--set", "spindle.max_speed=50"];
    told(&on_vmc(&crossed, &text("80")), 1, &["lies above the largest"]);
}

#[test]
fn the_length_that_travel_was_checked_with_is_told() {
    let text = format!(
        "{HEAD}LOADTL/3,LENGTH,80\nSPINDL/3000,CLW\n{CUT}LOADTL/4\n{CUT}LOADTL/3,LENGTH,80\n{CUT}{TAIL}"
    );
    let (done, summary) = posted("vmc", &["--set", "tools.4=120"], &text);
    told(&done, 0, &[]);
    let tool = |number: u32, length: f64, source: &str| json!({"number": number, "length_mm": length, "source": source});
    let tools = json!([tool(3, 80.0, "cl-file"), tool(4, 120.0, "machine-file")]);
    assert_eq!(summary["tools"], tools);
    let (done, summary) = posted("vmc", &LONG, &text);
    told(&done, 0, &[]);
    let tools = json!([tool(3, 100.0, "option"), tool(4, 100.0, "option")]);
    assert_eq!(summary["tools"], tools);
    // Nobody gave it: 0 was taken, and travel was checked with that; whoever keeps the tip.
    let text = format!("{HEAD}LOADTL/3\nSPINDL/3000,CLW\n{CUT}{TAIL}");
    for (machine, tcp) in [
        ("vmc", "post"),
        ("ac-trunnion", "post"),
        ("ac-trunnion", "control"),
        ("gantry", "control"),
    ] {
        let (done, summary) = posted(machine, &["--tcp", tcp], &text);
        told(&done, 0, &["warning[tool-length]", "tool 3", "0 mm", "--tool-length"]);
        assert_eq!(summary["tools"], json!([tool(3, 0.0, "unknown")]), "{machine}");
    }
    // Where the head turns and the post keeps the tip there is no program without it.
    let (done, _) = posted("head-head", &["--tcp", "post"], &text);
    told(&done, 1, &["error[tool-length]", "input:5", "whose head turns", "--tool-length"]);
    let (done, _) = posted("head-head", &["--tcp", "post", "--tool-length", "0"], &text);
    told(&done, 0, &[]);
}

#[test]
fn a_file_that_was_cut_off_is_refused() {
    let body = format!("{HEAD}LOADTL/1\nSPINDL/3000,CLW\n{CUT}");
    let creo = format!("$$-> MFGNO / 1\n{body}");
    let nx = format!("TOOL PATH/ROUGH,TOOL,MILL\n{body}");
    for (text, code, why) in [
        (format!("{body}GOTO/1,2,3\nFINI"), 0, ""),
        (format!("{body}GOTO/1,2,3\nFINI\n"), 0, ""),
        (format!("{body}GOTO/1,2,3\n  "), 0, "is it whole?"),
        (format!("{body}GOTO/1,2,3"), 1, "ends within this line"),
        (format!("{body}GOTO/1,2,3."), 1, "ends within this line"),
        (format!("{body}GOTO/1,2,3,\n"), 1, "ends in a comma"),
        (format!("{body}GOTO/1,2,3,$\n"), 1, "the file ends where this record should go on"),
        (format!("{creo}GOTO/1,2,3\n"), 1, "has no FINI, with which"),
        (format!("{body}OPFEATSTART/Hole1\n"), 1, "has no FINI, with which"),
        (format!("{nx}END-OF-PATH\n"), 0, ""),
        (format!("{nx}GOTO/1,2,3\n"), 1, "within the operation ROUGH"),
        (format!("{nx}END-OF-PATH"), 1, "ends within this line"),
    ] {
        let done = on_vmc(&[], &text);
        let parts = if why.is_empty() { vec![] } else { vec![why] };
        told(&done, code, &parts);
        if code == 0 && why.is_empty() {
            assert_eq!(done.err, "", "{text}");
        }
        if why.contains("this record should") {
            continue;
        }
        let whole = on_vmc(&["--allow", "FINI"], &text);
        told(&whole, 0, &[]);
        assert_eq!(whole.err.contains("warning[cut-off]"), code == 1, "{text}");
    }
}
