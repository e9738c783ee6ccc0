//! CL files that CAM systems wrote, on the machines that can make them, and refused where none can.
//!
//! Some of the programs are read back here by a reader and a kinematics of this test's own, which share no
//! code with the command: the machine's numbers are written out again, as matrices.

pub mod posted;
mod read_back;
mod reduced;

use crate::common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use common::{Run, check_numbers, command, read_json, root, run, sample};
use nalgebra::{Rotation3, Unit, Vector3};
use post_testkit::{all_drawn, drawn, shared};
use serde_json::Value;

type V = Vector3<f64>;

fn post(file: &Path, machine: &str, with: &str) -> (Run, Option<Value>) {
    let folder = tempfile::tempdir().unwrap();
    let json = folder.path().join("s.json");
    // Most of the files say neither how fast the spindle turns nor how long the tool is.
    let length = match with.contains("--tool-length") {
        true => "",
        false => "--tool-length 0",
    };
    let done = run(
        command()
            .args(["-q", "-m", machine, "-o", "-", "--summary"])
            .arg(&json)
            .args(["--spindle", "6000"])
            .args(length.split_whitespace())
            .args(with.split_whitespace())
            .arg(file),
        b"",
    );
    let summary = json.is_file().then(|| read_json(&json));
    (done, summary)
}

// Reading back.

/// A pose of the tool in the part frame: tip in mm, unit axis.
#[derive(Clone, Copy, Debug)]
struct Pose {
    tip: V,
    axis: V,
}

/// The points of a CL file in which every move is a GOTO: modal axes, `$`, MSYS if asked for.
fn cl_points(text: &str, scale: f64, apply_msys: bool) -> Vec<Pose> {
    let mut joined = String::new();
    for line in text.lines().map(str::trim_end) {
        match line.strip_suffix('$') {
            Some(part) if !line.starts_with("$$") => joined.push_str(part),
            _ => {
                joined.push_str(line);
                joined.push('\n');
            }
        }
    }
    let mut axis = V::z();
    let mut frame: Option<(V, V, V)> = None;
    let mut points = Vec::new();
    for line in joined.lines() {
        let Some((word, numbers)) = line.split_once('/') else {
            continue;
        };
        let numbers: Vec<f64> =
            numbers.split(',').filter_map(|number| number.trim().parse().ok()).collect();
        let at = |from: usize| V::new(numbers[from], numbers[from + 1], numbers[from + 2]);
        match word.trim() {
            "TOOL PATH" => axis = V::z(),
            "MSYS" if apply_msys => frame = Some((at(0) * scale, at(3), at(6))),
            "GOTO" => {
                if numbers.len() == 6 {
                    axis = at(3).normalize();
                }
                let (mut tip, mut turned) = (at(0) * scale, axis);
                if let Some((origin, x, y)) = frame {
                    let z = x.cross(&y);
                    let into = |v: V| V::new(x.dot(&v), y.dot(&v), z.dot(&v));
                    tip = into(tip - origin);
                    turned = into(turned);
                }
                points.push(Pose { tip, axis: turned });
            }
            word => assert_ne!(word, "CIRCLE", "this reader knows points alone"),
        }
    }
    points
}

/// Where a block ends: X Y Z A B C as programmed, and whether it is a rapid.
#[derive(Clone, Copy, Debug)]
struct Block {
    words: [f64; 6],
    rapid: bool,
}

/// The motion blocks of a program, ISO or conversational, once all of `letters` have been programmed.
fn nc_blocks(program: &str, letters: &str) -> Vec<Block> {
    let mut words = [0.0; 6];
    let mut known = BTreeSet::new();
    let mut rapid = true;
    let mut blocks = Vec::new();
    for line in program.lines() {
        let code = line.split(['(', ';']).next().unwrap();
        // Retracts are in machine coordinates or steps; cycles and tools have words of their own.
        if ["G28", "G53", "M91", "M140", "CYCL", "TOOL", "BLK"]
            .iter()
            .any(|word| code.contains(word))
        {
            continue;
        }
        if code.trim_start_matches(|c: char| c.is_ascii_digit()).starts_with(" L ") {
            rapid = code.contains("FMAX");
        }
        let mut moved = false;
        for word in code.split_whitespace() {
            match word {
                "G0" => rapid = true,
                "G1" => rapid = false,
                _ => {
                    let letter = word.chars().next().unwrap();
                    if let (Some(place), Ok(value)) = ("XYZABC".find(letter), word[1..].parse()) {
                        words[place] = value;
                        known.insert(letter);
                        moved = true;
                    }
                }
            }
        }
        if moved && letters.chars().all(|letter| known.contains(&letter)) {
            blocks.push(Block { words, rapid });
        }
    }
    blocks
}

fn turn(direction: [f64; 3], degrees: f64) -> Rotation3<f64> {
    let direction = Unit::new_normalize(V::from(direction));
    Rotation3::from_axis_angle(&direction, degrees.to_radians())
}

/// `v` turned about a line through `point`.
fn about(point: V, rotation: Rotation3<f64>, v: V) -> V {
    rotation * (v - point) + point
}

const X: [f64; 3] = [1.0, 0.0, 0.0];

const Y: [f64; 3] = [0.0, 1.0, 0.0];

const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Forward kinematics from the words of a program without TCP. With the rotary axes at zero the words are the
/// tip in the part frame; the part frame stands at `mount`.
type Forward = fn(words: [f64; 6], mount: V, tool: f64) -> Pose;

fn ac_trunnion([x, y, z, a, _, c]: [f64; 6], mount: V, _: f64) -> Pose {
    let (a, c) = (turn(X, a), turn(Z, c));
    let pivot = V::new(0.0, 0.012, 50.004);
    Pose { tip: c * about(pivot, a, V::new(x, y, z) + mount) - mount, axis: c * a * V::z() }
}

fn dmu50([x, y, z, _, b, c]: [f64; 6], mount: V, _: f64) -> Pose {
    let (b, c) = (turn(Y, b), turn(Z, c));
    let pivot = V::new(0.0, 0.0, -50.0);
    Pose { tip: c * about(pivot, b, V::new(x, y, z) + mount) - mount, axis: c * b * V::z() }
}

fn head_head([x, y, z, a, _, c]: [f64; 6], _: V, tool: f64) -> Pose {
    let (a, c) = (turn(X, a), turn(Z, c));
    let swing = V::new(0.0, 0.0, 250.0 + tool);
    Pose { tip: V::new(x, y, z) + swing - c * a * swing, axis: c * a * V::z() }
}

fn nutating_head([x, y, z, _, b, c]: [f64; 6], mount: V, tool: f64) -> Pose {
    let (b, c) = (turn([0.0, 1.0, 1.0], b), turn(Z, c));
    // From the point where the B axis meets the spindle axis down to the tip.
    let swing = V::new(0.0, 0.0, 680.0 - 500.0 + tool);
    Pose { tip: c * (V::new(x, y, z) + mount + swing - b * swing) - mount, axis: c * b * V::z() }
}

fn disc_cutter([x, y, z, a, b, c]: [f64; 6], mount: V, tool: f64) -> Pose {
    let (a, b, c) = (turn(X, a), turn(Y, b), turn(Z, c));
    let swing = V::new(0.0, 0.0, 312.0 + tool);
    let tip = V::new(x, y, z) + mount + swing - c * a * swing;
    Pose { tip: about(V::new(0.0, 0.0, -500.0), b, tip) - mount, axis: b * c * a * V::z() }
}

/// Degrees between two unit vectors.
fn angle(a: V, b: V) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b)).to_degrees()
}

/// The least value of a function with one valley between `low` and `high`.
fn least(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..30 {
        let third = (high - low) / 3.0;
        if of(low + third) < of(high - third) {
            high -= third;
        } else {
            low += third;
        }
    }
    of((low + high) / 2.0)
}

#[derive(Clone, Copy)]
struct Check {
    name: &'static str,
    machine: &'static str,
    with: &'static str,
    scale: f64,
    letters: &'static str,
    forward: Forward,
    mount: [f64; 3],
    tool: f64,
    /// How the part is turned about its Z, degrees.
    turned: f64,
}

const fn check(
    name: &'static str,
    machine: &'static str,
    with: &'static str,
    letters: &'static str,
    forward: Forward,
) -> Check {
    Check {
        name,
        machine,
        with,
        scale: 1.0,
        letters,
        forward,
        mount: [0.0; 3],
        tool: 0.0,
        turned: 0.0,
    }
}
