//! Whole runs, from CL text to the events a dialect is asked to write, judged by nothing of the crate: the printed
//! words are taken apart again, put through the isometries of `common` and sampled densely.

mod beside;
mod curves;
mod faults;
mod feeds;
mod polar;
mod runs;
mod stream;
mod tolerance;
mod words;

use nalgebra::{Rotation3, Vector3};
use post_machine::description::{Machine, Setting, Source, load};
use post_machine::diagnostic::Severity;
use post_machine::kinematics::{Joint, Joints};
use post_plugin::Feed;
use post_posting::program::ReadingOptions;
use post_posting::{MOST_FAULTS, Post, PostingRequest};
use post_testkit::{Rng, at_least, randomised, rounds, seeded};
use post_testmachines::{Reference, angle, between, distance, slerp};
use post_testruns::posted::{self, Asked, Point, Run, Samples, cl, line, post};

fn run(machine: &Machine, cl: &str, job: PostingRequest) -> Run {
    let mut run = post(machine, 3, cl, job, &mut Samples);
    // Programs this short do not care for the spindle.
    run.findings.retain(|finding| finding.code != "spindle");
    run
}

/// A machine file, and the same numbers once more for the isometries.
struct Model {
    machine: Machine,
    reference: Reference,
    /// Places in the chain, in the order of the words.
    order: Vec<usize>,
    /// Linear positions with the tip on the part origin and every rotary axis at zero.
    zero: Vector3<f64>,
    tcp: bool,
    length: f64,
}

const LINEAR: &str = "
[axis.X]
linear = [1, 0, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Y]
linear = [0, 1, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Z]
linear = [0, 0, 1]
travel = [-5000, 5000]
max_feed = 15000
[accuracy]
tolerance = 0.005
axis_tolerance = 0.05
rapid_tolerance = 0.5
";

const MOUNT: [f64; 3] = [10.0, -20.0, 30.0];

/// Trunnion, head or nutating head; `tilt` is the travel of the axis nearer the tool, degrees.
fn model(kind: &str, tcp: bool, tilt: [f64; 2], settings: &[&str]) -> Model {
    let turn = |direction: [f64; 3], point: [f64; 3]| Joint {
        rotary: true,
        direction: Vector3::from(direction).normalize(),
        point: Vector3::from(point),
    };
    let slide =
        |direction: Vector3<f64>| Joint { rotary: false, direction, point: Vector3::zeros() };
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()].map(slide);
    // Chain, the two rotary axes, gauge, tool length; then the same for the reference.
    let (chain, second, direction, point, gauge, length, joints, order): (
        _,
        _,
        _,
        _,
        _,
        _,
        _,
        &[usize],
    ) = match kind {
        "trunnion" => (
            "[w C' A' b Y X Z t]",
            "A",
            [1.0, 0.0, 0.0],
            [0.0, 0.012, 50.004],
            400.0,
            0.0,
            vec![
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                turn([1.0, 0.0, 0.0], [0.0, 0.012, 50.004]),
                y,
                x,
                z,
            ],
            &[3, 2, 4, 1, 0],
        ),
        "head" => (
            "[w b X Y Z C A t]",
            "A",
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 250.0],
            0.0,
            120.0,
            vec![
                x,
                y,
                z,
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                turn([1.0, 0.0, 0.0], [0.0, 0.0, 250.0]),
            ],
            &[0, 1, 2, 4, 3],
        ),
        "nutating" => (
            "[w C' b X Y Z B t]",
            "B",
            [0.0, 1.0, 1.0],
            [0.0, 0.0, 680.0],
            500.0,
            0.0,
            vec![
                turn([0.0, 0.0, 1.0], [0.0; 3]),
                x,
                y,
                z,
                turn([0.0, 1.0, 1.0], [0.0, 0.0, 680.0]),
            ],
            &[1, 2, 3, 4, 0],
        ),
        other => panic!("{other}"),
    };
    let text = format!(
        r#"
name = "{kind}"
chain = "{chain}"
[workpiece]
mount = {MOUNT:?}
[tool]
gauge = [0, 0, {gauge}]
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 9000
[axis.{second}]
rotary = {direction:?}
point = {point:?}
travel = {tilt:?}
max_feed = 5400
[control]
dialect = "recorder"
tcp = "{}"
{LINEAR}"#,
        if tcp { "control" } else { "post" }
    );
    let settings: Vec<Setting> =
        settings.iter().map(|&setting| Setting::Written(setting.to_owned())).collect();
    let machine =
        load(Source { name: kind.to_owned(), text }, &settings, &mut |_| Err(String::new()))
            .unwrap_or_else(|faults| panic!("{faults:#?}"));
    let tip = Vector3::new(0.0, 0.0, gauge - length);
    let mount = Vector3::from(MOUNT);
    Model {
        machine,
        reference: Reference { joints, mount, tip, axis: Vector3::z() },
        order: order.to_vec(),
        zero: mount - tip,
        tcp,
        length,
    }
}

impl Model {
    fn run(&self, cl: &str) -> Run {
        run(
            &self.machine,
            cl,
            PostingRequest { tool_length: Some(self.length), ..PostingRequest::default() },
        )
    }

    /// The place of an axis in the chain, by the order of the words.
    fn place(&self, name: &str) -> usize {
        self.order["XYZ".find(name).unwrap_or(if name == "C" { 4 } else { 3 })]
    }

    /// Axis values of printed words; the linear ones only if the words are axis positions.
    fn joints(&self, words: &[f64]) -> Joints {
        let mut joints = Joints::default();
        for (index, (place, word)) in self.order.iter().zip(words).enumerate() {
            joints[*place] = match index {
                0..3 if self.tcp => 0.0,
                0..3 => word + self.zero[index],
                _ => word.to_radians(),
            };
        }
        joints
    }

    /// Where tip and tool axis are at `t` of a block.
    fn at(&self, from: &[f64], to: &[f64], t: f64) -> (Vector3<f64>, Vector3<f64>) {
        let joints = between(&self.joints(from), &self.joints(to), t);
        let (mut tip, axis) = self.reference.forward(&joints);
        if self.tcp {
            tip = Vector3::from_fn(|row, _| from[row] * (1.0 - t) + to[row] * t);
        }
        (tip, axis)
    }

    /// The positions of the axes that put the tip of a block's end where it is, whoever keeps the tip.
    fn positions(&self, words: &[f64]) -> Joints {
        let mut joints = self.joints(words);
        if self.tcp {
            let off =
                Vector3::new(words[0], words[1], words[2]) - self.reference.forward(&joints).0;
            // All three machines have their linear axes along X, Y, Z, some of them behind the table's turns.
            let first = *self.reference.linear().first().expect("linear axes");
            let before = self.reference.rotation(&joints[..first]).inverse() * off;
            for (row, place) in self.order[..3].iter().enumerate() {
                joints[*place] += before[row];
            }
            let tip = self.reference.forward(&joints).0;
            assert!((tip - Vector3::new(words[0], words[1], words[2])).norm() < 1e-9);
        }
        joints
    }
}

/// A point whose axis has seven decimals.
fn point(tip: Vector3<f64>, axis: Vector3<f64>, rapid: bool) -> Point {
    posted::point(tip, axis.map(|value| libm::rint(value * 1e7) / 1e7), rapid)
}

const WIDE: [f64; 2] = [-175.0, 175.0];

/// A walk of tip and axis, tilted by at most `most` radians.
fn walk(rng: &mut Rng, count: usize, most: f64) -> Vec<Point> {
    let mut tip = rng.point(50.0);
    let mut axis = Vector3::z();
    (0..count)
        .map(|index| {
            tip += rng.direction() * rng.order(0.3, 1.5);
            let step = rng.direction() * rng.order(-3.0, -0.7);
            let next = (axis + step).normalize();
            if angle(next, Vector3::z()) < most {
                axis = next;
            }
            point(tip, axis, index % 9 == 0)
        })
        .collect()
}

/// The words of all motions of a CL text.
fn words(model: &Model, cl: &str) -> Vec<Vec<f64>> {
    let run = model.run(cl).good("a path");
    let motions = run.motions().into_iter();
    motions.map(|asked| asked.words.clone()).collect()
}

fn near(words: &[f64], expected: &[f64]) -> bool {
    words.len() == expected.len() && words.iter().zip(expected).all(|(a, b)| (a - b).abs() < 5.1e-4)
}
