//! `post --plan --map` and `--plan-pictures`: rows without gaps whose times are those of the summary, and limits that the
//! plan keeps.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Run, assert_contains, names, post_in, read_json, root};

fn posted(folder: &TempDir, file: &str, more: &[&str]) -> Run {
    let file = root().join("tests/samples").join(file);
    let file = file.display().to_string();
    let job = ["-m", "ac-trunnion", "--tool-length", "80", "-q", &file];
    post_in(folder.path(), &[&job, more].concat())
}

fn number(row: &Value, key: &str) -> f64 {
    let value = row[key].as_f64();
    value.unwrap_or_else(|| panic!("{key} of {row}"))
}

/// By limit and axis, s.
type Times = BTreeMap<(String, String), f64>;

fn key(row: &Value) -> (String, String) {
    let axis = row["axis"].as_str().unwrap_or_default();
    (row["limit"].as_str().unwrap().to_owned(), axis.to_owned())
}

/// The rows follow one another from the beginning of the plan to its end, and are told of no limit twice running.
fn assert_whole(map: &Path, summary: &Path) -> Vec<Value> {
    let rows = read_json(map).as_array().unwrap().clone();
    let plan = read_json(summary)["plan"].clone();
    assert_eq!(number(&rows[0], "way_from_mm"), 0.0);
    assert_eq!(number(&rows[0], "time_from_s"), 0.0);
    for pair in rows.windows(2) {
        for (to, from) in [("way_to_mm", "way_from_mm"), ("time_to_s", "time_from_s")] {
            assert_eq!(number(&pair[0], to), number(&pair[1], from), "{pair:?}");
        }
        let same = |name: &str| pair[0][name] == pair[1][name];
        assert!(!(same("cl_line") && same("limit") && same("axis")), "{pair:?}");
        assert!(number(&pair[1], "cl_line") >= number(&pair[0], "cl_line"));
    }
    let planned = number(&plan, "planned_s");
    let last = number(rows.last().unwrap(), "time_to_s");
    assert!((last / planned - 1.0).abs() < 1e-6, "{last} {planned}");
    let mut times = Times::new();
    for row in &rows {
        let [from, to] = ["from", "to"].map(|end| number(row, &format!("time_{end}_s")));
        let way = number(row, "way_to_mm") - number(row, "way_from_mm");
        let [least, most] = ["least", "most"].map(|end| number(row, &format!("feed_{end}_mm_min")));
        assert!(to >= from && way >= 0.0 && most >= least, "{row}");
        // No feed between is below the least of the samples: the squared speed is linear between them and the places halfway.
        let mean = 60.0 * way / (to - from);
        assert!(mean >= 0.99 * least && mean <= 1.01 * most, "{mean}: {row}");
        *times.entry(key(row)).or_default() += to - from;
    }
    let limits = plan["limits"].as_array().unwrap();
    assert_eq!(limits.len(), times.len());
    for limit in limits {
        let [told, found] = [number(limit, "time_s"), times[&key(limit)]];
        assert!((told - found).abs() < 1e-6 * planned, "{limit} {found}");
    }
    rows
}

#[test]
fn a_map_covers_the_plan_without_gaps_and_its_limits_are_kept() {
    for (file, chord) in [("s-piece.cls", 880.0), ("blade.cls", 330.0)] {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let plan = [
            "--plan",
            "-o",
            "part.nc",
            "--map",
            "map.json",
            "--plan-pictures",
            "plan",
            "--summary",
            "found.json",
        ];
        let run = posted(&folder, file, &plan);
        assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
        let rows = assert_whole(&at("map.json"), &at("found.json"));
        let way = number(rows.last().unwrap(), "way_to_mm");
        assert!(way > 0.9 * chord && way < chord, "{way}");
        // Feeds of the CL file.
        let most = rows.iter().map(|row| number(row, "feed_most_mm_min"));
        let most = most.fold(0.0, f64::max);
        let asked = if file == "blade.cls" { 1500.0 } else { 3000.0 };
        assert!((most / asked - 1.0).abs() < 1e-3, "{most}");
        assert_eq!(
            names(&at("plan")),
            [
                "axis-acceleration.svg",
                "axis-jerk.svg",
                "axis-velocity.svg",
                "chord-error.svg",
                "contour-error.svg",
                "feed.svg",
                "plan.json"
            ]
        );
        let picture = fs::read_to_string(at("plan/axis-acceleration.svg")).unwrap();
        assert_contains(&picture, &["part.nc on AC trunnion", "limit", "°/s²"]);
        assert!(!picture.contains("NaN") && !picture.contains("inf"));
        let found = read_json(&at("plan/plan.json"));
        assert!((number(&found, "length_mm") - way).abs() < 1e-6 * way);
        let mut reached: f64 = 0.0;
        for limit in found["limits"].as_array().unwrap() {
            let kept = limit["kept"] == true;
            if let (true, Some(share)) = (kept, limit["largest_share"].as_f64()) {
                // Accelerations are held as if the second derivative were linear between samples.
                assert!(share <= 1.01, "{limit}");
                reached = reached.max(share);
            }
        }
        assert!(reached > 0.999, "{reached}");
        // The same as a table, and the same program.
        let program = fs::read(at("part.nc")).unwrap();
        let table = ["--plan", "-o", "part.nc", "--map", "map.csv"];
        assert_eq!(posted(&folder, file, &table).code, 0);
        assert_eq!(fs::read(at("part.nc")).unwrap(), program);
        let table = fs::read_to_string(at("map.csv")).unwrap();
        let mut lines = table.lines();
        let head: Vec<&str> = lines.next().unwrap().split(',').collect();
        for (line, row) in lines.clone().zip(&rows) {
            for (name, cell) in head.iter().zip(line.split(',')) {
                match row[*name].as_f64() {
                    Some(value) => {
                        let cell: f64 = cell.parse().unwrap();
                        assert!((cell - value).abs() <= 5.1e-4, "{name} {line}");
                    }
                    None => assert_eq!(cell, row[*name].as_str().unwrap_or_default()),
                }
            }
            assert_eq!(line.split(',').count(), head.len());
        }
        assert_eq!(lines.count(), rows.len());
        // Where nobody looks on, the program is the same.
        assert_eq!(posted(&folder, file, &["--plan", "-o", "part.nc"]).code, 0);
        assert_eq!(fs::read(at("part.nc")).unwrap(), program);
    }
}

#[test]
fn errors_that_the_machine_limits_stand_in_the_map_and_are_kept() {
    for solver in ["reach", "jerk"] {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let solver = format!("plan.solver={solver}");
        let run = posted(
            &folder,
            "s-piece.cls",
            &[
                "--plan",
                "--set",
                "plan.contour_error=0.001",
                "--set",
                &solver,
                "--map",
                "map.json",
                "--plan-pictures",
                "plan",
                "--summary",
                "found.json",
                "-o",
                "part.nc",
            ],
        );
        assert_eq!(run.code, 0, "{}", run.err);
        let rows = assert_whole(&at("map.json"), &at("found.json"));
        assert!(rows.iter().any(|row| row["limit"] == "contour error"));
        let found = read_json(&at("plan/plan.json"));
        let limits = found["limits"].as_array().unwrap();
        for limit in limits.iter().filter(|limit| limit["kept"] == true) {
            let name = limit["limit"].as_str().unwrap();
            let share = limit["largest_share"].as_f64().unwrap();
            println!("{solver} {name}: {share}");
            // Held against limits that are linear between samples: the contour error, of a table besides, where the curve
            // bends otherwise.
            let most = if name == "contour error" { 1.06 } else { 1.01 };
            assert!(share <= most, "{limit}");
        }
        let picture = fs::read_to_string(at("plan/contour-error.svg")).unwrap();
        assert_contains(&picture, &["limit"]);
    }
}

#[test]
fn each_program_of_a_split_has_a_map_and_a_folder_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let plan = [
        "--plan",
        "--split",
        "tools",
        "-o",
        "part.nc",
        "--map",
        "map.json",
        "--plan-pictures",
        "plan",
        "--summary",
        "found.json",
    ];
    let run = posted(&folder, "facets.apt", &plan);
    assert_eq!(run.code, 0, "{}", run.err);
    let count = read_json(&folder.path().join("found.json"));
    let count = count.as_array().unwrap().len();
    assert!(count > 1 && !folder.path().join("map.json").exists());
    for number in 1..=count {
        assert!(folder.path().join(format!("map-{number}.json")).exists());
        assert!(folder.path().join(format!("plan-{number}/feed.svg")).exists());
    }
}

#[test]
fn nothing_is_shown_of_a_plan_that_is_not_made() {
    let folder = tempfile::tempdir().unwrap();
    for option in ["--map", "--plan-pictures"] {
        let run = posted(&folder, "blade.cls", &["-o", "part.nc", option, "shown"]);
        assert_eq!(run.code, 2, "{}", run.err);
        assert_contains(&run.err, &["--plan"]);
    }
    // What is not of such a plan is not overwritten.
    let own = folder.path().join("own");
    fs::create_dir(&own).unwrap();
    fs::write(own.join("feed.svg"), "mine").unwrap();
    let plan = ["-o", "part.nc", "--plan", "--plan-pictures", "own"];
    let run = posted(&folder, "blade.cls", &plan);
    assert_eq!(run.code, 1);
    assert_contains(&run.err, &["feed.svg", "--plan-pictures"]);
    assert_eq!(fs::read_to_string(own.join("feed.svg")).unwrap(), "mine");
    assert_eq!(names(folder.path()), ["own"]);
}
