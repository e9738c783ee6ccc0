//! A command that is interrupted leaves nothing behind.

use crate::common::{command, command_as, names};

use std::io::Write as _;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// What a CL file begins with; more of it never comes.
const BEGUN: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\n";

/// Waits until `done`, or fails.
#[track_caller]
fn until(what: &str, mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The command, which hears each signal even where whoever runs the tests has it ignored, as shells do of what they run in
/// the background.
fn hearing() -> Command {
    if cfg!(not(target_os = "linux")) {
        return command();
    }
    let mut hearing = command_as("env");
    hearing.args(["--default-signal", env!("CARGO_BIN_EXE_post")]);
    hearing
}

fn interrupted(
    mut command: Command,
    folder: &Path,
    arguments: &[&str],
    files: usize,
    signals: &[&str],
) -> Option<i32> {
    let mut child: Child = command
        .args(arguments)
        .current_dir(folder)
        // What goes to standard output waits in a file, too.
        .env("TMPDIR", folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    stdin.write_all(BEGUN.as_bytes()).unwrap();
    stdin.flush().unwrap();
    until("the temporary files are there", || names(folder).len() == files);
    for signal in signals {
        let kill = Command::new("kill").args([*signal, &child.id().to_string()]).status();
        assert!(kill.unwrap().success());
    }
    let code = child.wait().unwrap().code();
    drop(stdin);
    code
}

#[test]
fn an_interrupted_command_leaves_no_temporary_file() {
    // Where planes are wanted what comes by a pipe is read to its end before a file is begun.
    for (signal, code) in
        [("-INT", 130), ("-QUIT", 131), ("-USR1", 138), ("-ALRM", 142), ("-TERM", 143)]
    {
        let folder = tempfile::tempdir().unwrap();
        let to_file = &["-m", "vmc", "-", "-o", "part.nc", "--summary", "s.json"];
        let found = interrupted(hearing(), folder.path(), to_file, 2, &[signal]);
        assert_eq!((found, names(folder.path())), (Some(code), Vec::new()));
        let to_stream = &["-m", "vmc", "-", "-o", "-"];
        let found = interrupted(hearing(), folder.path(), to_stream, 1, &[signal]);
        assert_eq!((found, names(folder.path())), (Some(code), Vec::new()));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_command_that_shall_outlast_its_terminal_does() {
    let folder = tempfile::tempdir().unwrap();
    let mut shell = Command::new("sh");
    let script = "trap '' HUP; exec \"$0\" \"$@\"";
    shell.args(["-c", script, env!("CARGO_BIN_EXE_post")]);
    let arguments = &["-m", "ac-trunnion", "-", "-o", "part.nc"];
    let found = interrupted(shell, folder.path(), arguments, 1, &["-HUP", "-TERM"]);
    assert_eq!((found, names(folder.path())), (Some(143), Vec::new()));
}

/// No handler hears this signal; who writes there next takes away what it has left, and nothing of a run that lives.
#[cfg(unix)]
#[test]
fn what_a_killed_command_leaves_is_taken_away_by_the_next_one() {
    let folder = tempfile::tempdir().unwrap();
    let to_file = &["-m", "vmc", "-", "-o", "part.nc", "--summary", "s.json"];
    let found = interrupted(hearing(), folder.path(), to_file, 2, &["-KILL"]);
    assert_eq!((found, names(folder.path()).len()), (None, 2));
    let kept = folder.path().join(".post-of-mine.old");
    std::fs::write(&kept, "mine").unwrap();

    // A second run waits for its CL file while a third one comes and goes.
    let mut waiting = command()
        .args(["-m", "vmc", "-", "-o", "other.nc"])
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut stdin = waiting.stdin.take().unwrap();
    stdin.write_all(BEGUN.as_bytes()).unwrap();
    until("what was left is gone, and a file of its own is there", || {
        names(folder.path()).len() == 2
    });
    std::fs::write(folder.path().join("whole.cls"), format!("{BEGUN}FINI\n")).unwrap();
    let third = command()
        .args(["-m", "vmc", "whole.cls", "-o", "third.nc"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(third.status.success(), "{}", String::from_utf8_lossy(&third.stderr));
    stdin.write_all(b"FINI\n").unwrap();
    drop(stdin);
    assert!(waiting.wait().unwrap().success());
    let mut left = names(folder.path());
    left.sort();
    assert_eq!(left, [".post-of-mine.old", "other.nc", "third.nc", "whole.cls"]);
}
