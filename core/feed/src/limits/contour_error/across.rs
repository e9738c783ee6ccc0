//! What the lags of a machine's axes leave between the tip and its path.
//!
//! **Derivation.** Axis `k` answers a motion of frequency `ω` with the gain `M_k` and the phase `-φ_k`. Take a common
//! phase `-φ`, that of a lag of `φ / ω` that all axes share: what is common moves the tip along its path, later, and is no
//! contour error. With `δ_k = φ_k - φ` axis `k` strays from where it was commanded that long ago by
//!
//! ```text
//! e_k = -late_k * Q̇_k + short_k * Q̈_k,   late_k = M_k sin δ_k / ω,   short_k = (1 - M_k cos δ_k) / ω²
//! ```
//!
//! which is exact for a sine, whose quadrature is `Q̇ / ω` and whose opposite is `Q̈ / ω²`, and tends to the first two
//! terms of the response's power series where `ω` tends to 0. The tip strays by `Σ J_k e_k`, where `J_k` is how it goes
//! per unit of the axis ([`Samples::rates`]); what lies along its path is no contour error. With `J⊥_k` the part across,
//! `Q̇ = Q' ṡ` and `Q̈ = Q'' q + Q' s̈`, and the triangle inequality:
//!
//! ```text
//! ε <= L ṡ + S q + C |s̈|,   L = |Σ J⊥_k late_k Q'_k|,   S = |Σ J⊥_k short_k Q''_k|,   C = |Σ J⊥_k short_k Q'_k|
//! ```
//!
//! - The common phase matters in second order alone: `Σ J⊥_k Q'_k` is the part of `P'` across itself, which is nothing.
//! - Axes that answer alike have `L = C = 0` and `S = |short| |Σ J⊥_k Q''_k|`. With three straight axes the sum is the
//!   part of `P''` across, `κ |P'|²`, and `ε = |1 - M| κ f² / ω²`: with `ω = f κ` the feedrate paper's eqs. 6 and 7,
//!   `ρ |1 - |G||`. With rotary axes it is `P''` less what their turning bends, `Σ J'_k Q'_k`: a rotary axis that goes
//!   evenly leaves nothing, however bent the way of the tip on its table is.
//! - Two straight axes that differ, on a circle: `L ṡ` is half of `ρ (δ_x - δ_y)` times the sine of twice the direction,
//!   so the largest over the circle is the rule that [`super::deviation`] states for all directions together.
//!
//! **Frequency.** The path of the axes is taken as a local circle: `ω = c ṡ`, where `c = |v ∧ w| / |v|²` is the speed
//! times the curvature of the path whose coordinates are those of the axes in mm at the tip, `v_k = |J_k| Q'_k` and
//! `w_k = |J_k| Q''_k`; with three straight axes `ω = κ f`. As in eq. 11 it is at most the highest frequency.
//!
//! **What is left out** is what the paper leaves out: third derivatives, so the way from one curvature to another, and
//! what the drives still remember of a corner.

use super::STRAIGHT;
use super::lags::{Lag, Lags};
use crate::samples::{Samples, dot, is_still, norm};

/// The path of the axes at a sample, as the tip feels it.
#[derive(Clone, Debug, Default)]
pub(super) struct Across {
    /// `J⊥_k Q'_k` and `J⊥_k Q''_k` of each axis, mm.
    axes: Vec<[[f64; 3]; 2]>,
    /// Frequency per unit of the parameter's speed, rad; 0 where nothing moves.
    turning: f64,
}

/// How a contour error within a tolerance bounds the motion at a sample: `q <= speed²`, and
/// `|rate * q ± push * s̈| <= 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MotionBound {
    /// Largest speed of the parameter where it goes evenly.
    pub(super) speed: f64,
    pub(super) rate: f64,
    pub(super) push: f64,
}

/// What a frequency makes of the path: `L`, `S` and `C`.
#[derive(Clone, Copy, Debug, Default)]
struct FrequencyShare {
    late: f64,
    short: f64,
    push: f64,
}

impl FrequencyShare {
    fn max(self, other: Self) -> Self {
        Self {
            late: self.late.max(other.late),
            short: self.short.max(other.short),
            push: self.push.max(other.push),
        }
    }

    /// The speed whose error is `tolerance`.
    fn speed(self, tolerance: f64) -> f64 {
        let root = (self.late * self.late + 4.0 * self.short * tolerance).sqrt();
        // The form that loses no digits where one of both is small.
        2.0 * tolerance / (self.late + root)
    }

    /// `√q` is below its tangent, so that what it asks for is linear in `q`, and exact at the bound.
    fn bound(self, speed: f64, tolerance: f64) -> MotionBound {
        let (late, rest) = if speed.is_finite() {
            (0.5 * self.late / speed, tolerance - 0.5 * self.late * speed)
        } else {
            (0.0, tolerance)
        };
        MotionBound { speed, rate: (late + self.short) / rest, push: self.push / rest }
    }
}

impl Across {
    /// Looks at a sample, and at its first `count` axes.
    pub(super) fn take(&mut self, samples: &Samples, sample: usize, count: usize) {
        let along = samples.tip[0][sample];
        let stretch = norm(along);
        let unit = if is_still(stretch) {
            // No direction is along a path that stands still.
            [0.0; 3]
        } else {
            along.map(|value| value / stretch)
        };
        self.axes.clear();
        let (mut speed, mut both, mut bend) = (0.0, 0.0, 0.0);
        let each = || samples.rates.iter().zip(&samples.axes).take(count);
        for (rates, axis) in each() {
            let rate = rates[sample];
            let part = dot(rate, unit);
            let across: [f64; 3] = std::array::from_fn(|place| rate[place] - part * unit[place]);
            let (first, second) = (axis.first[sample], axis.second[sample]);
            self.axes.push([first, second].map(|by| across.map(|value| value * by)));
            let square = dot(rate, rate);
            speed += square * first * first;
            both += square * first * second;
        }
        self.turning = 0.0;
        if speed > 0.0 {
            for (rates, axis) in each() {
                let rest = axis.second[sample] - axis.first[sample] * both / speed;
                bend += dot(rates[sample], rates[sample]) * rest * rest;
            }
            let turning = (bend / speed).sqrt();
            self.turning = turning.max(STRAIGHT * speed.sqrt());
        }
    }

    /// `c`, rad per unit of the parameter.
    pub(super) fn turning(&self) -> f64 {
        self.turning
    }

    /// `|Σ J⊥_k Q''_k|`, mm: all that counts where axes answer alike.
    pub(super) fn bend(&self) -> f64 {
        norm(self.sum(|_| 1.0, 1))
    }

    fn sum(&self, weight: impl Fn(usize) -> f64, order: usize) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for (index, axis) in self.axes.iter().enumerate() {
            let weight = weight(index);
            for (sum, value) in sum.iter_mut().zip(axis[order]) {
                *sum += weight * value;
            }
        }
        sum
    }

    fn share(&self, lags: &[Lag]) -> FrequencyShare {
        FrequencyShare {
            late: norm(self.sum(|axis| lags[axis].late, 0)),
            short: norm(self.sum(|axis| lags[axis].short, 1)),
            push: norm(self.sum(|axis| lags[axis].short, 0)),
        }
    }

    /// The bound for a contour error of `tolerance` mm: the largest speed up to which every speed keeps it.
    pub(super) fn bound(&self, lags: &Lags, tolerance: f64) -> MotionBound {
        let free = MotionBound { speed: f64::INFINITY, rate: 0.0, push: 0.0 };
        if self.turning == 0.0 {
            return free;
        }
        let mut last: Option<(f64, FrequencyShare)> = None;
        for (frequency, lags) in lags.by_frequency() {
            let here = self.share(lags);
            let share = last.map_or(here, |(_, before)| before.max(here));
            let most = frequency / self.turning;
            let speed = share.speed(tolerance);
            if speed < most {
                return match last {
                    // Known to be kept there, and just not beyond.
                    Some((below, before)) if below > speed => before.bound(below, tolerance),
                    _ => share.bound(speed, tolerance),
                };
            }
            last = Some((most, here));
        }
        last.map_or(free, |(speed, share)| share.bound(speed, tolerance))
    }
}
