//! Contour errors of paths whose contour errors are known in closed form, and what no path may change.

mod asked;
mod corners;
mod curves;
mod long;
mod tool_axis;

use std::sync::Arc;

use nalgebra::{Rotation3, Vector3};
use post_machine::kinematics::{Chain, Joint, Joints, Pose, Solver};
use post_motion::contour::{Contour, ContourLeg, ContourPoint, ContourReport, ReferencePath};
use post_motion::path::Curve;
use post_motion::{ProgramPlace, SetPoints};

type Point = Vector3<f64>;

/// Three linear axes along these directions; with a rotary one on the tool's side about a line through the tip where
/// `turns`.
fn machine(frame: &Rotation3<f64>, turns: bool) -> Arc<Solver> {
    let linear = |direction: Point| Joint {
        rotary: false,
        direction: frame * direction,
        point: Point::zeros(),
    };
    let mut joints = vec![linear(Point::x()), linear(Point::y()), linear(Point::z())];
    let mut free = Vec::new();
    if turns {
        free.push(joints.len());
        joints.push(Joint { rotary: true, direction: frame * Point::x(), point: Point::zeros() });
    }
    let chain = Chain::new(joints, Point::zeros(), Point::zeros(), frame * Point::z());
    Arc::new(Solver::new(chain, &free, Joints::default()).unwrap())
}

fn joints(point: Point, turn: f64) -> Joints {
    let mut joints = Joints::default();
    joints[..3].copy_from_slice(point.as_slice());
    joints[3] = turn;
    joints
}

/// The contour of tips, commanded and actual, in batches of odd lengths.
fn run(
    period: f64,
    frame: &Rotation3<f64>,
    way: &[(Point, Point)],
) -> (Vec<ContourPoint>, ContourReport) {
    let joints: Vec<_> = way
        .iter()
        .map(|(commanded, actual)| [joints(*commanded, 0.0), joints(*actual, 0.0)])
        .collect();
    run_axes(period, machine(frame, false), &joints)
}

/// Legs of a path that is asked for.
struct Legs(std::vec::IntoIter<ContourLeg>);

impl ReferencePath for Legs {
    fn next(&mut self) -> Option<ContourLeg> {
        self.0.next()
    }
}

fn leg(line: u64, curve: Curve, from: Point, to: Point) -> ContourLeg {
    let pose = |tip| Pose { tip, axis: Point::z(), ..Pose::default() };
    let at = ProgramPlace { line, cuts: true, task: 0 };
    ContourLeg { at, curve, from: pose(from), to: pose(to), along: 0.0 }
}

fn run_axes(
    period: f64,
    solver: Arc<Solver>,
    way: &[[Joints; 2]],
) -> (Vec<ContourPoint>, ContourReport) {
    run_against(period, solver, way, Vec::new(), &|_| false)
}

fn run_against(
    period: f64,
    solver: Arc<Solver>,
    way: &[[Joints; 2]],
    legs: Vec<ContourLeg>,
    rapid: &dyn Fn(usize) -> bool,
) -> (Vec<ContourPoint>, ContourReport) {
    let mut contour = Contour::new().against(Box::new(Legs(legs.into_iter())));
    let mut told = Vec::new();
    let mut points = SetPoints::new(Arc::clone(&solver), period);
    let mut rest = way;
    let mut batch = 1;
    while !rest.is_empty() {
        let (now, behind) = rest.split_at(batch.min(rest.len()));
        points.clear();
        for [commanded, _] in now {
            let number = points.first as usize + points.len();
            points.joints.push(*commanded);
            points.poses.push(solver.chain().forward(commanded));
            points.at.push(ProgramPlace { cuts: !rapid(number), ..ProgramPlace::default() });
        }
        let actual: Vec<Joints> = now.iter().map(|pair| pair[1]).collect();
        contour.take(&points, &actual, &mut |point| told.push(*point));
        (rest, batch) = (behind, batch * 2 % 61 + 1);
    }
    let report = contour.finish(&mut |point| told.push(*point));
    assert_eq!(told.len(), way.len(), "each set-point is told once");
    for (place, point) in told.iter().enumerate() {
        assert!((point.time - place as f64 * period).abs() < 1e-9, "in order");
        let following = (point.commanded.tip - point.actual.tip).norm();
        assert!(point.distance <= following + 1e-9, "no more than the following error");
        assert!((point.error.norm() - point.distance).abs() < 1e-9);
    }
    (told, report)
}

/// The largest difference from `wanted`, not counting so many set-points at both ends, where the machine starts at speed.
fn off(told: &[ContourPoint], ends: usize, wanted: f64) -> f64 {
    told[ends..told.len() - ends]
        .iter()
        .map(|point| (point.distance - wanted).abs())
        .fold(0.0, f64::max)
}
