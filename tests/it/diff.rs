//! `post diff`: programs that do the same, and programs changed by hand in one thing each.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{Run, command, run, sample};

/// A program of a sample, in a folder of its own.
struct Bench {
    folder: tempfile::TempDir,
    machine: &'static str,
    program: String,
}

impl Bench {
    fn new(machine: &'static str, file: &str, with: &[&str]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let posted = post(machine, file, with);
        assert_eq!(posted.code, 0, "{}", posted.err);
        Self { folder, machine, program: posted.out }
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.folder.path().join(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// The program against what `changed` makes of it.
    fn against(&self, changed: &str, with: &[&str]) -> (i32, Value, String) {
        let old = self.write("old.nc", &self.program);
        let new = self.write("new.nc", changed);
        self.compared(&old, &new, with)
    }

    fn compared(&self, old: &Path, new: &Path, with: &[&str]) -> (i32, Value, String) {
        let json = self.folder.path().join("diff.json");
        let run = run(
            command()
                .args(["diff", "-m", self.machine, "--tool-length", "100", "--json"])
                .args([&json, old, new])
                .args(with),
            b"",
        );
        let text = fs::read_to_string(&json).unwrap_or_else(|_| panic!("{}", run.err));
        (run.code, serde_json::from_str(&text).unwrap(), run.out)
    }
}

fn post(machine: &str, file: &str, with: &[&str]) -> Run {
    run(
        command()
            .args(["-q", "-m", machine, "-o", "-", "--tool-length", "100"])
            .args(with)
            .arg(sample(file)),
        b"",
    )
}

/// Operations that differ, by place.
fn different(found: &Value) -> Vec<usize> {
    let operations = found["operations"].as_array().unwrap();
    let places = operations.iter().enumerate();
    let places = places.filter(|(_, operation)| operation["same"] == false);
    places.map(|(place, _)| place).collect()
}

#[test]
fn what_makes_no_difference_is_none() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    // Other numbers of blocks, no remarks, modal words again and again, more digits.
    let (mut motion, mut cycle) = (String::new(), false);
    let lines = bench.program.lines().filter(|line| !line.starts_with('('));
    let plain: Vec<String> = lines
        .enumerate()
        .map(|(index, line)| {
            for word in line.split(' ') {
                match word {
                    "G0" | "G1" | "G2" | "G3" => (motion, cycle) = (format!("{word} "), false),
                    "G80" => cycle = false,
                    "G81" | "G82" | "G83" | "G84" | "G85" | "G73" => cycle = true,
                    _ => {}
                }
            }
            let again = match line.starts_with(['X', 'Y', 'Z']) && !cycle {
                true => motion.as_str(),
                false => "",
            };
            match line.starts_with(['%', 'O']) {
                true => line.to_owned(),
                false => format!("N{} {again}{}", 5 * index, line.replace(".000", ".0000")),
            }
        })
        .collect();
    let (code, found, text) = bench.against(&(plain.join("\n") + "\n"), &[]);
    assert_eq!((code, &found["same"]), (0, &Value::Bool(true)), "{text}");
    assert!(text.ends_with("Both programs make the machine do the same.\n"), "{text}");
    assert_eq!(different(&found), [] as [usize; 0]);
}

#[test]
fn a_change_is_told_with_its_place_and_nothing_else() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    let swap = |from: &str, to: &str| {
        assert!(bench.program.contains(from), "{from}");
        bench.program.replacen(from, to, 1)
    };
    // A helix that goes 0.3 mm deeper.
    let (code, found, text) = bench.against(&swap("Z-4.000 I", "Z-4.300 I"), &[]);
    assert_eq!((code, different(&found)), (1, vec![0]), "{text}");
    let tip = found["operations"][0]["tip"]["value"].as_f64().unwrap();
    assert!((tip - 0.3).abs() < 1e-3, "{tip}");
    // The same within a tolerance of its own.
    let (code, ..) = bench.against(&swap("Z-4.000 I", "Z-4.300 I"), &["--tolerance", "0.4"]);
    assert_eq!(code, 0);
    let (_, found, text) = bench.against(&swap("F900.", "F450."), &[]);
    assert_eq!(different(&found), [0], "{text}");
    let feed = &found["operations"][0]["feed"];
    assert_eq!(feed["feeds"], serde_json::json!([900.0, 450.0]), "{text}");
    let (_, found, text) = bench.against(&swap("S2500", "S2400"), &[]);
    assert_eq!(different(&found), [1], "{text}");
    let state = &found["operations"][1]["states"][0];
    assert_eq!(state["what"], "spindle");
    assert_eq!(state["values"], serde_json::json!(["clockwise 2500", "clockwise 2400"]));
    let (_, found, text) = bench.against(&swap("P200", "P500"), &[]);
    assert_eq!(different(&found), [1], "{text}");
    let event = &found["operations"][1]["events"][0];
    assert_eq!(event["events"], serde_json::json!(["a wait of 0.2 s", "a wait of 0.5 s"]));
    let (_, found, text) = bench.against(&swap("M1\n", ""), &[]);
    assert_eq!(different(&found), [0], "{text}");
    let (_, found, text) = bench.against(&swap("M8\n", ""), &[]);
    assert_eq!(found["operations"][0]["states"][0]["what"], "coolant", "{text}");
    let (code, ..) = bench.against(&swap("M8\n", ""), &["--ignore", "coolant"]);
    assert_eq!(code, 0);
    let (code, ..) = bench.against(&swap("M8\n", ""), &["--ignore", "tools"]);
    assert_eq!(code, 1);
    let (_, found, text) = bench.against(&swap("G2 X20.000 Y-10.000 I-10.000 J0.000\n", ""), &[]);
    assert_eq!(different(&found), [0], "{text}");
    assert_eq!(found["operations"][0]["other_ways"].as_array().unwrap().len(), 1, "{text}");
    let again = "G2 X20.000 Y-10.000 I-10.000 J0.000\n";
    let loops = format!("{again}G3 X30.000 Y0.000 I0.000 J10.000\n{again}");
    let (_, found, text) = bench.against(&swap(again, &loops), &[]);
    let added = found["operations"][0]["added"].as_array().unwrap();
    assert_eq!(added.len(), 1, "{text}");
    let cut = added[0]["cut_mm"].as_f64().unwrap();
    assert!((cut - 10.0 * std::f64::consts::PI).abs() < 0.2, "{cut}");
}

/// With `--cuts` retracts at another height, a stop less and a wait do not drown what is cut otherwise; they are counted.
#[test]
fn cuts_alone_are_told_where_that_is_asked_for() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    let higher = bench.program.replace("G0 Z20.000\nX", "G0 Z75.000\nX").replace("M1\n", "");
    assert_ne!(higher, bench.program);
    let (code, found, text) = bench.against(&higher, &[]);
    assert_eq!((code, &found["beside_cuts"]), (1, &Value::from(0)), "{text}");
    let (code, found, text) = bench.against(&higher, &["--cuts"]);
    assert_eq!((code, different(&found)), (0, vec![]), "{text}");
    let beside = found["beside_cuts"].as_u64().unwrap();
    assert!(beside >= 2, "{text}");
    assert!(text.contains("Both programs make the same cuts."), "{text}");
    let told = format!("{beside} differences beside the cuts (rapids, waits, stops, tool changes)");
    assert!(text.contains(&told), "{text}");
    let deeper = higher.replacen("Z-4.000 I", "Z-4.300 I", 1);
    for (changed, more) in
        [(&deeper, beside), (&bench.program.replacen("Z-4.000 I", "Z-4.300 I", 1), 0)]
    {
        let (code, found, text) = bench.against(changed, &["--cuts"]);
        assert_eq!((code, different(&found)), (1, vec![0]), "{text}");
        let operation = &found["operations"][0];
        let tip = operation["tip"]["value"].as_f64().unwrap();
        assert!((tip - 0.3).abs() < 1e-3, "{tip}\n{text}");
        for other in ["left_out", "added", "other_ways", "events"] {
            assert_eq!(operation[other], serde_json::json!([]), "{other}\n{text}");
        }
        assert_eq!(found["beside_cuts"], more, "{text}");
    }
    // A cut that one program alone makes is told, and so is one that became a rapid.
    let arc = "G2 X20.000 Y-10.000 I-10.000 J0.000\n";
    for changed in
        [higher.replacen(arc, "", 1), higher.replacen("G1 Z-2.000 F600.", "G0 Z-2.000", 1)]
    {
        let (code, found, text) = bench.against(&changed, &["--cuts"]);
        assert_eq!((code, different(&found)), (1, vec![0]), "{text}");
    }
}

#[test]
fn an_operation_more_leaves_the_others_alone() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    let last = bench.program.find("T4 M6").unwrap();
    let without = format!("{}M30\n%\n", &bench.program[..last]);
    let (code, found, text) = bench.against(&without, &[]);
    assert_eq!((code, different(&found)), (1, vec![3]), "{text}");
    assert_eq!(found["operations"][3]["sides"][1], Value::Null);
    assert!(text.contains("left out"), "{text}");
    assert!(text.contains("1 of 4 operations is different."), "{text}");
}

#[test]
fn who_keeps_the_tip_and_where_blocks_end_make_no_difference_to_the_part() {
    let bench = Bench::new("ac-trunnion", "blade.cls", &["--tcp", "post"]);
    let control = post("ac-trunnion", "blade.cls", &["--tcp", "control"]);
    let (_, found, text) = bench.against(&control.out, &[]);
    // Both are within 5 µm of the CL file.
    for operation in found["operations"].as_array().unwrap() {
        let tip = &operation["tip"];
        assert!(tip["value"].as_f64().unwrap() < 0.5, "{text}");
    }
    let rough =
        post("ac-trunnion", "blade.cls", &["--tcp", "post", "--set", "accuracy.tolerance=0.05"]);
    let (code, found, text) = bench.against(
        &rough.out,
        &["--tolerance", "0.06", "--axis-tolerance", "0.2", "--feed-tolerance", "0.5"],
    );
    assert_eq!((code, different(&found)), (0, vec![]), "{text}");
}

#[test]
fn two_machines_are_compared_in_what_the_part_sees() {
    let bench = Bench::new("ac-trunnion", "facets.apt", &["--tcp", "control"]);
    let other = post("dmu50", "facets.apt", &["--tcp", "control"]);
    assert_eq!(other.code, 0, "{}", other.err);
    let (_, found, text) = bench.against(&other.out, &["--machine-new", "dmu50"]);
    for operation in found["operations"].as_array().unwrap() {
        let feeds = &operation["feed"]["worst"]["value"];
        assert!(feeds.as_f64().unwrap() <= 0.001, "{text}");
        assert_eq!(operation["left_out"].as_array().unwrap().len(), 0, "{text}");
    }
}

#[test]
fn one_part_in_every_dialect_is_one_motion() {
    // With planes the ways between operations are those of the control.
    let job = ["--tcp", "control", "--set", "control.planes=false", "--dialect"];
    let with = |dialect| [&job[..], &[dialect]].concat();
    let bench = Bench::new("ac-trunnion", "facets.apt", &with("fanuc"));
    for dialect in ["heidenhain", "linuxcnc", "mazak", "mitsubishi", "siemens"] {
        let other = post("ac-trunnion", "facets.apt", &with(dialect));
        assert_eq!(other.code, 0, "{}", other.err);
        let words = ["--dialect", "fanuc", "--dialect-new", dialect];
        let (code, found, text) = bench.against(&other.out, &words);
        assert_eq!((code, different(&found)), (0, vec![]), "{dialect}:\n{text}");
    }
}

#[test]
fn a_refused_program_is_no_difference() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    let old = bench.write("old.nc", &bench.program);
    let new = bench.write("new.nc", &bench.program.replace("G54\n", "G54\nG65 P9000\n"));
    let run = run(command().args(["diff", "-m", "vmc"]).args([&old, &new]), b"");
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    assert!(run.err.contains("new.nc"), "{}", run.err);
}

#[test]
fn standard_input_is_one_of_them() {
    let bench = Bench::new("vmc", "flange.ncl", &[]);
    let old = bench.write("old.nc", &bench.program);
    let run = run(
        command().args(["diff", "-m", "vmc", "--tool-length", "100"]).arg(&old).arg("-"),
        bench.program.as_bytes(),
    );
    assert_eq!(run.code, 0, "{}{}", run.err, run.out);
}

#[test]
fn standard_input_is_not_both_of_them() {
    let run = run(command().args(["diff", "-m", "vmc", "-", "-"]), b"");
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    assert!(run.err.contains("the two programs cannot both be standard input"), "{}", run.err);
}
