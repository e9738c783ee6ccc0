//! A block becomes several, where its feed changes.

use std::rc::Rc;

use nalgebra::Vector3;
use post_machine::axis_words::WordValues;
use post_machine::description::{Machine, Tcp};
use post_machine::kinematics::{Chain, Joints, Pose, Trace};

use super::pieces::FeedPiece;
use super::queue::BlockStart;
use crate::accuracy::{DeviationBound, PathNode, Placer};
use crate::blocks::{BlockKind, BlockReason, MotionBlock};

/// What rounding leaves of the bounds below by floating point.
const SLACK: f64 = 1.1;

/// Cuts blocks.
#[derive(Debug)]
pub(super) struct BlockCutter<'a> {
    pub(super) machine: &'a Machine,
    pub(super) placer: Rc<Placer>,
}

/// Where a piece of a block ends.
#[derive(Clone, Copy, Debug)]
struct PieceEnd {
    joints: Joints,
    words: WordValues,
    tip: Vector3<f64>,
    /// Place within the block, 0 to 1.
    t: f64,
    /// How far it is off the block as it was.
    off: DeviationBound,
}

impl BlockCutter<'_> {
    /// Can a block be several? Not along a curve, not off the part.
    pub(super) fn can_cut(block: &MotionBlock) -> bool {
        block.kind == BlockKind::Linear && !block.loose
    }

    /// Hands on the pieces of a block whose way is `length` as their speeds count. Where words have too few decimals for a piece,
    /// or its end would leave the tolerance, it goes together with the next at the lower feed. Gives their number.
    ///
    /// Each piece stays as close to the CL path as the block did, but for what its ends are rounded by: its axes (or, where
    /// the control keeps the tip, tip and rotary axes) go straight between places that are off the block by that.
    pub(super) fn cut(
        &self,
        block: &MotionBlock,
        start: &BlockStart,
        pieces: &[FeedPiece],
        length: f64,
        mut out: impl FnMut(MotionBlock, f64),
    ) -> usize {
        let mut from = PieceEnd {
            joints: start.joints,
            words: start.words,
            tip: start.tip,
            t: 0.0,
            off: DeviationBound::default(),
        };
        let end = PieceEnd {
            joints: block.joints,
            words: block.words,
            tip: block.tip,
            t: 1.0,
            off: DeviationBound::default(),
        };
        let bow = self.bow(start, block);
        let mut slowest = f64::INFINITY;
        let mut count = 0;
        for (index, piece) in pieces.iter().enumerate() {
            slowest = slowest.min(piece.speed);
            let to = match index + 1 == pieces.len() {
                true => Some(end),
                false => self
                    .reach(block, start, piece.end)
                    .filter(|to| self.holds(block, to, bow))
                    // No word of the piece, or of what is left after it, would change.
                    .filter(|to| to.words != from.words && to.words != end.words),
            };
            let Some(to) = to else {
                continue;
            };
            let seconds = (to.t - from.t) * length / slowest;
            out(self.between(block, &from, &to, bow), seconds);
            count += 1;
            slowest = f64::INFINITY;
            from = to;
        }
        count
    }

    /// Can a piece of a block end at the share `t` of it?
    pub(super) fn can_end(&self, block: &MotionBlock, start: &BlockStart, t: f64) -> bool {
        let bow = self.bow(start, block);
        self.reach(block, start, t).is_some_and(|to| {
            self.holds(block, &to, bow) && to.words != start.words && to.words != block.words
        })
    }

    /// The place at the share `t` of a block, as it is printed.
    fn reach(&self, block: &MotionBlock, start: &BlockStart, t: f64) -> Option<PieceEnd> {
        let placer = &self.placer;
        let joints: Joints = std::array::from_fn(|place| {
            start.joints[place] + (block.joints[place] - start.joints[place]) * t
        });
        let mut pose = placer.solver().chain().forward(&joints);
        let along = placer.control_point().along;
        if self.machine.control.tcp == Tcp::Control {
            let tip = start.tip + (block.tip - start.tip) * t;
            pose = Pose { tip: tip + pose.axis * along, ..pose };
        }
        let mut node = PathNode::default();
        placer.settle(&mut node, pose, t, &joints).ok()?;
        Some(PieceEnd {
            joints: node.trace.joints,
            words: node.words,
            tip: node.tip - node.trace.pose.axis * along,
            t,
            off: DeviationBound { tip: node.tip_error, axis: node.axis_error },
        })
    }

    /// What is proven of a block one of whose ends is off by so much.
    fn widened(block: &MotionBlock, off: DeviationBound, bow: DeviationBound) -> DeviationBound {
        DeviationBound {
            tip: block.deviation.tip + (off.tip + bow.tip) * SLACK,
            axis: block.deviation.axis + (off.axis + bow.axis) * SLACK,
        }
    }

    fn holds(&self, block: &MotionBlock, to: &PieceEnd, bow: DeviationBound) -> bool {
        let accuracy = &self.machine.accuracy;
        let bound = Self::widened(block, to.off, bow);
        bound.tip <= accuracy.tolerance && bound.axis <= accuracy.axis_tolerance
    }

    /// The piece between two places.
    fn between(
        &self,
        block: &MotionBlock,
        from: &PieceEnd,
        to: &PieceEnd,
        bow: DeviationBound,
    ) -> MotionBlock {
        if from.t == 0.0 && to.t == 1.0 {
            return *block;
        }
        let ends = to.t == 1.0;
        MotionBlock {
            reason: if ends { block.reason } else { BlockReason::Feed },
            words: to.words,
            joints: to.joints,
            tip: to.tip,
            axis: self.placer.solver().chain().forward(&to.joints).axis,
            deviation: Self::widened(block, from.off.and(to.off), bow),
            way: (to.tip - from.tip).norm(),
            ..block.part(to.t - from.t)
        }
    }

    /// How far a way of axes bends away from another one whose ends are off by rounding: by a half of what they turn
    /// times what the angles are rounded by, at the longest arm. Where the control keeps the tip only its axis does.
    fn bow(&self, start: &BlockStart, block: &MotionBlock) -> DeviationBound {
        let chain = self.placer.solver().chain();
        let joints = chain.joints().iter().enumerate();
        let turn: f64 = joints
            .filter(|(_, joint)| joint.rotary)
            .map(|(place, _)| (block.joints[place] - start.joints[place]).abs())
            .sum();
        let axis = 0.5 * turn * self.placer.axis_rounding();
        let arm = match self.machine.control.tcp {
            Tcp::Control => 0.0,
            Tcp::Post => [&start.joints, &block.joints]
                .map(|joints| arm(chain, joints))
                .into_iter()
                .fold(0.0, f64::max),
        };
        DeviationBound { tip: axis * arm, axis }
    }
}

/// How far the tip is from the farthest axis that turns it, mm.
fn arm(chain: &Chain, joints: &Joints) -> f64 {
    let mut trace = Trace { joints: *joints, turns: chain.turns(joints), ..Trace::default() };
    chain.trace(&mut trace);
    let arms = trace.tip_rates.iter().map(|rate| rate.norm());
    arms.fold(0.0, f64::max)
}
