//! `post --plan` writes no plan that costs time for nothing, as `post predict` sees it.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{Run, command, run};

/// Straight cuts with corners between them.
const ZIGZAG: &str = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nRAPID\nGOTO/0,0,50\nFEDRAT/3000,MMPM\nGOTO/0,0,5\n\
    GOTO/50,0,5\nGOTO/50,30,5\nGOTO/0,30,5\nGOTO/0,60,5\nGOTO/50,60,5\nRAPID\nGOTO/50,60,50\nEND\nFINI\n";

const JOB: [&str; 6] = ["-m", "vmc", "--tool-length", "100", "--mount", "0,0,-100"];

fn post(folder: &Path, more: &[&str]) -> (Run, String) {
    fs::write(folder.join("zigzag.cls"), ZIGZAG).unwrap();
    let mut post = command();
    post.current_dir(folder).args(["-q", "zigzag.cls", "-o", "zigzag.nc"]).args(JOB);
    let done = run(post.args(more), b"");
    assert_eq!(done.code, 0, "{}", done.err);
    let text = fs::read_to_string(folder.join("zigzag.nc")).unwrap();
    (done, text)
}

/// Seconds that the program takes, and how far it leaves the tool off the path of the CL file, mm.
fn predicted(folder: &Path, more: &[&str]) -> [f64; 2] {
    let mut predict = command();
    predict
        .current_dir(folder)
        .args(["predict", "zigzag.nc", "--against", "zigzag.cls"])
        .args(["--summary", "found.json"])
        .args(JOB);
    let done = run(predict.args(more), b"");
    assert_eq!(done.code, 0, "{}", done.err);
    let text = fs::read_to_string(folder.join("found.json")).unwrap();
    let found: Value = serde_json::from_str(&text).unwrap();
    ["/time/cycle_s", "/contour/tip_mm/largest"].map(|path| {
        let value = found.pointer(path).and_then(Value::as_f64);
        value.unwrap_or_else(|| panic!("{path} of {found}"))
    })
}

const LEFT_OUT: &str = "it is written without the plan";

/// A control that stands still at every corner leaves the path nowhere: there is nothing that a plan could better.
#[test]
fn a_plan_that_only_costs_time_is_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let stops = ["--set", "motion.corner=\"stop\""];
    let (_, unplanned) = post(folder, &stops);
    let [seconds, _] = predicted(folder, &stops);
    let (done, written) = post(folder, &[&stops[..], &["--plan"]].concat());
    assert!(done.err.contains("warning[plan]"), "{}", done.err);
    assert!(done.err.contains(LEFT_OUT), "{}", done.err);
    let told = format!("{seconds:.1} s without");
    assert!(done.err.contains(&told), "{told} is not in {}", done.err);
    assert_eq!(written, unplanned);
    // Who looks at the plan gets it: it is slower indeed.
    let map = ["--plan", "--map", "map.csv"];
    let (done, planned) = post(folder, &[&stops[..], &map].concat());
    assert!(!done.err.contains(LEFT_OUT), "{}", done.err);
    assert_ne!(planned, unplanned);
    assert!(predicted(folder, &stops)[0] > 1.01 * seconds);
}

/// Slower, and the servos keep the path the better for it.
#[test]
fn a_plan_that_costs_time_for_something_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (_, unplanned) = post(folder, &[]);
    let without = predicted(folder, &[]);
    let (done, planned) = post(folder, &["--plan"]);
    let with = predicted(folder, &[]);
    assert!(!done.err.contains(LEFT_OUT), "{}", done.err);
    assert_ne!(planned, unplanned);
    assert!(with[0] > without[0], "{with:?} {without:?}");
    assert!(with[1] < 0.5 * without[1], "{with:?} {without:?}");
}
