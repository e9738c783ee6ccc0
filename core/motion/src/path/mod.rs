//! How a control goes from one stance of the machine to another.

mod round;
mod spline;
mod stance;

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Chain, Joints, Pose};

pub use round::{GreatCircle, arm_and_height, between, on_arc};

/// Where the machine stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stance {
    /// Axis values, mm and radians, counted from the drawing's zero, in chain order.
    pub joints: Joints,
    /// Tip and tool axis, part frame, of the tool whose length is compensated.
    pub pose: Pose,
}

/// How the control goes from one end to the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Interpolation {
    /// All axes linearly in the same parameter.
    Axes,
    /// The tip straight, the rotary axes linearly.
    Tip,
    /// The tip straight, the tool axis on the great circle (vectors: G43.5, ORIVECT, LN).
    TipAndAxis,
    /// The tip on an arc or helix of the part frame, rotary axes linearly if they turn at all.
    Arc {
        /// A point of the axis, mm.
        centre: Vector3<f64>,
        /// Axis, unit vector.
        normal: Vector3<f64>,
        /// Turn about it, right-handed, radians; more than a turn where the program says so.
        sweep: f64,
    },
    /// The tip on a spline of the part frame: poles and knots, as the program states them.
    Spline(Arc<BSpline>),
}

/// A rational B-spline.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as poles + degree + 1.
    pub knots: Vec<f64>,
    /// Poles, mm, part frame, and their weights.
    pub poles: Vec<(Vector3<f64>, f64)>,
}

impl Interpolation {
    /// Tip and tool axis between `ends` at `t` from 0 to 1 of the way's own parameter (time, at constant feed), as the
    /// control and the chain make them.
    pub fn at(&self, chain: &Chain, ends: [&Stance; 2], t: f64) -> Pose {
        let Some(tip) = self.tip(ends, t) else {
            return chain.forward(&joints_between(ends, t));
        };
        if *self == Self::TipAndAxis {
            return on_great_circle(ends, tip, t);
        }
        if !turns(chain, ends) {
            return Pose { tip, ..ends[1].pose };
        }
        // Rotary axes alone say where the tool points.
        let pose = chain.forward(&joints_between(ends, t));
        Pose { tip, ..pose }
    }

    /// The tip at `t`, mm, part frame, where the control leads the tip; none where it leads the axes.
    fn tip(&self, ends: [&Stance; 2], t: f64) -> Option<Vector3<f64>> {
        let [from, to] = ends.map(|stance| stance.pose.tip);
        Some(match self {
            Self::Axes => return None,
            Self::Tip | Self::TipAndAxis => from + (to - from) * t,
            Self::Arc { centre, normal, sweep } => on_arc([from, to], *centre, *normal, *sweep, t),
            Self::Spline(way) => way.at(t),
        })
    }
}

/// The pose with its tip on `tip` whose directions are `t` of the way along the great circles between those of the
/// ends.
fn on_great_circle(ends: [&Stance; 2], tip: Vector3<f64>, t: f64) -> Pose {
    let [from, to] = ends.map(|stance| stance.pose);
    Pose {
        tip,
        axis: between(from.axis, to.axis, t),
        edge: match from.edge == Vector3::zeros() {
            true => from.edge,
            false => between(from.edge, to.edge, t),
        },
    }
}

/// Some rotary axis turns on the way.
pub fn turns(chain: &Chain, ends: [&Stance; 2]) -> bool {
    let axes = chain.joints().iter().enumerate();
    axes.filter(|(_, axis)| axis.rotary)
        .any(|(place, _)| ends[0].joints[place] != ends[1].joints[place])
}

/// Axis values at `t`, all linearly: where the control keeps the tip ([`Interpolation::Tip`] and below), those of the rotary axes
/// alone hold.
pub fn joints_between(ends: [&Stance; 2], t: f64) -> Joints {
    let [from, to] = ends.map(|stance| &stance.joints);
    std::array::from_fn(|place| from[place] + (to[place] - from[place]) * t)
}
