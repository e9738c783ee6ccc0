//! The ways off the part and back that the CL file does not write: to the reference, and drawn back in a cut.

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;
use post_machine::kinematics::orientation::angle;

use super::{Blocks, Leg, Reason, Surroundings};
use crate::accuracy::{Node, Placer};
use crate::configuration::pose;
use crate::program::{Motion, Pace};
use crate::refusal;

impl Blocks<'_> {
    /// Before the way to the reference, which goes along the depth axis: a tool that leans in the part is drawn
    /// back along its own axis.
    pub(super) fn leave_part(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        last: Box<Node>,
        to: &mut Surroundings<'_, '_>,
    ) -> Box<Node> {
        let leaning = angle(self.in_machine(placer, &last), self.machine.tool_axis) > 1e-3;
        if !self.on_part || !leaning {
            return last;
        }
        let stands = Motion {
            tip: last.target.tip,
            axis: last.target.axis,
            edge: last.target.edge,
            pace: Pace::Rapid,
            chord: 0.0,
        };
        let along = self.machine.control_point.along;
        let away = self
            .machine
            .rewind
            .and_then(|rewind| Some((stands.drawn_back(&rewind, along)?, rewind)));
        let Some((away, rewind)) = away else {
            to.findings.at(leg.line,
                Diagnostic::error(
                    "index",
                    "an index axis must turn here, and the tool leans in the part: straight up to the reference it would gouge",
                )
                .help("retract along the tool before this line, or give the machine a [rewind]"),
            );
            return last;
        };
        let motion = Motion {
            pace: Pace::feed_or_rapid(rewind.retract_feed),
            ..away
        };
        let out = Leg {
            motion: &motion,
            loose: true,
            reason: Reason::Leave,
            ..*leg
        };
        // The rotary axes as they stand, the index axis among them.
        match placer.settled(pose(&motion), 1.0, &last.trace.joints) {
            Ok(node) => {
                self.on_part = false;
                self.cut(placer, &out, &last, &node, to);
                Box::new(node)
            }
            Err(refused) => {
                to.findings
                    .at(leg.line, refusal::refused(self.machine, &refused));
                last
            }
        }
    }

    /// Draws the tool back along its axis, turns it to `joints`, and brings it back.
    pub(super) fn rewind(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        joints: &Joints,
        to: &mut Surroundings<'_, '_>,
    ) {
        let (Some(rewind), Some(last)) = (self.machine.rewind, self.last.take()) else {
            return;
        };
        self.counts.rewinds += 1;
        let along = self.machine.control_point.along;
        let away = leg.motion.drawn_back(&rewind, along).unwrap_or(*leg.motion);
        let back = rewind.plunge_feed.map_or(leg.motion.pace, Pace::PerMinute);
        // The tip stands still while the axes turn: what counts is the farthest of them.
        let turn = rewind.turn_feed.map_or(Pace::Rapid, |feed| {
            let axes = self.machine.axes.iter().enumerate();
            let farthest = axes
                .filter(|(_, axis)| axis.joint.rotary)
                .map(|(joint, _)| libm::fabs(joints[joint] - last.trace.joints[joint]))
                .fold(0.0, f64::max);
            Pace::InverseTime(feed / farthest.to_degrees().max(1e-3))
        });
        let stops = [
            (
                away,
                Pace::feed_or_rapid(rewind.retract_feed),
                last.trace.joints,
                true,
            ),
            (away, turn, *joints, true),
            (*leg.motion, back, *joints, false),
        ];
        let mut at = last;
        for (motion, pace, joints, loose) in stops {
            let motion = Motion {
                pace,
                chord: 0.0,
                ..motion
            };
            let leg = Leg {
                motion: &motion,
                loose: loose || pace == Pace::Rapid,
                reason: Reason::Rewind,
                ..*leg
            };
            match placer.settled(pose(leg.motion), 1.0, &joints) {
                Ok(mut node) => {
                    self.on_part = false;
                    self.go(placer, &leg, at, &mut node, false, to);
                    at = Box::new(node);
                }
                Err(refused) => {
                    to.findings
                        .at(leg.line, refusal::refused(self.machine, &refused));
                    break;
                }
            }
        }
        self.on_part = true;
        self.last = Some(at);
    }
}
