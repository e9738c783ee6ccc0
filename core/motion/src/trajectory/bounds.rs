//! How fast a move may be run through: its own parameter's largest rate, and the rate's largest change and change of
//! change, out of what axes and tip do along it.
//!
//! With `q` what a limit holds for, over the parameter `t`, its acceleration is `q'·ẗ + q''·ṫ²` and its jerk
//! `q'·t⃛ + 3·q''·ṫ·ẗ + q'''·ṫ³`. Bounds of the derivatives hold all over the move, so each limit is split once:
//! at most [`NORMAL`] of an acceleration goes to the curve, and what the curve leaves at the velocity that is then
//! allowed is the tangential acceleration; a jerk goes in thirds to `q'''`, to the mixed term and to `t⃛`. On an arc
//! with no turn of a rotary axis the two accelerations stand across each other and share as sides of a right triangle
//! do: [`ARC`] of it to the curve, half of it along, or more where even the axes' largest velocities ask for less
//! across, as LinuxCNC shares it.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::TimeLimit;
use crate::limits::{AxisLimits, MoveLimits};

/// The share of an acceleration that the curve may have.
pub(super) const NORMAL: f64 = 0.75;

/// Parts of its own that a jerk goes to: the curve, the curve and the change of velocity together, that change.
pub(super) const CURVE: f64 = 3.0;

/// The share of it on an arc, cos 30°, which leaves a half across.
pub(super) const ARC: f64 = 0.866_025_403_784_438_6;

/// No move is run through in less than this, s, and no velocity reached in less, however little is limited.
const INSTANT: f64 = 1e-6;

/// Bounds over a move, its parameter running from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MoveBounds {
    /// Largest rate, 1/s.
    pub rate: f64,
    /// Largest change of the rate, 1/s².
    pub acceleration: f64,
    /// Largest change of that, 1/s³; infinite without a jerk limit.
    pub jerk: f64,
    /// What bounds the rate, its change, and the change of that.
    pub by: [TimeLimit; 3],
}

/// Places of what is limited: the axes, the tip behind them, and one that stays empty, as an even number is what vector
/// instructions are made of.
pub(super) const PLACES: usize = MAX_AXES + 2;

/// The place of the tip.
pub(super) const TIP: usize = MAX_AXES;

/// A number of each thing that is limited.
type Places = [f64; PLACES];

/// Bounds of what is limited over a move, its parameter running from 0 to 1; zero where nothing goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct DerivativeBounds {
    /// Of the first three derivatives.
    pub orders: [Places; 3],
    /// Largest first derivatives on the whole circle of an arc.
    pub circle: Places,
}

/// Limits of each place.
#[derive(Clone, Copy)]
pub(super) struct PlaceLimits {
    velocity: Places,
    acceleration: Places,
    jerk: Places,
}

/// How a move is asked to be run through.
#[derive(Clone, Copy)]
pub(super) struct MoveDemand {
    /// Time that the program wants it to take, s; 0: as fast as it goes.
    pub seconds: f64,
    /// Share of the limits that accelerations and jerks may take.
    pub share: f64,
    /// The angle of an arc, radians, where nothing else turns.
    pub sweep: Option<f64>,
}

/// What each place asks of the rate: no more than the first, the root of the second and the cube root of the third.
///
/// Each step is done for all places before the next one, and places without a way are no exceptions: what does not
/// move is limited by infinity, or by no number where its limit is zero, and neither is the least.
struct RateOffers {
    /// By the velocity.
    velocity: Places,
    /// By what the curve may have of the acceleration.
    square: Places,
    /// By what it may have of the jerk.
    cube: Places,
}

/// What limits the velocity, the acceleration and the jerk of a place.
fn limit(place: usize, offer: usize) -> TimeLimit {
    let axis = place as u8;
    match (place < MAX_AXES, offer) {
        (true, 0) => TimeLimit::AxisVelocity(axis),
        (true, 1) => TimeLimit::AxisAcceleration(axis),
        (true, _) => TimeLimit::AxisJerk(axis),
        (false, 0) => TimeLimit::Feed,
        (false, 1) => TimeLimit::TipAcceleration,
        (false, _) => TimeLimit::TipJerk,
    }
}

/// Values of the axes with that of the tip behind them, and `empty`.
pub(super) fn with_tip(axes: &Joints, tip: f64, empty: f64) -> Places {
    let mut places = [empty; PLACES];
    places[..MAX_AXES].copy_from_slice(axes);
    places[TIP] = tip;
    places
}

/// The circle of an arc without what rounding makes of axes that stand still on it.
fn moving(found: &MoveLimits) -> Joints {
    let Some(circle) = found.circle else {
        return Joints::default();
    };
    let moves = |place: usize| {
        [&found.first, &found.second, &found.third].iter().any(|order| order[place] > 0.0)
    };
    std::array::from_fn(|place| if moves(place) { circle[place] } else { 0.0 })
}

impl DerivativeBounds {
    /// Those of a move.
    pub fn of(found: &MoveLimits) -> Self {
        let axes = [&found.first, &found.second, &found.third];
        Self {
            orders: std::array::from_fn(|order| with_tip(axes[order], found.tip[order], 0.0)),
            circle: with_tip(&moving(found), found.tip[0], 0.0),
        }
    }
}

impl PlaceLimits {
    pub fn of(rules: &AxisLimits) -> Self {
        let unlimited = f64::INFINITY;
        Self {
            velocity: with_tip(&rules.velocity, unlimited, unlimited),
            acceleration: with_tip(&rules.acceleration, rules.tip_acceleration, unlimited),
            jerk: with_tip(&rules.jerk, rules.tip_jerk, unlimited),
        }
    }
}

/// The least; what is no number is none.
#[inline]
fn least(values: &Places) -> f64 {
    values.iter().fold(f64::INFINITY, |least, value| lesser(least, *value))
}

/// The second where it is less, else the first.
#[inline(always)]
fn lesser(first: f64, second: f64) -> f64 {
    if second < first { second } else { first }
}

impl MoveDemand {
    /// The rate that the program wants, 1/s.
    fn rate(&self) -> f64 {
        1.0 / self.seconds.max(INSTANT)
    }
}

impl RateOffers {
    #[inline]
    fn new(found: &DerivativeBounds, limits: &PlaceLimits, demand: &MoveDemand) -> Self {
        let [first, second, third] = &found.orders;
        let share = demand.share;
        let (across, part) = match demand.sweep {
            Some(sweep) => (found.circle.map(|circle| sweep * circle), ARC),
            None => (*second, NORMAL),
        };
        let [mut velocity, mut square, mut cube] = [[0.0; PLACES]; 3];
        for place in 0..PLACES {
            velocity[place] = limits.velocity[place] / first[place];
            square[place] = part * share * limits.acceleration[place] / across[place];
            cube[place] = share * limits.jerk[place] / (CURVE * third[place]);
        }
        Self { velocity, square, cube }
    }

    /// The largest rate, 1/s. Roots are rounded correctly, so that the root of the least is the least of the roots.
    #[inline]
    fn largest(&self, demand: &MoveDemand) -> f64 {
        let rate = lesser(demand.rate(), least(&self.velocity));
        let rate = lesser(rate, least(&self.square).sqrt());
        let cube = least(&self.cube);
        match cube < above_cube(rate) {
            true => lesser(rate, libm::cbrt(cube)),
            false => rate,
        }
    }

    /// What bounds the rate: of what asks for the same, the first.
    fn bounded_by(&self, rate: f64, demand: &MoveDemand) -> TimeLimit {
        if rate == demand.rate() {
            return TimeLimit::Feed;
        }
        for place in 0..=TIP {
            if self.velocity[place] == rate {
                return limit(place, 0);
            }
            if self.square[place].sqrt() == rate {
                return limit(place, 1);
            }
            let cube = self.cube[place];
            if cube <= above_cube(rate) && libm::cbrt(cube) == rate {
                return limit(place, 2);
            }
        }
        TimeLimit::Feed
    }
}

/// No cube root of what is above it is as small as this rate: most need not be drawn.
fn above_cube(rate: f64) -> f64 {
    rate * rate * rate * (1.0 + 1e-12)
}

/// The largest rate of a move alone, 1/s: that of [`MoveBounds::new`].
pub(super) fn largest_rate(
    found: &DerivativeBounds,
    limits: &PlaceLimits,
    demand: &MoveDemand,
) -> f64 {
    RateOffers::new(found, limits, demand).largest(demand)
}

impl MoveBounds {
    /// Bounds of a move that is run through as `demand` says.
    pub fn new(found: &DerivativeBounds, limits: &PlaceLimits, demand: &MoveDemand) -> Self {
        let offers = RateOffers::new(found, limits, demand);
        let rate = offers.largest(demand);
        let [_, second, third] = &found.orders;
        let first = &found.orders[0];
        let most = limits.acceleration.map(|limit| demand.share * limit);
        let hardest = limits.jerk.map(|limit| demand.share * limit);
        let along = along(found, &most, rate, least(&offers.velocity), demand.sweep);
        let [mut steepest, mut change, mut left] = [[0.0; PLACES]; 3];
        for place in 0..PLACES {
            steepest[place] = hardest[place] / (9.0 * second[place] * rate);
        }
        // What the places up to each leave of the change.
        let mut acceleration = f64::INFINITY;
        for place in 0..PLACES {
            acceleration = lesser(lesser(acceleration, along[place]), steepest[place]);
            change[place] = acceleration;
        }
        for place in 0..PLACES {
            let spent = third[place] * rate * rate * rate;
            let mixed = 3.0 * second[place] * rate * change[place];
            left[place] = (hardest[place] - spent - mixed).max(hardest[place] / 3.0) / first[place];
        }
        let jerk = least(&left);
        Self {
            rate,
            acceleration: acceleration.min(rate / INSTANT),
            jerk,
            by: [
                offers.bounded_by(rate, demand),
                first_of(acceleration, [&along, &steepest], [1, 2]),
                first_of(jerk, [&left; 2], [2; 2]),
            ],
        }
    }

    /// The highest rate over the whole move from rest to rest, no jerk regarded, 1/s.
    pub fn reached(&self) -> f64 {
        self.rate.min(self.acceleration.sqrt())
    }
}

/// What each place leaves of its acceleration for the change of the rate, 1/s²; `free`: the rate by the velocities
/// alone, however fast the program wants it.
fn along(
    found: &DerivativeBounds,
    accelerations: &Places,
    rate: f64,
    free: f64,
    sweep: Option<f64>,
) -> Places {
    let [first, second, _] = &found.orders;
    let mut along = [0.0; PLACES];
    for place in 0..PLACES {
        let most = accelerations[place];
        along[place] = match sweep {
            None => (most - second[place] * rate * rate) / first[place],
            Some(sweep) => {
                let first = found.circle[place].max(first[place]);
                let across = sweep * first * free * free;
                match second[place] > 0.0 && across > ARC * most {
                    true => 0.5 * most / first,
                    false => (most * most - across * across).sqrt() / first,
                }
            }
        };
    }
    along
}

/// What the bound `value` comes from: the first place, and of its two values the first, that ask for it; the feed where
/// nothing bounds.
fn first_of(value: f64, values: [&Places; 2], offers: [usize; 2]) -> TimeLimit {
    if value == f64::INFINITY {
        return TimeLimit::Feed;
    }
    for place in 0..=TIP {
        for (values, offer) in values.iter().zip(offers) {
            if values[place] == value {
                return limit(place, offer);
            }
        }
    }
    TimeLimit::Feed
}
