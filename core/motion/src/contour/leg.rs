//! Legs of a path that is asked for: by the program, or by a CL file; and the knots that they are made of.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::path::Knot;
use crate::path::{Curve, GreatCircle};
use crate::{MovePace, ProgramPlace, Task};

/// A knot stands at least after such a turn, radians: the cubic between leaves an arc by less than a radius times the
/// fourth power of this over 1944, 3 nm of a metre.
const TURN: f64 = 0.05;

/// Knots in a span of a spline.
const SPANS: usize = 16;

/// Knots of a leg at most.
const MOST: f64 = 4096.0;

/// A leg of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct ContourLeg {
    /// What asks for it: the line, and the task where it is one of a program; whether it cuts.
    pub at: ProgramPlace,
    /// How the tip goes.
    pub curve: Curve,
    /// Start: tip and tool axis, part frame.
    pub from: Pose,
    /// End; the tool axis goes on the great circle.
    pub to: Pose,
    /// How far the point of the tool that goes so stands above the tip, mm.
    pub along: f64,
}

impl ContourLeg {
    /// The leg of a task, whose number is not known yet; none where it waits.
    pub fn of(task: &Task) -> Option<Self> {
        let Task::Move(go) = task else {
            return None;
        };
        Some(Self {
            at: ProgramPlace { task: 0, line: go.line, cuts: go.pace != MovePace::Rapid },
            curve: go.way.curve().clone(),
            from: go.from.pose,
            to: go.to.pose,
            along: 0.0,
        })
    }
}

/// A path that is asked for, handed out in order.
pub trait ReferencePath {
    /// The next leg; none at its end. A leg that does not begin where the last one ended is reached somehow.
    fn next(&mut self) -> Option<ContourLeg>;
}

impl ContourLeg {
    /// Tip and tool axis at `t` from 0 to 1.
    pub fn at(&self, t: f64) -> Pose {
        self.on(&GreatCircle::new(self.from.axis, self.to.axis), t)
    }

    /// The pose at `t` where the way of the tool axis is known.
    fn on(&self, turn: &GreatCircle, t: f64) -> Pose {
        let axis = turn.at(t);
        let tip = self.curve.tip([&self.from, &self.to], axis, self.along, t);
        Pose { tip, axis, edge: Vector3::zeros() }
    }

    /// Hands out its knots, that of its beginning first.
    pub(super) fn knots(&self, take: &mut dyn FnMut(Knot)) {
        let circle = GreatCircle::new(self.from.axis, self.to.axis);
        let spans = match &self.curve {
            Curve::Spline(way) => SPANS * way.spans().count(),
            _ => 1,
        };
        let pieces = libm::ceil(circle.angle.max(self.curve.turn()) / TURN).max(spans as f64);
        let pieces = pieces.clamp(1.0, MOST) as usize;
        let step = 1.0 / pieces as f64;
        let at = |t: f64| self.on(&circle, t);
        let mut last = at(0.0);
        let mut reached = [Vector3::zeros(); 2];
        for piece in 0..pieces {
            let start = piece as f64 * step;
            let inner = [1.0, 2.0].map(|third| at(start + step * third / 3.0));
            let end = match piece + 1 == pieces {
                true => at(1.0),
                false => at(start + step),
            };
            let points = [&last, &inner[0], &inner[1], &end];
            let tip = through(points.map(|pose| &pose.tip));
            let axis = through(points.map(|pose| &pose.axis));
            take(self.knot(&last, [reached[0], tip[0]], [reached[1], axis[0]]));
            reached = [tip[1], axis[1]];
            last = end;
        }
        let zero = Vector3::zeros();
        take(self.knot(&last, [reached[0], zero], [reached[1], zero]));
    }

    fn knot(&self, pose: &Pose, tip: [Vector3<f64>; 2], axis: [Vector3<f64>; 2]) -> Knot {
        Knot {
            number: 0,
            at: self.at,
            tip: pose.tip,
            axis: pose.axis,
            tip_ways: tip,
            axis_ways: axis,
            length: 0.0,
            gap: false,
        }
    }
}

/// The tangents at both ends of the cubic through four points at thirds.
fn through([a, b, c, d]: [&Vector3<f64>; 4]) -> [Vector3<f64>; 2] {
    [
        (b * 18.0 - a * 11.0 - c * 9.0 + d * 2.0) * 0.5,
        (d * 11.0 - c * 18.0 + b * 9.0 - a * 2.0) * 0.5,
    ]
}
