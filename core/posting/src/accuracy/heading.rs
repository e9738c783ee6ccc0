//! Where a leading edge is wanted along a piece: its heading (the direction of motion, or the second vector of the CL
//! points) goes along a great circle from end to end, and at each instant it is laid across the tool axis of that
//! instant.

use std::f64::consts::PI;

use super::certificate::chord_angle;
use post_machine::kinematics::Pose;
use post_machine::kinematics::orientation::angle;

/// A bound on the second derivative of the wanted edge over a piece between two wanted poses; infinite where the
/// heading may lie along the tool axis, for there the edge turns round.
///
/// With `u` the tool axis, `h` the heading, `w` the wanted edge, `v = u×w`: `h = c·u + s·w`, s the sine of the angle
/// between heading and axis. Along their great circles u turns by at most `a` and h by at most `b` in all. The frame
/// (u, w, v) turns about u at the rate `p = (v·h' - c·v·u')/s`, so `|p| <= P = (b + a)/s`, and `|w'|`, `|v'|` are at
/// most `Q = sqrt(a² + P²)`. Since `v·h'' = v·u'' = 0`, `|c'| <= s·(a + b)` and `|s'| <= a + b`,
/// `|p'| <= (Q·b + P·a + P·(a + b))/s + (a + b)·a`; and `w'' = -(u'·w)'u - (u'·w)u' + p'v + p·v'` with
/// `|(u'·w)'| <= P·a` gives `|w''| <= P·a + a² + |p'| + P·Q`.
pub(super) fn bend(from: &Pose, to: &Pose) -> f64 {
    let a = chord_angle((from.axis - to.axis).norm());
    let b = chord_angle((from.edge - to.edge).norm());
    // Between the ends the angle between heading and axis changes by no more than both turn.
    let sum = angle(from.edge, from.axis) + angle(to.edge, to.axis);
    let (least, most) = ((sum - a - b) / 2.0, (sum + a + b) / 2.0);
    if least <= 0.0 || most >= PI {
        return f64::INFINITY;
    }
    let s = libm::sin(least).min(libm::sin(most));
    let p = (b + a) / s;
    let q = libm::sqrt(a * a + p * p);
    let faster = (q * b + p * a + p * (a + b)) / s + (a + b) * a;
    p * a + a * a + faster + p * q
}
