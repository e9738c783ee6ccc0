//! Libraries that mean no good, and folders of libraries that are not what they should be: the command says so, ends
//! with 1, and leaves the program that was there.

#![cfg(unix)]
// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use crate::common::{Run, command, names, post, root, run, sample};

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::os::unix::fs::{PermissionsExt as _, symlink};
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

fn library(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{DLL_PREFIX}post_{name}{DLL_SUFFIX}"))
}

/// A folder with the dialect `hostile`, which has one fault.
fn hostile(fault: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    made("hostile.c", fault, &library(folder.path(), "hostile"));
    folder
}

/// Compiles `source` with one fault.
fn made(source: &str, fault: &str, library: &Path) {
    let done = Command::new("cc")
        .args(["-O2", "-shared", "-fPIC", &format!("-DFAULT_{fault}"), "-I"])
        .arg(root().join("plugins/api/include"))
        .arg(root().join("plugins/host/tests/c").join(source))
        .arg("-o")
        .arg(library)
        .args(["-lm", "-pthread"])
        .status();
    assert!(done.unwrap().success());
}

/// Posts the blade to `part.nc` in a folder, in the dialect of `fault`.
fn post_with(fault: &str, arguments: &[&str]) -> (Run, tempfile::TempDir) {
    let plugins = hostile(fault);
    let folder = tempfile::tempdir().unwrap();
    fs::copy(root().join(sample("blade.cls")), folder.path().join("blade.cls")).unwrap();
    fs::write(folder.path().join("part.nc"), "as it was\n").unwrap();
    let done = run(
        command()
            .current_dir(folder.path())
            .env("TMPDIR", folder.path())
            .args(["-m", "ac-trunnion", "blade.cls", "--dialect", "hostile"])
            .arg("--plugins")
            .arg(plugins.path())
            .args(arguments),
        b"",
    );
    (done, folder)
}

/// The command ended with 1, said why, and left the folder as it was.
fn refused(fault: &str, done: &Run, folder: &tempfile::TempDir) {
    assert_eq!(done.code, 1, "{fault}: {}", done.err);
    // One that ends as it is opened does so before anybody asks what stands at the targets.
    let last = done.err.lines().last().unwrap();
    assert!(last.starts_with("1 error; nothing was written"), "{fault}: {}", done.err);
    assert_eq!(names(folder.path()), ["blade.cls", "part.nc"], "{fault}");
    let part = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert_eq!(part, "as it was\n", "{fault}");
}

#[test]
fn a_plugin_that_ends_the_process_is_named_and_nothing_is_written() {
    for fault in ["EXIT_LOAD", "EXIT_OPEN", "EXIT", "QUICK_EXIT", "EXIT_THREAD"] {
        let targets = ["-o", "part.nc", "--summary", "part.json"];
        let (done, folder) = post_with(fault, &[&targets[..], &["--no-isolate"]].concat());
        assert!(done.err.contains("error[plugin]: plugin `hostile` ("), "{fault}: {}", done.err);
        assert!(done.err.contains("in the middle of its work"), "{fault}: {}", done.err);
        refused(fault, &done, &folder);
        // In a process of its own it is the call that fails.
        let (done, folder) = post_with(fault, &targets);
        let message = "it ended its process with exit code 0 in the middle of its work (`";
        assert!(done.err.contains(message), "{fault}: {}", done.err);
        refused(fault, &done, &folder);
    }
}

#[test]
fn a_plugin_that_opens_all_there_is_to_open_is_told_so() {
    let (done, folder) = post_with("OPENS_ALL", &["-o", "part.nc"]);
    let message = "it is open, and cannot be read again: Too many open files";
    assert!(done.err.contains(message), "{}", done.err);
    refused("OPENS_ALL", &done, &folder);
}

#[test]
fn a_plugin_that_dies_is_named_with_its_event_and_line_and_nothing_is_written() {
    for (fault, message) in [
        (
            "SEGV",
            "event Start: its process died of signal 11, SIGSEGV, in the middle of its work (`write` of ",
        ),
        ("LATER", "event Comment: its process died of signal 11, SIGSEGV,"),
        ("ABORT", "event Start: its process died of signal 6, SIGABRT,"),
        (
            "ABORT_LOAD",
            "its process died of signal 6, SIGABRT, in the middle of its work (`opening` of ",
        ),
        ("DIVIDES", "event Start: its process died of signal 8, SIGFPE,"),
        ("DEEP", "event Start: its process died of signal 11, SIGSEGV,"),
        ("KILLS_ITSELF", "event Start: its process died of signal 9, SIGKILL,"),
        ("EXITS_AT_ONCE", "event Start: it ended its process with exit code 0 in the middle of"),
        ("FORKS_AND_DIES", "event Start: its process died of signal 6, SIGABRT,"),
        ("SCRIBBLES", "it wrote to the connection of its process and was stopped in the middle"),
        ("EATS", "if it wants more than 256 MiB of memory, --plugin-memory gives it more"),
    ] {
        let arguments = ["-o", "part.nc", "--summary", "part.json", "--plugin-memory", "256"];
        let (done, folder) = post_with(fault, &arguments);
        assert!(done.err.contains(message), "{fault}: {}", done.err);
        assert!(done.err.contains("libpost_hostile"), "{fault}: {}", done.err);
        refused(fault, &done, &folder);
        if fault == "LATER" {
            assert!(done.err.contains("--> blade.cls:1:1\n"), "{}", done.err);
        }
    }
    for fault in ["CLOSES", "CLOSES_ALL"] {
        let (done, folder) = post_with(fault, &["-o", "part.nc"]);
        assert!(done.err.contains("in the middle of its work (`write` of "), "{}", done.err);
        refused(fault, &done, &folder);
    }
}

#[test]
fn a_plugin_that_does_not_return_is_stopped() {
    for fault in ["LOOPS", "SLEEPS", "LEAVES_GROUP"] {
        let (done, folder) = post_with(fault, &["-o", "part.nc", "--plugin-seconds", "0.3"]);
        let message = "event Start: it did not return within 0.3 s and was stopped in the middle of its work (`write` of ";
        assert!(done.err.contains(message), "{fault}: {}", done.err);
        refused(fault, &done, &folder);
    }
}

#[test]
fn a_plugin_that_never_stops_talking_is_stopped_too() {
    let (done, folder) = post_with("DRIPS", &["-o", "part.nc", "--plugin-seconds", "0.3"]);
    let message =
        "it did not return within 0.3 s and was stopped in the middle of its work (`write` of ";
    assert!(done.err.contains(message), "{}", done.err);
    refused("DRIPS", &done, &folder);

    // An error model that asks and asks; what the host does meanwhile takes no time of its own.
    let plugins = tempfile::tempdir().unwrap();
    made("hostile_model.c", "ASKS_ON", &library(plugins.path(), "hostile_model"));
    let words = ["-m", "ac-trunnion", "--set", "accuracy.model=\"hostile_model\"", "--trust-model"];
    let done = run(
        command()
            .args(words)
            .args(["-o", "-", "--plugin-seconds", "0.5", "--plugins"])
            .arg(plugins.path())
            .arg(root().join(sample("blade.cls"))),
        b"",
    );
    assert_eq!((done.code, done.out.as_str()), (1, ""), "{}", done.err);
    let late = done.err.contains(
        "it did not return within 0.5 s and was stopped in the middle of its work (`fit` of ",
    );
    let often = done.err.contains("it asks for more than 1048576 deviations of one move");
    assert!(late || often, "{}", done.err);
}

#[test]
fn the_function_that_does_not_return_is_named_and_no_other() {
    for (fault, function) in
        [("OPEN_LOOPS", "open"), ("FORMAT_LOOPS", "format"), ("SENTENCE_LOOPS", "last_error")]
    {
        let (done, folder) = post_with(fault, &["-o", "part.nc", "--plugin-seconds", "0.3"]);
        let message = format!("in the middle of its work (`{function}` of ");
        assert!(done.err.contains(&message), "{fault}: {}", done.err);
        refused(fault, &done, &folder);
    }
}

#[test]
fn a_close_that_fails_is_told_once_and_waited_for_once() {
    // The program was whole before that.
    for (fault, message) in [
        (
            "CLOSE_LOOPS",
            "it did not return within 8 s and was stopped in the middle of its work (`close` of ",
        ),
        (
            "CLOSE_CRASHES",
            "its process died of signal 11, SIGSEGV, in the middle of its work (`close` of ",
        ),
    ] {
        let begun = std::time::Instant::now();
        let (done, folder) = post_with(fault, &["-o", "part.nc", "--plugin-seconds", "8"]);
        // Twice is sixteen seconds, whatever else this computer does.
        assert!(begun.elapsed().as_secs_f64() < 16.0, "{fault}: {:?}", begun.elapsed());
        assert_eq!(done.code, 0, "{}", done.err);
        assert_eq!(
            done.err.matches("warning[plugin]: plugin `hostile` (").count(),
            1,
            "{}",
            done.err
        );
        assert!(done.err.contains(message), "{fault}: {}", done.err);
        let part = fs::read_to_string(folder.path().join("part.nc")).unwrap();
        assert!(part.starts_with("G0 X1\n"), "{part}");
    }
}

/// The command is killed while its plugin stands in the command's group: the plugin ends, and nobody else there.
#[cfg(target_os = "linux")]
#[test]
fn a_plugin_that_left_its_group_ends_with_the_command_and_takes_nobody_along() {
    let plugins = hostile("LEAVES_GROUP");
    let mut bystander = Command::new("sleep").arg("60").process_group(0).spawn().unwrap();
    let path = plugins.path().to_str().unwrap().to_owned();
    let mut posting = command()
        .args(["-m", "ac-trunnion", "--dialect", "hostile", "-o", "-"])
        .arg(root().join(sample("blade.cls")))
        .arg("--plugins")
        .arg(plugins.path())
        .process_group(bystander.id().try_into().unwrap())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut heard = BufReader::new(posting.stderr.take().unwrap()).lines();
    assert!(heard.any(|line| line.unwrap() == "plugin `hostile` prints: left"));
    assert!(runs(&path));
    posting.kill().unwrap();
    posting.wait().unwrap();
    let killed = std::time::Instant::now();
    while runs(&path) && killed.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(50));
    }
    let ended = !runs(&path);
    let stands = bystander.try_wait().unwrap().is_none();
    bystander.kill().unwrap();
    bystander.wait().unwrap();
    assert!(ended && stands, "{ended} {stands}");
}

/// Whether a plugin's process runs that was told of `path`.
#[cfg(target_os = "linux")]
fn runs(path: &str) -> bool {
    let processes = fs::read_dir("/proc").unwrap().filter_map(Result::ok);
    let mut words = processes.filter_map(|process| fs::read(process.path().join("cmdline")).ok());
    words.any(|words| {
        let words = String::from_utf8_lossy(&words);
        words.starts_with("post-plugin") && words.contains(path)
    })
}

#[test]
fn what_a_plugin_leaves_running_doubles_nothing() {
    let (plain, _) = post_with("NONE", &["-q", "-o", "-"]);
    assert_eq!(plain.code, 0, "{}", plain.err);
    for fault in ["FORKS", "THREAD_GOES_ON"] {
        let (done, _) = post_with(fault, &["-q", "-o", "-"]);
        assert_eq!((done.code, &done.out), (0, &plain.out), "{fault}: {}", done.err);
    }
    let (trusted, _) = post_with("NONE", &["-q", "-o", "-", "--no-isolate"]);
    assert_eq!((trusted.code, &trusted.out), (0, &plain.out), "{}", trusted.err);
}

#[test]
fn a_trusted_plugin_that_dies_is_named_and_leaves_no_file() {
    for (fault, signal) in [("SEGV", 11), ("ABORT", 6), ("DIVIDES", 8), ("DEEP", 11)] {
        let arguments = ["--no-isolate", "-o", "part.nc", "--summary", "part.json"];
        let (done, folder) = post_with(fault, &arguments);
        let message =
            format!("): the command died of signal {signal} in the middle of its work (`write`);");
        assert!(done.err.contains(&message), "{fault}: {}", done.err);
        assert!(done.err.contains("error[plugin]: plugin `hostile` ("), "{fault}: {}", done.err);
        assert_eq!(done.code, 1, "{fault}");
        assert_eq!(names(folder.path()), ["blade.cls", "part.nc"], "{fault}");
    }
}

#[test]
fn what_a_plugin_left_to_be_run_at_the_end_changes_no_exit_code() {
    let (done, _) = post_with(
        "LATE_EXIT",
        &["-o", "part.nc", "--unknown", "error", "--set", "control.hostile.x=1"],
    );
    assert_eq!(done.code, 1, "{}", done.err);
    let (done, folder) = post_with("LATE_EXIT", &["-o", "part.nc"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let part = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert!(part.starts_with("G0 X1\n"), "{part}");
}

#[test]
fn what_a_plugin_prints_is_no_part_of_the_program() {
    let (done, _) = post_with("PRINTS", &["-o", "-"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(done.out.starts_with("G0 X1\n") && done.out.ends_with("G0 X1\n"));
    assert!(!done.out.contains("Z-500"), "{}", done.out);
    // By another name it is the same stream.
    let (named, _) = post_with("PRINTS", &["-q", "-o", "/dev/stdout"]);
    assert_eq!((named.code, &named.out), (0, &done.out), "{}", named.err);
    // It is not lost either.
    assert!(done.err.contains("plugin `hostile` prints: G0 Z-500\n"), "{}", done.err);
}

#[test]
fn what_a_plugin_prints_without_an_end_is_told_as_it_is_closed() {
    let (done, _) = post_with("PRINTS_BIT", &["-q", "-o", "part.nc"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert!(
        done.err.contains("plugin `hostile` prints: a line that does not end\n"),
        "{}",
        done.err
    );
}

#[test]
fn what_a_plugin_prints_is_no_message_of_the_command() {
    let (done, _) = post_with("FORGES", &["-q", "-o", "part.nc"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let forged = "plugin `hostile` prints: error[travel]: X is \\u{1b}[2Jpast its travel\n\
                  plugin `hostile` prints: --> part.nc:1\n";
    assert!(done.err.contains(forged), "{}", done.err);
    let is_told = |line: &str| line.starts_with("plugin `hostile` prints: ");
    assert!(done.err.lines().all(|line| is_told(line) || !line.contains("part.nc:1")));
    assert!(!done.err.contains('\u{1b}'), "{}", done.err);
}

#[test]
fn a_plugin_that_prints_without_end_is_cut_short_and_waits_for_nobody() {
    let (done, folder) = post_with("PRINTS_ON", &["-q", "-o", "part.nc"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let part = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert!(part.starts_with("G0 X1\n"), "{part}");
    let told = done.err.lines().filter_map(|line| line.strip_prefix("plugin `hostile` prints: "));
    let lines: Vec<&str> = told.collect();
    assert_eq!(lines[0], "0 is said");
    assert_eq!(*lines.last().unwrap(), "(no more is shown than 64 KiB)");
    assert!(lines.len() < 8000, "{}", lines.len());
}

/// Whoever waits for the end of the command's messages does not wait for what a plugin has left behind.
#[test]
fn what_a_plugin_leaves_running_does_not_hold_the_command_s_messages_open() {
    let begun = std::time::Instant::now();
    let (done, _) = post_with("LEAVES_A_PRINTER", &["-q", "-o", "part.nc"]);
    assert_eq!(done.code, 0, "{}", done.err);
    // It prints for a minute.
    assert!(begun.elapsed().as_secs_f64() < 50.0, "{:?}", begun.elapsed());
}

#[test]
fn a_plugin_s_line_that_a_control_reads_as_two_is_refused_with_its_cl_line() {
    let (done, folder) = post_with("CR", &["-o", "part.nc"]);
    assert_eq!(done.code, 1, "{}", done.err);
    let message = "error[dialect]: dialect `hostile`, event Start: its line `(x)\\rG0 Z-50` holds the character U+000D";
    assert!(done.err.contains(message), "{}", done.err);
    assert!(done.err.contains("blade.cls:"), "{}", done.err);
    let part = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    assert_eq!(part, "as it was\n");
}

/// Posts the blade as `ac-trunnion` says, with `POST_PLUGINS` as it is given.
fn post_from(variable: &std::ffi::OsStr) -> Run {
    let arguments = ["-m", "ac-trunnion", "tests/samples/blade.cls", "-o", "-"];
    run(command().args(arguments).env("POST_PLUGINS", variable), b"")
}

#[test]
fn a_folder_that_is_not_what_it_should_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("good")).unwrap();
    fs::write(at("file"), "").unwrap();
    symlink("nowhere", at("dangling")).unwrap();
    symlink(at("round"), at("round")).unwrap();
    for (entry, message) in [
        (at("missing").display().to_string(), "missing: no such folder"),
        (at("dangling").display().to_string(), "dangling: no such folder"),
        (at("file").display().to_string(), "file: it cannot be read: Not a directory"),
        (at("round").display().to_string(), "round: it cannot be read: "),
        (format!(":{}", at("good").display()), "POST_PLUGINS has an empty entry"),
        (format!("{}:", at("good").display()), "POST_PLUGINS has an empty entry"),
        ("tests".to_owned(), "POST_PLUGINS tests: a folder in this variable must not be relative"),
    ] {
        let done = post_from(entry.as_ref());
        assert_eq!((done.code, done.out.as_str()), (1, ""), "{entry}");
        assert!(done.err.contains(message), "{entry}: {}", done.err);
    }
    assert_eq!(post_from("".as_ref()).code, 0);
    assert_eq!(post_from(at("good").as_os_str()).code, 0);
}

#[test]
fn a_link_that_leads_nowhere_is_not_replaced_by_the_stock_plugin() {
    let folder = tempfile::tempdir().unwrap();
    symlink("nowhere", library(folder.path(), "fanuc")).unwrap();
    let done = post_from(folder.path().as_os_str());
    assert_eq!((done.code, done.out.as_str()), (1, ""));
    assert!(done.err.contains("it cannot be opened: No such file"), "{}", done.err);
}

#[test]
fn a_folder_that_everybody_may_write_to_is_told() {
    let folder = tempfile::tempdir().unwrap();
    assert!(!post_from(folder.path().as_os_str()).err.contains("everybody"));
    fs::set_permissions(folder.path(), fs::Permissions::from_mode(0o777)).unwrap();
    let done = post_from(folder.path().as_os_str());
    assert_eq!(done.code, 0, "{}", done.err);
    let message = "everybody may write to this folder, and a plugin in it runs with your rights";
    assert!(done.err.contains(message), "{}", done.err);
}

#[test]
fn plugins_are_listed_with_what_they_are_and_where_they_are_from() {
    let plain = post(&["plugin", "list"]);
    assert_eq!((plain.code, plain.err.as_str()), (0, ""));
    for row in [
        "fanuc            dialect      0.1.0      built in\n    The dialect of Fanuc controls: ",
        "sampled          error model  0.1.0      built in\n",
    ] {
        assert!(plain.out.contains(row), "{}", plain.out);
    }
    let folder = hostile("NONE");
    fs::write(library(folder.path(), "fanuc"), "no library").unwrap();
    let path = folder.path().to_str().unwrap();
    let more = post(&["plugin", "list", "--plugins", path]);
    assert_eq!(more.code, 0, "{}", more.err);
    let row = |name: &str| {
        let rows: Vec<&str> = more.out.lines().filter(|line| line.starts_with(name)).collect();
        rows
    };
    assert!(row("hostile ")[0].contains("dialect      1.0 "), "{}", more.out);
    let [broken, hidden] = row("fanuc ")[..] else { panic!("{}", more.out) };
    assert!(broken.contains("broken") && hidden.contains("built in"));
    assert!(more.out.contains("not used: another of this name comes first"));
    assert!(more.err.contains("warning[plugin]: plugin `fanuc` ("), "{}", more.err);
}

#[test]
fn a_plugin_shows_its_options_and_what_it_writes() {
    let shown = post(&["plugin", "show", "linuxcnc"]);
    assert_eq!((shown.code, shown.err.as_str()), (0, ""));
    for part in [
        "linuxcnc 0.1.0 (built in), a dialect\n",
        "Options, [control.linuxcnc]:\n",
        "  block_step = 10    # 1 to 1000\n      From one N to the next.\n",
        "  tcp_on = \"M428\"    # a line, or an array of lines\n",
        "files end with .ngc\n",
        "  COMPENSATE_TCP   Compensate also while",
    ] {
        assert!(shown.out.contains(part), "{part}\n{}", shown.out);
    }
    let model = post(&["plugin", "show", "sampled"]);
    assert!(model.out.contains("Options, [accuracy.sampled]:\n"), "{}", model.out);
    let slip = post(&["plugin", "show", "fanuk"]);
    assert_eq!((slip.code, slip.out.as_str()), (1, ""));
    assert!(
        slip.err.contains("did you mean `fanuc`? there are brother, fagor, fanuc, "),
        "{}",
        slip.err
    );
}

#[test]
fn another_dialect_for_one_run() {
    let blade = sample("blade.cls");
    let post_as = |arguments: &[&str]| {
        let fixed = ["-m", "ac-trunnion", blade.to_str().unwrap(), "-o", "-"];
        post(&[&fixed, arguments].concat())
    };
    let short = post_as(&["--dialect", "heidenhain"]);
    let long = post_as(&["--set", "control.dialect=heidenhain"]);
    assert_eq!(short.code, 0, "{}", short.err);
    assert!(short.out.starts_with("0 BEGIN PGM ") && short.out == long.out);
    let message = "--dialect heidenhain is not the machine's own, which is fanuc";
    assert!(short.err.contains(message), "{}", short.err);

    // Options of the machine's own stay behind, and it is said which.
    let options = ["--set", "control.fanuc.block_numbers=\"all\""];
    let told = post_as(&[&options, &["--dialect", "linuxcnc"][..]].concat());
    assert_eq!(told.code, 0, "{}", told.err);
    let message = "its options are not carried over (block_numbers)";
    assert!(told.err.contains(message), "{}", told.err);
    assert!(!told.out.contains("N10 "), "{}", told.out);
    // Those of the other one are used.
    let options = ["--set", "control.linuxcnc.block_numbers=\"all\""];
    let used = post_as(&[&options, &["--dialect", "linuxcnc"][..]].concat());
    assert!(used.out.contains("N10 "), "{}", used.out);

    // Its own is no other one.
    let own = post_as(&["--dialect", "fanuc"]);
    assert_eq!(own.out, post_as(&[]).out);
    assert!(!own.err.contains("--dialect"), "{}", own.err);
    let slip = post_as(&["--dialect", "hiedenhain"]);
    assert_eq!(slip.code, 1);
    assert!(slip.err.contains("did you mean `heidenhain`? "), "{}", slip.err);
    let check = post(&["check", "ac-trunnion", "--dialect", "heidenhain"]);
    assert_eq!(check.code, 0, "{}", check.err);
}
