//! Bodies, what is to be kept between them, and what of that is looked at.

use crate::ALLOWANCE;
use crate::shape::Shape;

/// What a body is, for what it may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BodyKind {
    /// A part of the machine.
    Machine,
    /// What holds the part.
    Fixture,
    /// What is cut.
    Stock,
    /// What of the tool does not cut.
    Holder,
    /// What of the tool cuts.
    Cutter,
}

/// A body.
#[derive(Clone, Debug)]
pub struct Body {
    /// What messages call it.
    pub name: String,
    /// What it is.
    pub kind: BodyKind,
    /// The link that it hangs on: 0 is that of the part, n what follows the nth axis.
    pub link: usize,
    /// Its shape, machine frame, all axes at zero.
    pub shape: Shape,
}

/// What is to be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Distance at feed, mm.
    pub keep: f64,
    /// Distance at rapid, mm.
    pub rapid: f64,
    /// What cannot be told apart from a distance that is too short by less than this counts as one, mm.
    pub within: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { keep: 0.0, rapid: 0.0, within: 0.01 }
    }
}

impl Rules {
    /// Distance that bodies of these kinds keep at feed and at rapid, mm.
    pub(super) fn keeps(&self, kinds: [BodyKind; 2]) -> [f64; 2] {
        let keep = if may_touch(kinds) { 0.0 } else { self.keep };
        [keep, self.rapid].map(|keep| keep.max(ALLOWANCE))
    }
}

/// What is done with two bodies on a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// That they keep their distance is proven.
    Prove,
    /// A cutter at rapid where it has been: nothing is left there of the stock that it could touch.
    Spare {
        /// It goes back along the cut that it has just made.
        back: bool,
    },
    /// Nothing is, and behind it it is not known how they came where they are.
    LeaveOut,
}

/// What cuts, and what is cut: at feed they touch, and a rapid begins and ends as near as the CL file has it.
pub(super) fn may_touch(kinds: [BodyKind; 2]) -> bool {
    kinds.contains(&BodyKind::Cutter) && kinds.contains(&BodyKind::Stock)
}
