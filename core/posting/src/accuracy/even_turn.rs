//! How a robot's control turns a tool that it leads straight: evenly about one direction from one stand to the next.

use nalgebra::{Rotation3, UnitQuaternion, Vector3};
use post_machine::kinematics::chain::turn;

/// A tool on its way between two stands.
#[derive(Clone, Copy, Debug)]
pub(super) struct EvenTurn {
    /// Tool axis at the start, unit vector, part frame.
    from: Vector3<f64>,
    /// Direction about which it turns, unit vector, part frame.
    about: Vector3<f64>,
    /// How far, radians.
    angle: f64,
}

impl EvenTurn {
    /// Between stands told by the tool axis and a direction across it, unit vectors, part frame.
    pub(super) fn between(from: [Vector3<f64>; 2], to: [Vector3<f64>; 2]) -> Self {
        let frame = |[axis, across]: [Vector3<f64>; 2]| {
            Rotation3::from_basis_unchecked(&[across, axis.cross(&across), axis])
        };
        let whole = UnitQuaternion::from_rotation_matrix(&(frame(to) * frame(from).inverse()));
        let (about, angle) = match whole.axis_angle() {
            Some((about, angle)) => (about.into_inner(), angle),
            None => (from[0], 0.0),
        };
        Self { from: from[0], about, angle }
    }

    /// The tool axis at the share `t` of the way.
    pub(super) fn at(&self, t: f64) -> Vector3<f64> {
        let (sine, cosine) = libm::sincos(t * self.angle);
        turn(self.from, self.about, sine, cosine)
    }

    /// The second derivative of the tool axis by the share of the way: it goes evenly on a circle.
    pub(super) fn bend(&self) -> f64 {
        self.angle * self.angle * self.about.cross(&self.from).norm()
    }
}
