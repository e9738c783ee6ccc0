//! What a part of a mesh encloses.

use nalgebra::Vector3;

/// A part of a mesh that hangs together.
#[derive(Clone, Debug)]
pub(crate) struct Shell {
    triangles: Vec<[Vector3<f64>; 3]>,
    /// Least and largest coordinates, mm.
    extents: [Vector3<f64>; 2],
}

/// Of a full turn of the solid angle so much is inside. A closed shell has all of it inside and nothing outside; of an open
/// one what sees more than a quarter of the sphere covered counts as inside.
const INSIDE: f64 = 0.25;

impl Shell {
    /// None of fewer triangles than enclose anything.
    pub(crate) fn new(triangles: Vec<[Vector3<f64>; 3]>) -> Option<Self> {
        if triangles.len() < 4 {
            return None;
        }
        let infinite = Vector3::repeat(f64::INFINITY);
        let corners = triangles.as_flattened().iter();
        let extents = corners
            .fold([infinite, -infinite], |[low, high], corner| [low.inf(corner), high.sup(corner)]);
        Some(Self { triangles, extents })
    }

    /// Whether it encloses `point`: each shell by itself, so that a hollow, or a shell whose faces look inward, is no way
    /// out of what encloses both.
    pub(crate) fn holds(&self, point: Vector3<f64>) -> bool {
        let [low, high] = self.extents;
        if point.inf(&low) != low || point.sup(&high) != high {
            return false;
        }
        let full = 4.0 * std::f64::consts::PI;
        let seen: f64 = self.triangles.iter().map(|corners| solid_angle(corners, point)).sum();
        libm::fabs(seen / full) > INSIDE
    }
}

/// The solid angle under which a triangle is seen (van Oosterom, Strackee 1983), with the sign of its sense.
pub(crate) fn solid_angle(corners: &[Vector3<f64>; 3], from: Vector3<f64>) -> f64 {
    let [a, b, c] = corners.map(|corner| corner - from);
    let [x, y, z] = [a, b, c].map(|arm| arm.norm());
    let volume = a.dot(&b.cross(&c));
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * libm::atan2(volume, below)
}
