//! `post predict` and `post --predict`: what is told, in which form, and what is refused.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{assert_contains, names, post, post_text, read_json, root};

const FIVE: &[&str] = &["-m", "ac-trunnion", "--tcp", "control", "--tool-length", "100"];
const S_PIECE: &str = "tests/samples/s-piece.cls";
const PLATE: &str = "tests/samples/plate.ncl";

/// A folder with the program of a sample.
fn posted(sample: &str, machine: &[&str]) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("part.nc");
    let program = program.to_str().unwrap().to_owned();
    let run = post(&[machine, &["-q", sample, "-o", &program]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    (folder, program)
}

fn plate() -> (tempfile::TempDir, String) {
    posted(PLATE, &["-m", "vmc", "--tool-length", "80"])
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

/// Every key of the JSON, each with the key that it stands under.
fn keys(value: &Value, all: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                all.push(key.clone());
                keys(value, all);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| keys(value, all)),
        _ => {}
    }
}

#[test]
fn every_key_of_the_summary_is_explained_and_the_table_says_the_same() {
    let (folder, program) = posted(S_PIECE, FIVE);
    let summary = folder.path().join("summary.json");
    let more = ["--against", S_PIECE, "--summary", summary.to_str().unwrap()];
    let run = post(&[&["predict", &program], FIVE, &more].concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let found = read_json(&summary);
    let page = text(&root().join("docs/src/nc-programmer/predict.md"));
    let section = page.split("\n## ").next().unwrap();
    let mut all = Vec::new();
    keys(&found, &mut all);
    for key in &all {
        let explained = ["`", "."].map(|before| section.contains(&format!("{before}{key}`")));
        assert!(explained.contains(&true), "{key} is not explained");
    }
    let number = |path: &str| found.pointer(path).unwrap().as_f64().unwrap();
    // The parts of the time are all of it, by limit and by kind.
    let cycle = number("/time/cycle_s");
    let kinds = ["cutting_s", "rapid_s", "waiting_s"].map(|key| number(&format!("/time/{key}")));
    assert!((kinds.iter().sum::<f64>() - cycle).abs() < 1e-6, "{kinds:?} {cycle}");
    let limits = found["time"]["limits"].as_array().unwrap();
    let of = |key: &str| -> f64 { limits.iter().map(|row| row[key].as_f64().unwrap()).sum() };
    assert!((of("seconds") - cycle).abs() < 1e-6 && (of("share") - 1.0).abs() < 1e-9);
    let operations = found["time"]["operations"].as_array().unwrap();
    let cutting: f64 = operations.iter().map(|row| row["cutting_s"].as_f64().unwrap()).sum();
    assert!((cutting - kinds[0]).abs() < 1e-6);
    // A set-point a period, from beginning to end.
    let set_points = number("/set_points") * number("/period_s");
    assert!((set_points - cycle).abs() < 0.01, "{set_points} {cycle}");
    // What is in the JSON is in the table.
    let tip = &found["contour"]["tip_mm"];
    assert_contains(
        &run.out,
        &[
            &format!("at most {:.2} µm", 1e3 * tip["largest"].as_f64().unwrap()),
            &format!("CL line {}", tip["cl_line"]),
            "following",
            "interpolation",
            "limited by",
            &format!("against {S_PIECE}"),
        ],
    );
    let sizes: Vec<f64> = found["contour"]["parts"]
        .as_array()
        .unwrap()
        .iter()
        .map(|part| part["tip_mm"]["largest"].as_f64().unwrap())
        .collect();
    assert_eq!(sizes.len(), 3);
    assert!(tip["largest"].as_f64().unwrap() <= sizes.iter().sum::<f64>() + 1e-6);
    for key in ["p50", "p95", "p99"] {
        assert!(tip[key].as_f64().unwrap() <= tip["largest"].as_f64().unwrap());
    }
}

#[test]
fn posting_predicts_what_predicting_the_program_does() {
    let (folder, program) = posted(S_PIECE, FIVE);
    let [alone, while_posting, summary] =
        ["alone.json", "posting.json", "summary.json"].map(|name| folder.path().join(name));
    let more = ["-q", "--against", S_PIECE, "--summary", alone.to_str().unwrap()];
    let run = post(&[&["predict", &program], FIVE, &more].concat());
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
    let flag = format!("--predict={}", while_posting.display());
    let more = [S_PIECE, "-o", &program, &flag, "--summary", summary.to_str().unwrap()];
    let run = post(&[FIVE, &more].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(&run.out, &["tip deviation", "cycle time", "contour error"]);
    assert_eq!(read_json(&alone), read_json(&while_posting));
    assert_eq!(read_json(&summary)["prediction"], read_json(&alone));
}

#[test]
fn of_several_programs_each_is_predicted() {
    let folder = tempfile::tempdir().unwrap();
    let [program, found] = ["part.nc", "found.json"].map(|name| folder.path().join(name));
    let flag = format!("--predict={}", found.display());
    let run = post(&[
        "-q",
        "-m",
        "vmc",
        "--tool-length",
        "80",
        PLATE,
        "--split",
        "tools",
        "-o",
        program.to_str().unwrap(),
        &flag,
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let found = read_json(&found);
    let programs = found.as_array().unwrap();
    assert_eq!(programs.len(), 2);
    for found in programs {
        assert!(found["time"]["cutting_s"].as_f64().unwrap() > 1.0);
        // Each is held against its own part of the CL file.
        assert!(found["contour"]["tip_mm"]["largest"].as_f64().unwrap() < 0.005, "{found}");
    }
}

#[test]
fn without_servos_times_are_told_and_what_is_assumed() {
    let (_folder, program) = plate();
    let run = post(&["predict", &program, "-m", "vmc", "--tool-length", "80"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert_contains(
        &run.out,
        &[
            "cycle time",
            "cuts: ",
            "T5",
            "T7",
            "no axis has a [servo]: all are where they are commanded",
        ],
    );
}

#[test]
fn an_axis_without_limits_is_told_with_its_key() {
    let (folder, program) = plate();
    let machine = text(&root().join("machines/vmc.toml"));
    let machine: String = machine
        .lines()
        .filter(|line| !line.starts_with("max_accel"))
        .map(|line| format!("{line}\n"))
        .collect();
    let file = folder.path().join("mill.toml");
    fs::write(&file, machine).unwrap();
    let file = file.to_str().unwrap();
    let run = post(&["predict", &program, "-m", file, "--tool-length", "80"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_contains(
        &run.err,
        &[
            "warning[motion-limits]: axes X, Y, Z have no max_accel: they are at their velocity at once",
            "max_accel of [axis.X] in the machine file",
        ],
    );
}

#[test]
fn set_points_are_rows_of_one_period() {
    let (folder, program) = plate();
    let [csv, summary] = ["rows.csv", "found.json"].map(|name| folder.path().join(name));
    let run = post(&[
        "predict",
        &program,
        "-m",
        "vmc",
        "--tool-length",
        "80",
        "--period",
        "0.004",
        "--csv",
        csv.to_str().unwrap(),
        "--summary",
        summary.to_str().unwrap(),
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let rows = text(&csv);
    let mut rows = rows.lines();
    let head: Vec<&str> = rows.next().unwrap().split(',').collect();
    assert_eq!(
        head[..10],
        ["time", "line", "cl_line", "cuts", "X", "Y", "Z", "X_actual", "Y_actual", "Z_actual"]
    );
    let mut count = 0_u64;
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        assert_eq!(fields.len(), head.len());
        let time: f64 = fields[0].parse().unwrap();
        assert!((time - 0.004 * count as f64).abs() < 1e-9, "{row}");
        // Without a servo the axes are where they are commanded.
        assert_eq!(fields[4..7], fields[7..10], "{row}");
        count += 1;
    }
    assert_eq!(read_json(&summary)["set_points"], count);
}

#[test]
fn pictures_have_axes_with_units_and_nothing_old_stays_beside_them() {
    let (folder, program) = posted(S_PIECE, FIVE);
    let pictures = folder.path().join("prediction");
    let shown = pictures.to_str().unwrap();
    let run = post(&[&["predict", &program], FIVE, &["-q", "--pictures", shown]].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(
        names(&pictures),
        [
            "axis-errors.svg",
            "contour-vectors.svg",
            "contour.svg",
            "feed.svg",
            "path.svg",
            "prediction.json",
            "spectrum.svg"
        ]
    );
    for (name, parts) in [
        ("axis-errors.svg", ["time, s", ">X, µm<", ">C, 0.001°<"]),
        ("feed.svg", ["time, s", "mm/min", "programmed"]),
        ("contour.svg", ["way of the tip in cuts, mm", "tip, µm", "tool axis, 0.001°"]),
        ("contour-vectors.svg", ["µm of error", "commanded path", ">X, mm<"]),
        ("path.svg", ["and more", "ring: the largest", ">Y, mm<"]),
        ("spectrum.svg", ["frequency, Hz", ">Z, µm<", ">A, 0.001°<"]),
    ] {
        let picture = text(&pictures.join(name));
        assert_contains(&picture, &parts);
        assert!(picture.starts_with("<svg") && picture.ends_with("</svg>\n"));
        assert!(!picture.contains("NaN") && !picture.contains("inf"), "{name}");
        // They do not grow with the program: 35,000 set-points would take megabytes.
        assert!(picture.len() < 400_000, "{name}: {} bytes", picture.len());
    }
    // A machine without servos has no errors of axes to show.
    let (_folder, program) = plate();
    let run =
        post(&["predict", &program, "-q", "-m", "vmc", "--tool-length", "80", "--pictures", shown]);
    assert_eq!(run.code, 0, "{}", run.err);
    let left = names(&pictures);
    assert!(!left.contains(&"axis-errors.svg".to_owned()), "{left:?}");
    assert!(!left.contains(&"spectrum.svg".to_owned()), "{left:?}");
}

#[test]
fn a_folder_with_pictures_of_others_is_left_alone() {
    let (folder, program) = plate();
    let pictures = folder.path().join("prediction");
    fs::create_dir(&pictures).unwrap();
    fs::write(pictures.join("feed.svg"), "mine").unwrap();
    let shown = pictures.to_str().unwrap();
    let run = post(&["predict", &program, "-m", "vmc", "--pictures", shown]);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["the prediction would overwrite", "feed.svg", "--pictures"]);
    assert_eq!(text(&pictures.join("feed.svg")), "mine");
    let run = post(&["predict", &program, "-m", "vmc", "--pictures", "-"]);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["standard output is no folder"]);
}

#[test]
fn what_cannot_be_read_is_refused_by_its_line_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("part.nc");
    fs::write(&program, "G21 G90\nG1 X10. F500.\nG1 X[#1 Y20.\nG1 X0.\n").unwrap();
    let summary = folder.path().join("found.json");
    let run = post(&[
        "predict",
        program.to_str().unwrap(),
        "-m",
        "vmc",
        "--summary",
        summary.to_str().unwrap(),
    ]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert_contains(&run.err, &["part.nc:3", "nothing was written"]);
    assert!(!summary.exists());
}

#[test]
fn a_cl_file_with_faults_is_refused_before_the_program_is_gone_along() {
    let (folder, program) = plate();
    let file = folder.path().join("part.cls");
    fs::write(&file, "UNITS/MM\nGOTO/1,2\nFINI\n").unwrap();
    let run = post(&["predict", &program, "-m", "vmc", "--against", file.to_str().unwrap()]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert_contains(&run.err, &["part.cls:2"]);
}

#[test]
fn both_from_standard_input_is_refused_and_an_unknown_flag_is_a_wrong_command_line() {
    let run = post(&["predict", "-", "-m", "vmc", "--against", "-"]);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["program and CL file cannot both be standard input"]);
    assert_eq!(post(&["predict", "x.nc", "-m", "vmc", "--period", "0"]).code, 2);
}

#[test]
fn a_program_that_swaps_heads_is_refused_at_that_line() {
    let run = post(&[
        "-q",
        "-m",
        "head-change",
        "--tool-length",
        "100",
        "-o",
        "-",
        "tests/machines/head-change.ncl",
        "--predict",
    ]);
    assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
    assert_contains(&run.err, &["error[head]", "is swapped in: other axes move from here on"]);
}

#[test]
fn a_program_that_does_not_move_takes_no_time() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("still.nc");
    fs::write(&program, "G21 G90\nM30\n").unwrap();
    let run = post(&["predict", program.to_str().unwrap(), "-m", "vmc"]);
    assert_eq!(run.code, 0);
    assert_contains(&run.err, &["warning[no-motion]: nothing moves in this program", "still.nc"]);
    assert_contains(&run.out, &["cycle time       0.0 s"]);
    // And posting may come from a pipe.
    let run =
        post_text(&["-q", "-m", "vmc", "--predict", "--tool-length", "80"], crate::common::GOOD);
    assert_eq!(run.code, 1, "the tool cannot be tilted there");
}
