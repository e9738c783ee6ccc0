//! Robots: what is beyond the tool's pose stands still, or gives way without winding up.

use std::fs;

use crate::common::post;
use post_testruns::read_back::{Model, angle, blocks, points};

/// A cut three times around a bowl, the tool leaning outwards by 30 degrees.
fn bowl() -> String {
    let mut text = String::from("TOOL PATH/BOWL,TOOL,T1\nLOAD/TOOL,1\nSPINDL/RPM,9000,CLW\n");
    let goto = |tip: [f64; 3], axis: [f64; 3]| {
        let ([x, y, z], [i, j, k]) = (tip, axis);
        format!("GOTO/{x:.4},{y:.4},{z:.4},{i:.9},{j:.9},{k:.9}\n")
    };
    for step in 0..=108 {
        let (sine, cosine) = libm::sincos(f64::from(step) * std::f64::consts::PI / 18.0);
        let (lean, up) = libm::sincos(0.52);
        let axis = [lean * cosine, lean * sine, up];
        let tip = [50.0 * cosine, 50.0 * sine, -0.1 * f64::from(step)];
        let above = std::array::from_fn(|place| tip[place] + 40.0 * axis[place]);
        match step {
            0 => {
                text += &format!("RAPID\n{}FEDRAT/900,MMPM\n{}", goto(above, axis), goto(tip, axis))
            }
            108 => text += &format!("{}RAPID\n{}", goto(tip, axis), goto(above, axis)),
            _ => text += &goto(tip, axis),
        }
    }
    text + "SPINDL/OFF\nEND-OF-PATH\nFINI\n"
}

/// The blocks of a program of `machine`, the tool being `length` long, each within tolerance of the CL file's next points.
fn posted(machine: &str, length: f64, text: &str) -> Vec<Vec<f64>> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, text).unwrap();
    let length_said = length.to_string();
    let run = post(&[
        "-q",
        "-m",
        machine,
        "--tool-length",
        &length_said,
        "-o",
        "-",
        file.to_str().unwrap(),
    ]);
    assert_eq!(run.code, 0, "{}", run.err);
    let model = Model::new(machine, None);
    let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
    let blocks = blocks(&run.out, &names, &[]);
    let mut next = 0;
    for point in points(text) {
        let near = |block: &post_testruns::read_back::Block| {
            let pose = model.pose(&block.words, length);
            (pose.tip - point.tip).norm() < 0.005 && angle(pose.axis, point.axis) < 0.11
        };
        let found = blocks[next..].iter().position(near);
        next += found.unwrap_or_else(|| panic!("CL line {} is not met", point.line));
    }
    blocks.into_iter().map(|block| block.words).collect()
}

/// How far a word goes in all.
fn span(words: &[Vec<f64>], place: usize) -> f64 {
    let values = || words.iter().map(|words| words[place]);
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// A spindle across the flange goes around a bowl again and again, and no axis winds up.
#[test]
fn an_arm_goes_around_a_bowl_without_winding_up() {
    let words = posted("irb4600-rail", 100.0, &bowl());
    for (axis, name) in [(4, "U"), (6, "W")] {
        assert!(span(&words, axis) < 200.0, "{name} goes {}", span(&words, axis));
    }
}

/// A rail stands still while the arm reaches all that is asked for, and goes along where it does not.
#[test]
fn a_rail_stands_still_where_the_arm_reaches() {
    let holes = |apart: f64| {
        let hole = |place: i32| {
            let y = apart * f64::from(place);
            format!(
                "RAPID\nGOTO/0,{y},30,0,0,1\nFEDRAT/500,MMPM\nGOTO/0,{y},0\nRAPID\nGOTO/0,{y},30\n"
            )
        };
        let holes: String = (-3..=3).map(hole).collect();
        format!(
            "TOOL PATH/HOLES,TOOL,T1\nLOAD/TOOL,1\nSPINDL/RPM,9000,CLW\n{holes}SPINDL/OFF\nFINI\n"
        )
    };
    let near = posted("irb4600-rail", 100.0, &holes(15.0));
    assert!(span(&near, 0) == 0.0, "the rail goes {}", span(&near, 0));
    let far = posted("irb4600-rail", 100.0, &holes(700.0));
    assert!(span(&far, 0) > 1000.0, "the rail goes {}", span(&far, 0));
}
