//! `post check`: what it derives, against facts that are known from elsewhere, and the programs it writes.

use crate::common;

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use common::{Run, check_numbers, post, read_json, root};
use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use serde_json::Value;

/// What `post check` derives, and its messages.
fn check(arguments: &[&str]) -> (Value, Run) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("check.json");
    let mut all = vec!["check"];
    all.extend(arguments);
    all.extend(["--json", json.to_str().unwrap()]);
    let run = post(&all);
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.err);
    (read_json(&json), run)
}

fn close(value: &Value, wanted: f64, within: f64) {
    let value = value.as_f64().unwrap();
    assert!((value - wanted).abs() < within, "{value} is not {wanted}");
}

/// Machine, class, share of the sphere, tilt in all azimuths.
#[test]
fn the_reach_is_what_the_travels_say() {
    let cap = |tilt: f64| (1.0 - libm::cos(tilt.to_radians())) / 2.0;
    for (machine, class, tilt) in [
        ("ac-trunnion", "five-axis, table-table: C on A; orthogonal", 120.0),
        ("dmu50", "five-axis, table-table: C on B; orthogonal", 110.0),
        ("head-head", "five-axis, head-head: C carries A; orthogonal", 110.0),
        ("head-head-360", "five-axis, head-head: C carries A; orthogonal", 180.0),
        (
            "nutating-head",
            "five-axis, head-table: head B, table C; nutating, 45° between C and B, 45° between B and tool",
            90.0,
        ),
        (
            "disc-cutter",
            "six-axis, head-head: C carries A; table B is set between cuts; orthogonal",
            110.0,
        ),
    ] {
        let (check, run) = check(&[machine]);
        assert_eq!(run.err, "", "{machine}");
        assert_eq!(check["class"]["name"], class);
        let reach = &check["reach"];
        close(&reach["tilt_in_all_azimuths_deg"], tilt, 1e-3);
        close(&reach["tilt_in_some_azimuth_deg"], tilt, 1e-3);
        close(&reach["share_of_sphere"], cap(tilt), 0.01);
        let shares = reach["shares_by_solutions"].as_array().unwrap();
        let sum: f64 = shares.iter().map(|share| share.as_f64().unwrap()).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{machine}: {sum}");
        assert!(check["round_trip"]["tip_mm"].as_f64().unwrap() < 1e-9);
        assert!(check["round_trip"]["axis_rad"].as_f64().unwrap() < 1e-9);
        assert_eq!(check["round_trip"]["not_found"], 0);
    }
}

/// A reaches -120° to 30°: below 30° of tilt both solutions are inside, above only the negative one.
#[test]
fn two_solutions_where_both_signs_of_the_tilt_are_inside() {
    let (check, _) = check(&["ac-trunnion"]);
    let shares = check["reach"]["shares_by_solutions"].as_array().unwrap();
    let cap = |tilt: f64| (1.0 - libm::cos(tilt.to_radians())) / 2.0;
    close(&shares[2], cap(30.0), 0.005);
    close(&shares[1], cap(120.0) - cap(30.0), 0.005);
    assert_eq!(check["typical"]["inside"], 2);
    let poles = check["poles"]["at"].as_array().unwrap();
    assert_eq!(poles[0]["inside"], true);
    assert_eq!(poles[0]["free"], "C");
    assert_eq!(poles[1]["inside"], false);
}

/// An axis at an angle g to the spindle brings the tool to a tilt of 2g after half a turn, and after a turn of b
/// to cos t = cos² g + sin² g · cos b.
#[test]
fn a_nutating_head_reaches_a_right_angle_from_45_degrees_alone() {
    for (rotary, most, tilt) in [
        ("[0, 1, 1]", 180.0, 90.0),
        ("[0, 1, 1.1]", 180.0, 2.0 * libm::atan(1.0 / 1.1).to_degrees()),
        ("[0, 1.1, 1]", 180.0, 2.0 * libm::atan(1.1).to_degrees()),
        ("[0, 1, 1]", 90.0, 60.0),
    ] {
        let rotary = format!("axis.B.rotary={rotary}");
        let travel = format!("axis.B.travel=[0, {most}]");
        let (check, _) = check(&["nutating-head", "--set", &rotary, "--set", &travel]);
        close(&check["reach"]["tilt_in_all_azimuths_deg"], tilt, 1e-3);
    }
}

#[test]
fn an_axis_across_shuts_out_the_upright_tool() {
    let (check, run) = check(&["head-head", "--set", "tool.axis=[0.3, 0, 1]"]);
    assert!(run.err.contains("cannot stand upright"), "{}", run.err);
    assert_eq!(check["reach"]["tilt_in_all_azimuths_deg"], Value::Null);
    close(&check["poles"]["at"][0]["missed_by_deg"], libm::atan(0.3).to_degrees(), 1e-6);
}

/// Where C leans by e against the plane across A, a cone of e about C is out of reach: A cannot turn the tool into it.
#[test]
fn a_measured_table_has_a_small_hole_at_its_pole() {
    let (check, _) = check(&["ac-trunnion", "--set", "axis.C.rotary=[45e-6, 0, 1]"]);
    let pole = &check["poles"]["at"][0];
    close(&pole["missed_by_deg"], 45e-6f64.to_degrees(), 1e-9);
    assert_eq!(pole["inside"], false);
    // The tool is upright with both at zero all the same.
    assert_ne!(check["reach"]["ways_upright"], 0);
}

#[test]
fn what_looks_wrong_is_told() {
    let (_, run) = check(&["ac-trunnion", "--mount", "0,0,500"]);
    assert!(run.err.contains("part origin is out of travel: Z"), "{}", run.err);
    let (told, run) = check(&["ac-trunnion", "--set", "axis.A.travel=[40, 60]"]);
    assert!(run.err.contains("A cannot stand where it shows 0"), "{}", run.err);
    assert_eq!(told["reach"]["ways_upright"], 0);
    let shown = ["ac-trunnion", "--set", "axis.A.travel=[40, 60]", "--set", "axis.A.zero=50"];
    let (_, run) = check(&shown);
    assert!(run.err.contains("A cannot stand where it shows 0"), "{}", run.err);
    let shown = ["ac-trunnion", "--set", "axis.A.travel=[-60, 60]", "--set", "axis.A.zero=90"];
    let (_, run) = check(&shown);
    assert!(!run.err.contains("cannot stand where"), "{}", run.err);
}

/// The travel of the tip is that of the axes, from the gauge line less the tool.
#[test]
fn the_tip_goes_where_the_axes_go() {
    let (check, _) = check(&["ac-trunnion", "--tool-length", "120", "--mount", "10,0,0"]);
    let volume = &check["volume"];
    for (index, least, most) in [(0, -310.0, 290.0), (1, -300.0, 300.0), (2, -170.0, 280.0)] {
        close(&volume["least"][index], least, 1e-9);
        close(&volume["most"][index], most, 1e-9);
    }
}

// Signs.

fn signs(check: &Value) -> BTreeMap<String, (String, String)> {
    let rows = check["signs"].as_array().unwrap();
    rows.iter()
        .map(|row| {
            let text = |key: &str| row[key].as_str().unwrap().to_owned();
            let by = row["by"].as_f64().unwrap();
            let key = format!("{} {}{by:.0}", text("axis"), if by > 0.0 { "+" } else { "" });
            (key, (text("tool"), text("seen")))
        })
        .collect()
}

#[track_caller]
fn sign(signs: &BTreeMap<String, (String, String)>, of: &str, tool: &str, seen: &str) {
    let (told, saw) = signs.get(of).unwrap_or_else(|| panic!("{of} in {signs:?}"));
    assert!(told.contains(tool), "{of}: {told}");
    assert!(saw.contains(seen), "{of}: {saw}");
}

/// ISO 841: C+ turns the tool counter-clockwise seen from +Z against the part, so the table turns clockwise.
#[test]
fn the_sign_table_of_a_table_and_of_a_head() {
    let (check_table, _) = check(&["ac-trunnion"]);
    let table = signs(&check_table);
    sign(
        &table,
        "C +90",
        "from +X to +Y",
        "the table turns clockwise seen from +Z, its +X side to -Y",
    );
    sign(
        &table,
        "A -90",
        "from +Z to +Y",
        "the table turns counter-clockwise seen from +X, its +Y side to +Z",
    );
    sign(&table, "A +30", "30° towards -Y", "its +Y side 30° towards -Z");
    sign(&table, "X +100", "moves 100 mm to +X", "the head moves to +X");
    let (check_head, _) = check(&["head-head"]);
    let head = signs(&check_head);
    sign(&head, "C +90", "from +X to +Y", "the head turns counter-clockwise seen from +Z");
    sign(
        &head,
        "A +90",
        "from +Z to -Y",
        "the head turns counter-clockwise seen from +X, the tip swings to +Y",
    );
    let (check_vmc, _) = check(&["vmc"]);
    let vmc = signs(&check_vmc);
    sign(&vmc, "X +100", "to +X", "the table moves to -X");
    sign(&vmc, "Y -100", "to -Y", "the table moves to +Y");
    sign(&vmc, "Z +100", "to +Z", "the head moves to +Z");
    let (check_nutating, _) = check(&["nutating-head"]);
    sign(&signs(&check_nutating), "B +180", "from +Z to +Y", "the tip swings to -Y");
}

/// A machine as LinuxCNC's users have it: the laws of `shared/data/README.md` give the tool axis as
/// Rz(-C)·Rx(-A)·ez and Rz(-C)·Ry(-B)·ez on tables, Rz(C)·Ry(-B)·ez on a head.
#[test]
fn the_sign_table_agrees_with_the_laws_of_linuxcnc() {
    let machine = |chain: &str, reversed: &[&str], axes: [(&str, &str); 2]| {
        let mut text = format!(
            "name = \"x\"\nchain = \"{chain}\"\n[tool]\ngauge = [0, 0, 0]\n[control]\ndialect = \"linuxcnc\"\ntcp = \"post\"\n[axis]\nX = {{ linear = [1, 0, 0], travel = [-500, 500] }}\nY = {{ linear = [0, 1, 0], travel = [-500, 500] }}\nZ = {{ linear = [0, 0, 1], travel = [-500, 500] }}\n"
        );
        for (name, direction) in axes {
            let turned = reversed.contains(&name);
            text.push_str(&format!(
                "{name} = {{ rotary = {direction}, point = [0, 0, 0], travel = [-120, 120], reversed = {turned}, max_feed = 3600 }}\n"
            ));
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.toml");
        fs::write(&path, text).unwrap();
        signs(&check(&[path.to_str().unwrap()]).0)
    };
    let (a, b, c) = (("A", "[1, 0, 0]"), ("B", "[0, 1, 0]"), ("C", "[0, 0, 1]"));
    // Rz(-90) takes X to -Y, Rx(-90) takes Z to +Y, Ry(-90) takes Z to -X.
    let xyzac = machine("[w C' A' b X Y Z t]", &["A", "C"], [a, c]);
    sign(&xyzac, "C +90", "from +X to -Y", "the table turns counter-clockwise seen from +Z");
    sign(&xyzac, "A +90", "from +Z to +Y", "the table turns counter-clockwise seen from +X");
    let xyzbc = machine("[w C' B' b X Y Z t]", &["B", "C"], [b, c]);
    sign(&xyzbc, "B +90", "from +Z to -X", "the table turns counter-clockwise seen from +Y");
    let head = machine("[w b X Y Z C B t]", &["B"], [b, c]);
    sign(&head, "C +90", "from +X to +Y", "the head turns counter-clockwise seen from +Z");
    sign(
        &head,
        "B +90",
        "from +Z to -X",
        "the head turns clockwise seen from +Y, the tip swings to +X",
    );
}

/// A shifted zero and a reversed count change what is shown, not what can be reached.
#[test]
fn readings_are_those_of_the_control() {
    let (drawn, _) = check(&["ac-trunnion"]);
    let (shifted, _) =
        check(&["ac-trunnion", "--set", "axis.A.zero=10", "--set", "axis.A.travel=[-110, 40]"]);
    let shown =
        |check: &Value| check["typical"]["ways"][0]["readings"][1]["value"].as_f64().unwrap();
    close(&Value::from(shown(&shifted)), shown(&drawn) + 10.0, 1e-9);
    let tilt = |check: &Value| check["reach"]["tilt_in_all_azimuths_deg"].as_f64().unwrap();
    close(&Value::from(tilt(&shifted)), tilt(&drawn), 1e-6);
    close(&shifted["class"]["axes"][1]["travel"][0], -110.0, 1e-9);
}

/// With A at rest at 40° the line of C leans to +Y as the eye sees it, and stays where it is for the part.
#[test]
fn the_eye_sees_the_table_where_it_rests() {
    let (leaning, _) = check(&["ac-trunnion", "--set", "axis.A.travel=[40, 60]"]);
    let table = signs(&leaning);
    let eye = "the table turns clockwise seen from (0.000, 0.643, 0.766)";
    // At 40° of tilt C sweeps the tool axis around a cone: from azimuth -90° to 0°.
    sign(&table, "C +90", "from (0.000, -0.643, 0.766) to (0.643, 0.000, 0.766)", eye);
    // A has 20° of room.
    sign(&table, "A +20", "from (0.000, -0.643, 0.766) 20° towards", "clockwise seen from +X");
}

#[test]
fn the_machine_file_is_never_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    fs::copy(root().join("machines/vmc.toml"), &path).unwrap();
    let before = fs::read_to_string(&path).unwrap();
    let path_text = path.to_str().unwrap();
    for flags in [
        ["--json", path_text].as_slice(),
        &["--svg", path_text],
        &["--commission", "-o", path_text],
    ] {
        let mut all = vec!["check", path_text];
        all.extend(flags);
        let run = post(&all);
        assert_eq!(run.code, 1, "{flags:?}");
        assert_eq!(fs::read_to_string(&path).unwrap(), before);
    }
}

#[test]
fn json_on_standard_output_is_alone_there() {
    let run = post(&["check", "vmc", "--json", "-"]);
    let check: Value = serde_json::from_str(&run.out).unwrap();
    assert_eq!(check["machine"], "VMC");
}

// Measured against nominal.

const MEASURED: &str = "tests/measured/measured.toml";

fn compare(arguments: &[&str]) -> Value {
    let mut all = vec!["ac-trunnion", "--nominal", "ac-trunnion"];
    all.extend(arguments);
    check(&all).0
}

#[test]
fn a_file_against_itself_differs_by_nothing() {
    let compared = compare(&[]);
    close(&compared["tip_mm"], 0.0, 1e-12);
    close(&compared["axis_deg"], 0.0, 1e-12);
    assert_eq!(compared["tip_shares"].as_array().unwrap().len(), 0);
}

/// The tip stands on the part origin at Z -400 (gauge 400, no tool), so Z goes 400 mm from there at most.
#[test]
fn a_leaning_z_moves_the_tip_by_the_lean_times_the_way() {
    let compared = compare(&["--set", "axis.Z.linear=[50e-6, 0, 1]"]);
    close(&compared["tip_mm"], 400.0 * 50e-6, 1e-7);
    close(&compared["axis_deg"], 0.0, 1e-12);
    let shares = compared["tip_shares"].as_array().unwrap();
    assert_eq!(shares.len(), 1);
    assert_eq!(shares[0]["of"], "direction of Z");
    close(&shares[0]["size"], 400.0 * 50e-6, 1e-7);
}

/// An axis line that lies aside by d moves the tip by the chord 2·d·sin(A/2); A turns by 120° at most, C by 180°.
#[test]
fn a_line_aside_moves_the_tip_by_its_chord() {
    let compared = compare(&["--set", "axis.A.point=[0, 0.032, \"Zc\"]"]);
    close(&compared["tip_mm"], 2.0 * 0.020 * libm::sin(PI / 3.0), 1e-9);
    assert_eq!(compared["tip_shares"][0]["of"], "position of A");
    close(&compared["tip_shares"][0]["differs_by"], 0.020, 1e-12);
    // The grid of C has its half turn at the end.
    let compared = compare(&["--set", "axis.C.point=[0.020, 0, 0]"]);
    close(&compared["tip_mm"], 0.040, 1e-9);
    // Along its own direction a point may lie anywhere.
    let compared = compare(&["--set", "axis.C.point=[0, 0, -80]"]);
    close(&compared["tip_mm"], 0.0, 1e-12);
}

/// C leaning by e takes a tool that is upright at C 0 to 2·e after half a turn.
#[test]
fn a_leaning_c_turns_the_tool_axis_by_twice_its_lean() {
    let compared = compare(&["--set", "axis.C.rotary=[0, 40e-6, 1]"]);
    close(&compared["axis_deg"], (80e-6f64).to_degrees(), 1e-7);
    assert_eq!(compared["axis_shares"][0]["of"], "direction of C");
}

/// A table that is set between cuts may start anywhere; words still count from its zero. Its line 30 µm aside
/// moves the tip by the diameter after half a turn.
#[test]
fn an_indexed_table_is_compared_over_its_travel() {
    for start in ["0", "30"] {
        let start = format!("axis.B.indexed={start}");
        let (compared, _) = check(&[
            "disc-cutter",
            "--nominal",
            "disc-cutter",
            "--set",
            &start,
            "--set",
            "axis.B.point=[0.03, 0, -500]",
        ]);
        close(&compared["tip_mm"], 0.06, 1e-9);
        assert_eq!(compared["tip_shares"][0]["of"], "position of B");
    }
}

/// Every line of the fork head that was measured is told with its own part.
#[test]
fn a_measured_head_is_compared() {
    let (compared, _) = check(&[
        "tests/measured/measured-head.toml",
        "--nominal",
        "head-head",
        "--tool-length",
        "150",
    ]);
    let shares = compared["tip_shares"].as_array().unwrap();
    let named: Vec<&str> = shares.iter().map(|share| share["of"].as_str().unwrap()).collect();
    for of in [
        "direction of A",
        "position of A",
        "direction of C",
        "position of C",
        "direction of Y",
        "direction of Z",
    ] {
        assert!(named.contains(&of), "{of} is not in {named:?}");
    }
}

#[test]
fn machines_with_other_axes_are_not_compared() {
    let run = post(&["check", "ac-trunnion", "--nominal", "dmu50"]);
    assert_eq!((run.code, run.out.as_str()), (1, ""));
    assert!(run.err.contains("error[check-nominal]"), "{}", run.err);
}

/// The machine of `tests/measured/measured.toml`, from its numbers and by isometries alone: where the tip stands
/// at the words of a program.
struct Measured {
    length: f64,
    linear: Matrix3<f64>,
}

impl Measured {
    fn new(length: f64) -> Self {
        // X, Y, Z: unit vectors along the measured lines.
        let x = Vector3::x();
        let y = Vector3::new(-60e-6, 1.0, 0.0).normalize();
        let z = Vector3::new(80e-6, 40e-6, 1.0).normalize();
        Self { length, linear: Matrix3::from_columns(&[x, y, z]) }
    }

    fn turn(direction: Vector3<f64>, point: Vector3<f64>, degrees: f64) -> Isometry3<f64> {
        let line = Translation3::from(point);
        let turn =
            UnitQuaternion::from_axis_angle(&Unit::new_normalize(direction), degrees.to_radians());
        line * turn * line.inverse()
    }

    /// Tip in the part frame at the words X, Y, Z, A, C.
    fn tip(&self, [x, y, z, a, c]: [f64; 5]) -> Vector3<f64> {
        let tip = Vector3::new(0.0, 0.0, 400.0 - self.length);
        // A word counts from where the tip stands on the part origin.
        let zero = self.linear.try_inverse().unwrap() * -tip;
        let moved = tip + self.linear * (zero + Vector3::new(x, y, z));
        let c = Self::turn(Vector3::new(-45e-6, -30e-6, 1.0), Vector3::new(0.018, -0.012, 0.0), c);
        let a = Self::turn(
            Vector3::new(1.0, -70e-6, -50e-6),
            Vector3::new(0.0, 0.032, 50.004 - 0.015),
            a,
        );
        (c * a * Point3::from(moved)).coords
    }
}

/// The points of the sample: a spiral around a dome, the tool leaning outwards.
fn dome() -> Vec<(Vector3<f64>, Vector3<f64>)> {
    (0..=240)
        .map(|step| {
            let (sine, cosine) = libm::sincos(f64::from(step) * 0.06);
            let (lean, upright) = libm::sincos((35.0 + 0.2 * f64::from(step)).to_radians());
            let axis = Vector3::new(lean * cosine, lean * sine, upright);
            (Vector3::new(5.0, -3.0, 20.0) + axis * 60.0, axis)
        })
        .collect()
}

/// Words X, Y, Z, A, C of every motion from the first that has all of them in force.
fn words(program: &str) -> Vec<[f64; 5]> {
    let mut now = [None; 5];
    let mut all = Vec::new();
    for line in program.lines().filter(|line| !line.starts_with(['(', '%'])) {
        if line.contains("G53") || line.contains("G28") {
            continue;
        }
        let mut moved = false;
        for word in line.split_whitespace() {
            if let Some(index) =
                ["X", "Y", "Z", "A", "C"].iter().position(|name| word.starts_with(name))
            {
                now[index] = Some(word[1..].parse().unwrap());
                moved = true;
            }
        }
        if let (true, [Some(x), Some(y), Some(z), Some(a), Some(c)]) = (moved, now) {
            all.push([x, y, z, a, c]);
        }
    }
    all
}

/// Largest distance of the tip from the path of the CL file, between the blocks' ends as well, on the measured machine.
fn stray(program: &str, length: f64) -> f64 {
    let machine = Measured::new(length);
    let path = dome();
    let distance = |point: Vector3<f64>| {
        path.windows(2)
            .map(|pair| {
                let along = pair[1].0 - pair[0].0;
                let t = ((point - pair[0].0).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                (point - pair[0].0 - along * t).norm()
            })
            .fold(f64::INFINITY, f64::min)
    };
    let words = words(program);
    assert!(words.len() > path.len(), "{} blocks", words.len());
    let mut largest = 0f64;
    for pair in words.windows(2) {
        for step in 0..=4 {
            let t = f64::from(step) / 4.0;
            let between =
                std::array::from_fn(|index| pair[0][index] * (1.0 - t) + pair[1][index] * t);
            largest = largest.max(distance(machine.tip(between)));
        }
    }
    largest
}

#[test]
fn posting_with_the_measured_file_takes_the_errors_out() {
    const LENGTH: f64 = 100.0;
    let mut text =
        String::from("UNITS/MM\nMULTAX/ON\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/500,MMPM\n");
    for (tip, axis) in dome() {
        text.push_str(&format!(
            "GOTO/{:.6},{:.6},{:.6},{:.9},{:.9},{:.9}\n",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        ));
    }
    text.push_str("END\nFINI\n");
    let folder = tempfile::tempdir().unwrap();
    let cl = folder.path().join("dome.cls");
    fs::write(&cl, text).unwrap();
    let program = |machine: &str| {
        let run = post(&[
            "-m",
            machine,
            "-o",
            "-",
            "-q",
            "--tcp",
            "post",
            "--tool-length",
            "100",
            "--set",
            "control.dialect=\"linuxcnc\"",
            cl.to_str().unwrap(),
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
        run.out
    };
    let (compared, _) = check(&[MEASURED, "--nominal", "ac-trunnion", "--tool-length", "100"]);
    let predicted = compared["tip_mm"].as_f64().unwrap();
    let tolerance = 0.005;
    let drawn = stray(&program("ac-trunnion"), LENGTH);
    let measured = stray(&program(MEASURED), LENGTH);
    assert!(drawn > 0.03, "the drawing's program is off by {drawn} mm alone");
    assert!(drawn < predicted + tolerance, "{drawn} mm, {predicted} mm were predicted");
    assert!(measured < tolerance + 1e-6, "{measured} mm are left");
}

// The picture.

#[test]
fn the_picture_is_drawn_in_numbers_and_labelled() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("reach.svg");
    for machine in ["ac-trunnion", "vmc"] {
        let run = post(&["check", machine, "--svg", path.to_str().unwrap()]);
        assert_eq!(run.code, 0, "{}", run.err);
        let svg = fs::read_to_string(&path).unwrap();
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        for label in ["tilt from +Z", "degrees", ">90°<", "0° +X", "90° +Y"] {
            assert!(svg.contains(label), "{label} is not in the picture of {machine}");
        }
    }
}

// The commissioning program.

/// Words in force after each motion, and the remarks and stops between.
fn blocks(program: &str, names: &[&str]) -> Vec<(String, BTreeMap<String, f64>)> {
    let mut now = BTreeMap::new();
    program
        .lines()
        .map(|line| {
            let code = line.trim_start_matches(|c: char| c.is_ascii_digit()).trim();
            let remark = code.starts_with('(') || code.starts_with(';');
            if !remark && !code.contains("G28") && !code.contains("G53") {
                for word in code.split_whitespace() {
                    if let Some(name) = names.iter().find(|name| word.starts_with(**name))
                        && let Ok(value) = word[1..].trim_start_matches('+').parse::<f64>()
                    {
                        now.insert((*name).to_owned(), value);
                    }
                }
            }
            (code.to_owned(), now.clone())
        })
        .collect()
}

/// In every dialect, with and without TCP in the machine file: each block moves one axis, the readings told are
/// those in force, no axis leaves its travel, and nothing puts TCP or a tool length in force.
#[test]
fn the_commissioning_program_moves_one_axis_at_a_time() {
    for (machine, names, dialect) in [
        ("ac-trunnion", ["X", "Y", "Z", "A", "C"], "fanuc"),
        ("ac-trunnion", ["X", "Y", "Z", "A", "C"], "linuxcnc"),
        ("dmu50", ["X", "Y", "Z", "B", "C"], "heidenhain"),
        ("nutating-head", ["X", "Y", "Z", "B", "C"], "heidenhain"),
        ("head-head", ["X", "Y", "Z", "A", "C"], "fanuc"),
    ] {
        let dialect = format!("control.dialect=\"{dialect}\"");
        let run = post(&[
            "check",
            machine,
            "--commission",
            "-o",
            "-",
            "--set",
            &dialect,
            "--set",
            "control.tcp=\"control\"",
        ]);
        assert_eq!(run.code, 0, "{}", run.err);
        check_numbers(&run.out);
        for word in ["G43", "M128", "M428", "G0 X", "FMAX M91", "M3"] {
            let found = run.out.lines().any(|line| {
                line.contains(word)
                    && !line.starts_with('(')
                    && !line.ends_with("M30")
                    && !line.contains("G53")
            });
            assert!(!found, "{word} in:\n{}", run.out);
        }
        let blocks = blocks(&run.out, &names);
        let mut before: Option<BTreeMap<String, f64>> = None;
        let mut moves = 0;
        for (line, now) in &blocks {
            if let Some(before) = &before
                && before.len() == 5
            {
                let changed = names.iter().filter(|name| before[**name] != now[**name]);
                let changed = changed.count();
                assert!(changed <= 1, "{line} moves {changed} axes:\n{}", run.out);
                moves += changed;
            }
            before = Some(now.clone());
        }
        // There and back for both senses of five axes; the nutating head's B goes one way alone.
        let wanted = if machine == "nutating-head" { 18 } else { 20 };
        assert_eq!(moves, wanted, "{machine}:\n{}", run.out);
        readings_are_those_in_force(&blocks, &names);
        let head: String = run.out.lines().take(30).collect::<Vec<_>>().join(" ").to_uppercase();
        assert!(head.contains("WITHOUT A PART"), "{head}");
        assert!(head.contains("FEED OVERRIDE"), "{head}");
    }
}

/// Where words hold several axes, or multiples, one axis moves all the same: those of the others follow it. The axes are worked
/// out of the words here.
#[test]
fn the_commissioning_program_moves_one_axis_where_words_are_coupled() {
    let names = ["X", "Y", "Z", "B", "C"];
    let sets = ["--set", "word.B.is=B - 0.5 * C", "--set", "word.X.is=2 * X"];
    let run = post(&[&["check", "bc-fork", "--commission", "-o", "-"][..], &sets].concat());
    assert_eq!(run.code, 0, "{}", run.err);
    let blocks = blocks(&run.out, &names);
    readings_are_those_in_force(&blocks, &names);
    let axes = |now: &BTreeMap<String, f64>| {
        let word = |name: &str| now[name];
        [word("X") / 2.0, word("Y"), word("Z"), word("B") + 0.5 * word("C"), word("C")]
    };
    let whole = blocks.iter().filter(|(_, now)| now.len() == names.len());
    let stood: Vec<[f64; 5]> = whole.map(|(_, now)| axes(now)).collect();
    let mut ways = [0.0f64; 5];
    for pair in stood.windows(2) {
        let moved: Vec<usize> =
            (0..5).filter(|axis| (pair[1][*axis] - pair[0][*axis]).abs() > 0.0015).collect();
        assert!(moved.len() <= 1, "{moved:?} move:\n{}", run.out);
        for axis in moved {
            ways[axis] = ways[axis].max((pair[1][axis] - pair[0][axis]).abs());
        }
    }
    assert!(ways.iter().all(|way| *way > 10.0), "{ways:?}");
    assert!(ways[0] <= 100.0 + 1e-9, "X goes farther than is told: {}", ways[0]);
}

/// Every remark that tells the display, over its lines, against the words.
fn readings_are_those_in_force(blocks: &[(String, BTreeMap<String, f64>)], names: &[&str]) {
    let mut told = 0;
    for (index, (line, now)) in blocks.iter().enumerate() {
        if !line.to_uppercase().contains("THE DISPLAY SHOWS") || now.len() < names.len() {
            continue;
        }
        let mut text = String::new();
        for (line, _) in &blocks[index..] {
            if line.starts_with('M') {
                break;
            }
            text.push_str(&line.replace(['(', ')', ';'], " "));
            text.push(' ');
        }
        let all: Vec<&str> = text.split_whitespace().collect();
        for name in names {
            let place = all.iter().position(|word| word == name).unwrap();
            let value: f64 = all[place + 1].parse().unwrap();
            assert_eq!(value, now[*name], "{name}: {text}");
        }
        told += 1;
    }
    assert!(told >= 9, "{told} readings");
}

#[test]
fn the_commissioning_program_has_its_dialects_ending() {
    let folder = tempfile::tempdir().unwrap();
    let run = common::run(
        common::command().current_dir(folder.path()).args(["check", "dmu50", "--commission"]),
        b"",
    );
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(folder.path().join("commission.h").is_file());
}

/// An axis with positions goes to one of them, and is let go and clamped around the move.
#[test]
fn an_indexed_table_is_let_go_and_clamped() {
    let run = post(&[
        "check",
        "disc-cutter",
        "--commission",
        "-o",
        "-",
        "--set",
        "axis.B.positions=[0, 60, 120]",
        "--set",
        "axis.B.clamp=\"M10\"",
        "--set",
        "axis.B.unclamp=\"M11\"",
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let lines: Vec<&str> = run.out.lines().collect();
    let off = lines.iter().position(|line| *line == "M11").unwrap();
    assert!(lines[off + 1].contains("B120."), "{}", run.out);
    assert!(lines.contains(&"M10"));
}

// Under review.

const REVIEWED: &[&str] = &["ac-trunnion", "head-head", "nutating-head", "disc-cutter", "vmc"];

const COMMISSIONED: &[(&str, &str)] = &[
    ("ac-trunnion", "commission_fanuc"),
    ("disc-cutter", "commission_linuxcnc"),
    ("dmu50", "commission_heidenhain"),
];

/// The whole output for machines of each kind: after a change read it beside the machine file, then accept it.
#[test]
fn the_checks_are_those_that_were_reviewed() {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(root().join("tests/snapshots/check"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| {
        for machine in REVIEWED {
            let run = post(&["check", machine]);
            assert_eq!(run.code, 0, "{}", run.err);
            // Rounding errors of the round trip are no matter of review.
            let lines = run.out.lines().map(|line| match line.split_once(": tip off") {
                Some((head, _)) => head,
                None => line,
            });
            let text: Vec<&str> = lines.collect();
            insta::assert_snapshot!(*machine, format!("{}{}", run.err, text.join("\n")));
        }
        let run = post(&["check", MEASURED, "--nominal", "ac-trunnion", "--tool-length", "100"]);
        insta::assert_snapshot!("measured_nominal", run.out);
        for (machine, name) in COMMISSIONED {
            let run = post(&["check", machine, "--commission", "-o", "-"]);
            assert_eq!(run.code, 0, "{}", run.err);
            insta::assert_snapshot!(*name, run.out);
        }
    });
}

#[test]
fn the_files_for_tests_are_machines() {
    for entry in fs::read_dir(root().join("tests/measured")).unwrap() {
        let path = entry.unwrap().path();
        let run = post(&["check", path.to_str().unwrap()]);
        assert_eq!(run.code, 0, "{}: {}", path.display(), run.err);
    }
    assert!(Path::new(root()).join(MEASURED).is_file());
}

#[test]
fn a_head_that_the_program_swaps_in_is_checked_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.toml");
    let text =
        "extends = \"head-head\"\nname = \"two heads\"\n[head.long.tool]\ngauge = [0, 0, -150]\n";
    fs::write(&path, text).unwrap();
    let path = path.to_str().unwrap();
    let (first, run) = check(&[path]);
    assert!(run.out.contains("further heads, see --head: long"), "{}", run.out);
    let (long, _) = check(&[path, "--head", "long"]);
    close(&first["class"]["distances"][1]["value"], 250.0, 1e-9);
    close(&long["class"]["distances"][1]["value"], 400.0, 1e-9);
    let none = post(&["check", path, "--head", "short"]);
    assert_eq!(none.code, 1);
    assert!(none.err.contains("its heads are long"), "{}", none.err);
}

#[test]
fn no_reviewed_check_is_left_over() {
    let mut found: Vec<String> = fs::read_dir(root().join("tests/snapshots/check"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    found.sort();
    let mut names = REVIEWED.to_vec();
    names.extend(["measured_nominal"]);
    names.extend(COMMISSIONED.iter().map(|(_, name)| *name));
    names.sort_unstable();
    let names: Vec<String> = names.iter().map(|name| format!("{name}.snap")).collect();
    assert_eq!(found, names);
}
