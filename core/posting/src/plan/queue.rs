//! Blocks that wait for their feed, commands among them: nothing overtakes anything.

use std::collections::VecDeque;

use nalgebra::Vector3;
use post_machine::axis_words::WordValues;
use post_machine::kinematics::Joints;

use super::account::PlanTally;
use super::pieces::{BlockProfile, PlanSample};
use super::samples::{PathDerivatives, WatchedSample};
use super::solver::SettledSample;
use crate::blocks::{BlockSink, MotionBlock};
use crate::stream::StreamItem;

/// Where a block begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockStart {
    pub joints: Joints,
    pub words: WordValues,
    /// Tip, mm, part frame.
    pub tip: Vector3<f64>,
    /// The tool axis, unit vector, part frame.
    pub axis: Vector3<f64>,
}

impl BlockStart {
    /// Where a block ends.
    pub(super) fn after(block: &MotionBlock) -> Self {
        let MotionBlock { joints, words, tip, axis, .. } = *block;
        Self { joints, words, tip, axis }
    }
}

/// One that waits.
#[derive(Debug)]
struct QueueItem {
    flow: StreamItem<MotionBlock>,
    /// Start of a block whose feed is planned.
    open: Option<BlockStart>,
}

/// A sample of the path that the solver has.
#[derive(Clone, Debug)]
struct SampleMark {
    /// Parameter from the start of its block.
    at: f64,
    /// Speed of the tip for that of the parameter.
    stretch: f64,
    /// The block ends with it.
    ends: bool,
    /// Path as observers see it: how it comes there, and how it leaves if that is another way.
    stand: Option<Box<WatchedSample>>,
    leaves: Option<Box<WatchedSample>>,
}

/// Blocks and commands in order, and the samples that lie on them.
#[derive(Debug, Default)]
pub(super) struct BlockQueue {
    waiting: VecDeque<QueueItem>,
    marks: VecDeque<SampleMark>,
    /// The plan along the first open block, as far as it is settled.
    pub(super) profile: BlockProfile,
    /// What was planned so far.
    pub(super) account: PlanTally,
    /// Time from the sample before to the one settled last, s.
    pub(super) seconds: f64,
    /// Whether there is an observer.
    pub(super) watched: bool,
    /// The sample settled last, as the path comes there, and as it leaves a corner.
    pub(super) stand: Option<Box<WatchedSample>>,
    leaves: Option<Box<WatchedSample>>,
}

impl BlockQueue {
    /// What needs no plan.
    pub(super) fn push(&mut self, flow: StreamItem<MotionBlock>) {
        self.waiting.push_back(QueueItem { flow, open: None });
    }

    /// A block whose feed is planned, along a curve or not.
    pub(super) fn open(&mut self, block: StreamItem<MotionBlock>, start: BlockStart) {
        self.waiting.push_back(QueueItem { flow: block, open: Some(start) });
    }

    /// The solver was handed a sample.
    pub(super) fn mark(&mut self, at: f64, place: &PathDerivatives, ends: bool) {
        self.marks.push_back(SampleMark {
            at,
            stretch: place.stretch(),
            ends,
            stand: self.watched.then(|| Box::new(place.stand())),
            leaves: None,
        });
    }

    /// The path leaves the last sample another way than it came.
    pub(super) fn corner(&mut self, place: &PathDerivatives) {
        if let (true, Some(mark)) = (self.watched, self.marks.back_mut()) {
            mark.leaves = Some(Box::new(place.stand()));
        }
    }

    /// The sample settled last as the path leaves it; it is forgotten.
    pub(super) fn left(&mut self) -> Option<Box<WatchedSample>> {
        let came = self.stand.take();
        self.leaves.take().or(came)
    }

    /// The next sample is settled; true if a block ends with it, whose plan is then in the profile.
    pub(super) fn settle(&mut self, step: &SettledSample) -> bool {
        let Some(mark) = self.marks.pop_front() else {
            return false;
        };
        (self.stand, self.leaves) = (mark.stand, mark.leaves);
        let from = self.profile.last().filter(|from| mark.at > from.at);
        let seconds = from.map_or(0.0, |from| {
            let even = 2.0 * (mark.at - from.at) / (from.q.sqrt() + step.q.sqrt());
            step.seconds.unwrap_or(even)
        });
        let mut rest = seconds;
        if let Some(halfway) = step.halfway.filter(|_| from.is_some()) {
            rest = 0.5 * seconds;
            self.profile.halfway(mark.at, halfway, mark.stretch, rest);
        }
        self.seconds = seconds;
        self.profile.push(PlanSample {
            at: mark.at,
            q: step.q,
            stretch: mark.stretch,
            seconds: rest,
        });
        mark.ends
    }

    /// Everything up to the first block that still waits for its feed, that block with it: of all before it nothing is
    /// unknown any more. None where none waits.
    pub(super) fn first_open(
        &mut self,
        out: &mut BlockSink<'_>,
    ) -> Option<(StreamItem<MotionBlock>, BlockStart)> {
        while let Some(next) = self.waiting.pop_front() {
            match next.open {
                Some(start) => return Some((next.flow, start)),
                None => out.element(next.flow),
            }
        }
        None
    }

    /// All that waits for nothing any more.
    pub(super) fn ready(&mut self, out: &mut BlockSink<'_>) {
        while self.waiting.front().is_some_and(|next| next.open.is_none()) {
            if let Some(next) = self.waiting.pop_front() {
                out.element(next.flow);
            }
        }
    }

    /// The blocks that wait are left as they are.
    pub(super) fn give_up(&mut self) {
        let taken = self.waiting.iter_mut().map(|next| next.open.take());
        self.account.give_up(taken.flatten().count());
        self.marks.clear();
        self.profile.clear();
    }

    /// Line of the CL file of the first block that waits for its feed.
    pub(super) fn open_line(&self) -> Option<u64> {
        self.waiting.iter().find(|next| next.open.is_some()).map(|next| next.flow.line())
    }

    /// Line of the CL file of the first that waits.
    pub(super) fn first_line(&self) -> Option<u64> {
        self.waiting.front().map(|next| next.flow.line())
    }
}
