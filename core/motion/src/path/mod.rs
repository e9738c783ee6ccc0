//! How a control goes from one stance of the machine to another.

mod arc_spline;
mod chords;
mod curve;
mod round;
mod spline;
mod stance;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use post_machine::kinematics::{Chain, Joints, Pose};

pub use chords::{arc_chords, chords, nearest_share, piece_ends};
pub use curve::Curve;
pub use round::{GreatCircle, arm_and_height, between, circle_ends, on_arc};
pub use spline::BSpline;

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
    /// The tip along a curve of the part frame, the rotary axes linearly if they turn at all.
    Tip(Curve),
    /// The tip straight, the tool axis on the great circle (vectors: G43.5, ORIVECT, LN).
    TipAndAxis,
    /// The tip straight, the tool as a whole turned evenly about one direction by this vector: right-handed, its length the
    /// angle, radians, part frame (robots: MoveL, LIN, movel). Its axis is on no great circle where the tool turns about
    /// itself too.
    TipAndFrame(Vector3<f64>),
}

impl Interpolation {
    /// Tip and tool axis between `ends` at `t` from 0 to 1 of the way's own parameter (time, at constant feed), as the
    /// control and the chain make them.
    pub fn at(&self, chain: &Chain, ends: [&Stance; 2], t: f64) -> Pose {
        let Some(tip) = self.tip(ends, t) else {
            return chain.forward(&joints_between(ends, t));
        };
        if let Some(pose) = self.led(ends, tip, t) {
            return pose;
        }
        if !turns(chain, ends) {
            return Pose { tip, ..ends[1].pose };
        }
        // Rotary axes alone say where the tool points.
        let pose = chain.forward(&joints_between(ends, t));
        Pose { tip, ..pose }
    }

    /// The way of a robot's control that leads the tool straight between stands told by the tool axis and a direction across
    /// it, unit vectors, part frame.
    pub fn led_straight(from: [Vector3<f64>; 2], to: [Vector3<f64>; 2]) -> Self {
        let frame = |[axis, across]: [Vector3<f64>; 2]| {
            let basis = Matrix3::from_columns(&[across, axis.cross(&across), axis]);
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(basis))
        };
        Self::TipAndFrame((frame(to) * frame(from).inverse()).scaled_axis())
    }

    /// The pose with its tip on `tip` at `t`, where the control leads the directions of the tool too.
    fn led(&self, ends: [&Stance; 2], tip: Vector3<f64>, t: f64) -> Option<Pose> {
        match self {
            Self::TipAndAxis => Some(on_great_circle(ends, tip, t)),
            Self::TipAndFrame(turn) => {
                let turned = UnitQuaternion::from_scaled_axis(turn * t);
                let Pose { axis, edge, .. } = ends[0].pose;
                Some(Pose { tip, axis: turned * axis, edge: turned * edge })
            }
            Self::Axes | Self::Tip(_) => None,
        }
    }

    /// The tip at `t`, mm, part frame, where the control leads the tip; none where it leads the axes.
    fn tip(&self, ends: [&Stance; 2], t: f64) -> Option<Vector3<f64>> {
        let tips = ends.map(|stance| stance.pose.tip);
        (*self != Self::Axes).then(|| self.curve().at(tips, t))
    }

    /// The curve of the tip: straight where the control leads the axes, as if they did not turn.
    #[inline]
    pub fn curve(&self) -> &Curve {
        match self {
            Self::Tip(curve) => curve,
            Self::Axes | Self::TipAndAxis | Self::TipAndFrame(_) => &Curve::Straight,
        }
    }

    /// The tip goes on an arc or a spline.
    pub fn is_curved(&self) -> bool {
        *self.curve() != Curve::Straight
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
