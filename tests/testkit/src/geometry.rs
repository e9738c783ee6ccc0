//! Angles, great circles and distances.

use std::f64::consts::TAU;

use nalgebra::{Unit, UnitQuaternion, Vector3};
use post_machine::kinematics::{Joints, MAX_AXES};

/// The angle between two unit vectors by its half chord (Kahan), exact for small and large angles alike.
pub fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    2.0 * libm::atan2((a - b).norm(), (a + b).norm())
}

/// The angle from a to b on the turn nearest to zero.
pub fn turned(a: f64, b: f64) -> f64 {
    let difference = b - a;
    difference - TAU * libm::rint(difference / TAU)
}

/// The unit vector at `t` on the great circle from `a` to `b`, by turning `a` about their normal.
pub fn slerp(a: Vector3<f64>, b: Vector3<f64>, t: f64) -> Vector3<f64> {
    match Unit::try_new(a.cross(&b), 1e-14) {
        Some(normal) => UnitQuaternion::from_axis_angle(&normal, t * angle(a, b)) * a,
        None => a,
    }
}

/// The distance of a point from a piece of a straight line.
pub fn distance(point: Vector3<f64>, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let t = if square > 0.0 {
        ((point - from).dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - from - along * t).norm()
}

/// Values between two sets of axis values.
pub fn between(from: &Joints, to: &Joints, t: f64) -> Joints {
    std::array::from_fn::<f64, MAX_AXES, _>(|index| from[index] * (1.0 - t) + to[index] * t)
}
