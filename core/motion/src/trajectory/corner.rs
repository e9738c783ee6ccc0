//! From one move into the next.
//!
//! - **Stop**: the machine stands still between them.
//! - **Join** (exact path, and wherever two moves go on in each other's direction): both are run through as one path. The
//!   velocities of what is limited jump by `|Δ|·v`, `Δ` the difference of their derivatives along the path, and `v` is
//!   bounded so that none jumps by more than its acceleration makes of it in one period. For that one period, therefore, an
//!   acceleration of up to twice the limit can be seen in the set-points; where the direction changes for good, the machine
//!   all but stands still. Where moves overlap by rule it is [`KINK`] of that, and joined moves have the rest of their
//!   accelerations, so that the limits hold in the set-points too; and moves in which a rotary axis turns are never joined:
//!   LinuxCNC's way.
//! - **Round** (a curve within the tolerance): near the corner the one move runs out while the other one runs in, both over
//!   the same stretch of path and added, so that the derivative along the path goes from that of the one to that of the
//!   other by the smooth step `h(τ) = 3τ² - 2τ³`: curvature begins and ends with zero. Between straight ways the deviation
//!   is largest in the middle, `3/32·l·|Δ|` with `l` the length of the corner. No move gives more than half of itself to a
//!   corner, and no corner is longer than its feed needs.
//! - **Overlap** (parabolic blend; LinuxCNC for moves in which rotary axes turn): the next move begins at rest when this one
//!   is slowed down to `v₁` on its way to rest, and their ways add up. Each has half of all accelerations. `v₁` and the
//!   velocity `v₂` that the next one has reached when this one stands are what comes of the longest common time in which
//!   neither leaves more than half of its way; a tolerance `P` bounds both by `2·√(a·P/cos θ)`, `θ` half the angle between
//!   the ways: then the deviation in the middle of two like parabolas is `P`. Two moves in which no rotary axis turns are
//!   rounded instead. A move whose end may be left is accelerated by half even where a standstill comes, and one that must
//!   end where it is programmed with all of it even while it is overlapped, when both together may pass a limit by half of
//!   it: recorded so of LinuxCNC 2.9. With jerk limits, which that rule knows nothing of, both have half, the next
//!   move begins when this one is slowed down to half of `v₁`, and is speeded up over twice the time that is left: half of
//!   either ramp.

use nalgebra::Vector3;
use post_machine::description::BlendRule;
use post_machine::kinematics::{Joints, MAX_AXES};

use super::bounds::{Bounds, CURVE, NORMAL};
use crate::limits::{AxisLimits, MoveLimits};
use crate::path::{Way, turns};
use crate::{Corner, Move};

/// The part of the length of a corner by whose product with the change of direction it strays.
const STRAY: f64 = 3.0 / 32.0;

/// The steepest slope of the smooth step.
pub(super) const STEEPEST: f64 = 1.5;

/// The steepest change of that slope.
pub(super) const SHARPEST: f64 = 6.0;

/// The share of an acceleration that a jump of the velocity may take where moves overlap by rule: LinuxCNC's kink ratio.
/// Joined moves have the rest.
pub(super) const KINK: f64 = 0.1;

/// No move gives more of itself to a corner.
const HALF: f64 = 0.5;

/// A move as a corner sees it.
#[derive(Clone, Copy)]
pub(super) struct Side<'a> {
    pub task: &'a Move,
    pub found: &'a MoveLimits,
    /// With all accelerations.
    pub whole: &'a Bounds,
    /// With half of them.
    pub half: &'a Bounds,
    /// The move before overlaps it.
    pub overlapped: bool,
}

/// What happens between two moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Junction {
    /// The machine stands still.
    Stop,
    /// The path goes on, its parameter scaled by `ratio` from one move to the next; `rate` bounds that of the first one.
    Join { ratio: f64, rate: f64 },
    /// The same, by a curve that takes these shares of both moves.
    Round { ratio: f64, shares: [f64; 2] },
    /// The second begins when the rate of the first has come down to `rate`; its own rate then changes by no more than
    /// `change`, 1/s².
    Overlap { rate: f64, change: f64 },
}

impl Junction {
    /// Between two moves, the first of which asks for its `corner`.
    pub fn between(sides: [Side; 2], rules: &AxisLimits, blend: BlendRule, period: f64) -> Self {
        let overlaps = blend == BlendRule::Overlap && sides.iter().any(Side::turns);
        let tolerance = match sides[0].task.corner {
            Corner::Stop => return Self::Stop,
            Corner::Path if overlaps => return Self::Stop,
            Corner::Path => return Self::join(sides, rules, period, blend),
            Corner::Blend { tolerance } => tolerance,
        };
        let join = match overlaps {
            true => return Self::overlap(sides, tolerance),
            false => Self::join(sides, rules, period, blend),
        };
        let Self::Join { ratio, rate } = join else {
            return match blend {
                BlendRule::Overlap => Self::overlap(sides, tolerance),
                BlendRule::Round => join,
            };
        };
        let wanted = sides[0].whole.rate.min(sides[1].whole.rate / ratio);
        if rate >= wanted {
            return join;
        }
        // The beginning of an overlapped move is counted on its whole length.
        if sides[0].overlapped {
            return Self::overlap(sides, tolerance);
        }
        Self::round(sides, rules, tolerance, ratio, [rate, wanted]).unwrap_or(join)
    }

    fn join(sides: [Side; 2], rules: &AxisLimits, period: f64, blend: BlendRule) -> Self {
        let Some(ratio) = ratio(sides, rules) else {
            return Self::Stop;
        };
        let (change, tip) = change(sides, ratio);
        let mut rate = f64::INFINITY;
        let instant = period
            * match blend {
                BlendRule::Overlap => KINK,
                BlendRule::Round => 1.0,
            };
        for (place, change) in change.iter().enumerate() {
            rate = rate.min(rules.acceleration[place] * instant / libm::fabs(*change));
        }
        rate = rate.min(rules.tip_acceleration * instant / tip.norm());
        Self::Join { ratio, rate }
    }

    /// None where a curve is no better than passing at the first of two rates.
    fn round(
        sides: [Side; 2],
        rules: &AxisLimits,
        tolerance: Option<f64>,
        ratio: f64,
        [passing, wanted]: [f64; 2],
    ) -> Option<Self> {
        // The unit of length is that of the first move's parameter.
        let (change, tip) = change(sides, ratio);
        let sharpest = |limits: &Joints, of_tip: f64| {
            let axes = change.iter().zip(limits);
            let axes = axes.map(|(change, limit)| libm::fabs(*change) / limit);
            axes.fold(tip.norm() / of_tip, f64::max)
        };
        // x'' = 1.5·Δ/l and x''' = 6·Δ/l²: so long that the curve's share of accelerations and jerks does at the velocity
        // that is wanted.
        let bent = sharpest(&rules.acceleration, rules.tip_acceleration) * STEEPEST / NORMAL;
        let jerked = sharpest(&rules.jerk, rules.tip_jerk) * SHARPEST * CURVE;
        let mut length = (bent * wanted * wanted).max((jerked * wanted * wanted * wanted).sqrt());
        length = length.min(2.0 * HALF).min(2.0 * HALF / ratio);
        if let Some(tolerance) = tolerance {
            length = length.min(tolerance / (STRAY * tip.norm()));
        }
        // A jump would pass the jerk that is allowed, whatever its velocity.
        let possible = length > 0.0 && (jerked > 0.0 || length / bent > passing * passing);
        possible.then_some(Self::Round {
            ratio,
            shares: [0.5 * length, 0.5 * length * ratio],
        })
    }

    fn overlap(sides: [Side; 2], tolerance: Option<f64>) -> Self {
        let first = sides[0].half;
        let next = match sides[1].task.corner {
            Corner::Stop | Corner::Path if sides[1].whole.jerk.is_infinite() => sides[1].whole,
            _ => sides[1].half,
        };
        let [most_first, most_next] = [first.reached(), next.reached()];
        let longest = (1.0 / most_first).min(1.0 / most_next);
        let needed = (most_first / first.acceleration).max(most_next / next.acceleration);
        let seconds = longest.min(needed);
        let mut rates = [
            most_first.min(seconds * first.acceleration),
            most_next.min(seconds * next.acceleration),
        ];
        let [out, into] = [sides[0].found.tip_ends[1], sides[1].found.tip_ends[0]];
        let lengths = [out.norm(), into.norm()];
        if let Some(tolerance) = tolerance.filter(|_| lengths.iter().all(|length| *length > 0.0)) {
            // cos θ with θ half the angle between the ways: √((1 - cos of the change of direction) / 2).
            let turned = out.dot(&into) / (lengths[0] * lengths[1]);
            let cosine = (0.5 * (1.0 - turned)).max(0.0).sqrt();
            let speed = 2.0 * (first.acceleration * lengths[0] * tolerance / cosine).sqrt();
            for (rate, length) in rates.iter_mut().zip(lengths) {
                *rate = rate.min(speed / length);
            }
        }
        let [rate, next_rate] = rates;
        Self::Overlap {
            rate,
            // Recorded: without a tolerance it is speeded up as hard as it may be from where the overlap begins.
            change: match tolerance {
                None => next.acceleration,
                Some(_) => (next_rate * first.acceleration / rate).min(next.acceleration),
            },
        }
    }
}

impl Side<'_> {
    fn turns(&self) -> bool {
        turns(self.task.solver.chain(), [&self.task.from, &self.task.to])
    }
}

/// How much faster the parameter of the second move runs than that of the first where they meet, such that the velocities
/// of what is limited, each weighed by its acceleration, keep their length; none where they cannot be compared.
fn ratio(sides: [Side; 2], rules: &AxisLimits) -> Option<f64> {
    // Between coordinates of the tip and of the axes there is no comparison.
    let coordinates = sides.map(|side| side.task.keeps_tip && side.task.way != Way::Axes);
    if rules.programmed.is_some() && coordinates[0] != coordinates[1] {
        return None;
    }
    let weight = |place: usize| {
        [rules.acceleration[place], rules.velocity[place], 1.0]
            .into_iter()
            .find(|limit| limit.is_finite())
            .map_or(1.0, f64::recip)
    };
    let size = |derivatives: &Joints| {
        let squares = derivatives.iter().enumerate().map(|(place, value)| {
            let weighed = value * weight(place);
            weighed * weighed
        });
        squares.sum::<f64>().sqrt()
    };
    let [out, into] = [&sides[0].found.ends[1], &sides[1].found.ends[0]].map(size);
    let ratio = out / into;
    (out > 0.0 && into > 0.0 && ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

/// How the derivatives over the first move's parameter change at the corner: of what is limited, and of the tip.
fn change(sides: [Side; 2], ratio: f64) -> (Joints, Vector3<f64>) {
    let [out, into] = [&sides[0].found.ends[1], &sides[1].found.ends[0]];
    let mut change = [0.0; MAX_AXES];
    for (change, (out, into)) in change.iter_mut().zip(out.iter().zip(into)) {
        *change = into * ratio - out;
    }
    let [out, into] = [sides[0].found.tip_ends[1], sides[1].found.tip_ends[0]];
    (change, into * ratio - out)
}

/// How axes and tip go along a corner that takes these shares of two moves, over its own parameter from 0 to 1.
///
/// With `w = 2·share` for each, `t' = w·(1 - h)` or `w·h`, of which one grows as the other falls; `q'` differs over the
/// share from what it is at the corner by at most `q''·w/2`.
pub(super) fn found([first, next]: [&MoveLimits; 2], shares: [f64; 2]) -> MoveLimits {
    let [a, b] = shares.map(|share| 2.0 * share);
    let bounds = |change: f64, first: [f64; 3], next: [f64; 3]| {
        let bent = a * a * first[1] + b * b * next[1];
        [
            (a * first[0]).max(b * next[0]),
            STEEPEST * (change + 0.5 * bent) + bent,
            SHARPEST * (change + 0.5 * bent)
                + 3.0 * STEEPEST * bent
                + a * a * a * first[2]
                + b * b * b * next[2],
        ]
    };
    let mut found = MoveLimits::default();
    for place in 0..MAX_AXES {
        let change = libm::fabs(b * next.ends[0][place] - a * first.ends[1][place]);
        let of = |found: &MoveLimits| [found.first[place], found.second[place], found.third[place]];
        let [one, two, three] = bounds(change, of(first), of(next));
        (found.first[place], found.second[place], found.third[place]) = (one, two, three);
    }
    let change = (next.tip_ends[0] * b - first.tip_ends[1] * a).norm();
    found.tip = bounds(change, first.tip, next.tip);
    found
}
