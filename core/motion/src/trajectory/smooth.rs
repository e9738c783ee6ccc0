//! Look-ahead with jerk limits.
//!
//! An acceleration that went to zero where each block ends would never get far in thousands of short ones: it is
//! planned over many. The envelope of the accelerations alone is found first. Its *knots* are where a bound of the
//! velocity is met: a corner, the beginning of a slower block, a standstill. From knot to knot it goes up at most once,
//! holds, and goes down: a *hill*, over which a double S is laid, whatever blocks it spans. A ramp up that begins as
//! early as it can, with no more than the least acceleration under it, stays below the envelope, which goes up with the
//! largest one; so does a ramp down that ends as late as it can. Where a hill is too short to get from one knot's
//! velocity to the other's, the higher one is lowered: backwards, then forwards. Where blocks are very unlike, the
//! least acceleration and jerk of them all are too little for most: such a hill is split where that makes it shorter in
//! time, at one place or at all where blocks are unlike.
//!
//! Knots closer together than an acceleration takes to rise (`a/j`, or `√(v/j)` where that is less) are worth little,
//! as what lies between could hardly be used: if their velocities are alike it is run through at the least of them,
//! where that takes no longer than this either.
//!
//! At a knot the acceleration is zero. A plan is carried out up to such a place; what was planned after it, down to the
//! standstill at its end, is kept and carried out in its turn where a new plan, which sees more, cannot go on from
//! there (its knots lie elsewhere).

mod carried;
mod hills;
mod knots;

use super::block::{BlockPhase, VelocityLimit};
use super::envelope::VelocityEnvelope;
use super::profile::Phase;
use knots::EnvelopeKnot;

/// Velocities this near to each other, as a share, are one.
const SAME: f64 = 1e-9;

/// Constant jerk, however many blocks it spans.
#[derive(Clone, Copy, Debug)]
struct JerkStep {
    phase: Phase,
    why: VelocityLimit,
    /// The acceleration is zero where it ends: the plan can be left there.
    rests: bool,
    /// The block in front of which it ends, where that is at a block's end.
    ends: Option<usize>,
}

/// What a plan works with.
#[derive(Debug, Default)]
pub(super) struct SmoothPlan {
    knots: Vec<EnvelopeKnot>,
    steps: Vec<JerkStep>,
    /// The rest of the last plan, from where the run has got to, places counted as they are now.
    kept: Vec<JerkStep>,
    /// Largest velocities along the blocks, lowered between near knots.
    velocities: Vec<f64>,
}

/// How a plan is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PlanMode {
    /// Near knots are brought to one velocity.
    Thinned,
    /// All knots stay.
    Plain,
    /// All knots stay, and the run's velocity goes on whatever that asks for.
    Forced,
}

impl SmoothPlan {
    /// A new run begins.
    pub fn forget(&mut self) {
        self.kept.clear();
    }

    /// Hands over the parts of the first `done` blocks, or of about as many: of all of them if these are all.
    pub fn settle(
        &mut self,
        ahead: &mut VelocityEnvelope,
        done: usize,
        take: &mut dyn FnMut(BlockPhase),
    ) {
        let all = done == ahead.blocks.len();
        loop {
            let planned = self.plan(ahead, PlanMode::Thinned)
                || self.plan(ahead, PlanMode::Plain)
                || self.kept.is_empty() && self.plan(ahead, PlanMode::Forced);
            let count = match (planned, all) {
                (true, true) => self.steps.len(),
                (true, false) => self.leave(ahead, done),
                // The old plan, to the next place where it can be left.
                (false, _) => {
                    std::mem::swap(&mut self.steps, &mut self.kept);
                    let moves = |step: &JerkStep| step.rests && step.phase.seconds > 0.0;
                    let place = self.steps.iter().position(moves);
                    place.map_or(self.steps.len(), |place| place + 1)
                }
            };
            let gone = self.carry_out(ahead, count, take);
            self.kept.clear();
            let rest = self
                .steps
                .drain(..)
                .skip(count)
                .map(|step| JerkStep { ends: step.ends.map(|place| place - gone), ..step });
            self.kept.extend(rest);
            if !all || ahead.blocks.is_empty() {
                return;
            }
        }
    }

    /// Plans all blocks; false where the run is too fast for what lies ahead, planned like that.
    fn plan(&mut self, ahead: &mut VelocityEnvelope, mode: PlanMode) -> bool {
        self.velocities.clear();
        let own = ahead.blocks.iter().map(|block| block.velocity);
        self.velocities.extend(own);
        ahead.set_caps();
        ahead.raise();
        if mode == PlanMode::Thinned && self.thin(ahead) {
            ahead.raise();
        }
        self.find_knots(ahead);
        let count = self.knots.len();
        for place in (1..count - 1).rev() {
            let next = self.knots[place + 1].velocity;
            let knot = &mut self.knots[place];
            knot.velocity = knot.velocity.min(knot.ramp.reach(next, knot.length));
        }
        let [first, second] = [self.knots[0], self.knots[1]];
        let possible = first.ramp.reach(second.velocity, first.length);
        if mode != PlanMode::Forced && first.velocity > possible * (1.0 + SAME) {
            return false;
        }
        for place in 1..count {
            let last = self.knots[place - 1];
            let knot = &mut self.knots[place];
            knot.velocity = knot.velocity.min(last.ramp.reach(last.velocity, last.length));
        }
        self.lay_hills(ahead);
        true
    }
}
