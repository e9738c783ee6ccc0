//! The way to a first position: across, then down.

use post_machine::axis_words;
use post_machine::description::Tcp;
use post_machine::kinematics::Joints;

use super::{Blocks, Leg, MotionKind, Nominal, Reason, Surroundings, Travels};
use crate::accuracy::{Bound, Node, Placer};
use crate::program::{Motion, Pace};
use crate::refusal;

/// Directions that differ by less are the same.
const SAME: f64 = 1e-9;

/// Room for rounding below the end of travel, mm, where the chain has no closed form.
const ROOM: f64 = 0.01;

impl Blocks<'_> {
    /// The first position after the start, a tool change, or a turn of an index axis.
    ///
    /// The tool stands retracted. Where words of the plane move it across and the word of the depth down, the dialect
    /// writes them in that order; else, under tool centre point control, the way goes over a point straight above, as
    /// high as the tool was retracted.
    pub(super) fn first(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        node: &Node,
        kind: MotionKind,
        to: &mut Surroundings<'_, '_>,
    ) {
        if self.plane_first(placer, node) {
            self.arrive(leg, node, kind, to);
            return;
        }
        let Some(joints) = self.above(placer, node) else {
            // It stands as high already: one block, and none down.
            let across = Leg {
                reason: Reason::Approach,
                ..*leg
            };
            self.arrive(&across, node, kind, to);
            return;
        };
        match placer.settled(placer.solver().chain().forward(&joints), 1.0, &joints) {
            Ok(high) => {
                let motion = Motion {
                    tip: high.target.tip,
                    axis: high.target.axis,
                    edge: high.target.edge,
                    pace: Pace::Rapid,
                    chord: 0.0,
                };
                let across = Leg {
                    motion: &motion,
                    loose: true,
                    reason: Reason::Approach,
                    ..*leg
                };
                self.arrive(&across, &high, kind, to);
                self.cut(placer, leg, &high, node, to);
            }
            Err(refused) => to
                .findings
                .at(leg.line, refusal::refused(self.machine, &refused)),
        }
    }

    fn arrive(
        &mut self,
        leg: &Leg<'_>,
        node: &Node,
        kind: MotionKind,
        to: &mut Surroundings<'_, '_>,
    ) {
        let block = self.block(leg, node, Bound::default());
        to.out.push(crate::stream::Flow::Point(super::Block {
            kind,
            // Nobody knows the way: the feed is that of a millimetre.
            way: [1.0; 2],
            nominal: Nominal::of(leg.motion.pace, 1.0, Travels::default),
            ..block
        }));
    }

    /// The words of the plane move the tool across the depth axis, and the word of the depth moves it along, from where
    /// the dialect writes them.
    fn plane_first(&self, placer: &Placer, node: &Node) -> bool {
        let machine = self.machine;
        if machine.control.tcp == Tcp::Post {
            return true;
        }
        let joints = &node.trace.joints;
        let axes = || machine.axes.iter().zip(joints);
        // Ahead of the block that switches it on words are axis positions: the same where nothing is turned.
        let turned = axes().any(|(axis, joint)| {
            axis.joint.rotary && libm::fabs(axis.reading(*joint) * axis.unit()) > SAME
        });
        if turned && !self.tcp_still {
            return false;
        }
        let Some(depth) = axis_words::depth(machine) else {
            return true;
        };
        let chain = placer.solver().chain();
        let mut further = *joints;
        further[depth] += 1.0;
        let way = chain.forward(&further).tip - chain.forward(joints).tip;
        let along = match machine.axes[depth].name.as_str() {
            "X" => way.x,
            "Y" => way.y,
            _ => way.z,
        };
        1.0 - libm::fabs(along) < SAME
    }

    /// The axes as at `node`, the depth axis where the approach begins; none where it stands as high.
    fn above(&self, placer: &Placer, node: &Node) -> Option<Joints> {
        let machine = self.machine;
        let depth = axis_words::depth(machine)?;
        let retracted = machine.frame.retracted(depth)?;
        let mut joints = node.trace.joints;
        let up = retracted - joints[depth];
        let rounding = placer.tip_rounding();
        let room = if rounding.is_finite() {
            2.0 * rounding
        } else {
            ROOM
        };
        let height = machine.frame.approach.unwrap_or(f64::INFINITY);
        let height = height.min(libm::fabs(up) - room);
        (height > 0.0 && self.leads_away(placer, &joints, depth, up)).then(|| {
            joints[depth] += libm::copysign(height, up);
            joints
        })
    }

    /// Moving a joint that way brings the tool away from the part, towards its holder.
    pub(super) fn leads_away(
        &self,
        placer: &Placer,
        joints: &Joints,
        joint: usize,
        way: f64,
    ) -> bool {
        let chain = placer.solver().chain();
        let mut further = *joints;
        further[joint] += libm::copysign(1.0, way);
        let (from, to) = (chain.forward(joints), chain.forward(&further));
        (to.tip - from.tip).dot(&from.axis) > AWAY
    }
}

/// Cosine of the largest angle between a way that leads the tool away from the part and its axis.
const AWAY: f64 = 1e-3;
