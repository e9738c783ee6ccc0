//! Several CL files as one program, and operations that are chosen of them.

use std::fs;
use std::path::Path;

use post_testkit::randomised;
use tempfile::TempDir;

use crate::common::{assert_contains, post_in, read_json, root};
use crate::job_file::{good, refused};

/// A mill in inches, its tool and offset left in force, cycle, compensation and feed modal.
const FIRST: &str = "UNITS/INCH\nLOADTL/1\nSPINDL/1000,RPM,CLW\nCOOLNT/MIST\nRAPID\nGOTO/1,1,2\nFEDRAT/10,IPM\nGOTO/1,1,1\nGOTO/2,1,1\nGOTO/2,1,2\nFINI\n";

/// Millimetres, another tool, no coolant, and a hole.
const SECOND: &str = "UNITS/MM\nLOADTL/2\nSPINDL/2000,RPM,CLW\nRAPID\nGOTO/10,10,50\nFEDRAT/100,MMPM\nGOTO/10,10,5\nGOTO/20,10,5\nGOTO/20,10,50\nFINI";

/// Two operations of NX with one tool, and a third with another.
const PATHS: &str = "TOOL PATH/ROUGH,TOOL,A\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/MMPM,100\nGOTO/0,0,1\nGOTO/9,0,1\nGOTO/9,0,50\nEND-OF-PATH\nTOOL PATH/FINISH,TOOL,A\nLOAD/TOOL,1\nSPINDL/RPM,1500,CLW\nRAPID\nGOTO/0,5,50\nFEDRAT/MMPM,200\nGOTO/0,5,0\nGOTO/9,5,0\nGOTO/9,5,50\nEND-OF-PATH\nTOOL PATH/DRILL,TOOL,B\nLOAD/TOOL,2\nSPINDL/RPM,800,CLW\nRAPID\nGOTO/3,3,50\nFEDRAT/MMPM,50\nGOTO/3,3,-5\nGOTO/3,3,50\nEND-OF-PATH\n";

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// Lines that move the tool over the part.
fn motions(folder: &Path, program: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(program)).unwrap();
    let moves = |line: &&str| line.contains(['X', 'Y', 'Z']) && !line.contains(['(', 'H']);
    text.lines().filter(moves).filter(|line| !line.contains("G53")).map(str::to_owned).collect()
}

#[test]
fn each_file_begins_as_a_file_of_its_own() {
    let folder = folder(&[("a.apt", FIRST), ("b.apt", SECOND)]);
    let folder = folder.path();
    let base = ["-m", "vmc", "--tool-length=100", "-q", "--verify"];
    let with = |more: &[&'static str]| [&base[..], more].concat();
    good(folder, &with(&["a.apt"]));
    good(folder, &with(&["b.apt", "--allow=FINI"]));
    good(folder, &with(&["a.apt", "--then=b.apt", "--allow=FINI", "-o", "ab.nc"]));
    let both = [motions(folder, "a.nc"), motions(folder, "b.nc")].concat();
    assert_eq!(motions(folder, "ab.nc"), both);
    assert!(both.len() >= 8, "{both:?}");
    let program = fs::read_to_string(folder.join("ab.nc")).unwrap();
    let at = program.find("(B.APT)").unwrap();
    let (first, second) = program.split_at(at);
    // The tool is off the part and all is off before the second, which says nothing of coolant.
    let leaves: Vec<&str> = first.lines().rev().take_while(|line| !line.contains('X')).collect();
    for word in ["M5", "M9", "G53 G0 Z20.000"] {
        assert!(leaves.contains(&word), "{word}: {leaves:?}");
    }
    assert!(first.contains("M7") && !second.contains("M7") && !second.contains("M8"), "{second}");
    assert!(second.contains("T2 M6"), "{second}");
    // A file behind another that has the same tool does not change it.
    good(folder, &with(&["a.apt", "--then=a.apt", "-o", "aa.nc"]));
    let twice = fs::read_to_string(folder.join("aa.nc")).unwrap();
    assert_eq!(twice.matches("M6").count(), 1, "{twice}");
    assert_eq!(twice.matches("S1000 M3").count(), 2, "{twice}");
    assert_eq!(twice.matches("M7").count(), 2, "{twice}");
}

#[test]
fn what_a_file_leaves_in_force_is_named_anew_or_refused() {
    let offset = FIRST.replace("LOADTL/1", "LOADTL/1\nSET/OFSETL,2");
    let tool = SECOND.replace("LOADTL/2\n", "");
    let empty = "UNITS/MM\nFINI\n";
    let far = SECOND.replace("GOTO/20,10,5\n", "GOTO/20000,10,5\n");
    let cut = SECOND.replace("\nFINI", "");
    let on = FIRST.replace("\nFINI", "$\n");
    let files = [
        ("offset.apt", offset.as_str()),
        ("tool.apt", &tool),
        ("empty.apt", empty),
        ("far.apt", &far),
        ("cut.apt", &cut),
        ("on.apt", &on),
        ("a.apt", FIRST),
        ("b.apt", SECOND),
    ];
    let folder = folder(&files);
    let folder = folder.path();
    for (first, then, parts) in [
        ("a.apt", "tool.apt", ["error[tool]", "tool 1 of the file before it", "tool.apt:4:1"]),
        ("offset.apt", "b.apt", ["error[work-offset]", "offset 2 of the file before", "b.apt:5:1"]),
        ("empty.apt", "b.apt", ["error[empty]", "no move", "empty.apt:2:1"]),
        ("a.apt", "empty.apt", ["error[empty]", "no move", "empty.apt:2:1"]),
        ("a.apt", "far.apt", ["error[over-travel]", "X would be", "far.apt:8:1"]),
        ("cut.apt", "a.apt", ["error[cut-off]", "ends within this line", "cut.apt:9"]),
        ("on.apt", "b.apt", ["error[cl-files]", "ends in a `$`", "on.apt"]),
    ] {
        let line = ["-m", "vmc", "--mount=0,0,0", "--tool-length=100", first, "--then", then];
        refused(folder, &[&line[..], &["-o", "x.nc"]].concat(), &parts);
        assert!(!folder.join("x.nc").exists());
    }
    let named = ["-m", "vmc", "--tool-length=100", "a.apt", "--then=tool.apt", "--allow=FINI"];
    let with = [&named[..], &["--tool=7", "-q", "-o", "x.nc"]].concat();
    // The first loads one itself, and --tool is for files that load none.
    refused(folder, &with, &["the file loads tool 1 itself"]);
    let standard = ["-m", "vmc", "-", "--then=b.apt"];
    refused(folder, &standard, &["more than once"]);
}

/// Whatever stands together is held together, and what is wrong is told of its own file.
#[test]
fn a_file_without_a_line_is_told_at_its_first() {
    let folder = folder(&[("empty.apt", ""), ("a.apt", FIRST)]);
    let arguments = ["-m", "vmc", "--tool-length=100", "empty.apt", "--then=a.apt", "--allow=FINI"];
    refused(folder.path(), &arguments, &["empty.apt:1"]);
}

#[test]
fn every_verb_takes_the_files_of_a_job() {
    let samples = ["blade.cls", "facets.apt", "s-piece.cls", "lever.apt", "disc-blade.cls"];
    let (rounds, mut rng) = randomised(9, 29_016);
    for _ in rounds {
        let count = 2 + rng.pick(2);
        let cl: Vec<&str> = (0..count).map(|_| samples[rng.pick(3)]).collect();
        let machine = ["ac-trunnion", "head-head", "bc-trunnion"][rng.pick(3)];
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        for name in samples {
            fs::copy(root().join("tests/samples").join(name), folder.join(name)).unwrap();
        }
        let job = format!(
            "machine = \"{machine}\"\ncl = {cl:?}\noutput = \"p.nc\"\nmount = [0, 0, 20]\n\
             tool_length = 120\nsummary = \"p.json\"\n"
        );
        fs::write(folder.join("p.job.toml"), &job).unwrap();
        let made = post_in(folder, &["p.job.toml", "-q"]);
        if made.code != 0 {
            // What does not fit a machine does not fit it alone either.
            let alone = |name: &&str| {
                let line = ["-m", machine, name, "--mount=0,0,20", "--tool-length=120", "-q"];
                post_in(folder, &[&line[..], &["-o", "one.nc"]].concat()).code != 0
            };
            assert!(cl.iter().any(alone), "{job}{}", made.err);
            continue;
        }
        good(folder, &["predict", "p.nc", "-q"]);
        good(folder, &["diff", "p.nc", "p.job.toml"]);
        good(folder, &["words", "p.job.toml"]);
        let verified = post_in(folder, &["verify", "p.nc", "-q"]);
        // Samples that lie over one another may be touched by a rapid.
        assert!(verified.code == 0 || verified.err.contains("[rapid]"), "{job}{}", verified.err);
        assert!(!verified.err.contains("[deviation]") && !verified.err.contains("[missing]"));
        let summary = read_json(&folder.join("p.json"));
        let files = summary["cl_files"].as_array().unwrap();
        assert_eq!(files.len(), count);
        // A file more is missing in the program, and the message names it.
        let then = ["verify", "p.nc", "-m", "p.job.toml", "--then=disc-blade.cls", "-q"];
        let missing = post_in(folder, &then);
        assert_eq!(missing.code, 1, "{job}");
        assert_contains(&missing.err, &["disc-blade.cls"]);
    }
}

#[test]
fn chosen_operations_become_the_program() {
    let folder = folder(&[("p.cls", PATHS)]);
    let folder = folder.path();
    let base = ["-m", "vmc", "--tool-length=100", "p.cls", "--summary=s.json"];
    let chosen = |more: &[&'static str]| {
        let line = [&base[..], &["--verify", "-q", "-o", "x.nc"], more].concat();
        good(folder, &line);
        fs::read_to_string(folder.join("x.nc")).unwrap()
    };
    let text = chosen(&["--operations=ROUGH", "--operations=3"]);
    assert_contains(
        &text,
        &["(WITHOUT OPERATIONS 2 FINISH)", "(ROUGH)", "(DRILL)", "T2 M6", "S800"],
    );
    assert!(!text.contains("(FINISH)") && !text.contains("Y5.") && !text.contains("S1500"));
    assert_eq!(read_json(&folder.join("s.json"))["left_out"][0], "2 FINISH");
    // The state of an operation that is left out holds: its tool, and its own speed not.
    let text = chosen(&["--operations", "FINISH"]);
    assert_contains(&text, &["T1 M6", "S1500 M3"]);
    assert!(!text.contains("S1000"), "{text}");
    // All of them is the whole file.
    let all = chosen(&["--operations=1", "--operations=2", "--operations=DRILL"]);
    assert_eq!(all, chosen(&[]));
    assert!(read_json(&folder.join("s.json")).get("left_out").is_none());
    // A program of some is not one of others.
    chosen(&["--operations=FINISH"]);
    let verify = ["verify", "x.nc", "-m", "vmc", "--tool-length=100", "--against=p.cls", "-q"];
    good(folder, &[&verify[..], &["--operations=2"]].concat());
    let other = [&verify[..], &["--operations=2", "--operations=3"]].concat();
    refused(folder, &other, &["[missing]", "not"]);
    refused(folder, &verify, &["[missing]"]);
    let unknown = [&base[..], &["--operations=4", "-o", "y.nc"]].concat();
    refused(folder, &unknown, &["no operation 4", "1 ROUGH, 2 FINISH, 3 DRILL"]);
    // A batch makes the same of them, of files that are joined too.
    let batch = ["batch", "-m", "vmc", "--tool-length=100", "-q", "-o"];
    let moves = |name: &str, more: &[&str]| {
        good(folder, &[&batch[..], &[name], more].concat());
        let table = fs::read_to_string(folder.join(name)).unwrap();
        let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let head = lines.next().unwrap();
        let place = head.iter().position(|column| *column == "moves").unwrap();
        lines.map(|row| row[place].parse::<u32>().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(moves("b.csv", &["p.cls"]), [11]);
    assert_eq!(moves("one.csv", &["p.cls", "--operations=1"]), [4]);
    let jobs = "{\"file\": \"p.cls\", \"machine\": \"vmc\", \"then\": [\"p.cls\"], \"operations\": [\"DRILL\", \"1\"]}\n";
    fs::write(folder.join("jobs.jsonl"), jobs).unwrap();
    assert_eq!(moves("both.csv", &["jobs.jsonl"]), [10]);
}

/// A cut from the end of an operation that is left out would be a rapid into it.
#[test]
fn a_cut_begins_in_the_program_or_is_refused() {
    let joined = PATHS.replace("RAPID\nGOTO/0,5,50\nFEDRAT/MMPM,200\nGOTO/0,5,0\n", "GOTO/0,5,0\n");
    let folder = folder(&[("p.cls", joined.as_str())]);
    let base = ["-m", "vmc", "--tool-length=100", "p.cls", "-q", "-o", "x.nc"];
    good(folder.path(), &[&base[..], &["--operations=1", "--operations=2"]].concat());
    let alone = [&base[..], &["--operations=2"]].concat();
    refused(folder.path(), &alone, &["error[operation]", "p.cls:14:1", "the operation before it"]);
}

/// The sheet of a program is of what the program has: its files, and of these the operations that are chosen.
#[test]
fn the_setup_sheet_is_that_of_the_program() {
    let folder =
        folder(&[("paths.cls", PATHS), ("more.cls", &PATHS.replace("LOAD/TOOL,1", "LOAD/TOOL,3"))]);
    let folder = folder.path();
    let base = ["-m", "vmc", "--tool-length=100", "-q", "--setup-sheet=part.md", "-o", "part.nc"];
    let job = ["paths.cls", "--then=more.cls", "--operations=FINISH"];
    good(folder, &[&base[..], &job].concat());
    let sheet = fs::read_to_string(folder.join("part.md")).unwrap();
    assert_contains(
        &sheet,
        &["# Setup: paths.cls, more.cls", "WITHOUT OPERATIONS 1 ROUGH", "Y 5.000 to 5.000"],
    );
    for strange in ["| ROUGH", "| DRILL", "| T2", "For the operator"] {
        assert!(!sheet.contains(strange), "{strange}: {sheet}");
    }
    assert_eq!(sheet.matches("| FINISH |").count(), 2, "{sheet}");
    let clocks = |title: &str| {
        let line = sheet.lines().find(|line| line.contains(title)).unwrap();
        line.split('|').rev().map(str::trim).find(|cell| cell.ends_with(" s")).unwrap().to_owned()
    };
    let program = sheet.lines().find(|line| line.starts_with("| part.nc |")).unwrap();
    assert!(program.contains(&clocks("Time without tool changes")), "{sheet}");
}

/// Files that are joined, and operations that are chosen of them, become programs of their own.
#[test]
fn joined_files_and_chosen_operations_are_split() {
    let folder = folder(&[
        ("paths.cls", PATHS),
        ("b.apt", &FIRST.replace("UNITS/INCH\n", "UNITS/INCH\nTOOL PATH/LAST,TOOL,X\n")),
    ]);
    let folder = folder.path();
    let base =
        ["-m", "vmc", "--tool-length=100", "-q", "--verify", "--allow=FINI", "-o", "part.nc"];
    let job = ["paths.cls", "--then=b.apt", "--split=operations"];
    good(folder, &[&base[..], &job].concat());
    let named = |name: &str, number: u32| {
        let program = fs::read_to_string(folder.join(format!("part-{number}.nc"))).unwrap();
        assert!(program.contains(&format!("({name})")), "{name} in\n{program}");
        program
    };
    for (name, number) in [("ROUGH", 1), ("FINISH", 2), ("DRILL", 3)] {
        named(name, number);
    }
    // The units at the head of the second file are those of its first operation.
    assert!(named("LAST", 4).contains("X50.800"));
    assert!(!named("DRILL", 3).contains("LAST"));
    for number in 1..=4 {
        fs::remove_file(folder.join(format!("part-{number}.nc"))).unwrap();
    }
    good(folder, &[&base[..], &job, &["--operations=DRILL", "--operations=LAST"]].concat());
    named("DRILL", 1);
    named("LAST", 2);
    assert!(!folder.join("part-3.nc").exists());
}

/// An upright tool leaves the table free: a further file has it where it would have it alone.
#[test]
fn an_upright_file_has_its_table_as_it_begins_alone() {
    let tilted = "UNITS/MM\nMULTAX\nLOADTL/1\nSPINDL/1000,RPM,CLW\nRAPID\nGOTO/0,0,50,0.5,0,0.8660254\nFEDRAT/100,MMPM\nGOTO/0,0,30,0.5,0,0.8660254\nGOTO/9,0,30,0.5,0,0.8660254\nGOTO/9,0,50,0.5,0,0.8660254\n";
    let folder = folder(&[("tilted.apt", tilted), ("b.apt", SECOND)]);
    let folder = folder.path();
    let base = [
        "-m",
        "ac-trunnion",
        "--tool-length=100",
        "-q",
        "--verify",
        "--allow=FINI",
        "-o",
        "part.nc",
    ];
    good(folder, &[&base[..], &["b.apt"]].concat());
    let words = |text: &str| {
        let line = text.lines().rfind(|line| line.contains(" C") && line.contains('A'));
        line.map(str::to_owned).unwrap_or_else(|| panic!("{text}"))
    };
    let alone = words(&fs::read_to_string(folder.join("part.nc")).unwrap());
    good(folder, &[&base[..], &["tilted.apt", "--then=b.apt"]].concat());
    let joined = fs::read_to_string(folder.join("part.nc")).unwrap();
    assert_eq!(words(&joined), alone, "{joined}");
    assert!(joined.contains("C90.000") || joined.contains("C270.000"), "{joined}");
}
