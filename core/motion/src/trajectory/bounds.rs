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

use post_machine::kinematics::MAX_AXES;

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

/// One thing that is limited.
struct LimitedQuantity {
    /// Bounds of the derivatives over the parameter.
    derivatives: [f64; 3],
    /// Largest first derivative on the whole circle of an arc.
    circle: f64,
    velocity: f64,
    acceleration: f64,
    jerk: f64,
    by: [TimeLimit; 3],
}

/// What is limited on a move.
fn all<'a>(
    found: &'a MoveLimits,
    rules: &'a AxisLimits,
) -> impl Iterator<Item = LimitedQuantity> + 'a {
    let axes = (0..MAX_AXES).map(|place| {
        let axis = place as u8;
        LimitedQuantity {
            derivatives: [found.first[place], found.second[place], found.third[place]],
            circle: found.circle.map_or(0.0, |circle| circle[place]),
            velocity: rules.velocity[place],
            acceleration: rules.acceleration[place],
            jerk: rules.jerk[place],
            by: [
                TimeLimit::AxisVelocity(axis),
                TimeLimit::AxisAcceleration(axis),
                TimeLimit::AxisJerk(axis),
            ],
        }
    });
    let tip = LimitedQuantity {
        derivatives: found.tip,
        circle: found.tip[0],
        velocity: f64::INFINITY,
        acceleration: rules.tip_acceleration,
        jerk: rules.tip_jerk,
        by: [TimeLimit::Feed, TimeLimit::TipAcceleration, TimeLimit::TipJerk],
    };
    axes.chain([tip]).filter(|limited| limited.derivatives.iter().any(|value| *value > 0.0))
}

impl MoveBounds {
    /// Bounds of a move that the program wants to take `seconds` (0: as fast as it goes), and whose accelerations may
    /// take `share` of the limits. `sweep`: the angle of an arc, radians, and nothing else turns.
    pub fn new(
        found: &MoveLimits,
        rules: &AxisLimits,
        seconds: f64,
        share: f64,
        sweep: Option<f64>,
    ) -> Self {
        let mut bounds = Self {
            rate: 1.0 / seconds.max(INSTANT),
            acceleration: f64::INFINITY,
            jerk: f64::INFINITY,
            by: [TimeLimit::Feed; 3],
        };
        let least = |bound: &mut f64, own: &mut TimeLimit, value: f64, by: TimeLimit| {
            if value < *bound {
                (*bound, *own) = (value, by);
            }
        };
        // How fast it could go by the velocities alone, whatever the program asks for.
        let mut free = f64::INFINITY;
        for limited in all(found, rules) {
            let [first, second, third] = limited.derivatives;
            let [velocity, acceleration, jerk] = limited.by;
            free = free.min(limited.velocity / first);
            let (rate, by) = (&mut bounds.rate, &mut bounds.by[0]);
            least(rate, by, limited.velocity / first, velocity);
            let (across, part) = match sweep {
                Some(sweep) => (sweep * limited.circle, ARC),
                None => (second, NORMAL),
            };
            let most = part * share * limited.acceleration / across;
            least(rate, by, most.sqrt(), acceleration);
            let most = share * limited.jerk / (CURVE * third);
            // A cube root is asked for where it may be less: most are not.
            if most < *rate * *rate * *rate * (1.0 + 1e-12) {
                least(rate, by, libm::cbrt(most), jerk);
            }
        }
        let rate = bounds.rate;
        for limited in all(found, rules) {
            let [first, second, third] = limited.derivatives;
            let [_, acceleration, jerk] = limited.by;
            let (most, hardest) = (share * limited.acceleration, share * limited.jerk);
            let (change, by) = (&mut bounds.acceleration, &mut bounds.by[1]);
            let along = match sweep {
                Some(sweep) => {
                    let first = limited.circle.max(first);
                    let across = sweep * first * free * free;
                    match second > 0.0 && across > ARC * most {
                        true => 0.5 * most / first,
                        false => (most * most - across * across).sqrt() / first,
                    }
                }
                None => (most - second * rate * rate) / first,
            };
            least(change, by, along, acceleration);
            if second > 0.0 {
                least(change, &mut bounds.by[1], hardest / (9.0 * second * rate), jerk);
            }
            let spent = third * rate * rate * rate;
            let mixed = 3.0 * second * rate * bounds.acceleration;
            let left = (hardest - spent - mixed).max(hardest / 3.0);
            least(&mut bounds.jerk, &mut bounds.by[2], left / first, jerk);
        }
        bounds.acceleration = bounds.acceleration.min(rate / INSTANT);
        bounds
    }
}

impl MoveBounds {
    /// The highest rate over the whole move from rest to rest, no jerk regarded, 1/s.
    pub fn reached(&self) -> f64 {
        self.rate.min(self.acceleration.sqrt())
    }
}
