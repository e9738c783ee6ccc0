//! `post --plan --plan-rounds`: the program that is written keeps the contour error that the machine file limits, as
//! `post predict` sees it, and what is told of the rounds is true.

use std::fmt::Write as _;
use std::fs;

use serde_json::Value;
use tempfile::TempDir;

use crate::common::{Run, assert_contains, post_in, read_json, root, with_file};

/// The library's trunnion, its servos without feed-forward: they lag by 20 ms.
fn soft() -> TempDir {
    let mut machine = String::from("extends = \"ac-trunnion\"\n[plan]\ncontour_error = 0.02\n");
    for axis in ["X", "Y", "Z", "A", "C"] {
        let _ = writeln!(
            machine,
            "[servo.{axis}.loops]\nvelocity_feed_forward = 0\nacceleration_feed_forward = 0"
        );
    }
    with_file("mill.toml", &machine)
}

fn run(folder: &TempDir, file: &str, more: &[&str]) -> Run {
    let file = root().join("tests/samples").join(file);
    let file = file.display().to_string();
    let job = ["-m", "./mill.toml", "--tool-length", "80", &file];
    post_in(folder.path(), &[&job, more].concat())
}

/// The largest contour error of a program, µm, by the set-points that `post predict` writes: those of cuts, a quarter of a
/// second away from rapids.
fn strays(folder: &TempDir, program: &str) -> f64 {
    let arguments =
        ["predict", program, "-m", "./mill.toml", "--tool-length", "80", "--csv", "points.csv"];
    let predicted = post_in(folder.path(), &arguments);
    assert_eq!(predicted.code, 0, "{}", predicted.err);
    let text = fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| head.iter().position(|it| *it == name).unwrap();
    let [time, cuts, error] = ["time", "cuts", "error"].map(column);
    let rows: Vec<[f64; 3]> = lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            [time, cuts, error].map(|column| cells[column].parse().unwrap())
        })
        .collect();
    let rests: Vec<f64> = rows.iter().filter(|row| row[1] == 0.0).map(|row| row[0]).collect();
    let far = |time: f64| {
        let next = rests.partition_point(|rest| *rest < time);
        let near = rests[next.saturating_sub(1)..].iter().take(2);
        near.fold(f64::INFINITY, |least: f64, rest| least.min((rest - time).abs())) > 0.25
    };
    let cuts = rows.iter().filter(|row| row[1] == 1.0 && far(row[0]));
    let errors: Vec<f64> = cuts.map(|row| 1e3 * row[2]).collect();
    assert!(errors.len() > 1000);
    errors.into_iter().fold(0.0, f64::max)
}

fn number(found: &Value, path: &str) -> f64 {
    let value = found.pointer(path);
    let value = value.unwrap_or_else(|| panic!("{path} of {found}"));
    value.as_f64().unwrap()
}

#[test]
fn servos_that_lag_stray_within_the_limit_once_the_feed_is_planned_in_rounds() {
    for file in ["s-piece.cls", "blade.cls"] {
        let folder = soft();
        let plain = run(&folder, file, &["-q", "-o", "plain.nc"]);
        assert_eq!(plain.code, 0, "{}", plain.err);
        let arguments =
            ["-o", "part.nc", "--plan", "--plan-rounds", "8", "--summary", "found.json"];
        let planned = run(&folder, file, &arguments);
        assert_eq!(planned.code, 0, "{}", planned.err);
        assert!(!planned.err.contains("warning[plan-rounds]"), "{}", planned.err);
        assert_contains(
            &planned.out,
            &["contour limit    0.02000 mm, kept", "  unplanned", "; written"],
        );
        let found = read_json(&folder.path().join("found.json"))["plan_rounds"].clone();
        assert_eq!(found["kept"], true);
        let before = strays(&folder, "plain.nc");
        let after = strays(&folder, "part.nc");
        println!("{file}: {before:.1} µm become {after:.1}; {found}");
        assert!(before > 60.0 && after <= 20.0, "{file}: {before} {after}");
        let chosen = found["chosen"].as_u64().unwrap();
        assert_eq!(chosen + 1, found["rounds"].as_array().unwrap().len() as u64);
        let told = 1e3 * number(&found, &format!("/rounds/{chosen}/contour_mm"));
        assert!(told <= 20.0 && told >= after - 1e-3, "{told} {after}");
        // A limit that is kept costs time against the program that does not keep it.
        let cycle = number(&found, &format!("/rounds/{chosen}/cycle_s"));
        assert!(cycle > number(&found, "/unplanned/cycle_s"), "{cycle}");
    }
}

/// A limit at which the formula alone is not enough: what the control's corners do to stiff servos.
#[test]
fn a_round_is_gentler_where_the_one_before_was_too_fast_and_nowhere_else() {
    let folder =
        with_file("mill.toml", "extends = \"ac-trunnion\"\n[plan]\ncontour_error = 0.005\n");
    let arguments = ["-o", "part.nc", "--plan", "--plan-rounds", "8", "--summary", "found.json"];
    let planned = run(&folder, "blade.cls", &arguments);
    assert_eq!(planned.code, 0, "{}", planned.err);
    let found = read_json(&folder.path().join("found.json"))["plan_rounds"].clone();
    let rounds = found["rounds"].as_array().unwrap();
    assert!(rounds.len() > 1 && found["kept"] == true, "{found}");
    assert!(number(&rounds[0], "/contour_mm") > 0.005);
    assert_eq!(rounds[0]["tightened"], 0);
    let cells = number(rounds.last().unwrap(), "/tightened");
    assert!(cells > 0.0 && cells < 100.0, "{cells}");
    // The same again: nothing depends on time or threads.
    let first = fs::read_to_string(folder.path().join("part.nc")).unwrap();
    run(&folder, "blade.cls", &arguments);
    assert_eq!(fs::read_to_string(folder.path().join("part.nc")).unwrap(), first);
    // One round is the plan itself, and says that it is not enough.
    let once = run(&folder, "blade.cls", &["-o", "once.nc", "--plan", "--plan-rounds", "1"]);
    assert_eq!(once.code, 0, "{}", once.err);
    assert_contains(&once.err, &["warning[plan-rounds]", "after 1 round the", "0.005 mm"]);
    let plan = run(&folder, "blade.cls", &["-q", "-o", "plan.nc", "--plan"]);
    assert_eq!(plan.code, 0, "{}", plan.err);
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert_eq!(text("once.nc").replace("ONCE", "PLAN"), text("plan.nc"));
    assert_ne!(first.replace("PART", "PLAN"), text("plan.nc"));
}

#[test]
fn what_cannot_be_planned_in_rounds_is_refused_by_its_reason() {
    let folder = with_file("mill.toml", "extends = \"ac-trunnion\"\n");
    let arguments = ["-o", "part.nc", "--plan", "--plan-rounds", "3"];
    let refused = run(&folder, "blade.cls", &arguments);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["error[plan-rounds]", "[plan] contour_error = 0.01"]);
    let refused = run(&folder, "blade.cls", &["-o", "part.nc", "--plan-rounds", "3"]);
    assert_eq!(refused.code, 2);
    assert_contains(&refused.err, &["--plan"]);
    let folder = with_file("mill.toml", "extends = \"vmc\"\n[plan]\ncontour_error = 0.01\n");
    let refused = run(&folder, "flange.ncl", &arguments);
    assert_eq!(refused.code, 1);
    assert_contains(&refused.err, &["error[plan-rounds]", "describes no servo"]);
    assert!(!folder.path().join("part.nc").exists());
}
