//! The summary of a program, as JSON.

use crate::common;

use std::fs;

use common::{assert_contains, check_numbers, post, post_in, read_json, root, with_file};
use serde_json::Value;

const BLADE: &str = "tests/samples/blade.cls";

#[test]
fn the_summary_holds_what_is_documented_and_agrees_with_the_program() {
    for (machine, with) in [
        ("ac-trunnion", &["--tool-length", "80"][..]),
        ("dmu50", &["--tool-length", "80"]),
        ("disc-cutter", &["--tool-length", "80"]),
        ("nutating-head", &["--tcp", "post", "--tool-length", "80"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let (program, json) = (folder.path().join("p.nc"), folder.path().join("s.json"));
        let mut arguments = vec!["-m", machine, BLADE, "-o", program.to_str().unwrap()];
        arguments.extend(["--summary", json.to_str().unwrap()]);
        arguments.extend(with);
        let done = post(&arguments);
        assert_eq!((done.code, done.err.as_str()), (0, ""));
        let text = fs::read_to_string(&program).unwrap();
        check_numbers(&text);
        check_summary(&read_json(&json), &text, machine);
    }
}

/// Every key of the JSON stands in the book's page about it; predictions and plans have pages of their own.
#[test]
fn every_key_is_in_the_book() {
    let folder = tempfile::tempdir().unwrap();
    let (program, json) = (folder.path().join("p.nc"), folder.path().join("s.json"));
    let mut arguments = vec!["-m", "ac-trunnion", BLADE, "--tool-length", "80", "--verify"];
    arguments.extend(["--set", "accuracy.servo_compensation=0.003", "--compensate-servo"]);
    arguments.extend(["-o", program.to_str().unwrap(), "--summary", json.to_str().unwrap()]);
    let done = post(&arguments);
    assert_eq!(done.code, 0, "{}", done.err);
    let mut summary = read_json(&json);
    let object = summary.as_object_mut().unwrap();
    for key in ["verification", "servo_compensation"] {
        assert!(object[key].is_object(), "{key}");
    }
    object.remove("prediction");
    let page = fs::read_to_string(root().join("docs/src/reference/summary.md")).unwrap();
    let mut keys = Vec::new();
    keys_of(&summary, &mut keys);
    assert!(keys.len() > 60, "{keys:?}");
    for key in keys {
        assert!(page.contains(&format!("`{key}`")), "{key}");
    }
}

fn keys_of(value: &Value, keys: &mut Vec<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                keys.push(key.clone());
                keys_of(value, keys);
            }
        }
        Value::Array(values) => values.iter().for_each(|value| keys_of(value, keys)),
        _ => {}
    }
}

fn check_summary(summary: &Value, program: &str, machine: &str) {
    let keys: Vec<&str> = summary.as_object().unwrap().keys().map(String::as_str).collect();
    for key in [
        "machine",
        "dialect",
        "tcp",
        "model",
        "records",
        "moves",
        "blocks",
        "nc_lines",
        "points_added",
        "program",
        "model_asked",
        "model_overruled",
        "tip_deviation_mm",
        "axis_deviation_deg",
        "rapid_deviation_mm",
        "tolerance_mm",
        "axis_tolerance_deg",
        "axes",
        "tools",
        "time_s",
        "cutting_time_s",
        "blocks_limited",
        "blocks_capped",
        "fast_rapids",
        "ignored_words",
        "plugins",
        "warnings",
    ] {
        assert!(keys.contains(&key), "{key} is not among {keys:?}");
    }
    let told = &summary["program"];
    assert_eq!((&told["name"], &told["bytes"]), (&"p.nc".into(), &program.len().into()));
    assert_eq!(told["hash"], blake3::hash(program.as_bytes()).to_hex().as_str());
    let count = |key: &str| summary[key].as_u64().unwrap();
    let number = |key: &str| summary[key].as_f64().unwrap();
    let source = fs::read_to_string(root().join(BLADE)).unwrap();
    assert_eq!(count("records"), source.lines().count() as u64);
    let points = source.lines().filter(|line| line.starts_with("GOTO")).count() as u64;
    assert_eq!(count("moves"), points);
    // A head that leans is drawn back along the tool at the end.
    assert!(count("blocks") <= count("moves") + count("points_added") + 1);
    assert!(count("blocks") + 10 > count("moves") + count("points_added"));
    let lines: Vec<&str> = program.lines().collect();
    assert_eq!(count("nc_lines"), lines.len() as u64);
    for (key, limit) in [
        ("tip_deviation_mm", number("tolerance_mm")),
        ("axis_deviation_deg", number("axis_tolerance_deg")),
        ("rapid_deviation_mm", 0.5),
    ] {
        let deviation = &summary[key];
        let value = deviation["value"].as_f64().unwrap();
        assert!(value > 0.0 && value <= limit, "{machine}: {key} {value}");
        // The block is a line of the program with a motion in it, the line one with a point.
        let block = deviation["block"].as_u64().unwrap();
        let block = lines[usize::try_from(block).unwrap() - 1];
        let moves = block.contains(" X") || block.starts_with(['X', 'Y', 'Z', 'A', 'B', 'C']);
        assert!(
            moves || block.contains(" Z") || block.contains(" Y"),
            "{machine}: {key} in `{block}`"
        );
        let line = deviation["line"].as_u64().unwrap();
        let line = source.lines().nth(usize::try_from(line).unwrap() - 1).unwrap();
        assert!(line.starts_with("GOTO"), "{machine}: {key} at `{line}`");
    }
    for axis in summary["axes"].as_array().unwrap() {
        let (min, max) = (axis["min"].as_f64().unwrap(), axis["max"].as_f64().unwrap());
        assert!(min <= max, "{axis}");
        if let Some(travel) = axis["travel"].as_array() {
            assert!(travel[0].as_f64().unwrap() <= min && max <= travel[1].as_f64().unwrap());
        }
    }
    let (time, cutting) = (number("time_s"), number("cutting_time_s"));
    // 290 mm at 1500 mm/min.
    assert!(time > cutting && (10.0..20.0).contains(&cutting), "{time} {cutting}");
    assert_eq!(summary["warnings"], Value::Array(Vec::new()));
    let ignored: Vec<(String, u64)> =
        serde_json::from_value(summary["ignored_words"].clone()).unwrap();
    assert!(ignored.contains(&("PAINT".to_owned(), 16)), "{ignored:?}");
    for plugin in summary["plugins"].as_array().unwrap() {
        assert!(plugin["name"].is_string() && plugin["version"].is_string());
    }
}

#[test]
fn the_numbers_of_a_small_job_are_those_worked_out_by_hand() {
    let folder = with_file(
        "line.cls",
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,60\nFEDRAT/100,MMPM\nGOTO/0,0,10\nGOTO/30,40,10\nFINI\n",
    );
    let done = post_in(folder.path(), &["-m", "vmc", "line.cls", "--summary", "line.json"]);
    assert_eq!(done.code, 0, "{}", done.err);
    let summary = read_json(&folder.path().join("line.json"));
    assert_eq!(summary["records"], 9);
    assert_eq!(summary["moves"], 3);
    assert_eq!(summary["blocks"], 3);
    assert_eq!(summary["points_added"], 0);
    // 50 mm down and 50 mm across at 100 mm/min.
    assert!((summary["cutting_time_s"].as_f64().unwrap() - 60.0).abs() < 1e-9);
    let axes: Vec<(String, f64, f64)> = summary["axes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|axis| {
            let name = axis["name"].as_str().unwrap().to_owned();
            (name, axis["min"].as_f64().unwrap(), axis["max"].as_f64().unwrap())
        })
        .collect();
    // The gauge line stands 600 mm over the table.
    let expected = [("X", 0.0, 30.0), ("Y", 0.0, 40.0), ("Z", -590.0, -540.0)];
    for ((name, min, max), (name_wanted, min_wanted, max_wanted)) in axes.iter().zip(expected) {
        assert_eq!(name, name_wanted);
        assert!((min - min_wanted).abs() < 1e-9 && (max - max_wanted).abs() < 1e-9);
    }
    let program = fs::read_to_string(folder.path().join("line.nc")).unwrap();
    assert_contains(&program, &["G1 Z10.000 F100.\nX30.000 Y40.000\n"]);
}

#[test]
fn no_progress_and_no_colour_in_a_pipe() {
    let done = post(&["-m", "ac-trunnion", BLADE, "-o", "-"]);
    assert_eq!(done.code, 0);
    assert_contains(&done.err, &["warning[tool-length]", "--tool-length"]);
    for text in [&done.out, &done.err] {
        assert!(!text.contains('\u{1b}') && !text.contains('\r') && !text.contains("left"));
    }
}

/// Who is held by the control's largest F by time is not held by its axes.
#[test]
fn the_summary_says_what_slows_blocks_down() {
    let slow = ["-m", "ac-trunnion", "--tcp", "post", "--tool-length", "100", "-o"];
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("slow.nc");
    let mut all = slow.to_vec();
    let source = crate::common::sample("blade.cls");
    all.extend([program.to_str().unwrap(), "--set", "control.fanuc.most_inverse_time=60"]);
    all.push(source.to_str().unwrap());
    let done = crate::common::post(&all);
    assert_eq!(done.code, 0, "{}", done.err);
    let told = format!("{}{}", done.out, done.err);
    assert!(told.contains("by the largest F under inverse time"), "{told}");
}
