//! `--jobs`: programs, summaries and messages are the same bytes with any number of threads, and what is wrong is found as
//! soon.

use std::fs;
use std::io::Write as _;
use std::process::Stdio;

use crate::common::{self, CASES, command, run};

/// What a run leaves: its code, program, summary and messages.
fn left(arguments: &[&str], jobs: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let mut post = command();
    post.args(arguments).args(["-j", jobs]);
    let (program, summary) = (folder.path().join("p.nc"), folder.path().join("s.json"));
    let made = run(post.arg("-o").arg(&program).arg("--summary").arg(&summary), b"");
    let files = fs::read_dir(folder.path()).unwrap().count();
    let read = |path| fs::read_to_string(path).unwrap_or_else(|_| "none".to_owned());
    let folder = folder.path().display().to_string();
    let [told, found] = [made.out, made.err].map(|said| said.replace(&folder, ""));
    format!("{} {files}\n{found}\n{told}\n{}\n{}", made.code, read(&program), read(&summary))
}

#[test]
fn the_bytes_are_the_same_on_any_number_of_threads() {
    for case in CASES {
        let sample = common::sample(case.sample).display().to_string();
        let mut arguments = vec!["-m", case.machine, &sample];
        arguments.extend(case.with);
        let alone = left(&arguments, "1");
        assert!(alone.starts_with("0 2\n"), "{}: {alone}", case.machine);
        for jobs in ["2", "7"] {
            let beside = left(&arguments, jobs);
            let differs = alone.lines().zip(beside.lines()).find(|(one, other)| one != other);
            assert!(beside == alone, "{} {sample} -j {jobs}: {differs:?}", case.machine);
        }
    }
}

/// A fault late in a long file: nothing is left behind, and the messages are the same.
#[test]
fn a_fault_is_told_alike_and_leaves_nothing_behind() {
    let folder = tempfile::tempdir().unwrap();
    let cl = folder.path().join("part.cls");
    let mut text =
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\n".to_owned();
    // More than is read ahead at a time.
    for place in 0..9000 {
        text += &format!("GOTO/{:02}.{:03},{}.5,10\n", place / 100, place % 1000, place % 50);
    }
    let good = text.clone() + "END\nFINI\n";
    for (bad, told) in [
        // Beyond the travel; a word that is not known; a file that is cut off.
        (text.clone() + "GOTO/99999,0,10\n" + &text + "FINI\n", "over-travel"),
        (text.clone() + "NOSUCHWORD/1\n" + &text + "FINI\n", "NOSUCHWORD"),
        (text.clone() + "GOTO/1,2", "part.cls"),
        (text.clone() + "GOTO/1,2,oops\n" + &text + "FINI\n", "part.cls"),
    ] {
        fs::write(&cl, &bad).unwrap();
        let path = cl.display().to_string();
        let arguments = ["-m", "vmc", "--tool-length", "80", &path];
        let alone = left(&arguments, "1");
        assert!(alone.starts_with("1 0\n") && alone.contains(told), "{alone}");
        for jobs in ["2", "7"] {
            assert!(left(&arguments, jobs) == alone, "-j {jobs}: {alone}");
        }
    }
    fs::write(&cl, &good).unwrap();
    let path = cl.display().to_string();
    assert!(left(&["-m", "vmc", "--tool-length", "80", &path], "7").starts_with("0 2\n"));
}

/// Whoever writes into a pipe learns at once that enough is wrong: the command does not wait for more.
#[test]
fn a_pipe_that_stays_open_is_given_up_at_once() {
    for jobs in ["1", "2", "7"] {
        let mut post = command();
        post.args(["-m", "vmc", "--tool-length", "80", "-j", jobs, "-o", "-", "-"]);
        let streams = post.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = streams.spawn().unwrap();
        let mut stdin = child.stdin.take().unwrap();
        for place in 0..30 {
            writeln!(stdin, "GOTO/oops{}", "x".repeat(place)).unwrap();
        }
        stdin.flush().unwrap();
        let told = child.wait_with_output().unwrap();
        assert_eq!(told.status.code(), Some(1), "-j {jobs}");
        assert!(String::from_utf8_lossy(&told.stderr).contains("oops"), "-j {jobs}");
        drop(stdin);
    }
}

#[test]
fn no_threads_are_refused() {
    let made = common::post(&["-m", "vmc", "-j", "0", "none.cls"]);
    assert_eq!(made.code, 2, "{}", made.err);
    common::assert_contains(&made.err, &["--jobs <N>"]);
}
