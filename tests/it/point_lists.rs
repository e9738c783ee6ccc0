//! Lists of points, CSV and JSON, wherever a CL file is taken: the same programs, and faults by line and column.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::{assert_contains, post_in};
use crate::job_file::good;

/// A path in three forms: a rapid, cuts with two feeds and tool axes, and a rapid out.
const CL: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,6000,CLW\nCOOLNT/FLOOD\nRAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/800,PERMIN\n\
                  GOTO/0,0,0,0,0,1\nGOTO/10,0,0,0.1,0,1\nFEDRAT/600,PERMIN\nGOTO/20,5,-1,0.2,0.1,1\nRAPID\n\
                  GOTO/20,5,30,0,0,1\nFINI\n";
const CSV: &str = "tool,1\nspindle,6000\ncoolant,flood\nx,y,z,i,j,k,feed,rapid\n0,0,20,0,0,1,,1\n0,0,0,0,0,1,800,\n\
                   10,0,0,0.1,0,1,,\n20,5,-1,0.2,0.1,1,600,\n20,5,30,0,0,1,,1\n";
const JSON: &str = "{\"tool\": 1, \"spindle\": 6000, \"coolant\": \"flood\", \"points\": [[0, 0, 20, 0, 0, 1],\n\
                    {\"to\": [0, 0, 0], \"tool_axis\": [0, 0, 1], \"feed\": 800}, [10, 0, 0, 0.1, 0, 1],\n\
                    {\"to\": [20, 5, -1], \"tool_axis\": [0.2, 0.1, 1], \"feed\": 600},\n\
                    {\"x\": 20, \"y\": 5, \"z\": 30, \"i\": 0, \"j\": 0, \"k\": 1, \"rapid\": true}]}";

const BASE: [&str; 4] = ["-m", "xyzac-trt", "--tool-length=50", "-q"];

fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("path.cls", CL), ("path.csv", CSV), ("path.json", JSON)] {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn text(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn a_list_is_posted_as_its_cl_file() {
    let folder = folder();
    let folder = folder.path();
    let programs = ["cls", "csv", "json"].map(|form| {
        let (list, program) = (format!("path.{form}"), format!("{form}.ngc"));
        good(folder, &[&BASE[..], &["--verify", &list, "-o", &program]].concat());
        for against in ["path.cls", "path.csv", "path.json"] {
            let all =
                ["verify", &program, "-m", "xyzac-trt", "--tool-length=50", "--against", against];
            good(folder, &all);
        }
        // Its name stands in the first line.
        text(folder, &program).lines().skip(1).map(str::to_owned).collect::<Vec<_>>()
    });
    assert_eq!(programs[0], programs[1]);
    assert_eq!(programs[0], programs[2]);
    // Another path is another program, and is told.
    fs::write(folder.join("other.csv"), CSV.replace("10,0,0,", "10,0.1,0,")).unwrap();
    let all =
        ["verify", "csv.ngc", "-m", "xyzac-trt", "--tool-length=50", "--against", "other.csv"];
    let held = post_in(folder, &all);
    assert_eq!(held.code, 1, "{}{}", held.out, held.err);
}

#[test]
fn a_list_stands_wherever_a_cl_file_does() {
    let folder = folder();
    let folder = folder.path();
    let standard = [&BASE[..], &["path.cls", "--then=path.csv", "-o", "cl.ngc"]].concat();
    good(folder, &[&standard[..], &["--verify"]].concat());
    good(
        folder,
        &[&BASE[..], &["path.csv", "--then=path.json", "-o", "lists.ngc", "--verify"]].concat(),
    );
    let moves = |name: &str| {
        let text = text(folder, name);
        text.lines().filter(|line| !line.starts_with('(')).map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(moves("cl.ngc"), moves("lists.ngc"));
    let job = "machine = \"xyzac-trt\"\ncl = \"path.csv\"\noutput = \"job.ngc\"\ntool_length = 50\nverify = true\n";
    fs::write(folder.join("part.job.toml"), job).unwrap();
    good(folder, &["part.job.toml", "-q"]);
    good(folder, &[&BASE[..], &["path.csv", "-o", "csv.ngc"]].concat());
    let body = |name: &str| {
        moves(name).into_iter().filter(|line| line.contains(['X', 'Z'])).collect::<Vec<_>>()
    };
    assert_eq!(body("job.ngc"), body("csv.ngc"));
    good(folder, &["place", "path.json", "-m", "xyzac-trt", "--tool-length=50"]);
    assert_contains(&post_in(folder, &["words", "path.json"]).out, &["GOTO"]);
}

/// What is found while posting names the list's own line and text.
#[test]
fn faults_name_line_and_column_of_the_list() {
    let folder = folder();
    let folder = folder.path();
    fs::write(folder.join("far.csv"), CSV.replace("10,0,0,0.1", "10,9000,0,0.1")).unwrap();
    let far = post_in(folder, &[&BASE[..], &["far.csv"]].concat());
    assert_eq!(far.code, 1, "{}", far.err);
    assert_contains(&far.err, &["far.csv:7"]);
    assert_contains(&far.err, &["10,9000,0,0.1,0,1,,"]);
    fs::write(folder.join("nan.csv"), CSV.replace("20,5,-1", "20,nan,-1")).unwrap();
    let nan = post_in(folder, &[&BASE[..], &["nan.csv"]].concat());
    assert_eq!(nan.code, 1, "{}", nan.err);
    assert_contains(&nan.err, &["nan.csv:8:4"]);
    assert!(!folder.join("nan.ngc").exists() && !nan.err.contains("FINI"), "{}", nan.err);
}

/// An arc of a list stays an arc; and the word of an extruder goes with its way, in points that are put in as well.
#[test]
fn arcs_and_an_extruder() {
    let folder = folder();
    let folder = folder.path();
    let mut list =
        "x,y,z,feed,arc_x,arc_y,arc_z,arc_i,arc_j,arc_k\n0,0,5,,,,,,,\n0,0,0,600,,,,,,\n"
            .to_owned();
    list += "10,10,0,,0,10,0,0,0,1\n0,0,0,,0,10,0,0,0,-1\n0,0,5,,,,,,,\n";
    fs::write(folder.join("arc.csv"), &list).unwrap();
    let machine = "extends = \"vmc\"\nname = \"printer\"\n[word.U]\nis = \"0.1 * s\"\n";
    fs::write(folder.join("printer.toml"), machine).unwrap();
    let all = [
        "-m",
        "printer.toml",
        "--tool-length=0",
        "--tool=1",
        "--spindle=1000",
        "-q",
        "--verify",
        "arc.csv",
    ];
    good(folder, &all);
    let program = text(folder, "arc.nc");
    assert_contains(&program, &["G3 X10.000 Y10.000"]);
    assert_contains(&program, &["G2 X0.000 Y0.000"]);
    // 5 mm down, two quarters of 10 mm, 5 mm up.
    let pushed = program
        .lines()
        .rev()
        .find_map(|line| line.split_whitespace().find_map(|word| word.strip_prefix('U')));
    let way = 5.0 + std::f64::consts::PI * 10.0 + 5.0;
    let pushed: f64 = pushed.unwrap().parse().unwrap();
    assert!((pushed - 0.1 * way).abs() < 2e-3, "{pushed} {way}\n{program}");
}

/// A long list of CSV takes no more memory than a short one.
#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_grow_with_a_list() {
    use crate::common::{command_as, run};
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut list = "tool,1\nspindle,6000\nfeed,800\nx,y,z\n".to_owned();
    for point in 0..400_000 {
        let _ = writeln!(
            list,
            "{}.12345678901234,{}.12345678901234,{}.1234567890123",
            point % 50,
            point % 49,
            point % 3
        );
    }
    assert!(list.len() > 18_000_000);
    fs::write(folder.join("long.csv"), &list).unwrap();
    let mut shell = command_as("sh");
    shell
        .args(["-c", "ulimit -v 220000 && exec \"$@\"", "sh", env!("CARGO_BIN_EXE_post")])
        .args(["-m", "vmc", "--tool-length=100", "-q", "-o", "/dev/null"])
        .arg(folder.join("long.csv"));
    let done = run(&mut shell, b"");
    assert_eq!(done.code, 0, "{}", done.err);
}
