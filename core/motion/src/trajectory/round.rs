//! Curves in the place of corners.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::bounds::{
    ARC, CURVE, DerivativeBounds, MoveBounds, MoveDemand, NORMAL, PLACES, PlaceLimits, TIP,
    largest_rate, with_tip,
};
use super::kink::Kink;
use super::side::CornerSide;
use crate::limits::{AxisLimits, MoveLimits};

/// The part of the length of a corner by whose product with the change of direction it strays.
const STRAY: f64 = 3.0 / 32.0;

/// The steepest slope of the smooth step.
const STEEPEST: f64 = 1.5;

/// The steepest change of that slope.
const SHARPEST: f64 = 6.0;

/// No move gives more of itself to a corner.
const HALF: f64 = 0.5;

/// Factor by which a length is longer than what is just long enough.
const AMPLE: f64 = 1.0 + 1e-9;

/// Ways that turn by less, or by nearly half a turn, have no arc between them, radians.
const LEAST_SWEEP: f64 = 1e-3;

/// Share of the shorter way by which an arc without a tolerance may stray.
const STRAY_OF_LENGTH: f64 = 0.25;

/// What a corner is rounded by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum CornerCurve {
    /// The one way runs out by the smooth step while the other one runs in.
    Smooth,
    /// An arc of a circle, by the angle that it turns, radians.
    Circle(f64),
}

/// A curve in the place of a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoundedCorner {
    /// How much faster the parameter of the second move runs.
    pub ratio: f64,
    /// What it takes of the one move and of the other.
    pub shares: [f64; 2],
    pub curve: CornerCurve,
    /// Length over the first move's parameter.
    pub length: f64,
    /// What limits it, over its own parameter from 0 to 1.
    pub bounds: MoveBounds,
}

/// How far the path may be left at a corner, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CornerBound {
    /// Largest distance from the path.
    pub tolerance: Option<f64>,
    /// Largest distance from the corner, along the path.
    pub within: Option<f64>,
}

impl CornerBound {
    /// Largest distance from the path: no curve within so far of a corner is farther from it.
    pub fn off_path(self) -> Option<f64> {
        self.tolerance.or(self.within)
    }
}

/// Corners by the smooth step between two moves.
pub(super) struct SmoothCorners<'a> {
    found: [&'a MoveLimits; 2],
    limits: PlaceLimits,
    ratio: f64,
    /// Rate of the first move's parameter with which they would be passed, 1/s.
    wanted: f64,
    /// Length of the longest, over the first move's parameter: as long as it takes to be passed at that rate, or as it
    /// may be.
    longest: f64,
}

/// One of them, as far as it takes to compare it with others.
#[derive(Clone, Copy)]
pub(super) struct SmoothCorner {
    /// Length over the first move's parameter.
    pub length: f64,
    /// Largest rate of its own parameter from 0 to 1, 1/s.
    pub rate: f64,
}

impl SmoothCorner {
    /// The rate of the first move's parameter with which it is passed, 1/s.
    pub fn passes(&self) -> f64 {
        self.rate * self.length
    }
}

impl<'a> SmoothCorners<'a> {
    /// Those that keep to `bound`.
    pub fn new(
        sides: [CornerSide<'a>; 2],
        rules: &AxisLimits,
        kink: &Kink,
        bound: CornerBound,
        wanted: f64,
    ) -> Self {
        // The unit of length is that of the first move's parameter.
        let sharpest = |limits: &Joints, of_tip: f64| {
            let axes = kink.change.iter().zip(limits);
            let axes = axes.map(|(change, limit)| libm::fabs(*change) / limit);
            axes.fold(kink.tip.norm() / of_tip, f64::max)
        };
        // x'' = 1.5·Δ/l and x''' = 6·Δ/l²: so long that the curve's share of accelerations and jerks does at the
        // velocity that is wanted.
        let bent = sharpest(&rules.acceleration, rules.tip_acceleration) * STEEPEST / NORMAL;
        let jerked = sharpest(&rules.jerk, rules.tip_jerk) * SHARPEST * CURVE;
        let cube = wanted * wanted * wanted;
        let mut longest = AMPLE * (bent * wanted * wanted).max((jerked * cube).sqrt());
        longest = longest.min(2.0 * HALF).min(2.0 * HALF / kink.ratio);
        if let Some(tolerance) = bound.tolerance {
            longest = longest.min(tolerance / (STRAY * kink.tip.norm()));
        }
        if let Some(within) = bound.within {
            let ways = [sides[0].found.tip_ends[1], sides[1].found.tip_ends[0] * kink.ratio];
            let way = ways[0].norm().max(ways[1].norm());
            longest = longest.min(2.0 * within / way);
        }
        let found = [sides[0].found, sides[1].found];
        let limits = PlaceLimits::of(rules);
        Self { found, limits, ratio: kink.ratio, wanted, longest }
    }

    /// The one that is this share of the longest; none where that has no length.
    pub fn of(&self, share: f64) -> Option<SmoothCorner> {
        let length = self.longest * share;
        if length <= 0.0 {
            return None;
        }
        let found = on_smooth(self.found, self.shares(length));
        let rate = largest_rate(&found, &self.limits, &self.demand(length));
        Some(SmoothCorner { length, rate })
    }

    /// What it takes of the one move and of the other.
    fn shares(&self, length: f64) -> [f64; 2] {
        [0.5 * length, 0.5 * length * self.ratio]
    }

    fn demand(&self, length: f64) -> MoveDemand {
        MoveDemand { seconds: length / self.wanted, share: 1.0, sweep: None }
    }

    /// All of it.
    pub fn rounded(&self, corner: SmoothCorner) -> RoundedCorner {
        let length = corner.length;
        let shares = self.shares(length);
        let found = on_smooth(self.found, shares);
        RoundedCorner {
            ratio: self.ratio,
            shares,
            curve: CornerCurve::Smooth,
            length,
            bounds: MoveBounds::new(&found, &self.limits, &self.demand(length)),
        }
    }
}

impl RoundedCorner {
    /// The rate of the first move's parameter with which it is passed, 1/s.
    pub fn passes(&self) -> f64 {
        self.bounds.rate * self.length
    }

    /// An arc between straight ways of the tip: the one that is run through as fast as the faster one of them with
    /// [`ARC`] of the least acceleration, and is so long that half of it would do to get up to that within; or a
    /// smaller one. Recorded so of LinuxCNC 2.9: an arc that nothing else makes smaller is `2·v²/a` long at turns of up
    /// to 99°.
    pub fn circle(
        sides: [CornerSide; 2],
        rules: &AxisLimits,
        tolerance: Option<f64>,
    ) -> Option<Self> {
        if sides.iter().any(|side| side.task.way.is_curved()) {
            return None;
        }
        let [out, into] = [sides[0].found.tip_ends[1], sides[1].found.tip_ends[0]];
        let lengths = [out.norm(), into.norm()];
        let shorter = lengths[0].min(lengths[1]);
        let sweep = out.angle(&into);
        if shorter == 0.0 || !(LEAST_SWEEP..std::f64::consts::PI - LEAST_SWEEP).contains(&sweep) {
            return None;
        }
        let mut acceleration = rules.tip_acceleration;
        let ends = [&sides[0].found.ends[1], &sides[1].found.ends[0]];
        for (place, limit) in rules.acceleration.iter().enumerate() {
            if ends.iter().any(|ends| ends[place] != 0.0) {
                acceleration = acceleration.min(*limit);
            }
        }
        let rates = [sides[0].whole.rate, sides[1].whole.rate];
        let speed = (rates[0] * lengths[0]).max(rates[1] * lengths[1]);
        let (sine, cosine) = libm::sincos(0.5 * sweep);
        let most = tolerance.unwrap_or(STRAY_OF_LENGTH * shorter) * cosine / (1.0 - cosine);
        let radius = (speed * speed / acceleration * (1.0 / ARC).max(2.0 / sweep))
            .min(most)
            .min(HALF * shorter * cosine / sine);
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        let shares = lengths.map(|length| radius * sine / cosine / length);
        let length = shares[0] * longer(sweep);
        let found = on_circle([sides[0].found, sides[1].found], shares, sweep);
        let seconds = length * lengths[0] / speed;
        let demand = MoveDemand { seconds, share: 1.0, sweep: Some(sweep) };
        Some(Self {
            ratio: lengths[0] / lengths[1],
            shares,
            curve: CornerCurve::Circle(sweep),
            length,
            bounds: MoveBounds::new(&found, &PlaceLimits::of(rules), &demand),
        })
    }
}

impl CornerCurve {
    /// How much of its part of the first move and of the second one is behind at `share` of the curve.
    ///
    /// By the smooth step `h` the integrals of 1 - h and of h, each over its whole. On an arc of radius 1 that turns by
    /// φ the place at the angle α lies `sin α - (1 - cos α)/tan φ` along the first way and `(1 - cos α)/sin φ` along
    /// the second, of `tan(φ/2)` each.
    pub fn places(self, share: f64) -> [f64; 2] {
        match self {
            Self::Smooth => {
                let cube = share * share * share;
                let fourth = cube * share;
                [2.0 * share - 2.0 * cube + fourth, 2.0 * cube - fourth]
            }
            Self::Circle(sweep) => {
                let (sine, cosine) = libm::sincos(sweep * share);
                let (whole_sine, whole_cosine) = libm::sincos(sweep);
                let into = (1.0 - cosine) / whole_sine;
                let whole = (1.0 - whole_cosine) / whole_sine;
                [(sine - into * whole_cosine) / whole, into / whole]
            }
        }
    }
}

/// Ratio of an arc's length to what it takes of each way: R·φ over R·tan(φ/2).
fn longer(sweep: f64) -> f64 {
    sweep / libm::tan(0.5 * sweep)
}

/// How axes and tip go along a corner that takes these shares of two moves, over its own parameter from 0 to 1.
///
/// With `w = 2·share` for each, `t' = w·(1 - h)` or `w·h`, of which one grows as the other falls; `q'` differs over the
/// share from what it is at the corner by at most `q''·w/2`.
fn on_smooth([first, next]: [&MoveLimits; 2], shares: [f64; 2]) -> DerivativeBounds {
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
    let [mut firsts, mut seconds, mut thirds] = [[0.0; PLACES]; 3];
    for place in 0..MAX_AXES {
        let change = libm::fabs(b * next.ends[0][place] - a * first.ends[1][place]);
        let of = |found: &MoveLimits| [found.first[place], found.second[place], found.third[place]];
        let found = bounds(change, of(first), of(next));
        [firsts[place], seconds[place], thirds[place]] = found;
    }
    let change = (next.tip_ends[0] * b - first.tip_ends[1] * a).norm();
    let tip = bounds(change, first.tip, next.tip);
    [firsts[TIP], seconds[TIP], thirds[TIP]] = tip;
    DerivativeBounds { orders: [firsts, seconds, thirds], circle: [0.0; PLACES] }
}

/// Limits along an arc of a circle that turns by `sweep` between two straight ways.
fn on_circle([first, next]: [&MoveLimits; 2], shares: [f64; 2], sweep: f64) -> DerivativeBounds {
    let (sine, cosine) = libm::sincos(sweep);
    let [out, into] = shares.map(|share| share * longer(sweep));
    let circle = std::array::from_fn(|place| {
        let along = first.ends[1][place] * out;
        let across = (next.ends[0][place] * into - along * cosine) / sine;
        (along * along + across * across).sqrt()
    });
    let circle = with_tip(&circle, first.tip_ends[1].norm() * out, 0.0);
    let orders = [circle, circle.map(|of| of * sweep), circle.map(|of| of * sweep * sweep)];
    DerivativeBounds { orders, circle }
}
