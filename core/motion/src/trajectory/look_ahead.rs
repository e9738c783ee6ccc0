//! Velocities over a run of blocks that are gone through without standing still: look-ahead.
//!
//! A block has a length, and along it a largest velocity, acceleration and jerk; where it ends the velocity may be
//! bounded once more. In the plane of path and squared velocity a constant acceleration is a straight line, so that a
//! pass from the end backwards and one from the beginning forwards give the highest velocities that the accelerations
//! allow: the
//! *envelope*. Without jerk limits it is the solution.
//!
//! The control sees `depth` blocks, the one in progress among them, and plans such that it could stand still at the end
//! of the last: so that what it has begun is always sound. A plan is made once a quarter more than so many wait, and
//! carried out until a quarter less are left: `depth` on average, and each block is planned two and a half times, not
//! `depth` times.

use super::block::{BlockPhase, LookAheadBlock, VelocityLimit};
use super::envelope::VelocityEnvelope;
use super::profile::VelocityProfile;
use super::smooth;

/// Plans the blocks of a run as far as they are seen.
#[derive(Debug)]
pub(super) struct LookAhead {
    /// Blocks seen at once.
    depth: usize,
    envelope: VelocityEnvelope,
    /// What a plan with jerk limits works with; none without any.
    smooth: Option<smooth::SmoothPlan>,
}

impl LookAhead {
    /// A look-ahead over `depth` blocks; `jerk`: some jerk is limited.
    pub fn new(depth: usize, jerk: bool) -> Self {
        Self {
            depth: depth.max(1),
            envelope: VelocityEnvelope::default(),
            smooth: jerk.then(smooth::SmoothPlan::default),
        }
    }

    /// Begins a run with the block of this number, at `velocity` and `begun` into it.
    pub fn begin(&mut self, first: u64, velocity: f64, begun: f64) {
        let ahead = &mut self.envelope;
        debug_assert!(ahead.blocks.is_empty());
        ahead.first = first;
        ahead.velocity = velocity;
        ahead.begun = begun;
        if let Some(smooth) = &mut self.smooth {
            smooth.forget();
        }
    }

    /// Takes a block.
    pub fn push(&mut self, block: LookAheadBlock) {
        self.envelope.blocks.push_back(block);
    }

    /// Hands over what is settled: all if the run has `ended`.
    pub fn settle(&mut self, ended: bool, take: &mut dyn FnMut(BlockPhase)) {
        let ahead = &mut self.envelope;
        let count = ahead.blocks.len();
        let margin = self.depth / 4;
        if count == 0 || !ended && count < self.depth + margin {
            return;
        }
        let done = match ended {
            true => count,
            false => count + 1 - (self.depth - margin),
        };
        match &mut self.smooth {
            Some(smooth) => smooth.settle(ahead, done, take),
            None => settle(ahead, done, take),
        }
    }
}

/// Hands over the first `done` blocks, planned without jerk limits.
fn settle(ahead: &mut VelocityEnvelope, done: usize, take: &mut dyn FnMut(BlockPhase)) {
    ahead.set_caps();
    ahead.raise();
    let mut corner = RampCorners::new(ahead);
    for place in 0..done {
        let block = ahead.blocks[place];
        let ends = [place, place + 1].map(|place| ahead.squares[place].sqrt());
        let length = ahead.left(place);
        let profile =
            VelocityProfile::new(length, ends, block.velocity, block.ramp(), block.ramp());
        let whys = corner.whys(ahead, place, &profile);
        let mut from = block.length - length;
        let counts = profile.counts();
        for (place, phase) in profile.phases().iter().enumerate() {
            let part =
                usize::from(place >= counts[0]) + usize::from(place >= counts[0] + counts[1]);
            take(BlockPhase { block: ahead.first, from, phase: *phase, why: whys[part] });
            from += phase.length(phase.seconds);
        }
        ahead.first += 1;
    }
    ahead.velocity = ahead.squares[done].sqrt();
    ahead.begun = 0.0;
    ahead.blocks.drain(..done);
}

/// Whether the ramps in progress come from, or lead to, a corner.
struct RampCorners {
    up: bool,
    /// Found ahead where a ramp down begins.
    down: Option<bool>,
}

impl RampCorners {
    fn new(ahead: &VelocityEnvelope) -> Self {
        Self { up: ahead.velocity == 0.0, down: None }
    }

    /// Why the ramp up, the cruise and the ramp down of the block at `place` are no faster.
    fn whys(
        &mut self,
        ahead: &VelocityEnvelope,
        place: usize,
        profile: &VelocityProfile,
    ) -> [VelocityLimit; 3] {
        let why = |corner: bool| match corner {
            true => VelocityLimit::Corner,
            false => VelocityLimit::Change,
        };
        let [up, cruise, down] = profile.counts();
        let ups = why(self.up);
        if cruise + down > 0 {
            self.up = ahead.at_corner(place + 1);
        }
        if up + cruise > 0 {
            self.down = None;
        }
        let downs = match down > 0 {
            true => why(*self.down.get_or_insert_with(|| leads_to_corner(ahead, place))),
            false => VelocityLimit::Change,
        };
        [ups, VelocityLimit::Velocity, downs]
    }
}

/// The ramp down in the block at `place` ends at a corner.
fn leads_to_corner(ahead: &VelocityEnvelope, place: usize) -> bool {
    let mut end = place + 1;
    while let Some(block) = ahead.blocks.get(end) {
        let fall = ahead.squares[end] - ahead.squares[end + 1];
        if fall < 2.0 * block.acceleration * block.length * (1.0 - 1e-9) {
            break;
        }
        end += 1;
    }
    ahead.at_corner(end)
}
