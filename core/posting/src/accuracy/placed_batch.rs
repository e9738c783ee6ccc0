//! Many points solved together: [`Placer::settle`] of each, bit by bit the same, but a step of all points before the
//! next step, so that their latencies overlap.

use nalgebra::Vector3;
use post_machine::kinematics::batch::{Axes, LANES, Traces};
use post_machine::kinematics::travel::{AT_END, over};
use post_machine::kinematics::{Joints, Pose, Turns};

use super::node::{Node, Placer};

/// The working arrays of a batch, and its nodes.
#[derive(Debug)]
pub(crate) struct PlacedBatch {
    at: Axes,
    traces: Traces,
    /// Where the linear axes bring the points.
    wanted: [Vector3<f64>; LANES],
    /// The nodes, boxed so that they change hands without being copied.
    #[expect(clippy::vec_box, reason = "a node changes hands by its box; it is large")]
    nodes: Vec<Box<Node>>,
    /// Points that are solved; the others are left to [`Placer::settle`], which says why.
    settled: [bool; LANES],
}

impl Default for PlacedBatch {
    fn default() -> Self {
        Self {
            at: Axes::default(),
            traces: Traces::default(),
            wanted: [Vector3::zeros(); LANES],
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
    pub(crate) fn take(&mut self, lane: usize, spare: &mut Box<Node>) -> bool {
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
    pub(crate) fn settle<'p>(
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
            self.wanted[lane] = printed.unwrap_or(target.tip);
            for (index, joint) in chain.joints().iter().enumerate() {
                if joint.rotary {
                    self.at.joints[index][lane] = joints[index];
                }
            }
        }
        for (index, joint) in chain.joints().iter().enumerate() {
            if joint.rotary {
                for lane in 0..count {
                    let (sine, cosine) = libm::sincos(self.at.joints[index][lane]);
                    self.at.sines[index][lane] = sine;
                    self.at.cosines[index][lane] = cosine;
                }
            }
        }
        if !solver.place_all(&self.wanted[..count], &mut self.at) {
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
        chain.trace_all(&self.at, count, &mut self.traces);
        for lane in 0..count {
            let node = &mut *self.nodes[lane];
            let trace = &mut node.trace;
            trace.turns = Turns::of_lane(&self.at, lane);
            trace.pose = Pose {
                tip: self.traces.tip[lane],
                axis: self.traces.axis[lane],
                edge: Vector3::zeros(),
            };
            for (index, joint) in chain.joints().iter().enumerate() {
                if joint.rotary {
                    trace.tip_rates[index] = self.traces.tip_rates[index][lane];
                    trace.axes[index] = self.traces.axes[index][lane];
                }
            }
            node.tip = trace.pose.tip;
            node.measure();
            // As for a single point: what the forward chain misses by must be rounding.
            self.settled[lane] &= node.tip_error <= placer.tip_rounding();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use post_machine::description::{Source, load};
    use post_plugin::Format;

    /// Every node of a batch is, field by field, that of the point alone.
    #[test]
    fn a_batch_is_settled_as_its_points_are() {
        for tcp in ["post", "control"] {
            let text = format!(
                "name = \"trunnion\"\nchain = \"[w C' A' b Y X Z (S) t]\"\n[workpiece]\nmount = [10, -20, 30]\n\
                 [tool]\ngauge = [0, 0, 400]\naxis = [0, 0, 1]\n[axis.C]\nrotary = [0, 0, 1]\npoint = [0, 0, 0]\n\
                 cyclic = true\n[axis.A]\nrotary = [1, 0, 0]\npoint = [0, 0.012, 50.004]\ntravel = [-120, 30]\n\
                 [axis.X]\nlinear = [1, 0, 0]\ntravel = [-300, 300]\n[axis.Y]\nlinear = [0, 1, 0]\ntravel = [-300, 300]\n\
                 [axis.Z]\nlinear = [0, 0, 1]\ntravel = [-600, 300]\n[control]\ndialect = \"fanuc\"\ntcp = \"{tcp}\"\n"
            );
            let source = Source { name: "trunnion".to_owned(), text };
            let machine = load(source, &[], &mut |_| Err(String::new())).expect("a machine");
            let format = Format {
                words: vec![3; 5],
                feed: 1,
                inverse_time: None,
                feed_per_revolution: 4,
                extension: "nc".to_owned(),
                ..Format::default()
            };
            let placer = Placer::for_machine(&machine, &format, 100.0, &Joints::default())
                .expect("a placer");
            let solver = placer.solver();
            let points: Vec<(Pose, Joints)> = (0..LANES)
                .map(|lane| {
                    let t = lane as f64;
                    let axis = Vector3::new(0.2 + 0.003 * t, 0.3 - 0.005 * t, 1.0).normalize();
                    // Some of them beyond the travel of X.
                    let tip = Vector3::new(5.5 * t, 3.0 - t, 0.3 * t);
                    let pose = Pose { tip, axis, edge: Vector3::zeros() };
                    let joints =
                        solver.inverse(&pose, &Joints::default(), 1e-9).expect("a solution")[0];
                    (pose, joints)
                })
                .collect();
            let mut batch = PlacedBatch::default();
            batch.settle(&placer, points.iter().map(|(pose, joints)| (*pose, joints)));
            let (mut same, mut left) = (0, 0);
            for (lane, (pose, joints)) in points.iter().enumerate() {
                let alone = placer.settled(*pose, 1.0, joints);
                let mut node = Box::default();
                if batch.take(lane, &mut node) {
                    let alone = alone.expect("a node");
                    assert_eq!(format!("{node:?}"), format!("{alone:?}"));
                    same += 1;
                } else {
                    assert!(alone.is_err(), "point {lane} was left");
                    left += 1;
                }
            }
            assert!(same > 20 && left > 5, "{same} same, {left} left");
        }
    }
}
