//! Where the tool stands on a piece.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;
use post_motion::path::between;

use super::CoursePiece;

impl CoursePiece {
    /// The pose at `t` from 0 to 1.
    ///
    /// `along` is how far the point that is guided stands above the tip, mm (`[tool] control_point`): that point goes
    /// straight, and the tip follows from it.
    pub fn at(&self, t: f64, along: f64) -> Pose {
        let (from, to) = (&self.from, &self.to);
        let axis = between(from.axis, to.axis, t);
        let edge = match from.edge == Vector3::zeros() || to.edge == Vector3::zeros() {
            true => Vector3::zeros(),
            false => between(from.edge_across(), to.edge_across(), t),
        };
        Pose { tip: self.curve.tip([from, to], axis, along, t), axis, edge }
    }

    /// Length of the tip's way, mm: [`post_motion::path::Curve::length`].
    pub fn length(&self) -> f64 {
        self.curve.length([self.from.tip, self.to.tip])
    }

    /// The least and largest coordinates of the tip on it, mm.
    pub fn extents(&self) -> [Vector3<f64>; 2] {
        self.curve.extents([self.from.tip, self.to.tip])
    }
}
