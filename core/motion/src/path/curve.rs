//! How a tip goes from one place to another: straight, round an axis, along a spline.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::{BSpline, arm_and_height, on_arc};

/// How the tip goes from one end to the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Straight,
    /// On an arc, a helix, or a spiral where the ends differ in their distance from the axis: both distance and height
    /// change evenly with the turn.
    Arc {
        /// A point of the axis, mm.
        centre: Vector3<f64>,
        /// Axis, unit vector.
        normal: Vector3<f64>,
        /// Turn about it, right-handed, radians; more than a turn where the source says so.
        sweep: f64,
    },
    /// On a spline: poles and knots, as the source states them.
    Spline(Arc<BSpline>),
}

impl Curve {
    /// The point at `t` from 0 to 1 between two ends.
    #[inline]
    pub fn at(&self, [from, to]: [Vector3<f64>; 2], t: f64) -> Vector3<f64> {
        match self {
            Self::Straight => from + (to - from) * t,
            Self::Arc { centre, normal, sweep } => on_arc([from, to], *centre, *normal, *sweep, t),
            Self::Spline(way) => way.at(t),
        }
    }

    /// The tip at `t` between two poses, where the tool points along `axis`.
    ///
    /// `along` is how far the point that is guided stands above the tip, mm (`[tool] control_point`): that point goes
    /// straight, and the tip follows from it.
    pub fn tip(&self, ends: [&Pose; 2], axis: Vector3<f64>, along: f64, t: f64) -> Vector3<f64> {
        match self {
            Self::Straight if along != 0.0 => {
                let guided = ends.map(|pose| pose.tip + pose.axis * along);
                self.at(guided, t) - axis * along
            }
            _ => self.at(ends.map(|pose| pose.tip), t),
        }
    }

    /// Turn about the axis of an arc, radians, above zero; zero of other curves.
    pub fn turn(&self) -> f64 {
        match self {
            Self::Arc { sweep, .. } => libm::fabs(*sweep),
            _ => 0.0,
        }
    }

    /// Length between two ends, mm; of a spline and a spiral by their chords, too short by less than a thousandth.
    pub fn length(&self, ends: [Vector3<f64>; 2]) -> f64 {
        match self {
            Self::Straight => (ends[1] - ends[0]).norm(),
            Self::Arc { centre, normal, sweep } => {
                let [from, to] = ends.map(|tip| arm_and_height(tip, *centre, *normal));
                let rise = to.1 - from.1;
                let radius = 0.5 * (from.0.norm() + to.0.norm());
                libm::hypot(radius * sweep, rise)
            }
            Self::Spline(way) => way.length(),
        }
    }

    /// The least and largest coordinates between two ends, mm. Of an arc the quarters count, of a spline its poles, between
    /// which it stays.
    pub fn extents(&self, ends: [Vector3<f64>; 2]) -> [Vector3<f64>; 2] {
        let mut box_of = [ends[0].inf(&ends[1]), ends[0].sup(&ends[1])];
        let mut take = |tip: Vector3<f64>| {
            box_of = [box_of[0].inf(&tip), box_of[1].sup(&tip)];
        };
        match self {
            Self::Straight => {}
            Self::Arc { centre, normal, sweep } => {
                let (arm, _) = arm_and_height(ends[0], *centre, *normal);
                for place in quarters(arm, *normal, *sweep) {
                    take(self.at(ends, place));
                }
            }
            Self::Spline(way) => way.poles.iter().for_each(|(pole, _)| take(*pole)),
        }
        box_of
    }
}

/// The shares of an arc at which a coordinate turns back (of a spiral or helix: nearly).
fn quarters(arm: Vector3<f64>, normal: Vector3<f64>, sweep: f64) -> Vec<f64> {
    let across = normal.cross(&arm);
    let mut places = Vec::new();
    for place in 0..3 {
        // arm·cos + across·sin is extreme where its slope is zero.
        let first = libm::atan2(across[place], arm[place]);
        let half = std::f64::consts::PI;
        let mut angle = first - half * libm::floor(first / half);
        while angle < sweep.min(std::f64::consts::TAU) {
            places.push(angle / sweep);
            angle += half;
        }
    }
    places
}
