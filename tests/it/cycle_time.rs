//! `[solution] rule = "cycle-time"`: what is predicted of its programs is no slower than of those by `time`, and over poles
//! and in rapids it is faster. The prediction knows nothing of the choice: it reads the program, plans it block by block and
//! counts set-points.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::common::{self, assert_contains, post_in, read_json, root};

/// Radius of the cap, mm; its top is the part origin.
const RADIUS: f64 = 60.0;

/// Rows over the top of a spherical cap, each so far beside the pole, mm; the tool stands along the normal.
fn cap(beside: &[f64], feed: f64) -> String {
    let mut text = String::from("UNITS/MM\nLOADTL/1\nSPINDL/RPM,6000,CLW\n");
    let place = |text: &mut String, x: f64, y: f64, lift: f64| {
        let z = (RADIUS * RADIUS - x * x - y * y).sqrt();
        let axis = [x, y, z].map(|value| value / RADIUS);
        let tip: Vec<f64> = axis.iter().map(|value| value * (RADIUS + lift)).collect();
        let [i, j, k] = axis;
        let (x, y, z) = (tip[0], tip[1], tip[2] - RADIUS);
        writeln!(text, "GOTO/{x:.6},{y:.6},{z:.6},{i:.9},{j:.9},{k:.9}").unwrap();
    };
    for (row, y) in beside.iter().enumerate() {
        let sense = if row % 2 == 0 { 1.0 } else { -1.0 };
        for lift in [10.0, 0.0] {
            text.push_str("RAPID\n");
            place(&mut text, -10.0 * sense, *y, lift);
        }
        writeln!(text, "FEDRAT/MMPM,{feed}").unwrap();
        for step in -19..=20 {
            place(&mut text, 0.5 * f64::from(step) * sense, *y, 0.0);
        }
        text.push_str("RAPID\n");
        place(&mut text, 10.0 * sense, *y, 10.0);
    }
    text.push_str("FINI\n");
    text
}

/// Posts a file by a rule, verified: the program, and the predicted cycle time, s.
fn posted(folder: &Path, rule: &str, machine: &str, file: &str, more: &[&str]) -> (String, f64) {
    let rule = format!("solution.rule={rule}");
    let mut arguments = vec!["-q", "-m", machine, "-o", "part.nc", "--verify", "--predict=p.json"];
    arguments.extend(["--set", &rule, file]);
    arguments.extend(more);
    let run = post_in(folder, &arguments);
    assert_eq!(run.code, 0, "{machine} {rule} {more:?}: {}", run.err);
    let program = fs::read_to_string(folder.join("part.nc")).unwrap();
    let found = read_json(&folder.join("p.json"));
    (program, found["time"]["cycle_s"].as_f64().unwrap())
}

fn with_cap(beside: &[f64], feed: f64) -> TempDir {
    common::with_file("cap.cls", &cap(beside, feed))
}

const TIP: &[&str] = &["--tcp", "post", "--tool-length", "100"];

/// Over the pole and close beside it: never slower by more than a hundredth of a second, and all in all faster.
#[test]
fn rows_over_a_pole_are_predicted_to_be_faster() {
    for machine in ["ac-trunnion", "head-head", "nutating-head"] {
        let mut gained = Vec::new();
        for beside in [0.0, 0.02, 0.05, 0.2] {
            for feed in [600.0, 2000.0] {
                let folder = with_cap(&[beside], feed);
                let time = |rule: &str| posted(folder.path(), rule, machine, "cap.cls", TIP).1;
                gained.push(time("time") - time("cycle-time"));
            }
        }
        println!("{machine}: {gained:.3?}");
        assert!(gained.iter().all(|gained| *gained > -0.01), "{machine}: {gained:?}");
        assert!(gained.iter().sum::<f64>() > 1.0, "{machine}: {gained:?}");
    }
}

/// A head that can come by a short turn of its slow axis or by a long one of the fast one; and a trunnion whose rapids go in
/// pieces.
#[test]
fn rapids_are_predicted_to_be_faster() {
    let samples = root().join("tests/samples");
    let wedge = samples.join("wedge.ncl");
    let folder = tempfile::tempdir().unwrap();
    let time = |rule: &str| {
        let file = wedge.to_str().unwrap();
        // In planes the tool is drawn back between them.
        let arguments = ["--tool-length", "100", "--set", "control.planes=false"];
        posted(folder.path(), rule, "ac-trunnion", file, &arguments).1
    };
    let (by_time, by_cycle_time) = (time("time"), time("cycle-time"));
    assert!(by_cycle_time < by_time - 0.3, "{by_time} {by_cycle_time}");
}

/// What is written close to the pole, to be read: the table turns on the pole, or as close to it as tolerance allows, and
/// nowhere else.
#[test]
fn the_program_over_a_pole_is_the_one_that_was_reviewed() {
    let folder = with_cap(&[0.0, 0.05], 2000.0);
    let (program, _) = posted(folder.path(), "cycle-time", "ac-trunnion", "cap.cls", TIP);
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("tests/snapshots/cycle-time"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("cap_ac-trunnion", program));
}

/// The same program from a file and from a pipe, and again.
#[test]
fn it_is_the_same_program_every_time() {
    let folder = with_cap(&[0.0, 0.05, 1.0], 2000.0);
    let (first, _) = posted(folder.path(), "cycle-time", "ac-trunnion", "cap.cls", TIP);
    let (second, _) = posted(folder.path(), "cycle-time", "ac-trunnion", "cap.cls", TIP);
    assert!(first == second);
    let mut arguments = vec!["-q", "-m", "ac-trunnion", "--set", "solution.rule=cycle-time"];
    arguments.extend(TIP);
    let text = fs::read_to_string(folder.path().join("cap.cls")).unwrap();
    let piped = common::post_text(&arguments, &text);
    assert_eq!(piped.code, 0, "{}", piped.err);
    // All but its number and name.
    let lines = |program: &str| program.lines().skip(2).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(lines(&piped.out), lines(&first));
}

#[test]
fn a_machine_without_accelerations_is_refused() {
    let machine = fs::read_to_string(root().join("machines/ac-trunnion.toml")).unwrap();
    let unknown = machine.replace("max_accel = 4000", "");
    let folder = common::with_file("mill.toml", &unknown);
    fs::write(folder.path().join("cap.cls"), cap(&[0.0], 2000.0)).unwrap();
    let rule = "solution.rule=cycle-time";
    let run = post_in(folder.path(), &["-m", "mill.toml", "--set", rule, "-o", "-", "cap.cls"]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert_contains(&run.err, &["no max_accel of Y, X, Z", "rule = \"time\""]);
}
