//! The ways off the part and back that the CL file does not write: ahead of a retract, and drawn back in a cut.

use post_machine::diagnostic::{Diagnostic, Short};
use post_machine::kinematics::Joints;
use post_machine::kinematics::orientation::angle;

use super::tool_line::ToolLine;
use super::{BlockReason, BlockSink, BlockStage, PathLeg, TURN};
use crate::accuracy::{PathNode, Placer};
use crate::configuration::pose;
use crate::program::{MoveFeed, StraightMove};
use crate::refusal;

/// A tool leans from here on, radians.
const LEANS: f64 = 1e-3;

/// An axis that is as near to a position stands there, mm.
const STANDS: f64 = 1e-3;

/// Cosine of the largest angle between the axis of a tool in the part and a way that leads it away.
const AWAY: f64 = 1e-3;

/// A way across the tool axis is one but for so much.
const SIDEWAYS: f64 = 1e-6;

/// Least shortening of a way that is reported, mm.
const SHORT: f64 = 1e-3;

/// How far a tool that leans is drawn back where the machine has no `[rewind]`, mm: the first that travel allows.
const LEAVE: [f64; 5] = [100.0, 50.0, 25.0, 12.0, 6.0];

impl BlockStage<'_> {
    /// Off the part two linear axes and a rotary one go straight to where they are wanted: the straight way of the tip
    /// cannot be reached in general, and on the way out of the part it is asked for all the same.
    pub(super) fn goes_along_axes(&self, leg: &PathLeg<'_>) -> bool {
        leg.loose && !self.on_part && leg.placer.solver().planar()
    }

    /// The tool leaves the part standing otherwise than it is to stand then: it turns less so, or stays on its side of the
    /// centre line.
    pub(super) fn leaves_as(&self, placer: &Placer, [from, stay, to]: [&PathNode; 3]) -> bool {
        match placer.solver().planar() {
            true => self.turn_between(stay, to) > TURN,
            false => self.turn_between(from, stay) + TURN < self.turn_between(from, to),
        }
    }

    /// The tool is about to be retracted: from where it stands, if it stands anywhere.
    pub(super) fn depart(&mut self, line: u64, out: &mut BlockSink<'_>) {
        if let (Some(placer), Some(last)) = (self.placer.clone(), self.last.take()) {
            let last = self.leave_part(&placer, line, last, out);
            self.departs_from(&last);
        }
        self.on_part = false;
    }

    /// Before a retract, which goes along the depth axis: a tool that leans is drawn back along its own axis, and the
    /// retract must lead away from the part. Gives where the tool stands then.
    pub(super) fn leave_part(
        &mut self,
        placer: &Placer,
        line: u64,
        last: Box<PathNode>,
        out: &mut BlockSink<'_>,
    ) -> Box<PathNode> {
        if self.on_part {
            self.tool_line = ToolLine::of(&last);
        }
        if let Some(distance) = self.machine.frame.leave {
            return self.leave_along(placer, line, last, distance, out);
        }
        if self.machine.frame.retract.is_empty() {
            return last;
        }
        let leaning = angle(self.in_machine(placer, &last), self.machine.tool_axis) > LEANS;
        let last = match leaning {
            true => self.draw_back(placer, line, last, out),
            false => last,
        };
        self.check_retract(placer, line, &last);
        last
    }

    /// The tool goes back along its own axis by `distance` mm, or as far as travel lets it: what the machine file says of
    /// `leave`, which answers for where the axes go from there.
    fn leave_along(
        &mut self,
        placer: &Placer,
        line: u64,
        last: Box<PathNode>,
        distance: f64,
        out: &mut BlockSink<'_>,
    ) -> Box<PathNode> {
        let Some((away, way)) = self.out_by_leave(placer, &last, distance) else {
            if self.on_part {
                self.findings.at(line, stays());
            }
            return last;
        };
        if self.on_part && way < distance - SHORT {
            self.findings.at(line, left_early(way, distance));
        }
        let motion = StraightMove {
            tip: away.target.tip,
            axis: last.target.axis,
            edge: last.target.edge,
            pace: MoveFeed::Rapid,
            chord: 0.0,
        };
        let leg =
            PathLeg { placer, line, motion: &motion, loose: true, reason: BlockReason::Leave };
        self.cut(&leg, &last, &away, out);
        self.on_part = false;
        Box::new(away)
    }

    /// A tool that leans goes back along its own axis.
    fn draw_back(
        &mut self,
        placer: &Placer,
        line: u64,
        last: Box<PathNode>,
        out: &mut BlockSink<'_>,
    ) -> Box<PathNode> {
        let stands = StraightMove {
            tip: last.target.tip,
            axis: last.target.axis,
            edge: last.target.edge,
            pace: MoveFeed::Rapid,
            chord: 0.0,
        };
        let along = self.machine.control_point.along;
        let feed = self.machine.rewind.and_then(|rewind| rewind.retract_feed);
        let by =
            |distance: &f64| StraightMove { tip: stands.tip + stands.axis * *distance, ..stands };
        let rewind = self.machine.rewind.as_ref();
        let own = rewind.and_then(|rewind| stands.drawn_back(rewind, along));
        // A plane that lies below the tool has been passed.
        let passed = rewind.is_some() && own.is_none() && !self.on_part;
        let first = own.into_iter().chain(rewind.is_none().then(|| by(&LEAVE[0])));
        let shorter = LEAVE[1..].iter().map(by).filter(|_| !passed);
        let away: Vec<StraightMove> = first.chain(shorter).collect();
        // The rotary axes as they stand, an index axis among them; as far as the linear axes go.
        let mut refused = None;
        for (place, away) in away.into_iter().enumerate() {
            let motion = StraightMove { pace: MoveFeed::feed_or_rapid(feed), ..away };
            let joints = &last.trace.joints;
            let placed = match placer.solver().places_tip() {
                true => placer.settled(pose(&motion), 1.0, joints),
                // The rotary axes are needed for the way.
                false => placer.place(pose(&motion), 1.0, joints),
            };
            match placed {
                Ok(node) => {
                    let leg = PathLeg {
                        placer,
                        line,
                        motion: &motion,
                        loose: true,
                        reason: BlockReason::Leave,
                    };
                    self.cut(&leg, &last, &node, out);
                    // Cut short by the end of travel, it may still be in the part: from there it must not go sideways.
                    self.on_part &= place > 0;
                    return Box::new(node);
                }
                Err(fault) => refused = refused.or(Some(fault)),
            }
        }
        // Off the part the CL file has led the tool away; straight up it may go from there.
        if self.on_part {
            let fault = match refused {
                Some(refused) => refusal::refused(self.machine, &refused),
                None => Diagnostic::error(
                    "retract",
                    "the tool leans in the part, and must be retracted here: straight up it would gouge",
                )
                .help("retract along the tool before this line, or give [rewind] a distance"),
            };
            self.findings.at(line, fault);
        }
        last
    }

    /// A retract that is not proven to lead away from the part is refused.
    fn check_retract(&self, placer: &Placer, line: u64, node: &PathNode) {
        let machine = self.machine;
        let joints = &node.trace.joints;
        for (joint, position) in &machine.frame.retract {
            let axis = &machine.axes[*joint];
            let way = position - joints[*joint];
            if libm::fabs(way) < STANDS || self.leads_away(placer, joints, *joint, way) {
                continue;
            }
            let (now, then) = (axis.reading(joints[*joint]), axis.reading(*position));
            let leans = angle(self.in_machine(placer, node), machine.tool_axis).to_degrees();
            let chain = placer.solver().chain();
            let across = libm::fabs(chain.way_of(*joint, joints).dot(&chain.forward(joints).axis));
            let across = across < SIDEWAYS;
            let name = &axis.name;
            self.findings.at(line, match machine.frame.retract_said {
                // The machine file names the position and answers for the way to it.
                true if across => continue,
                true if leans < 90.0 => Diagnostic::error(
                    "retract",
                    format!("{name} stands at {now:.3} mm, and [control] retract = {then:.3} mm would bring the tool down"),
                )
                .help("put the retract beyond what the program reaches"),
                // The machine file names the position and answers for the way to it.
                true => continue,
                false if across => Diagnostic::error(
                    "retract",
                    format!("{name} goes across the tool: {then:.3} mm, the end of its travel, is not proven to lead away from the part"),
                )
                .help("[control] retract = {} where nothing retracts (a wire, a winder), retract = { … } or leave = … where something does"),
                false => Diagnostic::error(
                    "retract",
                    format!("the tool leans by {leans:.1}°: {name} at {then:.3} mm, the end of its travel, is not proven to lead it away from the part"),
                )
                .help("[control] leave = … leads the tool back along its own axis first, so many mm; or end the path with the tool less inclined, or name a position with [control] retract and answer for it"),
            });
        }
    }

    /// Moving a joint that way brings the tool away from the part, towards its holder; sideways is enough for one that
    /// has left the part.
    fn leads_away(&self, placer: &Placer, joints: &Joints, joint: usize, way: f64) -> bool {
        let chain = placer.solver().chain();
        let along = chain.way_of(joint, joints).dot(&chain.forward(joints).axis);
        let least = if self.on_part { AWAY } else { -SIDEWAYS };
        libm::copysign(1.0, way) * along > least
    }

    /// Draws the tool back along its axis, turns it to `joints`, and brings it back.
    pub(super) fn rewind(&mut self, leg: &PathLeg<'_>, joints: &Joints, out: &mut BlockSink<'_>) {
        let (Some(rewind), Some(last)) = (self.machine.rewind, self.last.take()) else {
            return;
        };
        self.counts.rewinds += 1;
        let along = self.machine.control_point.along;
        let away = leg.motion.drawn_back(&rewind, along).unwrap_or(*leg.motion);
        let back = rewind.plunge_feed.map_or(leg.motion.pace, MoveFeed::PerMinute);
        // The tip stands still while the axes turn: what counts is the farthest of them.
        let turn = rewind.turn_feed.map_or(MoveFeed::Rapid, |feed| {
            let axes = self.machine.axes.iter().enumerate();
            let farthest = axes
                .filter(|(_, axis)| axis.joint.rotary)
                .map(|(joint, _)| libm::fabs(joints[joint] - last.trace.joints[joint]))
                .fold(0.0, f64::max);
            MoveFeed::InverseTime(feed / farthest.to_degrees().max(1e-3))
        });
        let stops = [
            (away, MoveFeed::feed_or_rapid(rewind.retract_feed), last.trace.joints, true),
            (away, turn, *joints, true),
            (*leg.motion, back, *joints, false),
        ];
        let mut at = last;
        for (motion, pace, joints, loose) in stops {
            let motion = StraightMove { pace, chord: 0.0, ..motion };
            let leg = PathLeg {
                motion: &motion,
                loose: loose || pace == MoveFeed::Rapid,
                reason: BlockReason::Rewind,
                ..*leg
            };
            match leg.placer.settled(pose(leg.motion), 1.0, &joints) {
                Ok(mut node) => {
                    self.on_part = false;
                    self.go(&leg, at, &mut node, false, out);
                    at = Box::new(node);
                }
                Err(refused) => {
                    self.findings.at(leg.line, refusal::refused(self.machine, &refused));
                    break;
                }
            }
        }
        self.on_part = true;
        self.last = Some(at);
    }
}

/// The tool is in the part, and travel lets it back nowhere.
fn stays() -> Diagnostic {
    Diagnostic::error(
        "retract",
        "the tool must leave the part along its own axis here ([control] leave), and travel ends where it stands",
    )
    .help("end the path where there is way left, or another --mount")
}

/// Travel ends before the way that `leave` asks for.
fn left_early(way: f64, distance: f64) -> Diagnostic {
    let message = format!(
        "the tool leaves the part by {way:.3} mm along its own axis, and [control] leave says {}: travel ends there",
        Short(distance)
    );
    Diagnostic::warning("retract", message).help(
        "is it out of the part there? Else another --mount, or a shorter distance that is enough",
    )
}
