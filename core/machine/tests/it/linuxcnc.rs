//! Every pose that LinuxCNC's own kinematics modules computed (`shared/data/kinematics`), through machine files
//! as a builder would write them: its tables turn the other way, which `reversed = true` is made for.

use std::fs;

use nalgebra::Vector3;
use post_machine::description::{Machine, Setting, Source, load};
use post_machine::kinematics::{Joints, Pose};
use post_testkit::shared;
use post_testmachines::{angle, turned};

/// A table that turns by `letter` under C, both the other way; R and d are the module's.
fn table(letter: &str, direction: &str) -> String {
    format!(
        r#"
name = "table"
chain = "[w C' {letter}' b X Y Z t]"
parameters = {{ Rx = 0, Ry = 0, Rz = 0, dx = 0, dy = 0, dz = 0 }}
tool = {{ gauge = [0, 0, 0] }}
[axis.C]
rotary = [0, 0, 1]
point = ["Rx", "Ry", "Rz"]
reversed = true
cyclic = true
[axis.{letter}]
rotary = {direction}
point = ["Rx + dx", "Ry + dy", "Rz + dz"]
reversed = true
cyclic = true
"#
    )
}

const HEAD: &str = r#"
name = "head"
chain = "[w b X Y Z C B t]"
parameters = { P = 0 }
tool = { gauge = [0, 0, 0] }
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, "P"]
cyclic = true
[axis.B]
rotary = [0, 1, 0]
point = [0, 0, "P"]
reversed = true
cyclic = true
"#;

const LINEAR: &str = r#"
[axis]
X = { linear = [1, 0, 0], travel = [-1e5, 1e5] }
Y = { linear = [0, 1, 0], travel = [-1e5, 1e5] }
Z = { linear = [0, 0, 1], travel = [-1e5, 1e5] }
[control]
dialect = "linuxcnc"
tcp = "post"
"#;

/// One file: its machine, and its rows.
struct Table {
    machine: Machine,
    /// The tool length of every row.
    length: f64,
    rows: Vec<Vec<f64>>,
}

/// None if the data are not at hand, which is a failure in CI.
fn read(name: &str, rotary: &str) -> Option<Table> {
    let text =
        fs::read_to_string(shared(&format!("data/kinematics/{name}"))?).expect("a readable file");
    // The header names the module's settings: `pins: x-rot-point=3 …`.
    let pins = text.lines().next()?.split("pins:").nth(1)?;
    let mut settings = Vec::new();
    let mut length = 0.0;
    for pin in pins.split_whitespace() {
        let (pin, value) = pin.split_once('=').expect("pin=value");
        let parameter = match pin {
            "x-rot-point" => "Rx",
            "y-rot-point" => "Ry",
            "z-rot-point" => "Rz",
            "x-offset" => "dx",
            "y-offset" => "dy",
            "z-offset" => "dz",
            "pivot-length" => "P",
            "tool-offset" => {
                length = value.parse().expect("a length");
                continue;
            }
            other => panic!("{name} has a pin {other}"),
        };
        settings.push(Setting::Written(format!("{parameter}={value}")));
    }
    let source = Source {
        name: name.to_owned(),
        // `[axis]` after `[axis.C]` is one table in TOML only if it comes first.
        text: rotary.replacen("[axis.C]", &format!("{LINEAR}[axis.C]"), 1),
    };
    let machine = load(source, &settings, &mut |_| Err(String::new()))
        .unwrap_or_else(|faults| panic!("{name}: {faults:?}"));
    let numbers = |line: &str| -> Vec<f64> {
        line.split(',').map(|field| field.trim().parse().expect("a number")).collect()
    };
    let rows: Vec<_> = text
        .lines()
        .filter(|line| !line.starts_with(['#', 'p']) && !line.trim().is_empty())
        .map(numbers)
        .collect();
    assert!(rows.len() >= 500, "{name} has {} rows", rows.len());
    Some(Table { machine, length, rows })
}

/// Forward at the joints is the pose, and the inverse of the pose has the joints among its solutions.
/// `order` names the joints in the columns of the file; W lengthens the tool. Gives the worst of each, mm.
fn check(name: &str, rotary: &str, order: &str) {
    let Some(table) = read(name, rotary) else {
        return;
    };
    let machine = &table.machine;
    let (mut tip_error, mut axis_error, mut joint_error): (f64, f64, f64) = (0.0, 0.0, 0.0);
    for row in &table.rows {
        let (pose, columns) = row.split_at(9);
        let mut joints: Joints = Default::default();
        let mut length = table.length;
        for (letter, value) in order.chars().zip(columns) {
            match machine.axes.iter().position(|axis| axis.name == letter.to_string()) {
                Some(place) if machine.axes[place].joint.rotary => {
                    joints[place] = value.to_radians();
                }
                Some(place) => joints[place] = *value,
                None => length += value,
            }
        }
        let solver = machine.solver(length).expect("a closed form");
        let reached = solver.chain().forward(&joints);
        // The tool length is part of the pose's z.
        let tip = Vector3::new(pose[0], pose[1], pose[2] - table.length);
        tip_error = tip_error.max((reached.tip - tip).norm());
        let axis = law(order, pose);
        axis_error = axis_error.max(angle(reached.axis, axis));
        let solutions = solver
            .inverse(&Pose { tip, axis, ..Pose::default() }, &joints, 1e-9)
            .unwrap_or_else(|fault| panic!("{name}: {fault:?} at {row:?}"));
        let nearest = solutions
            .iter()
            .map(|solution| {
                (0..machine.axes.len())
                    .map(|place| {
                        if machine.axes[place].joint.rotary {
                            turned(joints[place], solution[place]).abs().to_degrees()
                        } else {
                            (joints[place] - solution[place]).abs()
                        }
                    })
                    .fold(0.0, f64::max)
            })
            .fold(f64::INFINITY, f64::min);
        joint_error = joint_error.max(nearest);
    }
    eprintln!(
        "{name}: {} rows, tip {tip_error:.1e} mm, axis {axis_error:.1e} rad, joints {joint_error:.1e} mm or deg",
        table.rows.len()
    );
    assert!(tip_error < 1e-9, "{name}: tip off by {tip_error} mm");
    assert!(axis_error < 1e-12, "{name}: axis off by {axis_error}");
    // One row stands 0.016° beside the pole, where angles lose seven digits.
    assert!(joint_error < 1e-7, "{name}: joints off by {joint_error}");
}

/// The tool axis of a pose as the README of the data gives it, written out.
fn law(order: &str, pose: &[f64]) -> Vector3<f64> {
    let [(sa, ca), (sb, cb), (sc, cc)] =
        [3, 4, 5].map(|column: usize| libm::sincos(pose[column].to_radians()));
    match order {
        // Rz(-C)·Rx(-A)·ez
        "XYZAC" => Vector3::new(sc * sa, cc * sa, ca),
        // Rz(-C)·Ry(-B)·ez
        "XYZBC" => Vector3::new(-cc * sb, sc * sb, cb),
        // Rz(C)·Ry(-B)·ez
        _ => Vector3::new(-cc * sb, -sc * sb, cb),
    }
}

#[test]
fn trunnion_xyzac() {
    let rotary = table("A", "[1, 0, 0]");
    check("ik_xyzac_plain.csv", &rotary, "XYZAC");
    check("ik_xyzac_offsets.csv", &rotary, "XYZAC");
}

#[test]
fn trunnion_xyzbc() {
    check("ik_xyzbc_plain.csv", &table("B", "[0, 1, 0]"), "XYZBC");
}

#[test]
fn bridge_head() {
    check("ik_5axiskins_headhead.csv", HEAD, "XYZBCW");
}
