//! Where one frame stands in another.

use nalgebra::{Matrix3, Vector3};

/// Where a link stands in the frame of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Rotation.
    pub rotation: Matrix3<f64>,
    /// Shift, mm.
    pub shift: Vector3<f64>,
}

impl Placement {
    /// Where both frames are one.
    pub fn identity() -> Self {
        Self { rotation: Matrix3::identity(), shift: Vector3::zeros() }
    }

    /// A point there.
    pub fn point(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.rotation * point + self.shift
    }

    /// A direction there.
    pub fn direction(&self, direction: Vector3<f64>) -> Vector3<f64> {
        self.rotation * direction
    }

    /// The point of the frame itself that stands on `point`.
    pub fn back(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.rotation.transpose() * (point - self.shift)
    }
}
