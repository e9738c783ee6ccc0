//! The certificate: a proven bound on the deviation of one output block.
//!
//! Along a block every axis is linear in t, so tip and tool axis are smooth functions of t, and the deviation
//! `e(t)` from the CL path (tip: the chord; tool axis: the great circle) has a second derivative that the chain
//! bounds. A function whose second derivative stays below M strays from the line between its ends by at most
//! M/8 over a unit interval; with the ends off by e0 and e1 (the rounding of the printed words among it),
//! `|e(t)| <= max(|e0|, |e1|) + M/8`.
//!
//! Three bounds are at hand, all rigorous: [`quick`] adds norms joint by joint, [`tight`] takes the second
//! derivative as a vector at both ends and bounds what it can do between them by the fourth derivative, and
//! [`BlockDerivatives::tip`] follows the curve that these vectors make, so that ends put off the path on purpose count
//! against the bow between them.

use nalgebra::Vector3;

use post_machine::kinematics::chain::turn;
use post_machine::kinematics::{Chain, MAX_AXES, Trace};

/// Bounds on the second derivative along one block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DerivativeBound {
    /// Bound for the tip's deviation, mm.
    pub tip: f64,
    /// Bound for the tool axis' deviation, as a difference of unit vectors.
    pub axis: f64,
    /// Bound for the tool axis itself, whatever axis is wanted: the bow of a point above a tip that the control keeps.
    pub turn: f64,
    /// Bound for the deviation of a leading edge, as a difference of unit vectors; zero for a tool that turns.
    pub lead: f64,
}

/// A bound from norms: cheap, and at most a small multiple too large.
///
/// From the tool to the workpiece, with r the arm before joint i turns it by w in all:
/// `|(R r)''| <= w²·|k×r| + 2·w·|k×r'| + |r''|`; r strays from its chord by at most an eighth of `|r''|` and
/// r' from the chord's slope by half of it. `sweep` is the angle between the wanted axes, radians.
#[inline]
pub fn quick(chain: &Chain, from: &Trace, to: &Trace, sweep: f64) -> DerivativeBound {
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
        pass(angle, (from.tip_rates[index], to.tip_rates[index]), &mut tip, &mut turns);
    }
    // A unit vector that turns at a rate of `turns` at most bends by its square at most.
    DerivativeBound { tip, axis: turns * turns + sweep * sweep, turn: turns * turns, lead: 0.0 }
}

/// Takes [`quick`] beyond a rotary joint that turns by `angle`, the tip's rates with it being `first` and `last` at the
/// ends; with an angle of zero nothing changes.
#[inline(always)]
pub(super) fn pass(
    angle: f64,
    (first, last): (Vector3<f64>, Vector3<f64>),
    tip: &mut f64,
    turns: &mut f64,
) {
    let radius = larger(first.norm_squared(), last.norm_squared()).sqrt() + *tip / 8.0;
    let slope = (last - first).norm() + *tip / 2.0;
    *tip += angle * (angle * radius + 2.0 * slope);
    *turns += angle;
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
) -> DerivativeBound {
    BlockDerivatives::new(chain, from, to).bend(from_axis, to_axis, sweep)
}

/// How tip and tool axis go along a block: second derivatives at its ends, and what bounds them between.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockDerivatives {
    /// Second derivative of the tip at both ends, mm.
    pub tip: [Vector3<f64>; 2],
    /// Second derivative of the tool axis at both ends.
    pub axis: [Vector3<f64>; 2],
    /// Bounds on the fourth derivatives.
    pub fourth: DerivativeBound,
}

/// The curve of a course is bounded in this many pieces.
const PIECES: u32 = 16;

impl BlockDerivatives {
    /// Works out the derivatives of a block.
    pub fn new(chain: &Chain, from: &Trace, to: &Trace) -> Self {
        let first = second_derivatives(chain, from, from, to);
        let last = second_derivatives(chain, to, from, to);
        Self {
            tip: [first.0, last.0],
            axis: [first.1, last.1],
            fourth: fourth_derivatives(chain, from, to),
        }
    }

    /// Bounds on the second derivatives; see [`tight`]. Nothing is said of a leading edge.
    pub fn bend(
        &self,
        from_axis: Vector3<f64>,
        to_axis: Vector3<f64>,
        sweep: f64,
    ) -> DerivativeBound {
        let square = sweep * sweep;
        // The great circle's own second derivative is -sweep² times itself.
        let first_axis = self.axis[0] + from_axis * square;
        let last_axis = self.axis[1] + to_axis * square;
        DerivativeBound {
            tip: self.tip_bend() + self.fourth.tip / 8.0,
            axis: first_axis.norm().max(last_axis.norm())
                + (self.fourth.axis + square * square) / 8.0,
            turn: self.axis_bend(),
            lead: f64::INFINITY,
        }
    }

    /// A bound on the second derivative of the tool axis, whatever axis is wanted.
    fn axis_bend(&self) -> f64 {
        self.axis[0].norm().max(self.axis[1].norm()) + self.fourth.axis / 8.0
    }

    fn tip_bend(&self) -> f64 {
        self.tip[0].norm().max(self.tip[1].norm())
    }

    /// A bound on the tip's deviation whose ends are off by the vectors `off`, mm.
    ///
    /// With `d0`, `d1` the second derivatives at the ends, the deviation is
    /// `off0·(1-t) + off1·t - t·(1-t)/6·((2-t)·d0 + (1+t)·d1)` but for a remainder whose second derivative is at
    /// most `F·t·(1-t)/2`, so the remainder is at most `5·F/384`, F the bound on the fourth derivative. Between
    /// looks at that cubic it can stray from its chord by an eighth of its second derivative over their distance
    /// squared.
    pub fn tip(&self, off: [Vector3<f64>; 2]) -> f64 {
        let bend = self.tip_bend();
        let ends = off[0].norm().max(off[1].norm());
        let simple = ends + bend / 8.0;
        let remainder = self.fourth.tip * (5.0 / 384.0);
        // Where nothing is to be gained, nothing is looked at.
        if ends < 1e-3 * bend {
            return simple + remainder;
        }
        let mut most = ends;
        for step in 1..PIECES {
            let t = f64::from(step) * (1.0 / f64::from(PIECES));
            let bow = (self.tip[0] * (2.0 - t) + self.tip[1] * (1.0 + t)) * (t * (1.0 - t) / 6.0);
            most = most.max((off[0] * (1.0 - t) + off[1] * t - bow).norm());
        }
        let blind = bend / f64::from(8 * PIECES * PIECES);
        simple.min(most + blind) + remainder
    }
}

/// Two unit vectors across the unit vector `axis` and each other.
pub fn across(axis: Vector3<f64>) -> [Vector3<f64>; 2] {
    let beside = if libm::fabs(axis.x) < 0.8 { Vector3::x() } else { Vector3::y() };
    let first = axis.cross(&beside).normalize();
    [first, axis.cross(&first)]
}

/// The largest length of `a·cos(φ) + b·sin(φ)`.
pub fn longest_around(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    let (aa, bb, ab) = (a.norm_squared(), b.norm_squared(), a.dot(&b));
    let difference = libm::hypot(aa - bb, 2.0 * ab);
    libm::sqrt((aa + bb + difference) / 2.0)
}

/// Takes first and second derivative of what lies beyond a rotary joint over it: `rate` is how it goes with the
/// joint before that has turned, `step` the joint's turn over the block.
#[inline]
fn advance(
    rate: Vector3<f64>,
    k: Vector3<f64>,
    step: f64,
    (sine, cosine): (f64, f64),
    slope: &mut Vector3<f64>,
    bend: &mut Vector3<f64>,
) {
    let across = rate * step;
    let turned_bend = *bend + k.cross(slope) * (2.0 * step) + k.cross(&across) * step;
    *bend = turn(turned_bend, k, sine, cosine);
    *slope = turn(*slope + across, k, sine, cosine);
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
        let turns = at.turns.of(index);
        let tip_rate = at.tip_rates[index];
        let axis_rate = k.cross(&at.axes[index]);
        advance(tip_rate, k, step, turns, &mut tip_slope, &mut tip_bend);
        advance(axis_rate, k, step, turns, &mut axis_slope, &mut axis_bend);
    }
    (tip_bend, axis_bend)
}

/// Bounds on the fourth derivatives, by Leibniz' rule joint by joint.
fn fourth_derivatives(chain: &Chain, from: &Trace, to: &Trace) -> DerivativeBound {
    // Bounds on the first to fourth derivative of what the joints beyond this one do.
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
    DerivativeBound { tip: tip[3], axis: axis[3], ..DerivativeBound::default() }
}

/// The larger of two numbers. [`f64::max`] asks besides whether one of them is none, at three times the cost.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest deviation that an interval can have whose ends are off by `ends`.
#[inline(always)]
pub fn deviation(ends: f64, bend: f64) -> f64 {
    ends + bend / 8.0
}

/// An upper bound on the angle between two unit vectors whose difference is at most `length`, radians.
///
/// `2·asin(c/2) = c + c³/24 + 3c⁵/640 + …`; below a tenth all that follows the first term is less than c³/23.
#[inline]
pub fn chord_angle(length: f64) -> f64 {
    if length < 0.1 {
        return short(length);
    }
    2.0 * libm::asin((length / 2.0).min(1.0))
}

/// [`chord_angle`] of a length below a tenth.
#[inline(always)]
pub(super) fn short(length: f64) -> f64 {
    length + length * length * length * (1.0 / 23.0)
}
