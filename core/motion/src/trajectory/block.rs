//! What the look-ahead takes and what it hands over: blocks, and how they are gone through.

use super::profile::{Phase, Ramp};

/// One block.
#[derive(Clone, Copy, Debug)]
pub(super) struct LookAheadBlock {
    /// Length of the block.
    pub length: f64,
    /// Largest velocity.
    pub velocity: f64,
    /// Largest acceleration along it.
    pub acceleration: f64,
    /// Largest jerk along it.
    pub jerk: f64,
    /// Largest velocity where it ends.
    pub exit: f64,
}

impl LookAheadBlock {
    pub(super) fn ramp(&self) -> Ramp {
        Ramp { acceleration: self.acceleration, jerk: self.jerk }
    }
}

/// Why a block is no faster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum VelocityLimit {
    /// The block's largest velocity.
    Velocity,
    /// The ramp from one velocity to another.
    Change,
    /// The ramp from or to a standstill or a corner.
    Corner,
}

/// Constant jerk within one block.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockPhase {
    /// Number of the block, from 0 at the beginning of all.
    pub block: u64,
    /// Where in the block it begins.
    pub from: f64,
    pub phase: Phase,
    pub why: VelocityLimit,
}
