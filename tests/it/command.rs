//! The command line: what goes where, exit codes, and that a refused job leaves nothing.

use crate::common;

use std::fs;
use std::process::Stdio;

use common::{
    GOOD, assert_contains, command, names, post, post_in, post_text, root, run, with_file,
};

const BLADE: &str = "tests/samples/blade.cls";
const PLATE: &str = "tests/samples/plate.ncl";

// Where the program goes.

#[test]
fn the_program_stands_beside_the_file_with_the_ending_of_the_dialect() {
    for (machine, program) in
        [("ac-trunnion", "part.nc"), ("dmu50", "part.h"), ("disc-cutter", "part.ngc")]
    {
        let folder = with_file("part.cls", GOOD);
        let done = post_in(folder.path(), &["-m", machine, "part.cls"]);
        assert_eq!(done.code, 0, "{}", done.err);
        assert_eq!(names(folder.path()), ["part.cls", program]);
        assert_contains(&done.out, &[program, "from part.cls", "tip deviation"]);
        assert_eq!(fs::read_to_string(folder.path().join("part.cls")).unwrap(), GOOD);
    }
}

#[test]
fn the_program_goes_where_it_is_told() {
    let folder = with_file("part.cls", GOOD);
    fs::create_dir(folder.path().join("nc")).unwrap();
    let done = post_in(folder.path(), &["-m", "ac-trunnion", "part.cls", "-o", "nc/side.tap"]);
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
    assert_eq!((quiet.code, quiet.out, quiet.err.as_str()), (0, file.out, ""));
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
fn a_reader_that_goes_away_is_told_that_the_program_is_cut_off() {
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
    // As a shell reports of any command whose reader went away, and not in silence: a machine may be reading.
    assert_eq!(output.status.code(), Some(141));
    let err = String::from_utf8_lossy(&output.stderr);
    assert_contains(&err, &["standard output: whoever reads it closed it"]);
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
    fs::write(own.join("ac-trunnion.toml"), text.replace("AC trunnion", "mine")).unwrap();
    let own = own.to_str().unwrap();
    let arguments = ["-q", "-m", "ac-trunnion", blade, "-o", "-"];
    let named = post_in(folder.path(), &[&arguments[..], &["--machines", own]].concat());
    assert_contains(&named.out, &["(MINE, FOR THE PART AT X0 Y0 Z0 ALONE)"]);
    let environment =
        run(command().current_dir(folder.path()).args(arguments).env("POST_MACHINES", own), b"");
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
    assert_contains(&listed.out, &["ac-trunnion", "dmu50", "vmc", "head-head-360"]);
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
    for (input, parts) in [("no/such.cls", &["no/such.cls"][..]), ("tests", &["tests is a folder"])]
    {
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
    let mut reader =
        std::process::Command::new("cat").arg(&pipe).stdout(Stdio::null()).spawn().unwrap();
    let done = post_in(folder.path(), &["-q", "-m", "ac-trunnion", "part.cls", "-o", "pipe"]);
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
