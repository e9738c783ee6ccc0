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

/// What `arguments` print and write into `out` on so many threads, with their code.
fn told(arguments: &[&str], out: &str, jobs: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out");
    let mut post = command();
    let made = run(post.args(arguments).args(["-j", jobs, out]).arg(&file), b"");
    let written = fs::read_to_string(&file).unwrap_or_else(|_| "none".to_owned());
    let folder = folder.path().display().to_string();
    let [told, found] = [made.out, made.err].map(|said| said.replace(&folder, ""));
    format!("{}\n{found}\n{told}\n{written}", made.code)
}

/// `arguments` come to the same on any number of threads: to which code.
#[track_caller]
fn same(arguments: &[&str], out: &str) -> char {
    let alone = told(arguments, out, "1");
    for jobs in ["2", "3"] {
        let beside = told(arguments, out, jobs);
        let differs = alone.lines().zip(beside.lines()).find(|(one, other)| one != other);
        assert!(beside == alone, "{arguments:?} -j {jobs}: {differs:?}");
    }
    alone.chars().next().unwrap()
}

/// Programs of some cases, read back and predicted; then spoilt so that they are given up in the middle, which is told of
/// as much as was judged, however far the program was run ahead.
#[test]
fn verify_and_predict_tell_the_same_on_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("p.nc").display().to_string();
    let spoilt = folder.path().join("spoilt.nc").display().to_string();
    let mut codes = String::new();
    for case in CASES.iter().step_by(4) {
        let sample = common::sample(case.sample).display().to_string();
        let mut arguments = vec!["-m", case.machine];
        arguments.extend(case.with);
        let mut post = command();
        assert_eq!(run(post.args(&arguments).args([&sample, "-q", "-o", &program]), b"").code, 0);
        let against = ["--against", &sample];
        let with = |verb, program| [&[verb, program], &arguments[..], &against].concat();
        codes.push(same(&with("verify", &program), "--map"));
        codes.push(same(&with("predict", &program), "--csv"));
        let text = fs::read_to_string(&program).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let half = lines.len() / 2;
        let noise = (0..60).map(|place| format!("?{place} XX\n")).collect::<String>();
        let (head, rest) = (lines[..half].join("\n"), lines[half..].join("\n"));
        for bad in [
            format!("{head}\n{noise}{rest}\n"),
            format!("{head}\n{}\n", lines[..half].join("\n")),
            format!("{}\n{noise}", text.replace("X1", "X2").replace("Z2", "Z1")),
        ] {
            fs::write(&spoilt, bad).unwrap();
            codes.push(same(&with("verify", &spoilt), "--map"));
            codes.push(same(&with("predict", &spoilt), "--csv"));
        }
    }
    assert!(codes.contains('0') && codes.contains('1'), "{codes}");
}

/// A CL file of which nothing can be understood but its beginning: its tools and faults are those that one thread finds.
#[test]
fn a_cl_file_that_cannot_be_read_is_told_of_alike() {
    let folder = tempfile::tempdir().unwrap();
    let (cl, nc) = (folder.path().join("part.cls"), folder.path().join("part.nc"));
    let mut text = "UNITS/MM\nLOADTL/1,LENGTH,80\nSPINDL/RPM,3000,CLW\n".to_owned();
    let mut program = "G90 G21\n".to_owned();
    for place in 0..2000 {
        text += &format!("FEDRAT/100,MMPM\nGOTO/{place},0,10\n");
        program += &format!("N{place} G1 X{place}. Y0. Z10. F100.\n");
        if place % 20 == 0 {
            text += &format!("GOTO/{place},oops\nLOADTL/{},LENGTH,90\n", 2 + place / 20);
        }
    }
    fs::write(&cl, text + "FINI\n").unwrap();
    fs::write(&nc, program + "M30\n").unwrap();
    let [cl, nc] = [cl, nc].map(|path| path.display().to_string());
    assert_eq!(same(&["verify", &nc, "-m", "vmc", "--against", &cl], "--map"), '1');
    assert_eq!(same(&["predict", &nc, "-m", "vmc", "--against", &cl], "--csv"), '1');
}

#[test]
fn place_finds_the_same_on_any_number_of_threads() {
    let sample = common::sample("blade.cls").display().to_string();
    for more in [&["--runs", "40"][..], &["--runs", "7"], &["--least", "rotary", "--runs", "9"]] {
        let arguments = [&["place", &sample, "-m", "ac-trunnion", "--tool-length", "100"], more];
        assert_eq!(same(&arguments.concat(), "--svg"), '0');
    }
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
