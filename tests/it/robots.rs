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

/// A cut 10 mm into a face of a block whose outward normal is `axis`, 30 mm from the part's origin, and 15 mm along it; the
/// tool comes to `first`, mm out and aside, at rapid, or to 3 mm out at feed, if there is none.
fn slot(axis: [f64; 3], first: Option<[f64; 2]>) -> String {
    let aside = if axis[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let goto = |out: f64, along: f64| {
        let [x, y, z] =
            std::array::from_fn(|place| axis[place] * (30.0 + out) + aside[place] * along);
        format!("GOTO/{x:.4},{y:.4},{z:.4},{},{},{}\n", axis[0], axis[1], axis[2])
    };
    let come = match first {
        Some([out, along]) => {
            format!("RAPID\n{}RAPID\n{}", goto(out, along), goto(out, 0.0))
        }
        None => format!("FEDRAT/200\n{}", goto(3.0, 0.0)),
    };
    let cut = [goto(-10.0, 0.0), goto(-10.0, 15.0)].concat();
    let leave = goto(60.0, 15.0);
    format!(
        "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\n{come}FEDRAT/200\n{cut}RAPID\n{leave}SPINDL/OFF\nFINI\n"
    )
}

/// A program with its CL file in a folder.
struct Program {
    folder: tempfile::TempDir,
    machine: &'static str,
    length: &'static str,
    text: String,
}

impl Program {
    /// None where the machine does not reach it.
    fn of(machine: &'static str, length: &'static str, cl: &str) -> Option<Self> {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("part.cls");
        fs::write(&file, cl).unwrap();
        let job = ["-q", "-m", machine, "--tool-length", length, "-o", "-"];
        let run = post(&[&job[..], &[file.to_str().unwrap()]].concat());
        (run.code == 0).then_some(Self { folder, machine, length, text: run.out })
    }

    /// What `verify` says of a program for the same file.
    fn verified(&self, text: &str, more: &[&str]) -> crate::common::Run {
        let [cl, nc] = ["part.cls", "part.nc"].map(|name| self.folder.path().join(name));
        fs::write(&nc, text).unwrap();
        let job = ["-m", self.machine, "--tool-length", self.length];
        let [cl, nc] = [cl.to_str().unwrap(), nc.to_str().unwrap()];
        post(&[&["verify", "-q", nc, "--against", cl][..], &job, more].concat())
    }
}

/// An arm on a rail comes to its first position with all axes at once, whichever way the tool points: with the rail alone it
/// came through what it cuts. The tool then goes in along its own line, at feed too.
#[test]
fn no_first_approach_crosses_what_is_cut() {
    let mut posted = 0;
    for (machine, length) in [("irb4600-rail", "100"), ("kr6-r700", "60")] {
        for axis in [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]] {
            for first in [Some([80.0, 0.0]), Some([2.0, 60.0]), Some([0.0, 0.0]), None] {
                let Some(program) = Program::of(machine, length, &slot(axis, first)) else {
                    continue;
                };
                posted += 1;
                for more in [&[][..], &["--posted"]] {
                    let run = program.verified(&program.text, more);
                    assert_eq!(run.code, 0, "{machine} {axis:?} {first:?}: {}", run.err);
                    assert!(!run.err.contains("a rapid comes to"), "{}", run.err);
                }
                if machine == "irb4600-rail" {
                    let mut moves = program.text.lines().filter(|line| line.contains(" G0 "));
                    let moves = moves.next().unwrap();
                    assert!([" Y", " U", " A"].iter().all(|word| moves.contains(word)), "{moves}");
                }
            }
        }
    }
    assert!(posted >= 28, "{posted}");
}

/// A word of a rapid of an arm that leads the tip off its way, into the part, is told: as the program was posted, and as that
/// of another hand where the tip goes lower than all that is asked for.
#[test]
fn no_rapid_of_an_arm_leads_the_tip_astray() {
    let cl = slot([0.0, 0.0, 1.0], Some([80.0, 0.0]));
    let program = Program::of("irb4600-rail", "100", &cl).unwrap();
    let lines: Vec<&str> = program.text.lines().collect();
    let leaves = lines.iter().rposition(|line| line.contains(" G0 ")).unwrap();
    let changed = |place: usize, word: &str, by: f64| {
        let mut lines: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
        let words = lines[place].split(' ').map(|own| match own.strip_prefix(word) {
            Some(value) => format!("{word}{:.4}", value.parse::<f64>().unwrap() + by),
            None => own.to_owned(),
        });
        lines[place] = words.collect::<Vec<String>>().join(" ");
        lines.join("\n") + "\n"
    };
    for (word, by) in [("B", 20.0), ("B", 5.0), ("V", 20.0)] {
        let text = changed(leaves, word, by);
        assert_ne!(text, program.text);
        let run = program.verified(&text, &["--posted"]);
        assert!(run.err.contains("mm from all where the CL file sends it"), "{word}: {}", run.err);
        assert_eq!(run.code, 1);
    }
    let aside = program.text.replace(lines[leaves], &format!("{} Y60.000", lines[leaves]));
    let run = program.verified(&aside, &["--posted"]);
    assert!(run.err.contains("mm from all where the CL file sends it"), "{}", run.err);
    let run = program.verified(&changed(leaves, "B", 20.0), &[]);
    assert!(run.err.contains("mm lower than all that the CL file asks for"), "{}", run.err);
    assert_eq!(run.code, 1);
}

/// Words of a rail count from where it brings the tip nearest to the part origin, with the other axes at zero: so they are
/// read, wherever along the rail the part lies.
#[test]
fn words_of_a_rail_are_read_as_they_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let [cl, nc] = ["part.cls", "part.nc"].map(|name| folder.path().join(name));
    fs::write(&cl, slot([0.0, 0.0, 1.0], Some([80.0, 0.0]))).unwrap();
    let [cl, nc] = [cl.to_str().unwrap(), nc.to_str().unwrap()];
    let job = ["-m", "irb4600-rail", "--mount", "1200,400,700", "--tool-length", "100"];
    let made = post(&[&["-q", "-o", nc, cl][..], &job].concat());
    assert_eq!(made.code, 0, "{}", made.err);
    let read = post(&[&["verify", "-q", "--posted", nc, "--against", cl][..], &job].concat());
    assert_eq!(read.code, 0, "{}", read.err);
}
