//! Every program of these tests, read back and held against its CL file in the run that makes it.

use crate::common::{CASES, check_numbers, post, root};
use crate::library::LIBRARY;

use std::fs;

use serde_json::Value;

#[test]
fn every_sample_on_every_machine_does_what_its_cl_file_asks_for() {
    for case in CASES {
        let (run, summary) = case.post(&["--verify"]);
        check_numbers(&run.out);
        let found = &summary["verification"];
        assert_eq!(found["faults"], Value::Array(Vec::new()), "{}", case.name());
        let value = |of: &Value, key: &str| of[key]["value"].as_f64().unwrap();
        // Two ways to the same number: what is found is no more than what was certified, but for the pieces that curves
        // are cut into.
        let certified = value(&summary, "tip_deviation_mm");
        let slack = summary["tolerance_mm"].as_f64().unwrap() / 16.0;
        assert!(
            value(found, "tip") <= certified + slack,
            "{}: {found}, certified {certified}",
            case.name()
        );
    }
}

#[test]
fn every_machine_of_the_library_does_what_its_cl_file_asks_for() {
    let mut failed = Vec::new();
    for row in LIBRARY {
        let length = row.length.to_string();
        let file = format!("tests/machines/{}.{}", row.machine, row.ending);
        let run = post(&[
            "-q",
            "--verify",
            "-m",
            row.machine,
            "--tool-length",
            &length,
            "-o",
            "-",
            &file,
        ]);
        if run.code != 0 {
            failed.push(format!("{}:\n{}", row.machine, run.err));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

const PLATE: &str = "tests/samples/plate.ncl";

/// A folder with the plate's program.
fn plate() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("plate.nc");
    let program = program.to_str().unwrap().to_owned();
    let run = post(&["-q", "-m", "vmc", "--tool-length", "80", "-o", &program, PLATE]);
    assert_eq!(run.code, 0, "{}", run.err);
    (folder, program)
}

fn verify(program: &str, more: &[&str]) -> crate::common::Run {
    let arguments = ["verify", program, "-m", "vmc", "--against", PLATE];
    post(&[&arguments[..], more].concat())
}

#[test]
fn the_verb_tells_what_it_finds_and_where() {
    let (folder, program) = plate();
    let length = ["--tool-length", "80"];
    let good = verify(&program, &length);
    assert_eq!((good.code, good.err.as_str()), (0, ""), "{}", good.out);
    assert!(good.out.contains("10 cuts, 36 rapids, 4 holes"), "{}", good.out);
    assert!(good.out.contains("faults           none"), "{}", good.out);
    let text = fs::read_to_string(&program).unwrap();
    let bad = folder.path().join("bad.nc");
    let bad_name = bad.to_str().unwrap();
    fs::write(&bad, text.replace("G1 Z-6.350", "G1 Z-6.250")).unwrap();
    let json = folder.path().join("found.json");
    let json = json.to_str().unwrap();
    let found = verify(bad_name, &[&length[..], &["--summary", json]].concat());
    assert_eq!(found.code, 1);
    assert!(found.err.contains("error[deviation]"), "{}", found.err);
    assert!(found.err.contains("bad.nc:18:1"), "{}", found.err);
    assert!(found.err.contains("plate.ncl, line 20"), "{}", found.err);
    let summary: Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    assert_eq!(summary["faults"][0]["code"], "deviation");
    assert_eq!(summary["faults"][0]["nc_line"], 18);
    // Within a wider tolerance it is good.
    let wide = verify(bad_name, &[&length[..], &["--tolerance", "0.2"]].concat());
    assert_eq!(wide.code, 0, "{}", wide.err);
}

#[test]
fn an_axis_that_was_not_moved_stands_within_its_travel() {
    // Homed at its upper ends, as many routers are: the drawing's zero is beyond them.
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let mut machine = vec!["-m", "vmc", "--mount=-400,-400,0", "--tool-length", "80", "-q"];
    machine.extend(["--set", "axis.X.travel=[-800,-2]", "--set", "axis.Y.travel=[-800,-2]"]);
    let [good, bad] = [at("good.nc"), at("bad.nc")];
    let made = post(&[&machine[..], &["-o", &good, PLATE]].concat());
    assert_eq!(made.code, 0, "{}", made.err);
    let held =
        |program: &str| post(&[&["verify", program, "--against", PLATE], &machine[..]].concat());
    let found = held(&good);
    assert_eq!(found.code, 0, "{}", found.err);
    // Where it is sent beyond them it is told, there alone.
    let text = fs::read_to_string(&good).unwrap().replace("M30\n", "G53 G0 Y0.\nM30\n");
    fs::write(&bad, text).unwrap();
    let found = held(&bad).err;
    let told = "Y would be at 0.000 mm, its travel ends at -2.000 mm\n";
    assert!(found.contains("error[over-travel]") && found.contains(told), "{found}");
}

#[test]
fn the_summary_says_whether_it_holds_and_why_not() {
    let (folder, program) = plate();
    let json = folder.path().join("found.json");
    let summary = |against: &str| -> (i32, Value) {
        let more = ["--tool-length", "80", "-q", "--summary", json.to_str().unwrap()];
        let line = ["verify", &program, "-m", "vmc", "--against", against];
        let run = post(&[&line[..], &more].concat());
        (run.code, serde_json::from_str(&fs::read_to_string(&json).unwrap()).unwrap())
    };
    let (code, good) = summary(PLATE);
    assert_eq!((code, &good["holds"], &good["refused"]), (0, &true.into(), &Value::Array(vec![])));
    // The path is as asked: what is wrong is a line of the CL file.
    let bad = folder.path().join("bad.ncl");
    let text = fs::read_to_string(root().join(PLATE)).unwrap();
    let line = text.lines().position(|line| line.starts_with("FINI")).unwrap() as u64 + 1;
    fs::write(&bad, text.replace("FINI", "QUUX/1,2\nFINI")).unwrap();
    let (code, told) = summary(bad.to_str().unwrap());
    assert_eq!((code, &told["holds"], &told["faults"]), (1, &false.into(), &Value::Array(vec![])));
    let [why] = &told["refused"].as_array().unwrap()[..] else { panic!("{told}") };
    assert!(why["message"].as_str().unwrap().contains("QUUX"), "{why}");
    assert_eq!((&why["file"], &why["line"]), (&bad.to_str().into(), &line.into()));
}

#[test]
fn coolants_of_ones_own_need_not_be_compared() {
    let (folder, program) = plate();
    let text = fs::read_to_string(&program).unwrap();
    let own = folder.path().join("own.nc");
    let own_name = own.to_str().unwrap();
    fs::write(&own, text.replace("\nM8\n", "\n")).unwrap();
    let length = ["--tool-length", "80"];
    let found = verify(own_name, &length);
    assert_eq!(found.code, 1);
    assert!(found.err.contains("error[coolant]"), "{}", found.err);
    let ignored = verify(own_name, &[&length[..], &["--ignore", "coolant"]].concat());
    assert_eq!((ignored.code, ignored.err.as_str()), (0, ""), "{}", ignored.out);
}

#[test]
fn the_length_of_the_tool_is_held_against_that_of_the_tables() {
    let (folder, program) = plate();
    let tables = folder.path().join("tables.toml");
    fs::write(&tables, "[length]\n5 = 100\n7 = 80\n").unwrap();
    let tables = ["--offsets", tables.to_str().unwrap()];
    assert_eq!(verify(&program, &tables).code, 0);
    let told = verify(&program, &[&tables[..], &["--tool-length", "80"]].concat());
    assert_eq!(told.code, 1);
    assert!(told.err.contains("error[length]"), "{}", told.err);
}

#[test]
fn the_map_leads_from_the_program_to_the_cl_file() {
    let (folder, program) = plate();
    let map = folder.path().join("map.json");
    let map_name = map.to_str().unwrap();
    let length = ["--tool-length", "80", "--map", map_name];
    assert_eq!(verify(&program, &length).code, 0);
    let first = fs::read_to_string(&map).unwrap();
    let rows: Vec<Value> = serde_json::from_str(&first).unwrap();
    let row = |line: u64| rows.iter().find(|row| row["nc_line"] == line).unwrap();
    assert_eq!((&row(19)["cl_line"], &row(19)["kind"]), (&24.into(), &"cut".into()));
    assert_eq!((&row(40)["cl_line"], &row(40)["kind"]), (&53.into(), &"hole".into()));
    assert_eq!(verify(&program, &length).code, 0);
    assert_eq!(fs::read_to_string(&map).unwrap(), first);
}

/// Tables of work offsets alone say nothing of lengths.
#[test]
fn the_length_that_is_told_holds_beside_tables_without_it() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("blade.nc");
    let tables = folder.path().join("tables.toml");
    fs::write(&tables, "[work.G54]\nX = 0\nY = 0\nZ = 0\n").unwrap();
    let [program, tables] = [&program, &tables].map(|path| path.to_str().unwrap());
    let blade = "tests/samples/blade.cls";
    let job = ["-m", "head-head", "--tool-length"];
    let posted = post(&[&["-q"], &job[..], &["100", "-o", program, blade]].concat());
    assert_eq!(posted.code, 0, "{}", posted.err);
    let verify = ["verify", program, "--against", blade, "--offsets", tables];
    let verify = |length: &str| post(&[&verify[..], &job[..], &[length]].concat());
    let good = verify("100");
    assert_eq!(good.code, 0, "{}", good.err);
    assert!(!good.err.contains("nc-length"), "{}", good.err);
    let bad = verify("100.5");
    assert_eq!(bad.code, 1, "{}", bad.out);
    assert!(bad.err.contains("error[deviation]"), "{}", bad.err);
}

#[test]
fn a_wrong_length_in_the_tables_shows_where_the_head_turns() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("blade.nc");
    let program = program.to_str().unwrap();
    let blade = "tests/samples/blade.cls";
    let machine = ["-m", "head-head"];
    let posted =
        post(&[&["-q", "--tool-length", "100", "-o", program, blade], &machine[..]].concat());
    assert_eq!(posted.code, 0, "{}", posted.err);
    let offsets = folder.path().join("offsets.toml");
    let verify = |length: &str| {
        fs::write(
            &offsets,
            format!(
                "[length]\n1 = {length}\n2 = {length}\n3 = {length}\n4 = {length}\n5 = {length}\n"
            ),
        )
        .unwrap();
        let offsets = offsets.to_str().unwrap();
        post(
            &[&["verify", program, "--against", blade, "--offsets", offsets], &machine[..]]
                .concat(),
        )
    };
    let good = verify("100.0");
    assert_eq!(good.code, 0, "{}", good.err);
    let bad = verify("100.5");
    assert_eq!(bad.code, 1);
    assert!(bad.err.contains("error[deviation]"), "{}", bad.err);
}

#[test]
fn what_is_split_is_verified_part_by_part() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("plate.nc");
    let program = program.to_str().unwrap();
    let run = post(&[
        "-q",
        "--verify",
        "-m",
        "vmc",
        "--tool-length",
        "80",
        "--split",
        "tools",
        "-o",
        program,
        PLATE,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let count = fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(count, 2);
}
