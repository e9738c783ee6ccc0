//! Corners: the way from one move into the next.
//!
//! - **Stop**: the machine stands still between them.
//! - **Join** (exact path, and wherever two moves go on in each other's direction): both are run through as one path.
//!   The velocities of what is limited jump by `|Δ|·v`, `Δ` the difference of their derivatives along the path, and `v`
//!   is bounded so that none jumps by more than its limit ([`AxisLimits::jump`]). Controls have that limit: Fanuc as the
//!   feedrate difference that is allowed for each axis (parameter 1783, B-63833EN-1/02 §7), Siemens as a factor on the
//!   acceleration of one interpolation cycle (MD32310, 6FC5397-0BP40-2BA0, B1 §3.3: factor 2 is what is assumed where the
//!   machine file says nothing). Where the blocks are so short that jump upon jump makes a curve of them, they pass no
//!   more than the acceleration in the time of the longer of two blocks (Fanuc's feedrate clamping by acceleration,
//!   A-78962EN §2.7). Where moves overlap by rule the jump is [`KINK`](crate::limits) of an acceleration, and joined
//!   moves have the rest of it, so that the limits hold in the set-points too; and moves in which a rotary axis turns are
//!   never joined: LinuxCNC's way.
//! - **Round** (a curve within the tolerance): near the corner the one move runs out while the other one runs in, both
//!   over the same stretch of path and added, so that the derivative along the path goes from that of the one to that of
//!   the other by the smooth step `h(τ) = 3τ² - 2τ³`: curvature begins and ends with zero. Between straight ways the
//!   deviation is largest in the middle, `3/32·l·|Δ|` with `l` the length of the corner. No move gives more than half of
//!   itself to a corner, and no corner is longer than its feed needs. Without jerk limits there is no curve where the
//!   moves may be joined at full feed; with them there is one wherever it costs no time. Where the curve would be passed
//!   more slowly than the kink (very short moves, tight tolerances) the moves are joined, as Siemens does with MD32310
//!   (ibid.).
//! - **Overlap** (parabolic blend; LinuxCNC for moves in which rotary axes turn): the next move begins at rest when
//!   this one is slowed down to `v₁` on its way to rest, and their ways add up. Each has half of all accelerations. `v₁`
//!   and the velocity `v₂` that the next one has reached when this one stands are what comes of the longest common time
//!   in which neither leaves more than half of its way; a tolerance `P` bounds both by `2·√(a·P/cos θ)`, `θ` half the
//!   angle between the ways: then the deviation in the middle of two like parabolas is `P`. Two moves in which no rotary
//!   axis turns are rounded instead, straight ones by an arc of a circle, without a tolerance by up to a quarter of the
//!   shorter one, at the faster one's feed. A move whose end may be left is accelerated by half even where a standstill
//!   comes, and one that must end where it is programmed with all of it even while it is overlapped, when both together
//!   may pass a limit by half of it: recorded so of LinuxCNC 2.9. With jerk limits, which that rule knows nothing of,
//!   both have half, the next move begins when this one is slowed down to half of `v₁`, and is speeded up over twice the
//!   time that is left: half of either ramp.

use post_machine::description::BlendRule;

use super::kink::Kink;
use super::profile::Ramp;
use super::round::{CornerBound, RoundedCorner, SmoothCorner, SmoothCorners};
use super::side::CornerSide;
use crate::CornerMode;
use crate::limits::AxisLimits;

/// What happens between two moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Junction {
    /// The machine stands still.
    Stop,
    /// The path goes on, its parameter scaled by `ratio` from one move to the next; `rate` bounds that of the first
    /// one.
    Join {
        ratio: f64,
        rate: f64,
        /// The velocities jump.
        jumps: bool,
    },
    /// The moves overlap by a curve.
    Round(RoundedCorner),
    /// The second begins when the rate of the first has come down to `rate`; its own rate then changes by no more than
    /// `change`, 1/s².
    Overlap { rate: f64, change: f64 },
}

/// Below this cosine of half the angle between two ways they go straight on.
const STRAIGHT: f64 = 1e-3;

/// A curve that is passed at this share of the feed or faster is taken as it is.
const AT_SPEED: f64 = 0.9;

/// Else shorter ones are tried: shares of the longest.
const SHORTER: [f64; 4] = [0.5, 0.25, 0.1, 0.03];

/// Rates this near to each other, as a share, are one.
const SAME: f64 = 1e-9;

impl Junction {
    /// Junction between two moves, the first of which asks for its `corner`.
    pub fn between(sides: [CornerSide; 2], rules: &AxisLimits, blend: BlendRule) -> Self {
        let overlaps = blend == BlendRule::Overlap && sides.iter().any(CornerSide::turns);
        let tolerance = match sides[0].task.corner {
            CornerMode::Stop => return Self::Stop,
            CornerMode::Path if overlaps => return Self::Stop,
            CornerMode::Path => None,
            CornerMode::Blend { .. } | CornerMode::Within { .. } if overlaps => {
                return Self::overlap(sides, rules);
            }
            CornerMode::Blend { tolerance } => Some(CornerBound { tolerance, within: None }),
            CornerMode::Within { distance } => {
                Some(CornerBound { tolerance: None, within: Some(distance) })
            }
        };
        let Some(kink) = Kink::new(sides, rules) else {
            return match (tolerance, blend) {
                (Some(_), BlendRule::Overlap) => Self::overlap(sides, rules),
                _ => Self::Stop,
            };
        };
        let rate = kink.rate(rules, blend);
        let join = Self::Join { ratio: kink.ratio, rate, jumps: kink.is_seen() };
        let wanted = sides[0].whole.rate.min(sides[1].whole.rate / kink.ratio);
        let jerk = rules.limits_jerk();
        let Some(tolerance) = tolerance.filter(|_| rate < wanted || jerk && kink.is_seen()) else {
            return join;
        };
        // The beginning of an overlapped move is counted on its whole length.
        if sides[0].overlapped {
            return Self::overlap(sides, rules);
        }
        let smooth = SmoothCorners::new(sides, rules, &kink, tolerance, wanted);
        let faster = |passes: f64| passes > rate.min(wanted) * (1.0 - SAME);
        if !jerk {
            let circle = match blend {
                BlendRule::Overlap => RoundedCorner::circle(sides, rules, tolerance.off_path()),
                BlendRule::Round => None,
            };
            let round = circle.or_else(|| smooth.of(1.0).map(|corner| smooth.rounded(corner)));
            return round.filter(|round| faster(round.passes())).map_or(join, Self::Round);
        }
        let whole = smooth.of(1.0).filter(|corner| faster(corner.passes()));
        if let Some(corner) = whole.filter(|corner| corner.passes() >= AT_SPEED * wanted) {
            return Self::Round(smooth.rounded(corner));
        }
        // A long curve that is passed slowly takes longer than a short one, or the kink: what counts is the time.
        let seconds = |corner: &SmoothCorner| {
            1.0 / corner.rate + around(sides, kink.ratio, corner.passes(), 0.5 * corner.length)
        };
        let shorter = SHORTER.iter().filter_map(|share| smooth.of(*share));
        let corners = whole.into_iter().chain(shorter.filter(|corner| faster(corner.passes())));
        let mut least = around(sides, kink.ratio, rate.min(wanted), 0.0);
        let mut best = None;
        for corner in corners {
            let taken = seconds(&corner);
            if taken < least {
                (least, best) = (taken, Some(corner));
            }
        }
        best.map_or(join, |corner| Self::Round(smooth.rounded(corner)))
    }

    fn overlap(sides: [CornerSide; 2], rules: &AxisLimits) -> Self {
        let tolerance = match sides[0].task.corner {
            CornerMode::Blend { tolerance } => tolerance,
            // No curve within so far of a corner is farther from it.
            CornerMode::Within { distance } => Some(distance),
            CornerMode::Stop | CornerMode::Path => None,
        };
        let first = sides[0].half;
        let next = match sides[1].task.corner {
            CornerMode::Stop | CornerMode::Path if sides[1].whole.jerk.is_infinite() => {
                sides[1].whole
            }
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
        let mut bound = tolerance.is_some();
        let ways = [sides[0].heading(1, rules), sides[1].heading(0, rules)];
        if let (Some(tolerance), [Some((out, length)), Some((into, next))]) = (tolerance, ways) {
            // cos θ with θ half the angle between the ways: √((1 - cos of the change of direction) / 2).
            let cosine = (0.5 * (1.0 - out.dot(&into))).max(0.0).sqrt();
            bound = cosine > STRAIGHT;
            let speed = 2.0 * (first.acceleration * length * tolerance / cosine).sqrt();
            for (rate, length) in rates.iter_mut().zip([length, next]) {
                *rate = rate.min(speed / length);
            }
        }
        let [rate, next_rate] = rates;
        Self::Overlap {
            rate,
            // Recorded: without a tolerance, and straight on, it is speeded up as hard as it may be from where the
            // overlap begins.
            change: match bound {
                true => (next_rate * first.acceleration / rate).min(next.acceleration),
                false => next.acceleration,
            },
        }
    }
}

/// How long the halves of two moves next to each other take, s, less what a corner takes of either, that is passed at
/// `rate`. Rates and lengths are those of the first move's parameter.
fn around(sides: [CornerSide; 2], ratio: f64, rate: f64, taken: f64) -> f64 {
    let half = |side: &CornerSide, ratio: f64| {
        let ramp =
            Ramp { acceleration: side.whole.acceleration / ratio, jerk: side.whole.jerk / ratio };
        let length = (0.5 / ratio - taken).max(0.0);
        let top = ramp.reach(rate, length).min(side.whole.rate / ratio).max(rate);
        let level = (length - ramp.length(rate, top)).max(0.0);
        ramp.seconds(top - rate) + if top > 0.0 { level / top } else { 0.0 }
    };
    half(&sides[0], 1.0) + half(&sides[1], ratio)
}
