//! `post new`: files that the loader and the check accept, from flags and from answers.

use crate::common;

use std::fs;
use std::path::Path;

use common::{Run, command, read_json, run};
use tempfile::TempDir;

const CLASSES: &[&str] = &[
    "three-axis",
    "four-axis-a",
    "four-axis-b",
    "table-table-ac",
    "table-table-bc",
    "table-table-nutating",
    "head-head-ac",
    "head-head-bc",
    "head-table-bc",
    "head-table-ba",
    "nutating-head",
    "lathe-xzc",
    "mill-turn",
    "lathe-xz",
    "tangential-knife",
    "robot",
    "robot-on-rail",
    "scara",
    "linear-delta",
    "hexapod",
    "tricept",
    "exechon",
];

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

fn post_in(folder: &Path, arguments: &[&str], answers: &str) -> Run {
    run(command().current_dir(folder).args(arguments), answers.as_bytes())
}

/// A small job that every class can make: the tool upright.
const JOB: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/20,5,10\nEND\nFINI\n";

/// What a lathe can make that turns.
const TURNED: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/30,0,50\nFEDRAT/0.2,MMPR\nGOTO/30,0,10\nGOTO/40,0,5\nEND\nFINI\n";

/// Lengths in metres, as DH tables have them, are no arm of a fraction of a millimetre.
#[test]
fn lengths_of_an_arm_in_metres_are_refused() {
    let folder = folder();
    let new = ["new", "arm", "--class", "robot", "--arm"];
    let told = |arm: &str| post_in(folder.path(), &[&new[..], &[arm]].concat(), "");
    let metres = told("0.15,-0.115,0,0.445,0.7,0.795,0.085");
    assert_eq!(metres.code, 2);
    let said = "here they are in millimetres, 150,-115,0,445,700,795,85";
    assert!(metres.err.contains(said), "{}", metres.err);
    assert!(!folder.path().join("arm.toml").exists());
    assert_eq!(told("150,-115,0,445,700,795,85").code, 0);
    let text = fs::read_to_string(folder.path().join("arm.toml")).unwrap();
    let beside = text.lines().filter(|line| line.contains('#') && !line.starts_with('#'));
    beside.for_each(|line| assert!(line.contains(" # "), "{line}"));
}

#[test]
fn every_class_passes_the_check_and_makes_a_program() {
    let help = post_in(folder().path(), &["new", "--help"], "").out;
    for class in CLASSES {
        assert!(help.contains(&format!("{class}:")), "{class} is not in:\n{help}");
        let folder = folder();
        let new = post_in(folder.path(), &["new", "mill", "--class", class], "");
        assert_eq!((new.code, new.err.as_str()), (0, ""), "{class}");
        let check = post_in(folder.path(), &["check", "mill.toml"], "");
        assert_eq!((check.code, check.err.as_str()), (0, ""), "{class}");
        assert!(check.out.contains("warnings          none"), "{}", check.out);
        let kind = class.replace("lathe-xzc", "rotary table C");
        let kind = kind.replace("lathe-xz", "two-axis").replace("tangential-knife", "head C");
        let kind =
            kind.replace("robot-on-rail", "rotary axes at once").replace("hexapod", "leg J5");
        let kind = kind.replace("tricept", "L3").replace("exechon", "qC");
        let kind = kind.replace("scara", "A carries B");
        let kind = kind.replace("four-axis-a", "rotary table A");
        let kind = kind.replace("four-axis-b", "rotary table B");
        let kind =
            kind.replace("nutating-head", "nutating").replace("table-table-nutating", "nutating");
        let kind = kind.replace("mill-turn", "head-table");
        let kind = kind.replace("robot", "six-axis");
        let kind = kind.replace("linear-delta", "leg J2");
        let kind = ["-ac", "-bc", "-ba"].iter().fold(kind, |kind, end| kind.replace(end, ""));
        assert!(check.out.contains(&kind), "{kind} is not in:\n{}", check.out);
        let job = if *class == "lathe-xz" { TURNED } else { JOB };
        fs::write(folder.path().join("part.cls"), job).unwrap();
        let posted = post_in(
            folder.path(),
            &["-q", "--verify", "-m", "mill.toml", "--tool-length", "80", "part.cls", "-o", "-"],
            "",
        );
        assert_eq!(posted.code, 0, "{class}: {}", posted.err);
    }
    assert_eq!(help.matches("    - ").count(), CLASSES.len(), "{help}");
}

/// On a lathe X of the program is a diameter: to a radius of sqrt(20² + 5²) mm.
#[test]
fn a_lathe_is_posted_in_diameters() {
    let folder = folder();
    let new = post_in(folder.path(), &["new", "lathe", "--class", "lathe-xzc"], "");
    assert_eq!(new.code, 0, "{}", new.err);
    fs::write(folder.path().join("part.cls"), JOB).unwrap();
    let posted = post_in(
        folder.path(),
        &["-q", "-m", "lathe.toml", "--tool-length", "80", "part.cls", "-o", "-"],
        "",
    );
    assert_eq!(posted.code, 0, "{}", posted.err);
    assert!(posted.out.contains("C14.036") && posted.out.contains("X41.231"), "{}", posted.out);
    let radii = post_in(folder.path(), &["check", "lathe.toml", "--set", "word.X.is=X"], "");
    assert!(radii.out.contains("\nX                 words are radii"), "{}", radii.out);
    let diameters = post_in(folder.path(), &["check", "lathe.toml"], "");
    assert!(!diameters.out.contains("words are radii"), "{}", diameters.out);
    // A table in the middle of a mill is no work spindle.
    let mill = post_in(folder.path(), &["check", "head-table-bc"], "");
    assert!(!mill.out.contains("words are radii"), "{}", mill.out);
}

#[test]
fn flags_say_everything() {
    let folder = folder();
    let new = post_in(
        folder.path(),
        &[
            "new",
            "mill",
            "--class",
            "table-table-ac",
            "--dialect",
            "linuxcnc",
            "--tcp",
            "control",
            "--units",
            "inch",
            "--title",
            "My \"mill\"",
            "--travel",
            "X=-200:210.5",
            "--travel",
            "a=-95:20",
            "--travel",
            "C=-360:360",
            "--reversed",
            "C",
            "--max-feed",
            "C=1200",
            "--point",
            "A=0,0.02,-35.5",
            "--gauge",
            "420",
            "--tolerance",
            "0.01",
        ],
        "",
    );
    assert_eq!(new.code, 0, "{}", new.err);
    let text = fs::read_to_string(folder.path().join("mill.toml")).unwrap();
    for line in [
        "name  = \"My \\\"mill\\\"\"",
        "travel   = [-200, 210.5]",
        "travel   = [-95, 20]",
        "travel   = [-360, 360]",
        "reversed = true",
        "max_feed = 1200",
        "point    = [0, 0.02, -35.5]",
        "dialect = \"linuxcnc\"",
        "tcp     = \"control\"",
        "units   = \"inch\"",
        "tolerance = 0.01",
    ] {
        assert!(text.contains(line), "{line} is not in:\n{text}");
    }
    // The point of A is said: no height of it is left over that nothing uses.
    assert!(!text.contains("tilt"), "{text}");
    let check = post_in(folder.path(), &["check", "mill.toml", "--json", "c.json"], "");
    assert_eq!(check.code, 0, "{}", check.err);
    let check = read_json(&folder.path().join("c.json"));
    assert_eq!(check["machine"], "My \"mill\"");
    assert_eq!(check["volume"]["most"][2], 420.0);
    // Reversed: C plus turns the tool the other way.
    assert_eq!(check["signs"][0]["tool"], "goes round from +X to -Y");
}

#[test]
fn answers_through_a_pipe_write_the_same_as_flags() {
    let folder = folder();
    let asked = post_in(
        folder.path(),
        &["new", "asked"],
        "nonsense\nhead-head-ac\nheidenhain\ncontrol\n600\n312.4\n-900:900\n\n\n-360:360\n-100:100\n",
    );
    assert_eq!(asked.code, 0, "{}", asked.err);
    assert!(asked.err.contains("head-table-bc"), "{}", asked.err);
    let told = post_in(
        folder.path(),
        &[
            "new",
            "told",
            "--title",
            "asked",
            "--class",
            "head-head-ac",
            "--dialect",
            "heidenhain",
            "--tcp",
            "control",
            "--gauge",
            "600",
            "--pivot",
            "312.4",
            "--travel",
            "X=-900:900",
            "--travel",
            "A=-100:100",
        ],
        "",
    );
    assert_eq!(told.code, 0, "{}", told.err);
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(text("asked.toml"), text("told.toml"));
}

#[test]
fn empty_answers_take_the_defaults_and_a_silent_pipe_is_refused() {
    let folder = folder();
    let asked = post_in(folder.path(), &["new", "asked"], "table-table-bc\n");
    assert_eq!(asked.code, 0, "{}", asked.err);
    let silent = post_in(folder.path(), &["new", "silent"], "");
    assert_eq!(silent.code, 1);
    assert!(silent.err.contains("--class"), "{}", silent.err);
    assert!(!folder.path().join("silent.toml").exists());
}

#[test]
fn a_file_that_is_there_stays() {
    let folder = folder();
    let path = folder.path().join("mill.toml");
    fs::write(&path, "mine").unwrap();
    let refused = post_in(folder.path(), &["new", "mill", "--class", "three-axis"], "");
    assert_eq!(refused.code, 1);
    assert!(refused.err.contains("--force"), "{}", refused.err);
    assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
    let forced =
        post_in(folder.path(), &["new", "mill.toml", "--class", "three-axis", "--force"], "");
    assert_eq!(forced.code, 0, "{}", forced.err);
    assert!(fs::read_to_string(&path).unwrap().contains("[w Y' X' b Z (S) t]"));
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = folder();
    for (arguments, code, message) in [
        (vec!["--class", "three-axis", "--travel", "A=-10:10"], 1, "has no such axis"),
        (vec!["--class", "three-axis", "--travel", "X=10:-10"], 2, "the first must be the smaller"),
        (vec!["--class", "three-axis", "--travel", "X=10"], 2, "is no travel"),
        (vec!["--class", "table-table-ac", "--max-feed", "C=0"], 2, "not above zero"),
        (
            vec!["--class", "table-table-ac", "--travel", "C=0:90", "--cyclic", "C"],
            1,
            "which of the two",
        ),
        (vec!["--class", "three-axis", "--dialect", "a\"b"], 2, "letters and digits"),
        (vec!["--class", "octopod"], 2, "possible values"),
    ] {
        let mut all = vec!["new", "mill"];
        all.extend(&arguments);
        let refused = post_in(folder.path(), &all, "");
        assert_eq!(refused.code, code, "{arguments:?}: {}", refused.err);
        assert!(refused.err.contains(message), "{arguments:?}: {}", refused.err);
    }
    let nowhere = post_in(folder.path(), &["new", "no/such/mill", "--class", "three-axis"], "");
    assert_eq!(nowhere.code, 1);
    assert!(nowhere.err.contains("there is no folder"), "{}", nowhere.err);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A flag that nothing in the file stands on is refused for its class, and names the classes it is for; where it is
/// taken, it changes the file.
#[test]
fn flags_are_used_or_refused_in_every_class() {
    for (flag, value) in [("--pivot", "312.5"), ("--tilt", "-35.25"), ("--tcp", "control")] {
        let mut taken = Vec::new();
        let mut refusals = Vec::new();
        for class in CLASSES {
            let folder = folder();
            let arguments = ["new", "mill", "--class", class];
            let plain = post_in(folder.path(), &arguments, "");
            assert_eq!(plain.code, 0, "{class}: {}", plain.err);
            let path = folder.path().join("mill.toml");
            let before = fs::read_to_string(&path).unwrap();
            fs::remove_file(&path).unwrap();
            // What a class has anyway changes nothing.
            let kept =
                ["mill-turn", "hexapod", "tricept", "exechon"].contains(class) && flag == "--tcp";
            let value = if kept { "post" } else { value };
            let mut all = arguments.to_vec();
            all.extend([flag, value]);
            let run = post_in(folder.path(), &all, "");
            match fs::read_to_string(&path) {
                Ok(after) => {
                    assert_eq!(run.code, 0, "{class} {flag}: {}", run.err);
                    assert!(after != before && after.contains(value), "{class} {flag}");
                    taken.push(*class);
                }
                Err(_) => {
                    assert_eq!(run.code, 1, "{class} {flag}");
                    let said = format!("{flag}: {class} has no ");
                    assert!(run.err.contains(&said), "{}", run.err);
                    refusals.push(run.err);
                }
            }
        }
        assert!(!taken.is_empty() && !refusals.is_empty(), "{flag}");
        for refusal in refusals {
            let listed = refusal.split("it is for ").nth(1).unwrap();
            let listed: Vec<&str> = listed.lines().next().unwrap().split(", ").collect();
            assert_eq!(listed, taken, "{flag}");
        }
    }
    let folder = folder();
    // Two ways to say one thing.
    let both = ["new", "mill", "--class", "head-head-ac", "--pivot", "1", "--point", "A=0,0,9"];
    let run = post_in(folder.path(), &both, "");
    assert_eq!(run.code, 1);
    let said = "--pivot and --point A both say where the line of A runs";
    assert!(run.err.contains(said), "{}", run.err);
    // Asked for on a terminal the class is known only later.
    let run = post_in(folder.path(), &["new", "mill", "--pivot", "1"], "three-axis\n");
    assert_eq!(run.code, 1);
    assert!(run.err.contains("--pivot: three-axis has no swivel head"), "{}", run.err);
}

/// What the check would refuse is not written: each dialect gets what it must be told of its control.
#[test]
fn every_dialect_passes_the_check() {
    for dialect in crate::dialects::dialects() {
        for class in ["three-axis", "table-table-ac"] {
            for units in ["mm", "inch"] {
                // Firmware of printers counts in mm, and says so.
                if units == "inch" && matches!(&*dialect, "klipper" | "marlin" | "rrf") {
                    continue;
                }
                let folder = folder();
                let new =
                    ["new", "mill", "--class", class, "--dialect", &dialect, "--units", units];
                let new = post_in(folder.path(), &new, "");
                assert_eq!((new.code, new.err.as_str()), (0, ""), "{dialect} {class} {units}");
                let check = post_in(folder.path(), &["check", "mill.toml"], "");
                assert_eq!((check.code, check.err.as_str()), (0, ""), "{dialect} {class} {units}");
            }
        }
    }
}

/// A class whose law stands in formulas takes what the flags say into the library's file.
#[test]
fn a_class_of_the_library_takes_what_flags_say() {
    let folder = folder();
    let new =
        ["new", "ours", "--class", "tricept", "--dialect", "siemens", "--travel", "X=-500:510"];
    let more =
        ["--max-feed", "A=5000", "--reversed", "C", "--tolerance", "0.03", "--title", "Ours"];
    let run = post_in(folder.path(), &[&new[..], &more].concat(), "");
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let text = fs::read_to_string(folder.path().join("ours.toml")).unwrap();
    for line in [
        "name  = \"Ours\"",
        "dialect = \"siemens\"",
        "travel   = [-500, 510]",
        "max_feed = 5000",
        "reversed = true",
        "tolerance = 0.03",
    ] {
        assert!(text.lines().any(|own| own == line), "{line}:\n{text}");
    }
    assert_eq!(text.matches("[-500, 510]").count(), 1, "{text}");
    let gauge = post_in(folder.path(), &["new", "other", "--class", "exechon", "--gauge", "3"], "");
    assert!(gauge.code == 1 && gauge.err.contains("exechon has no gauge line"), "{}", gauge.err);
}
