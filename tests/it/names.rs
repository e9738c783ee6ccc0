//! Names that a user misspells: machines, keys, values, parameters, words of the CL file; and the list of machines.

use crate::common::{Run, command, run};

const FILE: &str = "UNITS/MM\nLOADTL/3\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/20,0,10\nFINI\n";

/// Posts [`FILE`] with the text put before `FINI`.
fn posted(with: &[&str], more: &str) -> Run {
    let text = FILE.replace("FINI", &format!("{more}FINI"));
    let mut all = vec!["-q", "--tool-length", "100", "-o", "-"];
    all.extend(with);
    all.push("-");
    run(command().args(all), text.as_bytes())
}

#[track_caller]
fn refused(run: &Run, parts: &[&str]) {
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.out.is_empty(), "{}", run.out);
    for part in parts {
        assert!(run.err.contains(part), "`{part}` is not in:\n{}", run.err);
    }
}

#[test]
fn a_misspelt_machine_is_named_with_the_one_that_is_near() {
    for (slip, meant) in [
        ("ac-trunion", "ac-trunnion"),
        ("AC_Trunnion", "ac-trunnion"),
        ("dmu-50", "dmu50"),
        ("xyzac", "xyzac-trt"),
    ] {
        let parts = [format!("there is no machine {slip}"), format!("did you mean {meant}?")];
        let parts = parts.each_ref().map(String::as_str);
        refused(&posted(&["-m", slip], ""), &parts);
        refused(&run(command().args(["check", slip]), b""), &parts);
    }
    let far = posted(&["-m", "integrex"], "");
    refused(&far, &["there is no machine integrex", "`post machines`"]);
    assert!(!far.err.contains("did you mean"), "{}", far.err);
    let mine = "extends = \"vmcc\"\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, mine).unwrap();
    let path = path.to_str().unwrap();
    refused(&posted(&["-m", path], ""), &["there is no machine vmcc", "did you mean vmc?"]);
}

#[test]
fn all_misspelt_keys_of_a_machine_file_are_told_at_once() {
    let slips = ["accuracy.tolerence=0.1", "axis.X.travle=[0, 1]", "workpiece.mont=[0, 0, 0]"];
    let sets = slips.iter().flat_map(|slip| ["--set", slip]);
    let all: Vec<&str> = ["-m", "ac-trunnion"].into_iter().chain(sets).collect();
    refused(
        &posted(&all, ""),
        &[
            "there is no key `tolerence` here",
            "did you mean `tolerance`? known are model, placement, tolerance",
            "there is no key `travle` here",
            "did you mean `travel`?",
            "did you mean `mount`?",
            "3 errors",
        ],
    );
    // An unknown key and a value of another kind.
    let two = ["--set", "accuracy.tolerence=1", "--set", "name=3"];
    let two: Vec<&str> = ["-m", "vmc"].into_iter().chain(two).collect();
    refused(&posted(&two, ""), &["`tolerence`", "2 errors"]);
    let value = ["-m", "vmc", "--set", "accuracy.placement=fewset"];
    let value = posted(&value, "");
    refused(&value, &["there is no value `fewset` here", "did you mean `fewest`?"]);
}

#[test]
fn misspelt_parameters_and_axes_are_told_with_those_that_there_are() {
    refused(
        &posted(&["-m", "disc-cutter", "--set", "Lmm=4"], ""),
        &["no parameter of that name", "did you mean `Lm`?"],
    );
    let formula = ["-m", "disc-cutter", "--set", "axis.X.max_feed='2*topp'"];
    let formula = posted(&formula, "");
    refused(&formula, &["did you mean `top`? the parameters are Lm, top"]);
    // What follows from a number that has no value is not told too.
    refused(&formula, &["1 error;"]);
    refused(
        &posted(&["-m", "dmu50", "--set", "solution.start={ W = 0 }"], ""),
        &["the machine has no axis W", "its axes are C, B, Y, X, Z"],
    );
}

#[test]
fn words_that_nobody_knows_are_told_with_the_one_that_is_near() {
    let run = posted(&["-m", "vmc"], "GOTTO/0,0,5\nFROBNICATE/1\n");
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.err.contains("did you mean GOTO?"), "{}", run.err);
    assert_eq!(run.err.matches("did you mean").count(), 1, "{}", run.err);

    let slip = posted(&["-m", "vmc", "--allow", "OFSTL"], "");
    assert_eq!(slip.code, 0, "{}", slip.err);
    let told = "--allow OFSTL: the file has no such word, and post knows none";
    assert!(slip.err.contains(told), "{}", slip.err);
    assert!(slip.err.contains("did you mean OFSETL?"), "{}", slip.err);
    // A list that is given with every file says nothing where a word is not met.
    let known = posted(&["-m", "vmc", "--allow", "OFSETL"], "");
    assert!(!known.err.contains("OFSETL"), "{}", known.err);
}

#[test]
fn a_tool_that_the_file_contradicts_is_refused() {
    refused(
        &posted(&["-m", "vmc", "--tool", "7"], ""),
        &["the file loads tool 3 itself, --tool says 7", "1 error;"],
    );
    let same = posted(&["-m", "vmc", "--tool", "3"], "");
    assert_eq!(same.code, 0, "{}", same.err);
}

#[test]
fn numbers_in_messages_are_short() {
    let long = ["-m", "vmc", "--set", "accuracy.tolerance=-0.1234567890123"];
    refused(&posted(&long, ""), &["tolerance is -0.1234568; "]);
    let sum = ["-m", "vmc", "--set", "axis.X.max_feed='-0.1-0.2'"];
    refused(&posted(&sum, ""), &["max_feed of X is -0.3; "]);
}

#[test]
fn machines_are_listed_with_axes_dialect_and_class() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).unwrap();
    };
    write("vmc.toml", "extends = \"dmu50\"\n");
    write("broken.toml", "name = \"B\"\n");
    let named = folder.path().to_str().unwrap();
    // Beside no folder `machines`.
    let mut listing = command();
    listing.current_dir(&folder);
    let list = run(listing.args(["machines", "--machines", named]), b"");
    assert_eq!(list.code, 0, "{}", list.err);
    let row = |name: &str| {
        let mut rows = list.out.lines().filter(|line| {
            let mut words = line.split_whitespace();
            words.next() == Some(name)
        });
        let row = rows.next().unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(rows.next(), None, "one of a name is found");
        row.split("  ")
            .map(str::trim)
            .filter(|cell| !cell.is_empty())
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        row("disc-cutter")[1..],
        [
            "B' X Y Z C A",
            "linuxcnc",
            "built in",
            "six-axis, head-head: C carries A; table B is set between cuts; orthogonal"
        ]
    );
    let own = folder.path().join("vmc.toml");
    assert_eq!(row("vmc")[2..4], ["heidenhain", own.to_str().unwrap()]);
    assert!(row("broken")[4].starts_with("cannot be loaded: "));

    let missing = run(command().args(["machines", "--machines", "no-such"]), b"");
    refused(&missing, &["no-such: no such folder"]);
}

#[test]
fn the_file_of_a_machine_is_printed_and_posts_under_another_name() {
    let printed = run(command().args(["machines", "--print", "ac-trunnion"]), b"");
    assert_eq!(printed.code, 0, "{}", printed.err);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    std::fs::write(&path, &printed.out).unwrap();
    let mine = posted(&["-m", path.to_str().unwrap()], "");
    assert_eq!(mine.code, 0, "{}", mine.err);
    assert_eq!(mine.out, posted(&["-m", "ac-trunnion"], "").out);
    let slip = run(command().args(["machines", "--print", "ac-trunion"]), b"");
    refused(&slip, &["did you mean ac-trunnion?"]);
    // No other file is shown.
    let file = run(command().args(["machines", "--print", "/etc/passwd"]), b"");
    refused(&file, &["/etc/passwd names a file"]);
}

#[test]
fn a_misspelt_verb_is_told_and_no_file_is_looked_for() {
    for (slip, meant) in [("chek", "check"), ("plases", "place"), ("machnes", "machines")] {
        let done = run(command().args([slip, "vmc"]), b"");
        assert_eq!(done.code, 2, "{}", done.err);
        let told = format!("a similar verb exists: '{meant}'");
        assert!(done.err.contains(&told), "{}", done.err);
    }
    // A flag is no verb: what is wrong is said of what is wrong.
    let done = run(command().args(["--plugins", ".", "--plugin-seconds", "soon", "part.cls"]), b"");
    assert_eq!(done.code, 2, "{}", done.err);
    assert!(done.err.contains("--plugin-seconds"), "{}", done.err);
    assert!(!done.err.contains("there is no verb"), "{}", done.err);
}

#[test]
fn a_dialect_that_is_not_built_in_is_told_as_a_machine_file_is_begun() {
    let folder = tempfile::tempdir().unwrap();
    let mut new = command();
    new.current_dir(&folder);
    let flags = ["new", "mine", "--class", "three-axis", "--dialect", "fanuk"];
    let done = run(new.args(flags), b"");
    assert_eq!(done.code, 0, "{}", done.err);
    let told = "the dialect fanuk is not built in";
    assert!(done.err.contains(told), "{}", done.err);
    assert!(done.err.contains("did you mean `fanuc`?"), "{}", done.err);
}

#[test]
fn a_known_word_with_an_unknown_one_behind_it_is_not_taken_for_a_slip_of_itself() {
    let done = posted(&["-m", "vmc"], "COOLNT/FLOD\n");
    assert!(done.err.contains("COOLNT is not supported"), "{}", done.err);
    assert!(!done.err.contains("did you mean"), "{}", done.err);
}

#[test]
fn a_refused_tool_is_not_missed_too() {
    let done = posted(&["-m", "vmc", "--tool-from-cutter"], "");
    refused(&done, &["leave --tool-from-cutter out", "1 error;"]);
    let far = "UNITS/MM\nLOADTL/3,LENGTH,1e300\nSPINDL/RPM,3000,CLW\nFEDRAT/100,MMPM\nGOTO/0,0,10\nFINI\n";
    let done = run(command().args(["-q", "-m", "vmc", "-o", "-", "-"]), far.as_bytes());
    refused(&done, &["a tool of 1e300 mm", "1 error;"]);
}

/// Nothing else would judge them: no plugin is opened for them.
#[test]
fn options_of_plugins_that_are_not_used_are_looked_at_too() {
    let sets =
        ["control.fanucc.decimals=4", "control.heidenhain.perset=3", "accuracy.harmonic.ordre=3"];
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    let all: Vec<&str> = ["-m", "vmc"].into_iter().chain(sets).collect();
    let done = posted(&all, "");
    assert_eq!(done.code, 0, "{}", done.err);
    for part in [
        "[control.fanucc] has options for a dialect that is not here",
        "did you mean `fanuc`?",
        "heidenhain has no option `perset`",
        "did you mean `preset`?",
        "harmonic has no option `ordre`",
        "did you mean `order`?",
    ] {
        assert!(done.err.contains(part), "`{part}` is not in:\n{}", done.err);
    }
    let fine = ["-m", "vmc", "--set", "control.heidenhain.preset=3"];
    let fine = posted(&fine, "");
    assert!(!fine.err.contains("warning[plugin]"), "{}", fine.err);
}

/// A chain that is searched is not searched with a number that has no value.
#[test]
fn a_slip_in_a_formula_of_a_searched_chain_is_told_at_once() {
    for set in ["tool.gauge=[0, 0, \"q\"]", "axis.A.point=[\"q\", 0, 900]"] {
        let done = posted(&["-m", "vertical-lathe", "--set", set], "");
        refused(&done, &["`q` is not known", "1 error;"]);
        let check = ["check", "vertical-lathe", "--set", set];
        refused(&run(command().args(check), b""), &["`q` is not known"]);
    }
}

/// A name that is no Unicode is no verb, and nothing to stumble over.
#[cfg(unix)]
#[test]
fn a_first_word_that_is_no_unicode_is_a_wrong_command_line() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let done = run(command().arg(OsStr::from_bytes(b"\xFF.cls")), b"");
    assert_eq!(done.code, 2, "{}", done.err);
    assert!(done.err.contains("--machine"), "{}", done.err);
}

#[test]
fn verbs_that_are_those_of_papers_now_say_so() {
    for verb in ["study", "plan"] {
        let told = run(command().args([verb, "part.cls", "-m", "vmc"]), b"");
        assert_eq!((told.code, told.out.as_str()), (2, ""), "{}", told.err);
        assert!(
            told.err.contains(&format!("`post {verb}` is `papers {verb}` now")),
            "{}",
            told.err
        );
    }
}
