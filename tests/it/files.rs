//! A user's file is never lost: what is read is not written to, several texts take their places together or not at all,
//! and the last line of the messages is true.

use crate::common;

use std::fs;
use std::path::Path;

use crate::plugins::built;
use common::{GOOD, assert_contains, command, names, post_in, run, with_file};
use tempfile::TempDir;

/// A machine that extends another one, and a CL file.
pub fn workshop() -> TempDir {
    let folder = with_file("part.cls", GOOD);
    let parent = fs::read_to_string(common::root().join("machines/ac-trunnion.toml")).unwrap();
    fs::write(folder.path().join("parent.toml"), parent).unwrap();
    let own = "extends = \"parent.toml\"\nname = \"ours\"\n";
    fs::write(folder.path().join("ours.toml"), own).unwrap();
    folder
}

/// Names and contents of all files of a folder; of links where they lead.
fn contents(folder: &Path) -> Vec<(String, String)> {
    let read = |name: &String| {
        let path = folder.join(name);
        let link = fs::read_link(&path).map(|to| format!("-> {}", to.display()));
        link.or_else(|_| fs::read_to_string(&path)).unwrap_or_default()
    };
    let names = names(folder);
    let read: Vec<String> = names.iter().map(read).collect();
    names.into_iter().zip(read).collect()
}

pub const JOB: &[&str] = &["-q", "-m", "ours.toml", "--tool-length", "0", "part.cls"];

/// Runs a job that must be refused and change nothing; says what was said.
#[track_caller]
pub fn refused(folder: &Path, arguments: &[&str], parts: &[&str]) {
    let before = contents(folder);
    let done = post_in(folder, arguments);
    assert_eq!((done.code, done.out.as_str()), (1, ""), "{arguments:?}\n{}", done.err);
    assert_contains(&done.err, parts);
    assert_contains(&done.err, &["1 error; nothing was written"]);
    assert_eq!(contents(folder), before, "{arguments:?}");
}

#[test]
fn no_file_that_is_read_is_written_to() {
    let folder = workshop();
    for (target, what) in [
        ("ours.toml", "the machine file ours.toml"),
        ("./ours.toml", "the machine file ours.toml, which ./ours.toml is"),
        ("parent.toml", "the machine file parent.toml"),
        ("part.cls", "the CL file part.cls"),
    ] {
        for (option, text) in [("-o", "program"), ("--summary", "summary")] {
            let told = format!("the {text} would overwrite {what}");
            let help = format!("name another file with {option}");
            let kept = format!("nothing was written; {target} is as it was");
            let arguments = [JOB, &[option, target]].concat();
            refused(folder.path(), &arguments, &[&told, &help, &kept]);
        }
    }
    let check = &["check", "ours.toml"][..];
    for (arguments, told) in [
        (&["--svg", "parent.toml"][..], "the picture would overwrite the machine file parent.toml"),
        (&["--json", "ours.toml"], "the JSON would overwrite the machine file ours.toml"),
        (&["--commission", "-o", "parent.toml"], "the program would overwrite the machine file"),
        (&["--svg", "x", "--json", "./x"], "the JSON would overwrite the picture x, which ./x is"),
        (&["--nominal", "parent.toml", "--json", "parent.toml"], "the JSON would overwrite"),
    ] {
        refused(folder.path(), &[check, arguments].concat(), &[told]);
    }
}

#[cfg(unix)]
#[test]
fn no_name_of_a_file_that_is_read_is_written_to() {
    use std::os::unix::fs::symlink;
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    symlink("parent.toml", at("link")).unwrap();
    symlink("link", at("link-of-link")).unwrap();
    fs::hard_link(at("part.cls"), at("hard")).unwrap();
    symlink(".", at("here")).unwrap();
    for target in ["link", "link-of-link", "hard", "here/ours.toml", "here/hard"] {
        for option in ["-o", "--summary"] {
            let told = format!(", which {target} is");
            refused(folder.path(), &[JOB, &[option, target]].concat(), &["would overwrite", &told]);
        }
    }
    // The default target of `part.cls` is `part.nc`.
    symlink("part.cls", at("part.nc")).unwrap();
    refused(folder.path(), JOB, &["would overwrite the CL file part.cls, which part.nc is"]);
}

#[cfg(unix)]
#[test]
fn what_a_shell_reads_or_writes_is_known_too() {
    use std::process::Stdio;
    let folder = workshop();
    let cl = folder.path().join("part.cls");
    // `post - -o part.cls < part.cls`
    let mut post = command();
    post.current_dir(folder.path())
        .args(["-q", "-m", "ours.toml", "-", "-o", "part.cls"])
        .stdin(fs::File::open(&cl).unwrap());
    let done = post.output().unwrap();
    let err = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{err}");
    assert_contains(&err, &["would overwrite the CL file on standard input"]);
    assert_eq!(fs::read_to_string(&cl).unwrap(), GOOD);
    // `post part.cls -o - >> part.cls`
    let appended = fs::OpenOptions::new().append(true).open(&cl).unwrap();
    let mut post = command();
    post.current_dir(folder.path()).args(JOB).args(["-o", "-"]).stdout(appended);
    let done = post.stdin(Stdio::null()).output().unwrap();
    assert_eq!(done.status.code(), Some(1));
    assert_eq!(fs::read_to_string(&cl).unwrap(), GOOD);
    // `post part.cls >> part.cls`: what is printed for people would spoil it as well.
    for (arguments, read) in [
        (&["-m", "ours.toml", "part.cls", "-o", "x.nc"][..], "part.cls"),
        (JOB, "ours.toml"),
        (&["check", "ours.toml"], "parent.toml"),
        (&["words", "part.cls"], "part.cls"),
        (&["machines", "--print", "ours", "--machines", "."], "ours.toml"),
        (&["place", "-m", "ours.toml", "part.cls"], "part.cls"),
    ] {
        let before = contents(folder.path());
        let mut appended = fs::OpenOptions::new();
        let appended = appended.append(true).open(folder.path().join(read));
        let mut post = command();
        post.current_dir(folder.path()).args(arguments).stdout(appended.unwrap());
        let done = post.stdin(Stdio::null()).output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {err}");
        assert_contains(&err, &["standard output goes to the ", "which the run reads"]);
        assert_eq!(contents(folder.path()), before, "{arguments:?}");
    }
    // `post part.cls -o out.nc > out.nc`: a file that was replaced would not be the one that the shell opened.
    for option in ["out.nc", "/dev/stdout"] {
        let out = fs::File::create(folder.path().join("out.nc")).unwrap();
        let mut post = command();
        post.current_dir(folder.path()).args(&JOB[1..]).args(["-o", option]).stdout(out);
        let done = post.stdin(Stdio::null()).output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(0), "{err}");
        assert_contains(&err, &["tip deviation"]);
        let program = fs::read_to_string(folder.path().join("out.nc")).unwrap();
        assert!(program.starts_with("%\n") && program.ends_with("M30\n%\n"), "{program}");
    }
    // `post part.cls -o out.nc >> out.nc`: a program behind another one would be run as its end.
    let out = fs::OpenOptions::new().append(true).open(folder.path().join("out.nc"));
    let before = contents(folder.path());
    let mut post = command();
    post.current_dir(folder.path()).args(JOB).args(["-o", "out.nc"]).stdout(out.unwrap());
    let done = post.stdin(Stdio::null()).output().unwrap();
    let err = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{err}");
    assert_contains(&err, &["overwrite out.nc, which standard output is added to"]);
    assert_eq!(contents(folder.path()), before);
    let done =
        post_in(folder.path(), &[JOB, &["-o", "/dev/null", "--summary", "/dev/null"]].concat());
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    for summary in ["-", "/dev/stdout"] {
        let told = ["standard output", "name another file with --summary"];
        refused(folder.path(), &[JOB, &["-o", "-", "--summary", summary]].concat(), &told);
    }
}

#[cfg(unix)]
#[test]
fn program_and_summary_are_two_files() {
    use std::os::unix::fs::symlink;
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("nc")).unwrap();
    symlink("nc", at("other")).unwrap();
    symlink("nc/new", at("link")).unwrap();
    fs::write(at("old"), "old").unwrap();
    fs::hard_link(at("old"), at("hard")).unwrap();
    // Neither `new` nor `nc/new` is there yet.
    for [program, summary] in [
        ["new", "./new"],
        ["nc/new", "other/new"],
        ["nc/new", "nc/../nc/new"],
        ["link", "nc/new"],
        ["nc/new", "link"],
        ["old", "hard"],
    ] {
        let told = format!("the summary would overwrite the program {program}, which {summary} is");
        let arguments = [JOB, &["-o", program, "--summary", summary]].concat();
        refused(folder.path(), &arguments, &[&told]);
        assert_eq!(names(&at("nc")), [""; 0]);
    }
}

#[test]
fn no_plugin_is_written_to() {
    let folder = workshop();
    let library = format!("anything{}", std::env::consts::DLL_SUFFIX);
    fs::create_dir(folder.path().join("plugins")).unwrap();
    fs::write(folder.path().join("plugins").join(&library), "a library").unwrap();
    let target = format!("plugins/{library}");
    let arguments = [JOB, &["--plugins", "plugins", "-o", &target]].concat();
    let told = format!("would overwrite the plugin plugins/{library}");
    refused(folder.path(), &arguments, &[&told]);
    refused(
        folder.path(),
        &[JOB, &["--plugins", "plugins", "-o", "plugins"]].concat(),
        &["plugins is a folder"],
    );
    let kept = fs::read_to_string(folder.path().join(target)).unwrap();
    assert_eq!(kept, "a library");
}

#[cfg(target_os = "linux")]
#[test]
fn program_and_summary_take_their_names_together_or_not_at_all() {
    let folder = workshop();
    fs::write(folder.path().join("p.nc"), "the one before").unwrap();
    let kept = "1 error; nothing was written; p.nc is as it was";
    refused(
        folder.path(),
        &[JOB, &["-o", "p.nc", "--summary", "/dev/full"]].concat(),
        &["/dev/full: No space left on device", kept],
    );
    refused(
        folder.path(),
        &[JOB, &["-o", "/dev/full", "--summary", "new.json"]].concat(),
        &["/dev/full: No space left on device"],
    );
    // `--summary - > /dev/full`
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let mut post = command();
    post.current_dir(folder.path()).args(JOB).args(["-o", "p.nc", "--summary", "-"]).stdout(full());
    let done = post.output().unwrap();
    let err = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{err}");
    assert_contains(&err, &["standard output: No space left on device", kept]);
    let text = fs::read_to_string(folder.path().join("p.nc")).unwrap();
    assert_eq!(text, "the one before");
    // What is told to people is no part of it: the program is written, and that is said.
    let mut post = command();
    post.current_dir(folder.path()).args(&JOB[1..]).args(["-o", "p.nc"]).stdout(full());
    let done = post.output().unwrap();
    let err = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(1), "{err}");
    assert_contains(
        &err,
        &["standard output: No space left on device", "1 error; p.nc is written"],
    );
    let text = fs::read_to_string(folder.path().join("p.nc")).unwrap();
    assert!(text.ends_with("M30\n%\n"), "{text}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_table_that_cannot_be_printed_is_a_fault() {
    for arguments in
        [&["words"][..], &["machines"], &["schema"], &["check", "vmc"], &["--help"], &["--version"]]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let done = command().args(arguments).stdout(full).output().unwrap();
        let err = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{arguments:?}\n{err}");
        assert_contains(&err, &["standard output: No space left on device"]);
    }
}

/// A disk that is full, as a limit of the shell makes one.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_is_full_half_way_leaves_the_program_of_before() {
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/100,MMPM\n");
    for step in 0..20_000 {
        text.push_str(&format!("GOTO/{},{},10\n", step % 97, step % 89));
    }
    text.push_str("FINI\n");
    let folder = with_file("part.cls", &text);
    fs::write(folder.path().join("part.nc"), "the one before").unwrap();
    let script = "ulimit -f 64; exec \"$0\" -q -m vmc --tool-length 0 part.cls";
    let mut shell = std::process::Command::new("bash");
    shell.args(["-c", script, env!("CARGO_BIN_EXE_post")]).current_dir(folder.path());
    let done = run(&mut shell, b"");
    assert_eq!(done.code, 1, "{}", done.err);
    assert_contains(
        &done.err,
        &["part.nc: File too large", "nothing was written; part.nc is as it was"],
    );
    assert_eq!(names(folder.path()), ["part.cls", "part.nc"]);
    let kept = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert_eq!(kept, "the one before");
}

#[cfg(unix)]
#[test]
fn a_link_is_followed_and_stays() {
    use std::os::unix::fs::symlink;
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("nc")).unwrap();
    for there in [false, true] {
        for name in ["link", "link-of-link"] {
            let _ = fs::remove_file(at("link"));
            let _ = fs::remove_file(at("link-of-link"));
            let _ = fs::remove_file(at("nc/program"));
            symlink("nc/program", at("link")).unwrap();
            symlink(at("link"), at("link-of-link")).unwrap();
            if there {
                fs::write(at("nc/program"), "old").unwrap();
            }
            let done = post_in(folder.path(), &[JOB, &["-o", name]].concat());
            assert_eq!((done.code, done.err.as_str()), (0, ""));
            assert!(at(name).is_symlink());
            let text = fs::read_to_string(at("nc/program")).unwrap();
            assert!(text.ends_with("M30\n%\n"), "{text}");
            assert_eq!(names(&at("nc")), ["program"]);
        }
    }
    // In a circle, or into a folder that is missing.
    symlink("round", at("round")).unwrap();
    refused(folder.path(), &[JOB, &["-o", "round"]].concat(), &["round: Too many levels"]);
    symlink("no/such", at("lost")).unwrap();
    refused(folder.path(), &[JOB, &["-o", "lost"]].concat(), &["lost: No such file"]);
    refused(folder.path(), &[JOB, &["-o", "new/"]].concat(), &["there is no folder new/"]);
}

/// A plugin that changes the folder that the command works in, as it is opened.
#[test]
fn a_plugin_that_wanders_takes_no_file_along() {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let folder = workshop();
    let at = |name: &str| folder.path().join(name);
    let library = format!("{DLL_PREFIX}post_faulty{DLL_SUFFIX}");
    fs::create_dir(at("plugins")).unwrap();
    fs::copy(built("faulty"), at("plugins").join(library)).unwrap();
    fs::create_dir(at("elsewhere")).unwrap();
    let wandering = "extends = \"parent.toml\"\n[accuracy]\nmodel = \"faulty\"\n[accuracy.faulty]\nfault = \"wanders\"\n";
    fs::write(at("ours.toml"), wandering).unwrap();
    for (arguments, program) in [(&[][..], "part.nc"), (&["-o", "p.nc"], "p.nc")] {
        let mut post = command();
        post.current_dir(folder.path())
            .args(JOB)
            .args(["--plugins", "plugins", "--summary", "s.json"])
            .args(arguments)
            // There it goes.
            .env("TMPDIR", at("elsewhere"));
        let done = run(&mut post, b"");
        assert_eq!((done.code, done.err.as_str()), (0, ""));
        for name in [program, "s.json"] {
            assert!(at(name).is_file(), "{name} is not where it was asked for");
        }
        assert_eq!(names(&at("elsewhere")), [""; 0]);
    }
}

/// Of two runs that write the same pair at once, one has both: the program is called after its CL file.
#[test]
fn pairs_of_two_runs_are_not_mixed() {
    let folder = workshop();
    let other = GOOD.replace("GOTO/20,0,10", "GOTO/21,0,10\nGOTO/20,0,10");
    fs::write(folder.path().join("other.cls"), other).unwrap();
    for _ in 0..10 {
        let runs: Vec<_> = ["part.cls", "other.cls"]
            .iter()
            .map(|file| {
                let mut post = command();
                post.current_dir(folder.path())
                    .args(["-q", "-m", "ours.toml", "--tool-length", "0", file])
                    .args(["-o", "p.nc", "--summary", "s.json"]);
                post.spawn().unwrap()
            })
            .collect();
        for mut run in runs {
            assert!(run.wait().unwrap().success());
        }
        let program = fs::read_to_string(folder.path().join("p.nc")).unwrap();
        let summary = common::read_json(&folder.path().join("s.json"));
        assert_eq!(summary["nc_lines"], program.lines().count());
    }
    assert_eq!(names(folder.path()).len(), 6);
}

/// Somebody makes the file while the questions are answered.
#[test]
fn answers_do_not_replace_a_file_that_came_in_the_meantime() {
    use std::io::{Read as _, Write as _};
    use std::process::Stdio;
    let folder = tempfile::tempdir().unwrap();
    let mut new = command();
    new.current_dir(folder.path()).args(["new", "mill"]);
    let streams = new.stdin(Stdio::piped()).stderr(Stdio::piped());
    let mut asking = streams.stdout(Stdio::null()).spawn().unwrap();
    let mut asked = asking.stderr.take().unwrap();
    asked.read_exact(&mut [0]).unwrap();
    fs::write(folder.path().join("mill.toml"), "mine").unwrap();
    let mut answers = asking.stdin.take().unwrap();
    answers.write_all(b"three-axis\n").unwrap();
    answers.write_all(&b"\n".repeat(30)).unwrap();
    drop(answers);
    let mut told = String::new();
    asked.read_to_string(&mut told).unwrap();
    assert_eq!(asking.wait().unwrap().code(), Some(1), "{told}");
    assert_contains(&told, &["mill.toml is there already", "--force"]);
    let kept = fs::read_to_string(folder.path().join("mill.toml")).unwrap();
    assert_eq!(kept, "mine");
}
