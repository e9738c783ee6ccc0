//! The blocks in sight, and the highest velocities that their accelerations allow: what plans with jerk limits and
//! without both begin with.

use std::collections::VecDeque;

use super::block::LookAheadBlock;

/// Blocks of a run that are not yet carried out, and the velocities where they meet.
#[derive(Debug, Default)]
pub(super) struct VelocityEnvelope {
    pub blocks: VecDeque<LookAheadBlock>,
    /// Number of the first of them.
    pub first: u64,
    /// How much of it is behind, and with what velocity it goes on.
    pub begun: f64,
    pub velocity: f64,
    /// Squared velocities where blocks meet: before the first, …, after the last.
    pub squares: Vec<f64>,
    /// Largest velocities where blocks meet, numbered alike.
    pub caps: Vec<f64>,
}

impl VelocityEnvelope {
    /// Length of the block at `place` that is yet to come.
    pub fn left(&self, place: usize) -> f64 {
        let begun = if place == 0 { self.begun } else { 0.0 };
        (self.blocks[place].length - begun).max(0.0)
    }

    /// The largest velocities where blocks meet; 0 after the last.
    pub fn set_caps(&mut self) {
        self.caps.clear();
        self.caps.push(self.velocity);
        let pairs = self.blocks.iter().zip(self.blocks.iter().skip(1));
        let cap = |(last, next): (&LookAheadBlock, &LookAheadBlock)| {
            last.exit.min(last.velocity).min(next.velocity)
        };
        self.caps.extend(pairs.map(cap));
        self.caps.push(0.0);
    }

    /// The squares of the highest velocities that the accelerations allow.
    pub fn raise(&mut self) {
        let count = self.blocks.len();
        self.squares.clear();
        self.squares.extend(self.caps.iter().map(|cap| cap * cap));
        for place in (1..count).rev() {
            let gain = 2.0 * self.blocks[place].acceleration * self.blocks[place].length;
            self.squares[place] = self.squares[place].min(self.squares[place + 1] + gain);
        }
        for place in 0..count {
            let gain = 2.0 * self.blocks[place].acceleration * self.left(place);
            self.squares[place + 1] = self.squares[place + 1].min(self.squares[place] + gain);
        }
    }

    /// What bounds the velocity in front of the block at `place` is a corner or the end.
    pub fn at_corner(&self, place: usize) -> bool {
        let Some(next) = self.blocks.get(place) else {
            return true;
        };
        let Some(last) = place.checked_sub(1).map(|place| &self.blocks[place]) else {
            return self.velocity == 0.0;
        };
        last.exit < last.velocity.min(next.velocity)
            && self.squares[place] >= last.exit * last.exit * (1.0 - 1e-9)
    }
}
