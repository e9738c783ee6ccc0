//! The certificate: a proven bound on the deviation of one output block.
//!
//! Along a block every axis is linear in t, so tip and tool axis are smooth functions of t, and the deviation
//! `e(t)` from the CL path (tip: the chord; tool axis: the great circle) has a second derivative that the chain
//! bounds. A function whose second derivative stays below M strays from the line between its ends by at most
//! M/8 over a unit interval; with the ends off by e0 and e1 (the rounding of the printed words among it),
//! `|e(t)| <= max(|e0|, |e1|) + M/8`.
//!
//! Two bounds are at hand, both rigorous: [`quick`] adds norms joint by joint, [`tight`] takes the second
//! derivative as a vector at both ends and bounds what it can do between them by the fourth derivative.

use nalgebra::Vector3;

use crate::kinematics::chain::turn;
use crate::kinematics::{Chain, MAX_AXES, Trace};

/// Bounds on the second derivative along one block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bend {
    /// Of the tip's deviation, mm.
    pub tip: f64,
    /// Of the tool axis' deviation, as a difference of unit vectors.
    pub axis: f64,
}

/// A bound from norms: cheap, and at most a small multiple too large.
///
/// From the tool to the workpiece, with r the arm before joint i turns it by w in all:
/// `|(R r)''| <= w²·|k×r| + 2·w·|k×r'| + |r''|`; r strays from its chord by at most an eighth of `|r''|` and
/// r' from the chord's slope by half of it. `sweep` is the angle between the wanted axes, radians.
#[inline]
pub fn quick(chain: &Chain, from: &Trace, to: &Trace, sweep: f64) -> Bend {
    let mut tip = 0.0;
    let mut turns = 0.0;
    for (index, joint) in chain.joints().iter().enumerate().rev() {
        if !joint.rotary {
            continue;
        }
        let angle = (to.joints[index] - from.joints[index]).abs();
        if angle == 0.0 {
            continue;
        }
        let (first, last) = (from.tip_rates[index], to.tip_rates[index]);
        let radius = first.norm_squared().max(last.norm_squared()).sqrt() + tip / 8.0;
        let slope = (last - first).norm() + tip / 2.0;
        tip += angle * (angle * radius + 2.0 * slope);
        turns += angle;
    }
    // A unit vector that turns at a rate of `turns` at most bends by its square at most.
    Bend {
        tip,
        axis: turns * turns + sweep * sweep,
    }
}

/// A bound that tends to the true second derivative as the block grows short.
///
/// `from_axis` and `to_axis` are the wanted axes, `sweep` the angle between them, radians.
pub fn tight(
    chain: &Chain,
    from: &Trace,
    to: &Trace,
    from_axis: Vector3<f64>,
    to_axis: Vector3<f64>,
    sweep: f64,
) -> Bend {
    let (first_tip, first_axis) = second_derivatives(chain, from, from, to);
    let (last_tip, last_axis) = second_derivatives(chain, to, from, to);
    let fourth = fourth_derivatives(chain, from, to);
    let square = sweep * sweep;
    // The great circle's own second derivative is -sweep² times itself.
    let first_axis = first_axis + from_axis * square;
    let last_axis = last_axis + to_axis * square;
    Bend {
        tip: first_tip.norm().max(last_tip.norm()) + fourth.tip / 8.0,
        axis: first_axis.norm().max(last_axis.norm()) + (fourth.axis + square * square) / 8.0,
    }
}

/// Second derivatives of tip and tool axis at `at`, an end of the block, in the part frame.
fn second_derivatives(
    chain: &Chain,
    at: &Trace,
    from: &Trace,
    to: &Trace,
) -> (Vector3<f64>, Vector3<f64>) {
    let zero = Vector3::zeros();
    let (mut tip_slope, mut tip_bend) = (zero, zero);
    let (mut axis_slope, mut axis_bend) = (zero, zero);
    for (index, joint) in chain.joints().iter().enumerate().rev() {
        let step = to.joints[index] - from.joints[index];
        let k = joint.direction;
        if !joint.rotary {
            tip_slope += k * step;
            continue;
        }
        let (sine, cosine) = at.turns.of(index);
        let advance = |rate: Vector3<f64>, slope: &mut Vector3<f64>, bend: &mut Vector3<f64>| {
            let across = rate * step;
            let turned_bend = *bend + k.cross(slope) * (2.0 * step) + k.cross(&across) * step;
            *bend = turn(turned_bend, k, sine, cosine);
            *slope = turn(*slope + across, k, sine, cosine);
        };
        advance(at.tip_rates[index], &mut tip_slope, &mut tip_bend);
        advance(k.cross(&at.axes[index]), &mut axis_slope, &mut axis_bend);
    }
    (tip_bend, axis_bend)
}

/// Bounds on the fourth derivatives, by Leibniz' rule joint by joint.
fn fourth_derivatives(chain: &Chain, from: &Trace, to: &Trace) -> Bend {
    // Bounds on the first to fourth derivative of what the joints behind this one do.
    let mut tip = [0.0; 4];
    let mut axis = [0.0; 4];
    for index in (0..chain.joints().len().min(MAX_AXES)).rev() {
        let joint = &chain.joints()[index];
        let w = (to.joints[index] - from.joints[index]).abs();
        if !joint.rotary {
            tip[0] += w;
            continue;
        }
        let grow = |d: &mut [f64; 4], from: Vector3<f64>, to: Vector3<f64>| {
            let radius = from.norm().max(to.norm()) + d[1] / 8.0;
            let (w2, w3) = (w * w, w * w * w);
            *d = [
                w * radius + d[0],
                w2 * radius + 2.0 * w * d[0] + d[1],
                w3 * radius + 3.0 * w2 * d[0] + 3.0 * w * d[1] + d[2],
                w3 * w * radius + 4.0 * w3 * d[0] + 6.0 * w2 * d[1] + 4.0 * w * d[2] + d[3],
            ];
        };
        grow(&mut tip, from.tip_rates[index], to.tip_rates[index]);
        let rate = |trace: &Trace| joint.direction.cross(&trace.axes[index]);
        grow(&mut axis, rate(from), rate(to));
    }
    Bend {
        tip: tip[3],
        axis: axis[3],
    }
}

/// The largest deviation that an interval can have whose ends are off by `ends`.
#[inline]
pub fn deviation(ends: f64, bend: f64) -> f64 {
    ends + bend / 8.0
}

/// An upper bound on the angle between two unit vectors whose difference is at most `length`, radians.
///
/// `2·asin(c/2) = c + c³/24 + 3c⁵/640 + …`; below a tenth all that follows the first term is less than c³/23.
#[inline]
pub fn chord_angle(length: f64) -> f64 {
    if length < 0.1 {
        return length + length * length * length * (1.0 / 23.0);
    }
    2.0 * libm::asin((length / 2.0).min(1.0))
}
