//! Knots: where the envelope meets a bound of the velocity.

use super::{SAME, SmoothPlan};
use crate::trajectory::block::LookAheadBlock;
use crate::trajectory::envelope::VelocityEnvelope;
use crate::trajectory::profile::{Ramp, VelocityProfile};

/// Knots are brought to one velocity where its square is no less than this of the largest one's: a slow corner must not
/// hold up what is near it.
const ALIKE: f64 = 0.5;

/// Changes of a velocity below this share of it are rounding.
const ROUNDING: f64 = 1e-13;

/// A place of the envelope where a bound is met, and what follows on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnvelopeKnot {
    /// The block in front of which it stands.
    pub place: usize,
    pub velocity: f64,
    /// Length, least acceleration and jerk, and the envelope's highest velocity, from here to the next one.
    pub length: f64,
    pub ramp: Ramp,
    pub top: f64,
    /// A corner or a standstill is the reason for it.
    pub corner: bool,
}

impl Default for EnvelopeKnot {
    fn default() -> Self {
        Self {
            place: 0,
            velocity: 0.0,
            length: 0.0,
            ramp: Ramp { acceleration: f64::INFINITY, jerk: f64::INFINITY },
            top: 0.0,
            corner: false,
        }
    }
}

impl EnvelopeKnot {
    /// The hill from it to the next knot, which is passed at `velocity`.
    pub fn profile(&self, velocity: f64) -> VelocityProfile {
        let ends = [self.velocity, velocity];
        VelocityProfile::new(self.length, ends, self.top, self.ramp, self.ramp)
    }

    /// The next knot's velocity can be come to, up or down; what rounding leaves of a change is none.
    pub fn covers(&self, velocity: f64) -> bool {
        libm::fabs(velocity - self.velocity) <= ROUNDING * velocity
            || self.ramp.length(self.velocity, velocity) <= self.length * (1.0 + SAME)
    }
}

/// Blocks between near knots: how long an acceleration takes to rise on them, against how long they last.
#[derive(Clone, Copy, Debug, Default)]
struct KnotGap {
    /// Sum of `l·j/a` over the blocks, their lengths `l`.
    accelerating: f64,
    /// Sum of `l·√j`.
    rising: f64,
}

impl KnotGap {
    fn add(&mut self, block: &LookAheadBlock) {
        self.accelerating += block.length * block.jerk / block.acceleration;
        self.rising += block.length * block.jerk.sqrt();
    }

    /// All of them, run through at the velocity `v` whose `square` this is, last no longer than an acceleration takes to
    /// rise: `Σ l/v` is no more than `a/j` and `√(v/j)`. From `v` on a hill over them would be higher by `v/16` at most.
    fn is_short(&self, square: f64) -> bool {
        let velocity = square.sqrt();
        self.accelerating <= velocity && self.rising <= velocity * velocity.sqrt()
    }
}

impl SmoothPlan {
    /// The velocity in front of the block at `place` is at a bound, and not amid blocks that go at the same.
    fn is_knot(&self, ahead: &VelocityEnvelope, place: usize) -> bool {
        let cap = ahead.caps[place];
        let met = ahead.squares[place] >= cap * cap * (1.0 - SAME);
        let level = |velocity: f64| velocity <= cap * (1.0 + SAME);
        met && !(level(self.velocities[place - 1]) && level(self.velocities[place]))
    }

    /// Brings knots that are closer than an acceleration takes to rise to the least of their velocities; true if any.
    pub(super) fn thin(&mut self, ahead: &mut VelocityEnvelope) -> bool {
        let count = ahead.blocks.len();
        let mut lowered = false;
        let mut place = 1;
        while place < count {
            if !self.is_knot(ahead, place) {
                place += 1;
                continue;
            }
            let begins = place;
            let mut gap = KnotGap::default();
            let (mut last, mut least) = (begins, ahead.squares[begins]);
            let mut most = least;
            while place + 1 < count {
                gap.add(&ahead.blocks[place]);
                if !gap.is_short(least) {
                    break;
                }
                place += 1;
                if self.is_knot(ahead, place) {
                    let square = ahead.squares[place];
                    most = most.max(square);
                    let lowered = least.min(square);
                    if lowered < ALIKE * most || !gap.is_short(lowered) {
                        break;
                    }
                    (last, least) = (place, lowered);
                }
            }
            if last > begins {
                lowered = true;
                let velocity = least.sqrt();
                for place in begins..=last {
                    ahead.caps[place] = ahead.caps[place].min(velocity);
                }
                for place in begins..last {
                    self.velocities[place] = self.velocities[place].min(velocity);
                }
            }
            place = last + 1;
        }
        lowered
    }

    /// Finds the knots, and what follows on each of them.
    pub(super) fn find_knots(&mut self, ahead: &VelocityEnvelope) {
        let count = ahead.blocks.len();
        self.knots.clear();
        for place in 0..=count {
            if place > 0 && place < count && !self.is_knot(ahead, place) {
                continue;
            }
            self.knots.push(EnvelopeKnot {
                place,
                velocity: ahead.squares[place].sqrt(),
                corner: ahead.at_corner(place),
                ..EnvelopeKnot::default()
            });
        }
        let knots = self.knots.len();
        for index in 0..knots - 1 {
            let next = self.knots[index + 1].place;
            self.knots[index] = self.up_to(ahead, self.knots[index], next);
        }
    }

    /// A knot with what follows on it up to the block at `next`.
    pub(super) fn up_to(
        &self,
        ahead: &VelocityEnvelope,
        knot: EnvelopeKnot,
        next: usize,
    ) -> EnvelopeKnot {
        let mut knot = EnvelopeKnot {
            place: knot.place,
            velocity: knot.velocity,
            corner: knot.corner,
            ..EnvelopeKnot::default()
        };
        for place in knot.place..next {
            let block = &ahead.blocks[place];
            let length = ahead.left(place);
            knot.length += length;
            knot.ramp.acceleration = knot.ramp.acceleration.min(block.acceleration);
            knot.ramp.jerk = knot.ramp.jerk.min(block.jerk);
            let mean = 0.5 * (ahead.squares[place] + ahead.squares[place + 1]);
            let peak = (mean + block.acceleration * length).sqrt();
            knot.top = knot.top.max(peak.min(self.velocities[place]));
        }
        knot
    }
}
