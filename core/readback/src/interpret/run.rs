//! Runs of plain motion blocks: many are read and worked out together, and told one by one.
//!
//! Nearly every block of a program is a straight move at feed by words of axes alone, under the same modal words as the block
//! before. As many of these as are at hand are taken as columns, with the operations of a single block in their order, so
//! that the bits are the same. What one of them might do besides moving ends the run before it, and the block goes the plain
//! way.

use std::sync::Arc;

use nalgebra::Vector3;
use post_grammar::nc::{NcRun, NcRunRule};
use post_machine::kinematics::batch::{AxisBatch, Traces, VectorLanes, groups, set_vector, vector};
use post_machine::kinematics::lane_math::sincos_all;
use post_machine::kinematics::{MAX_AXES, Pose, Solver, Turns};
use post_plugin::Meaning;

use super::block_words::bit;
use super::go::{REACHED, told_over};
use super::state::{ControlState, FeedMeaning, MotionMode};
use crate::g_code::GCode;
use crate::lexicon::WordMeaning;
use crate::{MotionKind, Stance};

/// A shorter run costs more than its blocks one by one.
const FEWEST: usize = 2;

/// Blocks that were run together and are told one by one.
#[derive(Debug)]
pub(super) struct MotionRun {
    pub(super) read: NcRun,
    /// Place of the block that is told next.
    next: usize,
    /// Most blocks of a run; with none all go the plain way.
    pub(super) longest: usize,
    at: AxisBatch,
    /// Tips that the words lead to where the control keeps them, mm, part frame.
    wanted: VectorLanes,
    traces: Traces,
    /// The last solver that does not place tips together.
    unfit: Option<Arc<Solver>>,
}

impl MotionRun {
    /// None yet.
    pub(super) fn new() -> Box<Self> {
        Box::new(Self {
            read: NcRun::default(),
            next: 0,
            longest: NcRun::MOST,
            at: AxisBatch::default(),
            wanted: [[0.0; NcRun::MOST]; 3],
            traces: Traces::default(),
            unfit: None,
        })
    }

    /// Nothing of it is left to be told.
    #[inline]
    pub(super) fn is_over(&self) -> bool {
        self.next >= self.read.count()
    }
}

impl ControlState {
    /// What blocks may say that are run together; none where the next is not to be one of them.
    pub(super) fn run_rule(&self, run: &MotionRun) -> Option<NcRunRule> {
        let modal = &self.modal;
        let straight = modal.motion == MotionMode::Linear
            && !modal.incremental
            && !modal.vectors
            && self.spline.is_none()
            && self.cycles.are_off()
            && self.clamps.are_off()
            && !modal.frame_dropped
            && (self.report.length_across.is_some() || !self.length_goes_elsewhere());
        let plain = straight
            && self.fed
            && self.has_begun()
            && self.shared.is_some()
            && !self.in_machine
            && !self.hole
            && self.face.is_none()
            && self.state.wrap.is_none()
            && self.axes.are_cartesian()
            && self.machine.word_map.is_none()
            && self.axes.scale == [1.0; MAX_AXES]
            && self.machine.along.is_none()
            && self.state.solver.chain().edge().is_none();
        let counted = match self.tip_words() {
            true => self.state.tcp && self.frames.plane.is_none(),
            false => self.to_work.upright(),
        };
        let solver = &self.state.solver;
        let unfit = run.unfit.as_ref().is_some_and(|unfit| Arc::ptr_eq(unfit, solver));
        // A block that begins with no command is no motion of every control.
        if self.lexicon.commands_a_line() || !plain || !counted || self.state.tcp && unfit {
            return None;
        }
        let feed = bit(b'F');
        // It would end a cycle, and the spindle that a tap has left turning.
        let quiet = !modal.rigid_taps && !modal.tapped;
        let linear = WordMeaning::Means(Meaning::Linear);
        Some(NcRunRule {
            letters: self.axes.mask | feed,
            some: self.axes.mask,
            all: if modal.feed_mode == FeedMeaning::Inverse { feed } else { 0 },
            pointed: self.axes.mask,
            code: (quiet && self.lexicon.g(GCode::whole(1)) == linear).then_some(1.0),
        })
    }

    /// Begins to tell a run from its first block on.
    pub(super) fn begin_run(&mut self, run: &mut MotionRun) {
        run.next = 0;
        let said = run.read.said().iter().fold(0, |all, said| all | said);
        self.said |= self.axes.places_of(said);
    }

    /// Works out where the blocks that were read into `run` lead; gives how many of them keep to the plain way.
    pub(super) fn work_out(&self, run: &mut MotionRun) -> usize {
        let count = run.read.count().min(run.longest);
        if count < FEWEST {
            return 0;
        }
        let count = self.before_a_wrong_feed(&run.read, count);
        let turned = self.put_axes(run, count);
        self.put_turns(run, count, turned);
        if self.state.tcp && !self.put_tips(run, count) {
            run.unfit = Some(Arc::clone(&self.state.solver));
            return 0;
        }
        self.state.solver.chain().trace_all(&run.at, count, &mut run.traces);
        match self.state.tcp {
            true => reached(run, count),
            false => count,
        }
    }

    /// Blocks in front of the first whose feed is below zero.
    fn before_a_wrong_feed(&self, read: &NcRun, count: usize) -> usize {
        let feeds = read.column(usize::from(b'F' - b'A'));
        let wrong = |place: &usize| read.said()[*place] & bit(b'F') != 0 && feeds[*place] < 0.0;
        (0..count).find(wrong).unwrap_or(count)
    }

    /// Fills in the values of the axes that words lead, and holds all others; gives the bits of the rotary ones that are said.
    fn put_axes(&self, run: &mut MotionRun, count: usize) -> u32 {
        let said = run.read.said();
        let all = said[..count].iter().fold(0, |all, said| all | said);
        for (joint, value) in run.at.joints.iter_mut().zip(self.at.joints) {
            joint[..groups(count)].fill(value);
        }
        let mut turned = 0;
        for letter in 0..NcRun::LETTERS {
            let own = 1 << letter;
            if all & own & self.axes.mask == 0 {
                continue;
            }
            let place = usize::from(self.axes.letters[letter]).min(MAX_AXES - 1);
            let rotary = self.axes.rotary & (1 << place) != 0;
            let row = letter.wrapping_sub(23);
            if row < 3 && !rotary && self.state.tcp {
                continue;
            }
            let values = run.read.column(letter);
            let zero = self.zero[place];
            let origin = (row < 3).then(|| self.to_work.origin[row % 3]);
            let mut last = self.at.joints[place];
            let column = &mut run.at.joints[place];
            for lane in 0..count {
                if said[lane] & own != 0 {
                    let value = values[lane];
                    last = match (rotary, origin) {
                        (true, _) => self.turned_from(place, zero + value.to_radians(), last),
                        (false, Some(origin)) => zero + (origin + (0.0 + value * self.modal.unit)),
                        (false, None) => zero + value * self.modal.unit,
                    };
                }
                column[lane] = last;
            }
            column[count..groups(count)].fill(last);
            turned |= u32::from(rotary) << place;
        }
        turned
    }

    /// Fills in sines and cosines; those of axes at the bits of `turned` anew.
    fn put_turns(&self, run: &mut MotionRun, count: usize, turned: u32) {
        let AxisBatch { joints, sines, cosines } = &mut run.at;
        for (place, joint) in self.state.solver.chain().joints().iter().enumerate() {
            if !joint.rotary {
                continue;
            }
            if turned & (1 << place) != 0 {
                sincos_all(&joints[place], count, &mut sines[place], &mut cosines[place]);
            } else {
                let (sine, cosine) = self.turns.of(place);
                sines[place][..groups(count)].fill(sine);
                cosines[place][..groups(count)].fill(cosine);
            }
        }
    }

    /// Fills in the tips that the words lead to, and brings the linear axes there. False where the chain asks for more than
    /// that.
    fn put_tips(&self, run: &mut MotionRun, count: usize) -> bool {
        let mut tip = self.at.pose.tip;
        for lane in 0..count {
            let said = run.read.said()[lane];
            if said & XYZ != 0 {
                let told: [Option<f64>; 3] = std::array::from_fn(|row| {
                    let value = run.read.column(23 + row)[lane];
                    (said & (1 << (23 + row)) != 0).then_some(0.0 + value * self.modal.unit)
                });
                tip = self.to_part.out(told_over(self.to_part.inside(tip), &told));
            }
            set_vector(&mut run.wanted, lane, tip);
        }
        for lane in count..groups(count) {
            set_vector(&mut run.wanted, lane, tip);
        }
        self.state.solver.place_all(&run.wanted, count, &mut run.at)
    }

    /// Tells the next block of a run: the machine moves to its end.
    #[inline]
    pub(super) fn tell_next(&mut self, run: &mut MotionRun) {
        let lane = run.next % NcRun::MOST;
        run.next += 1;
        self.line = run.read.line(lane);
        self.number = run.read.number(lane);
        self.exact_stop = false;
        if run.read.said()[lane] & bit(b'F') != 0 {
            let inverse = self.modal.feed_mode == FeedMeaning::Inverse;
            let unit = if inverse { 1.0 } else { self.modal.unit };
            let feed = run.read.column(usize::from(b'F' - b'A'))[lane];
            self.modal.feed = Some(feed * unit);
        }
        let from = self.at;
        let tip = match self.state.tcp {
            true => vector(&run.wanted, lane),
            false => vector(&run.traces.tip, lane),
        };
        self.at = Stance {
            joints: std::array::from_fn(|place| run.at.joints[place][lane]),
            pose: Pose { tip, axis: vector(&run.traces.axis, lane), edge: Vector3::zeros() },
        };
        if run.is_over() {
            self.turns = Turns::of_lane(&run.at, lane);
        }
        self.report.blocks += 1;
        self.moved(MotionKind::Feed, self.straight_way(), from);
    }
}

/// Bits of the letters X, Y and Z.
const XYZ: u32 = bit(b'X') | bit(b'Y') | bit(b'Z');

/// Blocks in front of the first whose tip the axes miss.
fn reached(run: &MotionRun, count: usize) -> usize {
    let misses = |lane: &usize| {
        let off = (vector(&run.traces.tip, *lane) - vector(&run.wanted, *lane)).norm();
        off > REACHED
    };
    (0..count).find(misses).unwrap_or(count)
}
