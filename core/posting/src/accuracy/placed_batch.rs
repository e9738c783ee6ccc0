//! Many points solved together: [`Placer::settle`] of each, bit by bit the same, but a step of all points before the
//! next step, so that their latencies overlap.

use nalgebra::Vector3;
use post_machine::kinematics::batch::{AxisBatch, LANES, Traces, VectorLanes, set_vector, vector};
use post_machine::kinematics::lane_math::sincos_all;
use post_machine::kinematics::travel::{AT_END, over};
use post_machine::kinematics::{Joints, Pose, Turns};

use super::node::{PathNode, Placer};

/// The working arrays of a batch, and its nodes.
#[derive(Debug)]
pub struct PlacedBatch {
    at: AxisBatch,
    traces: Traces,
    /// Where the linear axes bring the points.
    wanted: VectorLanes,
    /// The nodes, boxed so that they change hands without being copied.
    #[expect(clippy::vec_box, reason = "a node changes hands by its box; it is large")]
    nodes: Vec<Box<PathNode>>,
    /// Points that are solved; the others are left to [`Placer::settle`], which says why.
    settled: [bool; LANES],
}

impl Default for PlacedBatch {
    fn default() -> Self {
        Self {
            at: AxisBatch::default(),
            traces: Traces::default(),
            wanted: [[0.0; LANES]; 3],
            nodes: (0..LANES).map(|_| Box::default()).collect(),
            settled: [false; LANES],
        }
    }
}

impl PlacedBatch {
    /// Largest number of points in a batch.
    pub(crate) const MOST: usize = LANES;

    /// Takes the node of point `lane` out, in the place of `spare`; false if it is not solved.
    #[inline]
    pub fn take(&mut self, lane: usize, spare: &mut Box<PathNode>) -> bool {
        let settled = std::mem::take(&mut self.settled[lane]);
        if settled {
            std::mem::swap(&mut self.nodes[lane], spare);
        }
        settled
    }

    /// No point is solved.
    pub(crate) fn forget(&mut self) {
        self.settled = [false; LANES];
    }

    /// Solves the first of `points`, each a pose and its rotary values.
    pub fn settle<'p>(
        &mut self,
        placer: &Placer,
        points: impl Iterator<Item = (Pose, &'p Joints)>,
    ) {
        self.forget();
        let solver = placer.solver();
        let chain = solver.chain();
        if placer.control_point().along != 0.0 || chain.edge().is_some() || !solver.closed_form() {
            return;
        }
        let (mut count, mut kept) = (0, false);
        for (lane, (target, rotary)) in points.take(LANES).enumerate() {
            count = lane + 1;
            let node = &mut *self.nodes[lane];
            node.t = 1.0;
            node.target = target;
            let joints = &mut node.trace.joints;
            *joints = *rotary;
            placer.words.print_rotary(joints, &mut node.words);
            let printed = placer.words.print_tip(target.tip, &mut node.words);
            kept = printed.is_some();
            set_vector(&mut self.wanted, lane, printed.unwrap_or(target.tip));
            for (index, joint) in chain.joints().iter().enumerate() {
                if joint.rotary {
                    self.at.joints[index][lane] = joints[index];
                }
            }
        }
        for (index, joint) in chain.joints().iter().enumerate() {
            if joint.rotary {
                let angles = &self.at.joints[index];
                let (sines, cosines) = (&mut self.at.sines[index], &mut self.at.cosines[index]);
                sincos_all(angles, count, sines, cosines);
            }
        }
        if !solver.place_all(&self.wanted, count, &mut self.at) {
            return;
        }
        for lane in 0..count {
            let node = &mut *self.nodes[lane];
            let joints = &mut node.trace.joints;
            for (index, joint) in chain.joints().iter().enumerate() {
                if !joint.rotary {
                    joints[index] = self.at.joints[index][lane];
                }
            }
            if !kept {
                placer.words.print_linear(joints, &mut node.words);
                for (index, joint) in chain.joints().iter().enumerate() {
                    if !joint.rotary {
                        self.at.joints[index][lane] = joints[index];
                    }
                }
            }
            self.settled[lane] = placer.linear.iter().all(|limit| {
                let value = joints[limit.joint];
                over(limit.joint, Some(limit.travel), value, AT_END).is_ok()
            });
        }
        self.trace(placer, count);
    }

    /// Traces the chain at the first `count` points, and measures how far they are off.
    #[inline]
    fn trace(&mut self, placer: &Placer, count: usize) {
        let chain = placer.solver().chain();
        chain.trace_all(&self.at, count, &mut self.traces);
        for lane in 0..count {
            let node = &mut *self.nodes[lane];
            let trace = &mut node.trace;
            trace.turns = Turns::of_lane(&self.at, lane);
            trace.pose = Pose {
                tip: vector(&self.traces.tip, lane),
                axis: vector(&self.traces.axis, lane),
                edge: Vector3::zeros(),
            };
            for (index, joint) in chain.joints().iter().enumerate() {
                if joint.rotary {
                    trace.tip_rates[index] = vector(&self.traces.tip_rates[index], lane);
                    trace.axes[index] = vector(&self.traces.axes[index], lane);
                }
            }
            node.tip = trace.pose.tip;
            node.measure();
            // As for a single point: what the forward chain misses by must be rounding.
            self.settled[lane] &= node.tip_error <= placer.tip_rounding();
        }
    }
}
