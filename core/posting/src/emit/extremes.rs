//! Extremes of the program that was written, for the report.

use post_machine::kinematics::{Joints, MAX_AXES};
use post_machine::part_anywhere::AxisEnds;

use crate::accuracy::{DeviationBound, RunColumns};
use crate::blocks::MotionBlock;
use crate::report::ReportedDeviation;

/// Deviations that differ by less are the same: mm or radians.
const EQUAL: f64 = 1e-9;

const TIP: usize = 0;
const AXIS: usize = 1;
const RAPID: usize = 2;

/// Extremes and sums over the blocks of a program.
#[derive(Clone, Debug)]
pub(crate) struct Extremes {
    /// Blocks with a motion.
    pub blocks: u64,
    /// Blocks among them that go along a curve.
    pub curves: u64,
    /// Cuts: tip (mm), tool axis (radians); rapids: tip (mm).
    pub deviations: [ReportedDeviation; 3],
    /// Least axis values.
    pub least: Joints,
    /// Largest axis values.
    pub most: Joints,
    /// Lines of the CL file that lead to both, where they are wanted.
    lines: Option<Box<AxisEnds>>,
    /// Way of each axis over all blocks, mm or radians.
    pub travel: Joints,
    /// Where the largest deviations stand in the batch that is not written yet: index of the event.
    marks: [Option<usize>; 3],
    /// The batch that each of them was marked in last.
    batches: [u64; 3],
    /// Axes of the machine.
    axes: usize,
}

impl Extremes {
    /// None so far of a machine with so many axes; `lines`: those that lead to the least and largest axis values are wanted.
    pub(super) fn new(axes: usize, lines: bool) -> Self {
        Self {
            blocks: 0,
            curves: 0,
            deviations: [ReportedDeviation::default(); 3],
            least: [f64::INFINITY; MAX_AXES],
            most: [f64::NEG_INFINITY; MAX_AXES],
            lines: lines.then(|| Box::new(AxisEnds::NONE)),
            travel: [0.0; MAX_AXES],
            marks: [None; 3],
            batches: [0; 3],
            axes,
        }
    }

    /// Keeps the largest deviations; the block will be event `index` of the batch.
    #[inline]
    pub(super) fn mark(&mut self, block: &MotionBlock, index: usize) {
        if block.loose {
            self.keep(RAPID, block.deviation.tip, block.line, index);
        } else {
            self.mark_cut(block.deviation, block.line, index);
        }
    }

    /// [`Extremes::mark`] of a cut with this deviation.
    #[inline]
    pub(super) fn mark_cut(&mut self, deviation: DeviationBound, line: u64, index: usize) {
        self.keep(TIP, deviation.tip, line, index);
        self.keep(AXIS, deviation.axis, line, index);
    }

    /// [`Extremes::mark_cut`] of all blocks of a run: which of them is the worst from here on, by tip and by tool axis.
    /// Their events are told by [`Extremes::marked`].
    pub(super) fn mark_cuts(&mut self, run: &RunColumns) -> [Option<usize>; 2] {
        let columns = [(TIP, &run.tip_bound), (AXIS, &run.axis_bound)];
        columns.map(|(slot, bounds)| {
            let bounds = &bounds[..run.count];
            let before = self.deviations[slot].value;
            // Nearly always none of them is.
            if !bounds.iter().fold(false, |some, bound| some | (bound + 0.0 > before)) {
                return None;
            }
            let own = self.marks[slot].take();
            for (lane, bound) in bounds.iter().enumerate() {
                self.keep(slot, bound + 0.0, run.lines[lane], lane);
            }
            let marked = self.marks[slot].take();
            self.marks[slot] = own.filter(|_| marked.is_none());
            marked
        })
    }

    /// The block at a lane, which is one of those that [`Extremes::mark_cuts`] has named, is the last of the event
    /// `index`.
    pub(super) fn marked(&mut self, worst: [Option<usize>; 2], lane: usize, index: usize) {
        for (slot, worst) in [TIP, AXIS].into_iter().zip(worst) {
            if worst == Some(lane) {
                self.marks[slot] = Some(index);
            }
        }
    }

    /// [`Extremes::reach`], [`Extremes::note_line`] and [`Extremes::go`] of all blocks of a run that begins at `last`.
    pub(super) fn reach_all(&mut self, last: &Joints, run: &RunColumns) {
        self.blocks += run.count as u64;
        for (joint, (column, last)) in run.joints.iter().zip(last).enumerate().take(self.axes) {
            let column = &column[1..=run.count];
            let (mut least, mut most) = (self.least[joint], self.most[joint]);
            for value in column {
                least = if *value < least { *value } else { least };
                most = if *value > most { *value } else { most };
            }
            (self.least[joint], self.most[joint]) = (least, most);
            if let Some(noted) = &mut self.lines {
                let first = |end: f64| column.iter().position(|value| *value == end);
                let line = |end: f64| run.lines[first(end).unwrap_or_default()];
                noted.take(joint, [least, most], line);
            }
            let (mut travel, mut from) = (self.travel[joint], *last);
            for to in column {
                travel += (to - from).abs();
                from = *to;
            }
            self.travel[joint] = travel;
        }
    }

    #[inline]
    fn keep(&mut self, slot: usize, value: f64, line: u64, index: usize) {
        let deviation = &mut self.deviations[slot];
        // Of blocks that are equal but for rounding errors, the first is named.
        if value > deviation.value + EQUAL {
            *deviation = ReportedDeviation { value, block: 0, line };
            self.marks[slot] = Some(index);
        } else if value > deviation.value {
            deviation.value = value;
        }
    }

    /// The batch goes to be written as number `batch`: its events whose lines are wanted.
    pub(super) fn hand_over(&mut self, batch: u64) -> [Option<usize>; 3] {
        for (last, mark) in self.batches.iter_mut().zip(&self.marks) {
            if mark.is_some() {
                *last = batch;
            }
        }
        std::mem::take(&mut self.marks)
    }

    /// Batch number `batch` is written: `lines` of the program are those that the marked events end on.
    pub(super) fn written(&mut self, batch: u64, lines: [Option<u64>; 3]) {
        for (slot, line) in lines.into_iter().enumerate() {
            // A larger one may have come since.
            let last = self.batches[slot] == batch && self.marks[slot].is_none();
            if let Some(line) = line.filter(|_| last) {
                self.deviations[slot].block = line;
            }
        }
    }

    /// A block is written that brings the tool to a point over the first one: as a retract, it takes no travel that the part
    /// needs.
    pub(super) fn reach_above(&mut self) {
        self.blocks += 1;
    }

    /// A block is written that ends at `joints`.
    #[inline]
    pub(super) fn reach(&mut self, joints: &Joints) {
        self.blocks += 1;
        self.cover(joints);
    }

    /// The axes come there, whether a block says it or a cycle.
    #[inline]
    pub(super) fn cover(&mut self, joints: &Joints) {
        // All places, used or not, and no question of what is no number: two at a time.
        for (index, value) in joints.iter().enumerate() {
            let (least, most) = (self.least[index], self.most[index]);
            self.least[index] = if *value < least { *value } else { least };
            self.most[index] = if *value > most { *value } else { most };
        }
    }

    /// What was covered since the last call is that of a line.
    #[inline]
    pub(super) fn note_line(&mut self, line: u64) {
        let Some(noted) = &mut self.lines else {
            return;
        };
        for joint in 0..MAX_AXES {
            noted.take(joint, [self.least[joint], self.most[joint]], |_| line);
        }
    }

    /// Lines that lead to the least and the largest value of an axis; zero where they were not wanted.
    pub(crate) fn lines_of(&self, joint: usize) -> [u64; 2] {
        self.lines.as_ref().map(|noted| noted.lines(joint)).unwrap_or_default()
    }

    /// Adds a block's way of each axis.
    #[inline]
    pub(super) fn go(&mut self, from: &Joints, to: &Joints) {
        for index in 0..MAX_AXES {
            self.travel[index] += (to[index] - from[index]).abs();
        }
    }
}
