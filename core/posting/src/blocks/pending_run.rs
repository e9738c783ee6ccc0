//! CL points that wait for what comes after them: along one stretch of path some of them may be needless.

use super::{BlockReason, BlockSink, BlockStage, PathLeg, STILL};
use crate::accuracy::{MoveRoom, PathNode};
use crate::program::{MoveFeed, StraightMove};
use post_machine::description::Axis;
use post_machine::kinematics::Second;
use post_machine::kinematics::orientation::angle;

/// More legs than this do not wait: the point at the end of them is kept.
const MOST: usize = 1024;

/// Directions of shorter moves mean nothing, mm.
const LEAST: f64 = 1e-6;

/// Legs that follow one another at one feed and without a corner, and the points at their ends.
#[derive(Debug, Default)]
pub(super) struct PendingRun {
    legs: Vec<(u64, StraightMove)>,
    nodes: Vec<PathNode>,
}

impl PendingRun {
    /// Line of the first leg that waits.
    pub(super) fn first_line(&self) -> Option<u64> {
        self.legs.first().map(|(line, _)| *line)
    }

    /// Can a leg to `node` go on here, if the path turns by no more than `corner`, radians?
    fn joins(&self, leg: &PathLeg<'_>, node: &PathNode, corner: f64) -> bool {
        let (Some((_, motion)), [.., before, last]) = (self.legs.last(), self.nodes.as_slice())
        else {
            return false;
        };
        let (first, second) =
            (last.target.tip - before.target.tip, node.target.tip - last.target.tip);
        self.legs.len() < MOST
            && motion.pace == leg.motion.pace
            && first.norm() > LEAST
            && second.norm() > LEAST
            && angle(first.normalize(), second.normalize()) <= corner
    }
}

/// Whether an axis moves only where another one ends.
fn in_reserve(axis: &Axis) -> bool {
    matches!(axis.second, Some(Second::Reserve { .. }))
}

impl BlockStage<'_> {
    /// Does a move to `node` wait, as part of a run?
    #[inline]
    pub(super) fn gathers(&self, leg: &PathLeg<'_>, node: &PathNode) -> bool {
        // Cutter radius compensation offsets the points that the control is given.
        if !(self.machine.accuracy.reduce || self.keeps.fits()) || leg.loose || self.compensating {
            return false;
        }
        // A time of its own cannot be shared; axes that exclude one another, or of which one moves where the other
        // ends, cannot move in one block.
        let steady = matches!(leg.motion.pace, MoveFeed::PerMinute(_))
            && self.machine.solution.exclusive.is_empty()
            && !self.machine.axes.iter().any(in_reserve);
        steady
            && self.last.as_ref().is_some_and(|last| {
                let apart =
                    self.stands(last, node) || (self.machine.indexes && self.indexes(last, node));
                !apart
            })
    }

    /// The tip as good as stands still while the axes turn. Such a move is paced by the axes: together with others
    /// it would be paced by the way of the tip, and they would turn in no time.
    fn stands(&self, last: &PathNode, node: &PathNode) -> bool {
        let way = self.wanted_way(last, node);
        way <= STILL && self.turn_between(last, node).to_degrees() > way
    }

    /// Takes a move into the run, or ends that and begins another with it.
    pub(super) fn gather(
        &mut self,
        leg: &PathLeg<'_>,
        last: &PathNode,
        node: &PathNode,
        out: &mut BlockSink<'_>,
    ) {
        let corner = self.machine.accuracy.corner;
        if !self.gathered.joins(leg, node, corner) {
            self.end_run(out);
            self.gathered.nodes.push(*last);
        }
        self.gathered.nodes.push(*node);
        self.gathered.legs.push((leg.line, *leg.motion));
    }

    /// Carries out the run that waits.
    #[inline]
    pub(super) fn end_run(&mut self, out: &mut BlockSink<'_>) {
        if !self.gathered.legs.is_empty() {
            self.carry_out_run(out);
        }
    }

    /// Goes along legs by straight blocks, without the points that are needless, if that is wanted.
    pub(super) fn go_straight(
        &mut self,
        legs: &[PathLeg<'_>],
        nodes: &[PathNode],
        out: &mut BlockSink<'_>,
    ) {
        if let (true, [_, _, ..]) = (self.machine.accuracy.reduce, legs) {
            return self.split(legs, MoveRoom::Part, nodes, out);
        }
        for (leg, pair) in legs.iter().zip(nodes.windows(2)) {
            self.cut(leg, &pair[0], &pair[1], out);
        }
    }

    fn carry_out_run(&mut self, out: &mut BlockSink<'_>) {
        let Some(placer) = self.placer.clone() else {
            return;
        };
        let mut gathered = std::mem::take(&mut self.gathered);
        let chords = gathered.legs.iter().map(|(_, motion)| motion.chord);
        let chord = chords.fold(0.0, f64::max);
        // A block of several legs strays by the farthest of them.
        for (_, motion) in &mut gathered.legs {
            motion.chord = chord;
        }
        let legs: Vec<PathLeg<'_>> = gathered
            .legs
            .iter()
            .map(|(line, motion)| PathLeg {
                placer: &placer,
                line: *line,
                motion,
                loose: false,
                reason: BlockReason::Point,
            })
            .collect();
        match self.keeps.fits() {
            true => self.fit(&legs, &gathered.nodes, out),
            false => self.go_straight(&legs, &gathered.nodes, out),
        }
        gathered.legs.clear();
        gathered.nodes.clear();
        self.gathered = gathered;
    }
}
