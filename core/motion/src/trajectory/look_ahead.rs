//! Velocities over a run of blocks that are gone through without standing still: look-ahead.
//!
//! A block has a length, and along it a largest velocity, acceleration and jerk; where it ends the velocity may be bounded
//! once more. In the plane of path and squared velocity a constant acceleration is a straight line, so that a pass from the
//! end backwards and one from the beginning forwards give the highest velocities that the accelerations allow: the
//! *envelope*. Without jerk limits it is the solution.
//!
//! The control sees `depth` blocks, the one in progress among them, and plans such that it could stand still at the end of
//! the last: so that what it has begun is always sound. A plan is made once a quarter more than so many wait, and carried out
//! until a quarter less are left: `depth` on average, and each block is planned two and a half times, not `depth` times.

use std::collections::VecDeque;

use super::profile::{Phase, Profile, Ramp};
use super::smooth;

/// One block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    /// Its length.
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

impl Block {
    pub(super) fn ramp(&self) -> Ramp {
        Ramp {
            acceleration: self.acceleration,
            jerk: self.jerk,
        }
    }
}

/// Why it is no faster.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Why {
    /// The block's largest velocity.
    Velocity,
    /// On the way from one to another.
    Change,
    /// On the way from or to a standstill or a corner.
    Corner,
}

/// Constant jerk within one block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Number of the block, from 0 at the beginning of all.
    pub block: u64,
    /// Where in the block it begins.
    pub from: f64,
    pub phase: Phase,
    pub why: Why,
}

/// Blocks of a run that are not yet carried out.
#[derive(Debug)]
pub(super) struct LookAhead {
    /// Blocks seen at once.
    depth: usize,
    pub(super) blocks: VecDeque<Block>,
    /// Number of the first of them.
    pub(super) first: u64,
    /// How much of it is behind, and with what velocity it goes on.
    pub(super) begun: f64,
    pub(super) velocity: f64,
    /// Squared velocities where blocks meet: before the first, …, behind the last.
    pub(super) squares: Vec<f64>,
    /// Largest velocities where blocks meet, numbered alike.
    pub(super) caps: Vec<f64>,
    /// What a plan with jerk limits works with; none without any.
    smooth: Option<smooth::Work>,
}

impl LookAhead {
    /// That sees so many blocks at once; `jerk`: some jerk is limited.
    pub fn new(depth: usize, jerk: bool) -> Self {
        Self {
            depth: depth.max(1),
            blocks: VecDeque::new(),
            first: 0,
            begun: 0.0,
            velocity: 0.0,
            squares: Vec::new(),
            caps: Vec::new(),
            smooth: jerk.then(smooth::Work::default),
        }
    }

    /// Begins a run with the block of this number, at `velocity` and `begun` into it.
    pub fn begin(&mut self, first: u64, velocity: f64, begun: f64) {
        debug_assert!(self.blocks.is_empty());
        self.first = first;
        self.velocity = velocity;
        self.begun = begun;
        if let Some(smooth) = &mut self.smooth {
            smooth.forget();
        }
    }

    /// Takes a block.
    pub fn push(&mut self, block: Block) {
        self.blocks.push_back(block);
    }

    /// Hands over what is settled: all if the run has `ended`.
    pub fn settle(&mut self, ended: bool, take: &mut dyn FnMut(Part)) {
        let count = self.blocks.len();
        let margin = self.depth / 4;
        if count == 0 || !ended && count < self.depth + margin {
            return;
        }
        let done = match ended {
            true => count,
            false => count + 1 - (self.depth - margin),
        };
        if let Some(mut smooth) = self.smooth.take() {
            smooth.settle(self, done, take);
            self.smooth = Some(smooth);
            return;
        }
        self.set_caps();
        self.envelope();
        let mut corner = Corners::new(self);
        for place in 0..done {
            let block = self.blocks[place];
            let ends = [place, place + 1].map(|place| self.squares[place].sqrt());
            let length = self.left(place);
            let profile = Profile::new(length, ends, block.velocity, block.ramp(), block.ramp());
            let whys = corner.whys(self, place, &profile);
            let mut from = block.length - length;
            let counts = profile.counts();
            for (place, phase) in profile.phases().iter().enumerate() {
                let part =
                    usize::from(place >= counts[0]) + usize::from(place >= counts[0] + counts[1]);
                take(Part {
                    block: self.first,
                    from,
                    phase: *phase,
                    why: whys[part],
                });
                from += phase.length(phase.seconds);
            }
            self.first += 1;
        }
        self.velocity = self.squares[done].sqrt();
        self.begun = 0.0;
        self.blocks.drain(..done);
    }

    /// Length of the block at `place` that is yet to come.
    pub(super) fn left(&self, place: usize) -> f64 {
        let begun = if place == 0 { self.begun } else { 0.0 };
        (self.blocks[place].length - begun).max(0.0)
    }

    /// The largest velocities where blocks meet; 0 behind the last.
    pub(super) fn set_caps(&mut self) {
        self.caps.clear();
        self.caps.push(self.velocity);
        let pairs = self.blocks.iter().zip(self.blocks.iter().skip(1));
        let cap = |(last, next): (&Block, &Block)| last.exit.min(last.velocity).min(next.velocity);
        self.caps.extend(pairs.map(cap));
        self.caps.push(0.0);
    }

    /// The squares of the highest velocities that the accelerations allow.
    pub(super) fn envelope(&mut self) {
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
}

/// Whether the ramps in progress come from, or lead to, a corner.
struct Corners {
    up: bool,
    /// Found ahead where a ramp down begins.
    down: Option<bool>,
}

impl Corners {
    fn new(ahead: &LookAhead) -> Self {
        Self {
            up: ahead.velocity == 0.0,
            down: None,
        }
    }

    /// Why the ramp up, the cruise and the ramp down of the block at `place` are no faster.
    fn whys(&mut self, ahead: &LookAhead, place: usize, profile: &Profile) -> [Why; 3] {
        let why = |corner: bool| match corner {
            true => Why::Corner,
            false => Why::Change,
        };
        let [up, cruise, down] = profile.counts();
        let ups = why(self.up);
        if cruise + down > 0 {
            self.up = at_corner(ahead, place + 1);
        }
        if up + cruise > 0 {
            self.down = None;
        }
        let downs = match down > 0 {
            true => why(*self
                .down
                .get_or_insert_with(|| leads_to_corner(ahead, place))),
            false => Why::Change,
        };
        [ups, Why::Velocity, downs]
    }
}

/// The ramp down in the block at `place` ends at a corner.
fn leads_to_corner(ahead: &LookAhead, place: usize) -> bool {
    let mut end = place + 1;
    while let Some(block) = ahead.blocks.get(end) {
        let fall = ahead.squares[end] - ahead.squares[end + 1];
        if fall < 2.0 * block.acceleration * block.length * (1.0 - 1e-9) {
            break;
        }
        end += 1;
    }
    at_corner(ahead, end)
}

/// What bounds the velocity in front of the block at `place` is a corner or the end.
pub(super) fn at_corner(ahead: &LookAhead, place: usize) -> bool {
    let Some(next) = ahead.blocks.get(place) else {
        return true;
    };
    let Some(last) = place.checked_sub(1).map(|place| &ahead.blocks[place]) else {
        return ahead.velocity == 0.0;
    };
    last.exit < last.velocity.min(next.velocity)
        && ahead.squares[place] >= last.exit * last.exit * (1.0 - 1e-9)
}
