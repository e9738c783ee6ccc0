//! The command line: what goes where, exit codes, messages, settings, and that a refused job leaves nothing.

use crate::common;

use std::fs;
use std::path::Path;
use std::process::Stdio;

use common::{Run, check_numbers, command, names, post, read_json, root, run};
use serde_json::Value;
use tempfile::TempDir;

const BLADE: &str = "tests/samples/blade.cls";
const PLATE: &str = "tests/samples/plate.ncl";
const KNIFE: &str = "tests/samples/knife.ncl";

/// A small good file.
const GOOD: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/20,0,10,0,0.1736482,0.9848078\nEND\nFINI\n";

/// A folder with a CL file in it.
fn with_file(name: &str, text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    folder
}

/// Runs in a folder that has no machine files of its own.
fn post_in(folder: &Path, arguments: &[&str]) -> Run {
    run(command().current_dir(folder).args(arguments), b"")
}

/// Posts a text to standard output.
fn post_text(arguments: &[&str], text: &str) -> Run {
    let mut all = vec!["-o", "-"];
    all.extend(arguments);
    all.push("-");
    run(command().args(all), text.as_bytes())
}

#[track_caller]
fn assert_contains(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "`{part}` is not in:\n{text}");
    }
}

// Where the program goes.

#[test]
fn the_program_stands_beside_the_file_with_the_ending_of_the_dialect() {
    for (machine, program) in [
        ("ac-trunnion", "part.nc"),
        ("dmu50", "part.h"),
        ("disc-cutter", "part.ngc"),
    ] {
        let folder = with_file("part.cls", GOOD);
        let done = post_in(folder.path(), &["-m", machine, "part.cls"]);
        assert_eq!(done.code, 0, "{}", done.err);
        assert_eq!(names(folder.path()), ["part.cls", program]);
        assert_contains(&done.out, &[program, "from part.cls", "tip deviation"]);
        assert_eq!(
            fs::read_to_string(folder.path().join("part.cls")).unwrap(),
            GOOD
        );
    }
}

#[test]
fn the_program_goes_where_it_is_told() {
    let folder = with_file("part.cls", GOOD);
    fs::create_dir(folder.path().join("nc")).unwrap();
    let done = post_in(
        folder.path(),
        &["-m", "ac-trunnion", "part.cls", "-o", "nc/side.tap"],
    );
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(names(folder.path()), ["nc", "part.cls"]);
    assert_eq!(names(&folder.path().join("nc")), ["side.tap"]);
    let text = fs::read_to_string(folder.path().join("nc/side.tap")).unwrap();
    // The program is called after its own file.
    assert_contains(&text, &["(SIDE)"]);
}

#[test]
fn a_program_on_standard_output_is_alone_there() {
    let file = post(&["-m", "ac-trunnion", BLADE, "-o", "-"]);
    assert_eq!(file.code, 0, "{}", file.err);
    assert!(file.out.starts_with("%\nO1000") && file.out.ends_with("M30\n%\n"));
    assert_contains(&file.err, &["standard output", "tip deviation"]);
    let length = ["--tool-length", "0"];
    let quiet = post(&[&["-q", "-m", "ac-trunnion", BLADE, "-o", "-"], &length[..]].concat());
    assert_eq!(
        (quiet.code, quiet.out, quiet.err.as_str()),
        (0, file.out, "")
    );
}

#[test]
fn standard_input_is_read_and_standard_output_written() {
    let text = fs::read(root().join(BLADE)).unwrap();
    let from_pipe = run(command().args(["-m", "ac-trunnion", "-"]), &text);
    assert_eq!(from_pipe.code, 0, "{}", from_pipe.err);
    let from_file = post(&["-m", "ac-trunnion", BLADE, "-o", "-"]);
    let unnamed = |text: &str| text.replace("(PROGRAM)", "(BLADE)");
    assert_eq!(unnamed(&from_pipe.out), from_file.out);
    assert_contains(&from_pipe.err, &["from standard input"]);
}

#[test]
fn line_ends_of_windows_change_nothing() {
    let here = post_text(&["-m", "ac-trunnion"], GOOD);
    let there = post_text(&["-m", "ac-trunnion"], &GOOD.replace('\n', "\r\n"));
    assert_eq!((here.code, &here.out), (0, &there.out), "{}", there.err);
}

#[cfg(unix)]
#[test]
fn the_program_can_be_read_by_others_and_keeps_the_rights_of_the_one_before() {
    use std::os::unix::fs::PermissionsExt;
    let folder = with_file("part.cls", GOOD);
    let target = folder.path().join("part.nc");
    let mode = || fs::metadata(&target).unwrap().permissions().mode() & 0o777;
    let again = || {
        let done = post_in(folder.path(), &["-q", "-m", "ac-trunnion", "part.cls"]);
        assert_eq!(done.code, 0, "{}", done.err);
    };
    again();
    assert_eq!(mode(), 0o644);
    fs::set_permissions(&target, fs::Permissions::from_mode(0o660)).unwrap();
    again();
    assert_eq!(mode(), 0o660);
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_seen_enough_is_no_fault() {
    // A program far larger than what a pipe holds, of which nobody reads a byte.
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n");
    for step in 0..20_000 {
        text.push_str(&format!("GOTO/{},{},10\n", step % 97, step % 89));
    }
    text.push_str("FINI\n");
    let folder = with_file("long.cls", &text);
    let mut child = command()
        .args(["-q", "-m", "vmc", "--tool-length", "0", "-o", "-"])
        .arg(folder.path().join("long.cls"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

// Which machine.

#[test]
fn a_machine_is_found_by_name_by_path_and_in_folders() {
    let quiet = ["-q", "--tool-length", "0", "-o", "-", "-m"];
    let with = |machine: &str| post(&[&quiet[..], &[machine, BLADE]].concat());
    let built_in = with("ac-trunnion");
    for machine in ["ac-trunnion.toml", "machines/ac-trunnion.toml"] {
        assert_eq!(with(machine), built_in);
    }
    // A folder without `machines`: the one built in.
    let folder = tempfile::tempdir().unwrap();
    let blade = root().join(BLADE);
    let blade = blade.to_str().unwrap();
    let arguments = [&quiet[..], &["ac-trunnion", blade]].concat();
    let done = post_in(folder.path(), &arguments);
    assert_eq!(done, built_in);
    // A file of the same name in a folder that is named comes first.
    let own = folder.path().join("own");
    fs::create_dir(&own).unwrap();
    let text = fs::read_to_string(root().join("machines/ac-trunnion.toml")).unwrap();
    fs::write(
        own.join("ac-trunnion.toml"),
        text.replace("AC trunnion", "mine"),
    )
    .unwrap();
    let own = own.to_str().unwrap();
    let arguments = ["-q", "-m", "ac-trunnion", blade, "-o", "-"];
    let named = post_in(
        folder.path(),
        &[&arguments[..], &["--machines", own]].concat(),
    );
    assert_contains(&named.out, &["(MINE)"]);
    let environment = run(
        command()
            .current_dir(folder.path())
            .args(arguments)
            .env("POST_MACHINES", own),
        b"",
    );
    assert_eq!(environment, named);
}

#[test]
fn a_machine_refines_another_by_extending_it() {
    let folder = with_file("part.cls", GOOD);
    let text = "extends = \"ac-trunnion\"\nname = \"ours\"\n[control]\ntcp = \"control\"\n";
    fs::write(folder.path().join("ours.toml"), text).unwrap();
    let done = post_in(folder.path(), &["-m", "ours.toml", "part.cls", "-o", "-"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_contains(&done.out, &["(OURS)", "G43.4 H1"]);
}

#[test]
fn an_unknown_machine_is_refused_with_those_that_there_are() {
    let done = post(&["-m", "dmu60", BLADE, "-o", "-"]);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(&done.err, &["dmu60", "dmu50", "machines"]);
    let done = post(&["-m", "no/such.toml", BLADE, "-o", "-"]);
    assert_eq!(done.code, 1);
    assert_contains(&done.err, &["no/such.toml"]);
    let listed = post(&["machines"]);
    assert_eq!(listed.code, 0);
    assert_contains(
        &listed.out,
        &["ac-trunnion", "dmu50", "vmc", "head-head-360"],
    );
}

#[test]
fn a_fault_in_a_machine_file_is_shown_in_its_line() {
    let folder = with_file("part.cls", GOOD);
    let text = "extends = \"ac-trunnion\"\n[axis.X]\ntravle = [0, 1]\n";
    fs::write(folder.path().join("bad.toml"), text).unwrap();
    let done = post_in(folder.path(), &["-m", "bad.toml", "part.cls"]);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(&done.err, &["bad.toml:3", "travle", "travel"]);
    assert_eq!(names(folder.path()), ["bad.toml", "part.cls"]);
}

// The summary.

#[test]
fn the_summary_holds_what_is_documented_and_agrees_with_the_program() {
    for (machine, with) in [
        ("ac-trunnion", &["--tool-length", "80"][..]),
        ("dmu50", &["--tool-length", "80"]),
        ("disc-cutter", &["--tool-length", "80"]),
        ("nutating-head", &["--tcp", "post", "--tool-length", "80"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (program, json) = (folder.path().join("p.nc"), folder.path().join("s.json"));
        let mut arguments = vec!["-m", machine, BLADE, "-o", program.to_str().unwrap()];
        arguments.extend(["--summary", json.to_str().unwrap()]);
        arguments.extend(with);
        let done = post(&arguments);
        assert_eq!((done.code, done.err.as_str()), (0, ""));
        let text = fs::read_to_string(&program).unwrap();
        check_numbers(&text);
        check_summary(&read_json(&json), &text, machine);
    }
}

fn check_summary(summary: &Value, program: &str, machine: &str) {
    let keys: Vec<&str> = summary
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    for key in [
        "machine",
        "dialect",
        "tcp",
        "model",
        "records",
        "moves",
        "blocks",
        "nc_lines",
        "points_added",
        "model_overruled",
        "tip_deviation_mm",
        "axis_deviation_deg",
        "rapid_deviation_mm",
        "tolerance_mm",
        "axis_tolerance_deg",
        "axes",
        "tools",
        "time_s",
        "cutting_time_s",
        "blocks_limited",
        "fast_rapids",
        "ignored_words",
        "plugins",
        "warnings",
    ] {
        assert!(keys.contains(&key), "{key} is not among {keys:?}");
    }
    let count = |key: &str| summary[key].as_u64().unwrap();
    let number = |key: &str| summary[key].as_f64().unwrap();
    let source = fs::read_to_string(root().join(BLADE)).unwrap();
    assert_eq!(count("records"), source.lines().count() as u64);
    let points = source
        .lines()
        .filter(|line| line.starts_with("GOTO"))
        .count() as u64;
    assert_eq!(count("moves"), points);
    // A head that leans is drawn back along the tool at the end.
    assert!(count("blocks") <= count("moves") + count("points_added") + 1);
    assert!(count("blocks") + 10 > count("moves") + count("points_added"));
    let lines: Vec<&str> = program.lines().collect();
    assert_eq!(count("nc_lines"), lines.len() as u64);
    for (key, limit) in [
        ("tip_deviation_mm", number("tolerance_mm")),
        ("axis_deviation_deg", number("axis_tolerance_deg")),
        ("rapid_deviation_mm", 0.5),
    ] {
        let deviation = &summary[key];
        let value = deviation["value"].as_f64().unwrap();
        assert!(value > 0.0 && value <= limit, "{machine}: {key} {value}");
        // The block is a line of the program with a motion in it, the line one with a point.
        let block = deviation["block"].as_u64().unwrap();
        let block = lines[usize::try_from(block).unwrap() - 1];
        let moves = block.contains(" X") || block.starts_with(['X', 'Y', 'Z', 'A', 'B', 'C']);
        assert!(
            moves || block.contains(" Z") || block.contains(" Y"),
            "{machine}: {key} in `{block}`"
        );
        let line = deviation["line"].as_u64().unwrap();
        let line = source
            .lines()
            .nth(usize::try_from(line).unwrap() - 1)
            .unwrap();
        assert!(line.starts_with("GOTO"), "{machine}: {key} at `{line}`");
    }
    for axis in summary["axes"].as_array().unwrap() {
        let (min, max) = (axis["min"].as_f64().unwrap(), axis["max"].as_f64().unwrap());
        assert!(min <= max, "{axis}");
        if let Some(travel) = axis["travel"].as_array() {
            assert!(travel[0].as_f64().unwrap() <= min && max <= travel[1].as_f64().unwrap());
        }
    }
    let (time, cutting) = (number("time_s"), number("cutting_time_s"));
    // 290 mm at 1500 mm/min.
    assert!(
        time > cutting && (10.0..20.0).contains(&cutting),
        "{time} {cutting}"
    );
    assert_eq!(summary["warnings"], Value::Array(Vec::new()));
    let ignored: Vec<(String, u64)> =
        serde_json::from_value(summary["ignored_words"].clone()).unwrap();
    assert!(ignored.contains(&("PAINT".to_owned(), 16)), "{ignored:?}");
    for plugin in summary["plugins"].as_array().unwrap() {
        assert!(plugin["name"].is_string() && plugin["version"].is_string());
    }
}

#[test]
fn the_numbers_of_a_small_job_are_those_worked_out_by_hand() {
    let folder = with_file(
        "line.cls",
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,60\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/30,40,10\nFINI\n",
    );
    let done = post_in(
        folder.path(),
        &["-m", "vmc", "line.cls", "--summary", "line.json"],
    );
    assert_eq!(done.code, 0, "{}", done.err);
    let summary = read_json(&folder.path().join("line.json"));
    assert_eq!(summary["records"], 9);
    assert_eq!(summary["moves"], 3);
    assert_eq!(summary["blocks"], 3);
    assert_eq!(summary["points_added"], 0);
    // 50 mm down and 50 mm across at 100 mm/min.
    assert!((summary["cutting_time_s"].as_f64().unwrap() - 60.0).abs() < 1e-9);
    let axes: Vec<(String, f64, f64)> = summary["axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|axis| {
            let name = axis["name"].as_str().unwrap().to_owned();
            (
                name,
                axis["min"].as_f64().unwrap(),
                axis["max"].as_f64().unwrap(),
            )
        })
        .collect();
    // The gauge line stands 600 mm over the table.
    let expected = [("X", 0.0, 30.0), ("Y", 0.0, 40.0), ("Z", -590.0, -540.0)];
    for ((name, min, max), (name_wanted, min_wanted, max_wanted)) in axes.iter().zip(expected) {
        assert_eq!(name, name_wanted);
        assert!((min - min_wanted).abs() < 1e-9 && (max - max_wanted).abs() < 1e-9);
    }
    let program = fs::read_to_string(folder.path().join("line.nc")).unwrap();
    assert_contains(&program, &["G1 Z10.000 F100.\nX30.000 Y40.000\n"]);
}

#[test]
fn no_progress_and_no_colour_in_a_pipe() {
    let done = post(&["-m", "ac-trunnion", BLADE, "-o", "-"]);
    assert_eq!(done.code, 0);
    assert_contains(&done.err, &["warning[tool-length]", "--tool-length"]);
    for text in [&done.out, &done.err] {
        assert!(!text.contains('\u{1b}') && !text.contains('\r') && !text.contains("left"));
    }
}

// Exit codes and refusals.

#[test]
fn a_wrong_command_line_is_usage() {
    for arguments in [
        &[][..],
        &["-m", "vmc"],
        &[BLADE],
        &["-m", "vmc", BLADE, "--units", "yard"],
        &["-m", "vmc", BLADE, "--tool", "-1"],
        &["-m", "vmc", BLADE, "--frobnicate"],
        &["-m", "vmc", BLADE, PLATE],
        &["words", "--unknown-only"],
    ] {
        let done = post(arguments);
        assert_eq!((done.code, done.out.as_str()), (2, ""), "{arguments:?}");
        assert_contains(&done.err, &["error: ", "--help"]);
    }
}

#[test]
fn a_refused_job_leaves_nothing_behind() {
    let bad = GOOD.replace("GOTO/0,0,10", "GOTO/9000,0,10");
    let folder = with_file("part.cls", &bad);
    let arguments = ["-m", "ac-trunnion", "part.cls", "--summary", "s.json"];
    let done = post_in(folder.path(), &arguments);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(&done.err, &["nothing was written"]);
    assert_eq!(names(folder.path()), ["part.cls"]);
    // A program that stands there stays as it is.
    fs::write(folder.path().join("part.nc"), "the one before").unwrap();
    assert_eq!(post_in(folder.path(), &arguments).code, 1);
    assert_eq!(names(folder.path()), ["part.cls", "part.nc"]);
    let kept = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert_eq!(kept, "the one before");
}

#[test]
fn nothing_goes_to_standard_output_before_all_is_good() {
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n");
    for step in 0..5000 {
        text.push_str(&format!("GOTO/{},0,10\n", step % 97));
    }
    text.push_str("GOTO/9000,0,10\n");
    let done = post_text(&["-m", "vmc"], &text);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(&done.err, &["standard input:5005", "over-travel"]);
}

#[test]
fn the_file_that_is_read_is_never_overwritten() {
    let folder = with_file("part.nc", GOOD);
    for target in [&[][..], &["-o", "part.nc"], &["-o", "./part.nc"]] {
        let arguments = [&["-m", "ac-trunnion", "part.nc"], target].concat();
        let done = post_in(folder.path(), &arguments);
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{target:?}");
        assert_contains(&done.err, &["overwrite", "part.nc", "-o"]);
        assert_eq!(names(folder.path()), ["part.nc"]);
        let kept = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        assert_eq!(kept, GOOD);
    }
}

#[test]
fn what_cannot_be_opened_is_named() {
    for (input, parts) in [
        ("no/such.cls", &["no/such.cls"][..]),
        ("tests", &["tests is a folder"]),
    ] {
        let done = post(&["-m", "vmc", input, "-o", "-"]);
        assert_eq!((done.code, done.out.as_str()), (1, ""));
        assert_contains(&done.err, parts);
    }
    let done = post(&["-m", "vmc", PLATE, "-o", "no/such/folder.nc"]);
    assert_eq!(done.code, 1);
    assert_contains(&done.err, &["no/such/folder.nc"]);
    let done = post(&["-m", "vmc", PLATE, "-o", "tests"]);
    assert_eq!(done.code, 1);
    assert_contains(&done.err, &["tests is a folder"]);
}

#[test]
fn the_summary_never_overwrites_the_file_that_is_read_or_the_program() {
    for summary in ["part.cls", "./part.cls", "part.nc"] {
        let folder = with_file("part.cls", GOOD);
        let arguments = ["-m", "ac-trunnion", "part.cls", "--summary", summary];
        let done = post_in(folder.path(), &arguments);
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{summary}");
        assert_contains(&done.err, &["overwrite", "--summary"]);
        assert_eq!(names(folder.path()), ["part.cls"]);
        let kept = fs::read_to_string(folder.path().join("part.cls")).unwrap();
        assert_eq!(kept, GOOD);
    }
}

#[test]
fn a_summary_that_cannot_be_written_is_found_before_the_program_is_written() {
    let folder = with_file("part.cls", GOOD);
    let arguments = ["-m", "ac-trunnion", "part.cls", "--summary", "no/such.json"];
    let done = post_in(folder.path(), &arguments);
    assert_eq!(done.code, 1);
    assert_contains(&done.err, &["no/such.json", "nothing was written"]);
    assert_eq!(names(folder.path()), ["part.cls"]);
    let done = post_in(folder.path(), &[&arguments[..], &["-o", "-"]].concat());
    assert_eq!((done.code, done.out.as_str()), (1, ""));
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_written_to_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt;
    let folder = with_file("part.cls", GOOD);
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    // Somebody reads from the pipe, so that opening it does not wait.
    let mut reader = std::process::Command::new("cat")
        .arg(&pipe)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let done = post_in(
        folder.path(),
        &["-q", "-m", "ac-trunnion", "part.cls", "-o", "pipe"],
    );
    let kind = fs::metadata(&pipe).unwrap().file_type();
    let _ = reader.kill();
    let _ = reader.wait();
    // Written to or refused: both are right.
    assert!(done.code <= 1);
    assert!(kind.is_fifo(), "the pipe is gone");
}

#[test]
fn a_tool_length_is_a_number() {
    for length in ["nan", "inf", "-inf"] {
        let option = format!("--tool-length={length}");
        let done = post(&["-m", "ac-trunnion", BLADE, "-o", "-", &option]);
        assert!(done.code != 0 && done.out.is_empty());
        assert!(!done.err.contains("fault of post"), "{}", done.err);
    }
}

#[test]
fn a_file_without_a_move_is_refused() {
    for text in ["", "UNITS/MM\nFINI\n", "$$ nothing\n"] {
        let done = post_text(&["-m", "vmc"], text);
        assert_eq!((done.code, done.out.as_str()), (1, ""));
        assert_contains(&done.err, &["error[empty]", "has no move"]);
    }
}

// Messages.

#[test]
fn a_message_says_where_what_how_much_and_what_helps() {
    let head = "UNITS/MM\nLOADTL/1\nFEDRAT/100,MMPM\nGOTO/0,0,50\n";
    for (machine, line, parts) in [
        (
            "ac-trunnion",
            "GOTO/412.5,0,10",
            &[
                "over-travel",
                "X would be 412.500 mm",
                "300.000 mm, passed by 112.500 mm",
                "--mount",
            ][..],
        ),
        (
            "ac-trunnion",
            "GOTO/0,0,10,0,0.7071068,-0.7071068",
            &[
                "over-travel",
                "A would be",
                "135.000°",
                "-120.000°",
                "help: ",
            ],
        ),
        (
            "vmc",
            "GOTO/0,0,10,0,0.1736482,0.9848078",
            &["out-of-reach", "VMC", "10.0000°", "0.0500°", "help: "],
        ),
        ("vmc", "GOTO/0,0", &["syntax", "help: expected GOTO/x,y,z"]),
        ("vmc", "FEDRAT/-5,MMPM", &["feed", "-5"]),
        ("vmc", "TRACUT/ON", &["refused-word", "TRACUT", "help: "]),
        ("vmc", "GOTO/0,0,10,0,0,0", &["axis", "null", "help: "]),
    ] {
        let with = ["-m", machine, "--spindle", "3000"];
        let done = post_text(&with, &format!("{head}{line}\nFINI\n"));
        assert_eq!(
            (done.code, done.out.as_str()),
            (1, ""),
            "{line}\n{}",
            done.err
        );
        assert_contains(&done.err, parts);
        assert_contains(&done.err, &["standard input:5", line, "1 error"]);
    }
}

#[test]
fn a_cut_without_a_feed_is_refused() {
    let done = post_text(
        &["-m", "vmc"],
        "UNITS/MM\nLOADTL/1\nGOTO/0,0,50\nGOTO/0,0,10\n",
    );
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert_contains(
        &done.err,
        &["no-feed", "standard input:4", "GOTO/0,0,10", "FEDRAT"],
    );
}

#[test]
fn several_faults_are_told_in_one_run() {
    let text = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nGOTO/0,0,50\nGOTO/0,0,10\nFEDRAT/100,MMPM\nGOTO/1,2,x\nGOTO/900,0,10\nGOTO/950,0,10\nGOTO/0,0,10,0,0,-1\nCIRCLE/1,2\nFINI\n";
    let done = post_text(&["-m", "ac-trunnion"], text);
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    for (line, code) in [
        (5, "no-feed"),
        (7, "syntax"),
        (8, "over-travel"),
        (10, "over-travel"),
        (11, "syntax"),
    ] {
        let at = format!("standard input:{line}:");
        let told = done
            .err
            .split("\n\n")
            .any(|told| told.contains(&at) && told.contains(&format!("error[{code}]")));
        assert!(told, "{code} on line {line}:\n{}", done.err);
    }
    // A limit that is passed again is told once, with the farthest.
    assert_contains(&done.err, &["2 points pass it", "X 950.000", "5 errors"]);
}

#[test]
fn an_unknown_word_is_refused_told_or_passed_on() {
    let text = GOOD.replace("RAPID\n", "WIGGLE/4,5\nRAPID\n");
    let known = post_text(&["-q", "-m", "ac-trunnion"], GOOD);
    let refused = post_text(&["-m", "ac-trunnion", "--unknown=error"], &text);
    assert_eq!((refused.code, refused.out.as_str()), (1, ""));
    let told = ["WIGGLE", ":4:1"];
    assert_contains(&refused.err, &["error[unknown-word]", "--unknown=warn"]);
    assert_contains(&refused.err, &told);
    let warned = post_text(&["-q", "-m", "ac-trunnion"], &text);
    assert_eq!((warned.code, &warned.out), (0, &known.out));
    assert_contains(&warned.err, &["warning[unknown-word]", "left out"]);
    assert_contains(&warned.err, &told);
    let explicit = post_text(&["-q", "-m", "ac-trunnion", "--unknown", "warn"], &text);
    assert_eq!(explicit, warned);
    let passed = post_text(&["-q", "-m", "ac-trunnion", "--unknown=pass"], &text);
    assert_eq!(passed.code, 0);
    assert_contains(&passed.out, &["(WIGGLE/4,5)"]);
    assert_contains(&passed.err, &["warning[unknown-word]", "comment"]);
    assert_eq!(passed.out.replace("(WIGGLE/4,5)\n", ""), known.out);
}

#[test]
fn words_lists_what_becomes_of_each_word() {
    let text = GOOD.replace("RAPID\n", "WIGGLE/4\nPAINT/COLOR,3\nTRACUT/ON\nRAPID\n");
    let listed = run(command().args(["words", "-"]), text.as_bytes());
    assert_eq!((listed.code, listed.err.as_str()), (0, ""));
    let row = |word: &str| -> Vec<String> {
        let line = listed.out.lines().find(|line| line.starts_with(word));
        line.unwrap()
            .split_whitespace()
            .map(str::to_owned)
            .collect()
    };
    assert_eq!(row("GOTO"), ["GOTO", "3", "used", "8"]);
    assert_eq!(row("WIGGLE"), ["WIGGLE", "1", "unknown", "4"]);
    assert_eq!(row("PAINT"), ["PAINT", "1", "ignored", "5"]);
    assert_eq!(row("TRACUT"), ["TRACUT", "1", "refused", "6"]);
    let unknown = run(
        command().args(["words", "--unknown-only", "-"]),
        text.as_bytes(),
    );
    assert_eq!(unknown.out.lines().count(), 3, "{}", unknown.out);
}

#[test]
fn words_without_a_file_lists_those_that_are_known() {
    let listed = run(command().arg("words"), b"");
    assert_eq!((listed.code, listed.err.as_str()), (0, ""));
    let words = post_grammar::MajorWord::all();
    assert_eq!(listed.out.lines().count(), 1 + words.len());
    assert_contains(
        &listed.out,
        &[
            "LOADTL = LOAD = TURRET = TOOLNO",
            "FEDRAT",
            "refused    repeats moves",
        ],
    );
}

#[test]
fn help_names_every_option() {
    let help = post(&["--help"]);
    assert_eq!((help.code, help.err.as_str()), (0, ""));
    assert_contains(
        &help.out,
        &[
            "--machine",
            "--output",
            "--summary",
            "--quiet",
            "--units",
            "--msys",
            "--unknown",
            "--tool ",
            "--mount",
            "--tool-length",
            "--set",
            "--tolerance",
            "--tcp",
            "--machines",
            "--plugins",
            "--trust-model",
            "--version",
            "POST_PLUGINS",
            "POST_MACHINES",
            "Exit codes",
            "words",
            "machines",
            "Examples",
        ],
    );
    assert_eq!(post(&["--version"]).code, 0);
}

// Settings.

/// Blocks of a job and its summary.
fn posted(arguments: &[&str]) -> (String, Value) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    let mut all = vec!["-q", "-o", "-", "--summary", json.to_str().unwrap()];
    all.extend(arguments);
    let done = post(&all);
    assert_eq!(done.code, 0, "{arguments:?}\n{}", done.err);
    (done.out, read_json(&json))
}

#[test]
fn a_parameter_of_the_machine_is_set_for_one_job() {
    let as_filed = posted(&["-m", "disc-cutter", KNIFE]);
    assert_eq!(
        posted(&["-m", "disc-cutter", KNIFE, "--set", "Lm=312"]),
        as_filed
    );
    let shorter = posted(&["-m", "disc-cutter", KNIFE, "--set", "Lm=250"]);
    assert_ne!(shorter.0, as_filed.0);
    // The shorter swing strays less and needs fewer points.
    let added = |job: &(String, Value)| job.1["points_added"].as_u64().unwrap();
    assert!(added(&shorter) < added(&as_filed));
    // An expression of parameters follows: a head of 250 mm with a tool of 62 mm is the head of 312 mm.
    let tool = posted(&[
        "-m",
        "disc-cutter",
        KNIFE,
        "--set",
        "Lm=250",
        "--tool-length",
        "62",
    ]);
    assert_eq!(tool.0, as_filed.0);
    let refused = post(&["-m", "disc-cutter", KNIFE, "-o", "-", "--set", "Ln=250"]);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["Ln", "Lm"]);
}

#[test]
fn the_tolerance_is_kept_whatever_it_is() {
    let mut before = u64::MAX;
    for (tolerance, most) in [("0.002", 0.002), ("0.005", 0.005), ("0.05", 0.05)] {
        let (_, summary) = posted(&["-m", "disc-cutter", KNIFE, "--tolerance", tolerance]);
        let deviation = summary["tip_deviation_mm"]["value"].as_f64().unwrap();
        assert!(deviation <= most && deviation > most / 10.0, "{deviation}");
        assert_eq!(summary["tolerance_mm"], most);
        let blocks = summary["blocks"].as_u64().unwrap();
        assert!(blocks < before);
        before = blocks;
        let set = format!("accuracy.tolerance={tolerance}");
        let (_, same) = posted(&["-m", "disc-cutter", KNIFE, "--set", &set]);
        assert_eq!(same, summary);
    }
}

#[test]
fn the_model_is_trusted_only_on_demand() {
    let distrusted = posted(&["-m", "disc-cutter", KNIFE]).1;
    let trusted = posted(&["-m", "disc-cutter", KNIFE, "--trust-model"]).1;
    assert!(trusted["blocks"].as_u64() <= distrusted["blocks"].as_u64());
    let deviation = trusted["tip_deviation_mm"]["value"].as_f64().unwrap();
    // The stock model is good to a hundredth of its peak.
    assert!(deviation < 0.005 * 1.05, "{deviation}");
}

#[test]
fn the_mount_moves_the_axes_and_not_the_words_of_a_work_offset() {
    let here = posted(&["-m", "vmc", PLATE]);
    let there = posted(&["-m", "vmc", PLATE, "--mount", "-100,50,20"]);
    assert_eq!(there.0, here.0, "three axes without a table to turn");
    let low = |job: &(String, Value)| job.1["axes"][0]["min"].as_f64().unwrap();
    assert!((low(&here) - low(&there) - 100.0).abs() < 1e-9);
    // On a table that turns the words depend on it.
    let here = posted(&["-m", "ac-trunnion", BLADE]);
    let there = posted(&["-m", "ac-trunnion", BLADE, "--mount", "0,0,30"]);
    assert_ne!(there.0, here.0);
}

#[test]
fn units_are_what_the_user_says() {
    let text = "LOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/1,0,2\nFEDRAT/10\nGOTO/1,0,1\nFINI\n";
    let on_vmc = ["-q", "-m", "vmc", "--tool-length", "0"];
    let inch = post_text(&[&on_vmc[..], &["--units", "inch"]].concat(), text);
    assert_contains(&inch.out, &["X25.400", "G1 Z25.400 F254."]);
    assert_eq!(inch.err, "");
    let millimetres = post_text(&[&on_vmc[..], &["--units", "mm"]].concat(), text);
    assert_contains(&millimetres.out, &["X1.000", "G1 Z1.000 F10."]);
    // Without a word from anybody they are mm, and that is said.
    let unsaid = post_text(&["-q", "-m", "vmc"], text);
    assert_eq!(unsaid.out, millimetres.out);
    assert_contains(&unsaid.err, &["warning[units]", "--units"]);
    // The file's own word is overruled.
    let declared = format!("UNITS/INCHES\n{text}");
    let told = post_text(&["-q", "-m", "vmc", "--units", "mm"], &declared);
    assert_eq!(told.out, millimetres.out);
}

#[test]
fn the_tool_length_matters_where_the_head_turns_and_nowhere_else() {
    let words =
        |machine: &str, length: &str| posted(&["-m", machine, BLADE, "--tool-length", length]).0;
    assert_eq!(words("ac-trunnion", "50"), words("ac-trunnion", "80"));
    assert_ne!(words("head-head", "50"), words("head-head", "80"));
    // A length in the CL file serves; the command line overrules it.
    let text = GOOD.replace("LOADTL/1", "LOADTL/1,LENGTH,80");
    let from_file = post_text(&["-q", "-m", "head-head"], &text);
    assert_eq!((from_file.code, from_file.err.as_str()), (0, ""));
    let told = post_text(&["-q", "-m", "head-head", "--tool-length", "80"], GOOD);
    assert_eq!(told, from_file);
    let other = post_text(&["-q", "-m", "head-head", "--tool-length", "81"], &text);
    assert_ne!(other.out, from_file.out);
}

#[test]
fn a_file_that_loads_no_tool_is_told_which_it_is() {
    let text = GOOD.replace("LOADTL/1\n", "");
    let refused = post_text(&["-m", "ac-trunnion"], &text);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["no tool was loaded", "--tool N"]);
    let told = post_text(&["-m", "ac-trunnion", "--tool", "12"], &text);
    assert_eq!(told.code, 0, "{}", told.err);
    assert_contains(&told.out, &["T12 M6", "G43 H12"]);
}

#[test]
fn the_control_or_the_post_keeps_the_tip() {
    let (control, summary) = posted(&["-m", "ac-trunnion", BLADE, "--tcp", "control"]);
    assert_eq!(summary["tcp"], "control");
    assert_contains(&control, &["G43.4 H3", "X-32.211 Y-8.132 Z30.155"]);
    assert!(!control.contains("G93"));
    let (post, summary) = posted(&["-m", "ac-trunnion", BLADE, "--tcp", "post"]);
    assert_eq!(summary["tcp"], "post");
    assert!(!post.contains("G43.4") && post.contains("G93"));
}
