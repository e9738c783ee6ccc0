//! Robots around bowls and domes: what an arm can go is gone, without a word of where it is to begin. What it can go is told
//! by an inverse of its own, formulas of the one arm, and a search over turns about the tool.

use std::f64::consts::{PI, TAU};
use std::fs;

use nalgebra::{Matrix3, Rotation3, Vector3};
use post_testkit::randomised;
use post_testruns::read_back::{Model, angle, blocks, points};

use crate::common::{Run, post};

type V = Vector3<f64>;

/// Travel of A, B, C, U, V, W, degrees.
const TRAVEL: [[f64; 2]; 6] = [
    [-170.0, 170.0],
    [-190.0, 45.0],
    [-120.0, 156.0],
    [-185.0, 185.0],
    [-120.0, 120.0],
    [-350.0, 350.0],
];

/// Length of the tool, mm.
const LENGTH: f64 = 60.0;

/// Turns about the tool that are tried: every 5°.
const SPINS: usize = 72;

/// A point of a path: tip and tool axis, part frame.
type Point = (V, V);

fn about(direction: V, angle: f64) -> Matrix3<f64> {
    Rotation3::new(direction * angle).into_inner()
}

/// Angles in -180° to 180°.
fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The eight solutions of machines/kr6-r700.toml for a tool turned about itself by `spin`, those that its limits rule out
/// left empty: the wrist is 120 mm behind the tip and 120 mm above it, all axes at zero.
fn solutions((tip, axis): Point, spin: f64) -> [Option<[f64; 6]>; 8] {
    let tip = tip + V::new(420.0, 0.0, 150.0);
    let aside = if axis.x.abs() < 0.9 { V::x() } else { V::y() };
    let aside = (aside - axis * axis.dot(&aside)).normalize();
    let forward = aside * libm::cos(spin) + axis.cross(&aside) * libm::sin(spin);
    let tool = Matrix3::from_columns(&[forward, axis.cross(&forward), axis]);
    let wrist = tip + tool * V::new(705.0 - 825.0, 0.0, 435.0 - (435.0 - 60.0 - LENGTH));
    let (upper, fore) = (315.0, libm::hypot(365.0, 35.0));
    let bent = libm::atan2(35.0, 365.0);
    let mut found = [None; 8];
    for (place, found) in found.iter_mut().enumerate() {
        let side = |bit: usize| if place >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let turned = libm::atan2(side(0) * wrist.y, side(0) * wrist.x);
        let (out, up) = (side(0) * libm::hypot(wrist.x, wrist.y) - 25.0, wrist.z - 400.0);
        let cosine = (out * out + up * up - upper * upper - fore * fore) / (2.0 * upper * fore);
        if cosine.abs() > 1.0 {
            continue;
        }
        let elbow = side(1) * libm::acos(cosine);
        let rises = libm::atan2(up, out)
            - libm::atan2(fore * libm::sin(elbow), upper + fore * libm::cos(elbow));
        let (second, third) = (wrapped(-rises), wrapped(bent - elbow));
        let arm = about(V::z(), turned) * about(V::y(), second + third);
        let hand = arm.transpose() * tool;
        let fifth = side(2) * libm::acos(hand[(0, 0)].clamp(-1.0, 1.0));
        let fourth = libm::atan2(side(2) * hand[(1, 0)], -side(2) * hand[(2, 0)]);
        let sixth = libm::atan2(side(2) * hand[(0, 1)], side(2) * hand[(0, 2)]);
        let second = if second > 45f64.to_radians() { second - TAU } else { second };
        let all = [-turned, second, third, -fourth, fifth, -sixth];
        let inside = |place: usize| {
            let [least, most] = TRAVEL[place].map(f64::to_radians);
            (least..=most).contains(&all[place])
        };
        *found = [0, 1, 2, 4].into_iter().all(inside).then_some(all);
    }
    found
}

/// A way of standing: turn about the tool, which solution, and the angles with their full turns.
type Stand = (usize, usize, [f64; 6]);

/// All ways of standing at a point.
fn stands(point: Point) -> Vec<Stand> {
    let mut found = Vec::new();
    for spin in 0..SPINS {
        let all = solutions(point, TAU * spin as f64 / SPINS as f64);
        for (branch, angles) in all.into_iter().enumerate() {
            let Some(angles) = angles else {
                continue;
            };
            for turns in 0..9 {
                let mut turned = angles;
                turned[3] += TAU * f64::from(turns / 3 - 1);
                turned[5] += TAU * f64::from(turns % 3 - 1);
                let inside = |place: usize| turned[place].abs() <= TRAVEL[place][1].to_radians();
                if inside(3) && inside(5) {
                    found.push((spin, branch, turned));
                }
            }
        }
    }
    found
}

/// What can be said of a path without the product: the arm goes it, with no axis turning by more than 25° from one point to
/// the next and the tool about itself by no more than 5°; or some point of it cannot be stood at, however the tool is turned.
#[derive(Debug, PartialEq)]
enum Verdict {
    Goes,
    OutOfReach,
    NotKnown,
}

fn verdict(path: &[Point]) -> Verdict {
    let mut alive: Option<Vec<Stand>> = None;
    for point in path {
        let here = stands(*point);
        if here.is_empty() {
            return Verdict::OutOfReach;
        }
        let goes_on = |(spin, branch, angles): &Stand| {
            alive.as_ref().is_none_or(|before| {
                before.iter().any(|(from, other, start)| {
                    let apart = (spin + SPINS - from) % SPINS;
                    branch == other
                        && (apart <= 1 || apart == SPINS - 1)
                        && angles.iter().zip(start).all(|(a, b)| (a - b).abs() < 25f64.to_radians())
                })
            })
        };
        let next: Vec<Stand> = here.into_iter().filter(goes_on).collect();
        alive = Some(next);
    }
    match alive.is_some_and(|alive| !alive.is_empty()) {
        true => Verdict::Goes,
        false => Verdict::NotKnown,
    }
}

/// A path on a sphere of `radius` mm whose top (bottom, of a bowl) is at `middle`, from one angle off the pole to another,
/// degrees, a point every 10° around; the tool stands square to it.
fn path(radius: f64, tilts: [f64; 2], turns: f64, bowl: bool, middle: V) -> Vec<Point> {
    let count = (36.0 * turns) as usize;
    let at = |place: usize| {
        let share = place as f64 / count as f64;
        let (lean, up) = libm::sincos((tilts[0] + (tilts[1] - tilts[0]) * share).to_radians());
        let (sine, cosine) = libm::sincos(PI * place as f64 / 18.0);
        let out = V::new(lean * cosine, lean * sine, up);
        match bowl {
            true => {
                (middle + radius * V::new(out.x, out.y, 1.0 - out.z), V::new(-out.x, -out.y, out.z))
            }
            false => (middle + radius * (out - V::z()), out),
        }
    };
    (0..=count).map(at).collect()
}

/// The CL file of a path, and all its points: the tool comes and leaves along itself.
fn job(path: &[Point]) -> (String, Vec<Point>) {
    let goto = |(tip, axis): &Point| {
        format!(
            "GOTO/{:.4},{:.4},{:.4},{:.9},{:.9},{:.9}\n",
            tip.x, tip.y, tip.z, axis.x, axis.y, axis.z
        )
    };
    let away = |point: &Point| (point.0 + point.1 * 20.0, point.1);
    let (first, last) = (away(&path[0]), away(path.last().unwrap()));
    let cuts: String = path.iter().map(goto).collect();
    let text = format!(
        "TOOL PATH/BOWL,TOOL,T1\nLOAD/TOOL,1\nSPINDL/RPM,9000,CLW\nRAPID\n{}FEDRAT/900,MMPM\n{cuts}RAPID\n{}SPINDL/OFF\nEND-OF-PATH\nFINI\n",
        goto(&first),
        goto(&last)
    );
    (text, [&[first], path].concat())
}

fn made(text: &str) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("part.cls");
    fs::write(&file, text).unwrap();
    let length = LENGTH.to_string();
    let job = ["-q", "--verify", "-m", "kr6-r700", "--tool-length", &length, "-o", "-"];
    post(&[&job[..], &[file.to_str().unwrap()]].concat())
}

/// The program meets every point of the CL file, one after the other.
fn meets(program: &str, text: &str) {
    let model = Model::new("kr6-r700", None);
    let names: Vec<&str> = model.axes.iter().map(|axis| axis.name.as_str()).collect();
    let blocks = blocks(program, &names, &[]);
    let mut next = 0;
    for point in points(text) {
        let near = |block: &post_testruns::read_back::Block| {
            let pose = model.pose(&block.words, LENGTH);
            (pose.tip - point.tip).norm() < 0.005 && angle(pose.axis, point.axis) < 0.11
        };
        let found = blocks[next..].iter().position(near);
        next += found.unwrap_or_else(|| panic!("CL line {} is not met", point.line));
    }
}

/// The formulas of this test are those of the arm: the axes that they give bring the tip there.
#[test]
fn the_inverse_of_these_tests_is_that_of_the_arm() {
    let model = Model::new("kr6-r700", None);
    let point = path(80.0, [25.0, 40.0], 1.0, false, V::zeros())[7];
    let all = stands(point);
    assert!(all.len() > 50);
    for (_, _, angles) in all {
        let pose = model.pose(&angles.map(f64::to_degrees), LENGTH);
        assert!((pose.tip - point.0).norm() < 1e-6 && angle(pose.axis, point.1) < 1e-6);
    }
}

/// Bowls and domes that an arm goes if its tool is turned along early: it begins so by itself.
#[test]
fn an_arm_finds_where_to_begin_around_a_bowl() {
    for (radius, tilts, turns, bowl) in [
        (60.0, [30.0, 30.0], 1.0, false),
        (80.0, [45.0, 45.0], 1.0, false),
        (80.0, [45.0, 45.0], 1.0, true),
        (80.0, [12.0, 40.0], 3.0, false),
        (80.0, [12.0, 40.0], 3.0, true),
        (60.0, [0.0, 30.0], 3.0, false),
    ] {
        let (text, all) = job(&path(radius, tilts, turns, bowl, V::zeros()));
        assert_eq!(verdict(&all), Verdict::Goes);
        let run = made(&text);
        assert_eq!(run.code, 0, "{radius} {tilts:?} {bowl}: {}", run.err);
        meets(&run.out, &text);
    }
}

/// Paths of any kind: what can be gone is posted, and what no axes reach is refused.
#[test]
fn what_an_arm_can_go_is_posted_and_what_it_cannot_reach_is_refused() {
    let (rounds, mut rng) = randomised(8, 3);
    let mut told = [0, 0];
    for _ in rounds {
        let middle =
            V::new(rng.range(-150.0, 250.0), rng.range(-250.0, 250.0), rng.range(-100.0, 200.0));
        let tilts = [rng.range(5.0, 55.0), rng.range(5.0, 55.0)];
        let bowl = rng.pick(2) == 0;
        let (text, all) = job(&path(rng.range(30.0, 120.0), tilts, 1.0, bowl, middle));
        let run = match verdict(&all) {
            Verdict::NotKnown => continue,
            Verdict::Goes => {
                told[0] += 1;
                let run = made(&text);
                assert_eq!(run.code, 0, "{middle} {tilts:?} {bowl}: {}\n{text}", run.err);
                meets(&run.out, &text);
                continue;
            }
            Verdict::OutOfReach => made(&text),
        };
        told[1] += 1;
        assert_eq!(run.code, 1, "{middle} {tilts:?} {bowl}\n{text}");
    }
    assert!(told[0] > 0, "{told:?}");
}
