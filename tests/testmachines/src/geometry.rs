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
    let t = if square > 0.0 { ((point - from).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (point - from - along * t).norm()
}

/// Values between two sets of axis values.
pub fn between(from: &Joints, to: &Joints, t: f64) -> Joints {
    std::array::from_fn::<f64, MAX_AXES, _>(|index| from[index] * (1.0 - t) + to[index] * t)
}

/// The shares of a line from `a` to `b` that are within `bound` of `point`.
pub fn within(
    point: Vector3<f64>,
    a: Vector3<f64>,
    b: Vector3<f64>,
    bound: f64,
) -> Option<[f64; 2]> {
    let (chord, to) = (b - a, point - a);
    let square = chord.norm_squared();
    if square < 1e-18 {
        return (to.norm() <= bound).then_some([0.0, 1.0]);
    }
    let middle = to.dot(&chord) / square;
    let across = (to - chord * middle).norm_squared();
    let half = libm::sqrt((bound * bound - across) / square);
    // A root of a negative number is none.
    (half.is_finite() && middle + half >= 0.0 && middle - half <= 1.0)
        .then(|| [(middle - half).max(0.0), (middle + half).min(1.0)])
}
