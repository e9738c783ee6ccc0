//! What the linear words of a program count from.

use nalgebra::{Matrix3, Vector3};

/// A frame: where its origin lies and how its directions stand in the frame around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CoordinateFrame {
    /// Directions as columns, in the frame around it.
    pub axes: Matrix3<f64>,
    /// Origin in the frame around it, mm.
    pub origin: Vector3<f64>,
    /// Whether the directions are those of the frame around it.
    upright: bool,
}

impl Default for CoordinateFrame {
    fn default() -> Self {
        Self::shifted(Vector3::zeros())
    }
}

impl CoordinateFrame {
    /// A frame that is shifted alone, mm.
    pub fn shifted(origin: Vector3<f64>) -> Self {
        Self { axes: Matrix3::identity(), origin, upright: true }
    }

    /// A frame with these directions.
    pub fn new(axes: Matrix3<f64>, origin: Vector3<f64>) -> Self {
        Self { upright: axes == Matrix3::identity(), axes, origin }
    }

    /// Whether the directions are those of the frame around it.
    pub fn upright(&self) -> bool {
        self.upright
    }

    /// Whether it is the frame around it.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// A point of this frame in the frame around it, mm.
    #[inline]
    pub fn out(&self, point: Vector3<f64>) -> Vector3<f64> {
        if self.upright { self.origin + point } else { self.origin + self.axes * point }
    }

    /// A point of the frame around it in this frame, mm.
    #[inline]
    pub fn inside(&self, point: Vector3<f64>) -> Vector3<f64> {
        if self.upright {
            point - self.origin
        } else {
            self.axes.transpose() * (point - self.origin)
        }
    }

    /// A direction of this frame in the frame around it.
    #[inline]
    pub fn out_direction(&self, direction: Vector3<f64>) -> Vector3<f64> {
        if self.upright { direction } else { self.axes * direction }
    }

    /// The frame `inner`, which is given in this one, in the frame around this one.
    pub fn around(&self, inner: &Self) -> Self {
        Self::new(self.axes * inner.axes, self.out(inner.origin))
    }
}

/// The frames between the words of a program and its work offset, from outside to inside.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FrameStack {
    /// What is shifted or turned outside of a tilted plane, or where there is none: `CYCL DEF 7`, `G52`, `G92`.
    pub outer: CoordinateFrame,
    /// The tilted plane. While there is one the linear words are the tip, whether control or post keeps it.
    pub plane: Option<CoordinateFrame>,
    /// What is shifted or turned inside of the tilted plane.
    pub inner: CoordinateFrame,
    /// `G92` has a part in `outer`.
    pub preset: bool,
}

impl FrameStack {
    /// The frame that the words are written in, within that of the work offset.
    pub fn all(&self) -> CoordinateFrame {
        let plane = self.plane.unwrap_or_default();
        self.outer.around(&plane).around(&self.inner)
    }
}
