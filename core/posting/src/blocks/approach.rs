//! The way to a first position, from where the tool is retracted.

use post_machine::axis_words;
use post_machine::description::Tcp;
use post_machine::kinematics::Pose;

use super::nominal::{Nominal, Travels};
use super::{Block, Blocks, Leg, MotionKind, Reason, Surroundings};
use crate::accuracy::{Bound, Node, Placer, Refused};
use crate::program::{Motion, Pace};
use crate::refusal;
use crate::stream::Flow;

/// So far below the end of its travel the depth axis comes over a first position, mm: a part that sits higher on the
/// machine than the file's `mount` still leaves it room.
const ROOM: f64 = 50.0;

/// A shorter way down is none, mm.
const LEAST: f64 = 1.0;

/// A tool lies across an axis where the cosine of the angle between them is less.
const LYING: f64 = 0.01;

/// Angles that differ by less are the same, radians; of directions, one less their cosine.
const SAME: f64 = 1e-9;

/// The word of a plane along its normal.
const DEPTH: usize = 2;

/// A tool that is measured, and not drawn, leans by less: 0.1 degrees.
const MEASURED: f64 = 1.8e-3;

/// One less the cosine of an angle that the rounding of a plane's angles can make.
const SAME_WAY: f64 = 1e-8;

impl Blocks<'_> {
    /// The first position after the start, a tool change, or a turn of an index axis.
    pub(super) fn first(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        node: &Node,
        kind: MotionKind,
        to: &mut Surroundings<'_, '_>,
    ) {
        if !self.comes_from_above(placer, node) {
            return self.come(leg, node, kind, to);
        }
        let above = match self.above(placer, node) {
            Some(Ok(above)) => above,
            Some(Err(refused)) => {
                let fault = refusal::refused(self.machine, &refused);
                return to.findings.at(leg.line, fault);
            }
            // It is up there already.
            None => {
                let leg = Leg {
                    reason: Reason::Above,
                    ..*leg
                };
                return self.come(&leg, node, kind, to);
            }
        };
        let motion = Motion {
            tip: above.target.tip,
            pace: Pace::Rapid,
            chord: 0.0,
            ..*leg.motion
        };
        let over = Leg {
            motion: &motion,
            loose: true,
            reason: Reason::Above,
            ..*leg
        };
        self.come(&over, &above, kind, to);
        self.cut(placer, leg, &above, node, to);
    }

    /// From wherever the tool stands to `node`.
    fn come(&self, leg: &Leg<'_>, node: &Node, kind: MotionKind, to: &mut Surroundings<'_, '_>) {
        let block = self.block(leg, node, Bound::default());
        to.out.push(Flow::Point(Block {
            kind,
            // Nobody knows the way: the feed is that of a millimetre.
            way: 1.0,
            nominal: Nominal::of(leg.motion.pace, 1.0, Travels::default),
            ..block
        }));
    }

    /// No word moves the depth axis alone, as X and Y move the others: the words are those of a part that is turned, or
    /// of a plane whose Z is not the depth's word, or the control begins to keep the tip with the very move. Else the words
    /// across the tool come first.
    fn comes_from_above(&self, placer: &Placer, node: &Node) -> bool {
        let machine = self.machine;
        let joints = &node.trace.joints;
        let Some(depth) = axis_words::depth(self.base) else {
            return false;
        };
        let way = placer.solver().chain().way_of(depth, joints);
        let word = axis_words::coordinate(&machine.axes[depth].name);
        if let Some(normal) = self.plane_normal() {
            // Along it, and not into the part, it is the plane's own Z: the others come first where that is its word.
            return word != DEPTH || 1.0 - way.dot(&normal) >= SAME_WAY;
        }
        if machine.control.tcp == Tcp::Post {
            return false;
        }
        // Ahead of a block that has the control keep the tip with a move, words are axis positions: the same where
        // nothing is turned.
        let mut axes = machine.axes.iter().zip(joints);
        let turned = axes.any(|(axis, joint)| {
            axis.joint.rotary && libm::fabs(axis.reading(*joint) * axis.unit()) > SAME
        });
        if turned && !self.tcp_still {
            return true;
        }
        // With a move that puts the length on, a tool that lies aslant moves the depth as well as the others.
        let axis = node.target.axis;
        let aslant = libm::fabs(way.dot(&axis)).min(way.cross(&axis).norm()) > MEASURED;
        (aslant && !self.tcp_still) || 1.0 - libm::fabs(way[word]) >= SAME
    }

    /// The same stance with the depth axis drawn back, as high as the retract and `ROOM` below the end of travel allow:
    /// where no head leans that is the tool's own line. None where there is no such place.
    fn above(&self, placer: &Placer, node: &Node) -> Option<Result<Node, Refused>> {
        let machine = self.machine;
        let depth = axis_words::depth(self.base)?;
        let mut retract = machine.frame.retract.iter();
        let (_, retract) = retract.find(|(joint, _)| *joint == depth)?;
        let joints = &node.trace.joints;
        let chain = placer.solver().chain();
        // Along the tool to its holder; where it lies across the axis, to the retract.
        let along = chain.way_of(depth, joints).dot(&node.target.axis);
        let away = match libm::fabs(along) > LYING {
            true => libm::copysign(1.0, along),
            false => libm::copysign(1.0, retract - joints[depth]),
        };
        let to_retract = (retract - joints[depth]) * away;
        let end =
            machine.axes[depth].travel.map_or(
                *retract,
                |[least, most]| {
                    if away > 0.0 { most } else { least }
                },
            );
        let to_end = (end - joints[depth]) * away;
        // A tool without a length is one that nobody has measured.
        let measured = chain.tip() != machine.gauge;
        let room = (to_end / 2.0).min(if measured { ROOM } else { f64::INFINITY });
        let way = to_retract.min(to_end - room);
        if way < LEAST {
            return None;
        }
        let target = Pose {
            tip: node.target.tip + chain.way_of(depth, joints) * (away * way),
            ..node.target
        };
        Some(match placer.solver().closed_form() {
            true => placer.settled(target, 1.0, joints),
            false => placer.place(target, 1.0, joints),
        })
    }
}
