//! A run: CL points that follow one another without a corner, a change of feed or anything between them.
//!
//! A block may go along several legs of a run. It is compared with each of them: where the axes stand when the block
//! passes a CL point is put beside that point, and between two such places the block is a move like any other, so
//! that the same bounds hold. Which share of the block belongs to which CL point is free as long as the shares never
//! decrease; the one at which the tip is beside the CL point is taken. So the bound is one on the Fréchet distance: tip
//! and path are gone along in order, each at its own pace.

use super::bound::DeviationBound;
use super::deviation::{MoveTolerances, NodeMove, between};
use super::node::{PathNode, Placer};
use post_machine::kinematics::orientation::angle;
use post_machine::kinematics::{Pose, Trace};

/// CL points that follow one another, and what the blocks along them must keep.
#[derive(Clone, Copy, Debug)]
pub struct NodeRun<'a> {
    /// Solves points put in.
    pub placer: &'a Placer,
    /// The CL points, two at least.
    pub nodes: &'a [PathNode],
    /// What the blocks must stay within.
    pub tolerances: MoveTolerances,
    /// The tip follows the words in a straight line by itself.
    pub control_keeps_tip: bool,
    /// As [`NodeMove::straight`]: a block goes from CL point to CL point then, since what stands between is no block of
    /// its own.
    pub straight: Option<f64>,
    /// Points put in may stand off the path, so that blocks are balanced about it.
    pub balances: bool,
}

/// A place on a run: a share of a leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RunPosition {
    /// Which leg.
    pub leg: usize,
    /// Share of it, 0 to 1.
    pub t: f64,
}

impl<'a> NodeRun<'a> {
    /// Straight pieces of the CL path.
    pub fn legs(&self) -> usize {
        self.nodes.len() - 1
    }

    /// The CL point that a leg starts from.
    pub(super) fn start(&self, leg: usize) -> PathNode {
        PathNode { t: 0.0, ..self.nodes[leg] }
    }

    /// The CL point that the last of `legs` legs ends in.
    pub(super) fn end(&self, legs: usize) -> PathNode {
        PathNode { t: 1.0, ..self.nodes[legs] }
    }

    /// A leg from `start`, its CL point or one put into it.
    pub(super) fn leg<'m>(&'m self, start: &'m PathNode, leg: usize) -> NodeMove<'m> {
        self.block(start, &self.nodes[leg + 1])
    }

    fn block<'m>(&'m self, from: &'m PathNode, to: &'m PathNode) -> NodeMove<'m> {
        NodeMove {
            placer: self.placer,
            from,
            to,
            tolerances: self.tolerances,
            control_keeps_tip: self.control_keeps_tip,
            straight: self.straight,
        }
    }

    /// What the CL file asks for at a spot.
    pub(super) fn target(&self, spot: RunPosition) -> Pose {
        let leg = self.block(&self.nodes[spot.leg], &self.nodes[spot.leg + 1]);
        leg.target(spot.t)
    }

    /// Fills `way` with the way of the tip to each CL point, mm; of a run whose tip stands still, with that of the
    /// tool axis, radians.
    pub(super) fn measure(&self, way: &mut Vec<f64>) {
        way.clear();
        let mut sum = 0.0;
        way.push(sum);
        for pair in self.nodes.windows(2) {
            sum += (pair[1].target.tip - pair[0].target.tip).norm();
            way.push(sum);
        }
        if sum > 0.0 {
            return;
        }
        for (index, pair) in self.nodes.windows(2).enumerate() {
            sum += angle(pair[0].target.axis, pair[1].target.axis);
            way[index + 1] = sum;
        }
    }

    /// The spot at a distance from the start.
    pub(super) fn spot(&self, way: &[f64], at: f64) -> RunPosition {
        let after = way.partition_point(|end| *end <= at);
        let leg = after.clamp(1, self.legs()) - 1;
        let length = way[leg + 1] - way[leg];
        let t = if length > 0.0 { ((at - way[leg]) / length).clamp(0.0, 1.0) } else { 1.0 };
        RunPosition { leg, t }
    }

    /// The farthest CL point up to `last` that one block from CL point `at` reaches within tolerance, if any, and its
    /// bound.
    pub(super) fn farthest(
        &self,
        at: usize,
        last: usize,
        way: &[f64],
    ) -> Option<(usize, DeviationBound)> {
        let start = self.start(at);
        let from = RunPosition { leg: at, t: 0.0 };
        let try_to = |reach: usize| {
            let to = RunPosition { leg: reach - 1, t: 1.0 };
            self.along((&start, from), (&self.end(reach), to), way)
        };
        // Twice as far each time, then the half between what holds and what does not.
        let mut good = (at, DeviationBound::default());
        let mut step = 1;
        let mut bad = loop {
            let reach = (at + step).min(last);
            match try_to(reach) {
                Some(bound) => good = (reach, bound),
                None => break reach,
            }
            if reach == last {
                break last + 1;
            }
            step *= 2;
        };
        while bad - good.0 > 1 {
            let middle = (good.0 + bad) / 2;
            match try_to(middle) {
                Some(bound) => good = (middle, bound),
                None => bad = middle,
            }
        }
        (good.0 > at).then_some(good)
    }

    /// The bound of a block between two spots, against every leg that it passes; none if it is over tolerance.
    pub(super) fn along(
        &self,
        (from, start): (&PathNode, RunPosition),
        (to, end): (&PathNode, RunPosition),
        way: &[f64],
    ) -> Option<DeviationBound> {
        let beyond = self.straight.is_some() && end.leg > start.leg;
        if beyond || self.block(from, to).goes_another_way() {
            return None;
        }
        let mut bound = DeviationBound::default();
        let mut last = PathNode { t: 0.0, ..*from };
        let chord = to.tip - from.tip;
        let square = chord.norm_squared();
        for leg in start.leg..end.leg {
            let target = self.nodes[leg + 1].target;
            let even = share(way, start, end, leg);
            let mut next = self.passed(from, to, even, target);
            // The share at which the tip is beside the CL point, not before or after it; never before the share of
            // the CL point ahead of it, or the order of the path would not be proven.
            let beside = if square > 0.0 { even - next.off().dot(&chord) / square } else { even };
            let share = beside.clamp(last.t, 1.0);
            if share != even {
                next = self.passed(from, to, share, target);
            }
            bound = bound.and(self.hold(&last, &next)?);
            last = next;
        }
        Some(bound.and(self.hold(&last, to)?))
    }

    /// Where the axes stand at the share `share` of a block, put beside what the CL file asks for there.
    pub(super) fn passed(
        &self,
        from: &PathNode,
        to: &PathNode,
        share: f64,
        target: Pose,
    ) -> PathNode {
        let chain = self.placer.solver().chain();
        let joints = between(&from.trace.joints, &to.trace.joints, share);
        let mut trace = Trace { joints, turns: chain.turns(&joints), ..Trace::default() };
        chain.trace(&mut trace);
        let tip = self.block(from, to).reached(&trace.pose, share);
        let mut node = PathNode { t: share, target, trace, tip, ..PathNode::default() };
        node.measure();
        node
    }

    fn hold(&self, from: &PathNode, to: &PathNode) -> Option<DeviationBound> {
        let (bound, _) = self.block(from, to).known();
        self.tolerances.hold(bound).then_some(bound)
    }
}

/// Share of a block from `start` to `end` at which the CL point after `leg` is passed.
fn share(way: &[f64], start: RunPosition, end: RunPosition, leg: usize) -> f64 {
    let place = |spot: RunPosition| distance(way, spot);
    let whole = place(end) - place(start);
    if whole > 0.0 { ((way[leg + 1] - place(start)) / whole).clamp(0.0, 1.0) } else { 1.0 }
}

/// Way of the tip from the start of the run to a spot, mm.
pub(super) fn distance(way: &[f64], spot: RunPosition) -> f64 {
    way[spot.leg] * (1.0 - spot.t) + way[spot.leg + 1] * spot.t
}
