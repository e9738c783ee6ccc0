//! Moves whose axis values are chosen: points put in, feeds, and the events that say them.

use nalgebra::Vector3;
use post_plugin::{Event, ToolPose};

use super::Path;
use super::tally::{AXIS, RAPID, TIP};
use crate::accuracy::{Bound, Node, Run};
use crate::feed::{Due, STILL};
use crate::program::{Motion, Pace};
use crate::refusal;
use crate::report::Deviation;
use crate::route::{Chosen, planned, pose};
use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::orientation::angle;
use post_machine::kinematics::{Joints, Pose};

/// Deviations that differ by less are the same: mm or radians.
const EQUAL: f64 = 1e-9;

/// Turns that differ by less are the same, radians.
const TURN: f64 = 1e-6;

/// A control that shows an axis over one turn takes the shorter way: no block turns it by more, radians.
pub(super) const LONGEST: f64 = 2.9;

/// A move on its way to the dialect.
#[derive(Clone, Copy, Debug)]
pub(super) struct Leg<'m> {
    pub line: u64,
    pub motion: &'m Motion,
    /// Off the part: the tolerance of a rapid is enough.
    pub loose: bool,
    pub setting: usize,
}

/// Which of the largest deviations a block counts for.
struct Slots(&'static [usize]);

impl Slots {
    #[inline]
    fn of(leg: &Leg<'_>) -> Self {
        Self(if leg.loose { &[RAPID] } else { &[TIP, AXIS] })
    }
}

/// Deviations of a block in all places.
#[inline]
fn values(leg: &Leg<'_>, bound: Bound) -> [f64; 3] {
    let chord = leg.motion.chord;
    [bound.tip + chord, bound.axis, bound.tip + chord]
}

/// What is due between two places of a run, each a leg and a share of it.
fn due_between(due: &[Due], (first, from): (usize, f64), (last, to): (usize, f64)) -> Due {
    if first == last {
        return due[first].share(to - from);
    }
    let whole: f64 = due[first + 1..last].iter().map(|due| due.minutes).sum();
    Due {
        minutes: due[first].minutes * (1.0 - from) + whole + due[last].minutes * to,
        moves: true,
    }
}

/// Where the printed words bring the tool: a node's tip is the control point.
#[inline]
fn tool_pose(machine: &Machine, node: &Node) -> ToolPose {
    let axis = node.trace.pose.axis;
    let tip = node.tip - axis * machine.control_point.along;
    ToolPose {
        tip: tip.into(),
        axis: axis.into(),
    }
}

impl Path<'_> {
    /// Carries out a point that was decided.
    #[inline]
    pub(super) fn carry_out(&mut self, chosen: &Chosen) {
        let leg = Leg {
            line: chosen.line,
            motion: &chosen.motion,
            loose: chosen.motion.pace == Pace::Rapid,
            setting: chosen.setting,
        };
        if chosen.arrives {
            self.tally.branch_changes += u64::from(chosen.changed && leg.loose);
            self.tally.eased += u64::from(chosen.eased);
            self.travel(&leg, &chosen.joints);
        }
        if let Some(joints) = &chosen.rewind {
            self.end_run();
            self.rewind(&leg, joints);
        }
    }

    #[inline]
    fn travel(&mut self, leg: &Leg<'_>, joints: &Joints) {
        let target = pose(leg.motion);
        let mut node = self.spare.take().unwrap_or_default();
        let placer = self.route.placer(leg.setting);
        if let Err(refused) = placer.settle(&mut node, target, 1.0, joints) {
            self.spare = Some(node);
            self.find(leg.line, refusal::refused(self.machine, &refused));
            return;
        }
        if self.compensating {
            self.check_compensation(leg.line, &node);
        }
        let cuts = leg.motion.pace != Pace::Rapid;
        // A knife does not turn.
        let turns = self.machine.edge.is_none();
        if turns && !self.turning && cuts && !self.told_spindle {
            self.told_spindle = true;
            self.find(
                leg.line,
                Diagnostic::warning(
                    "spindle",
                    "the tool cuts, and the spindle was not switched on",
                )
                .help("the CAM system should write SPINDL before this line"),
            );
        }
        let gathers = self.gathers(leg, &node);
        if !gathers {
            self.end_run();
        }
        match self.last.take() {
            None => self.first(leg, &node),
            Some(last) if self.machine.indexes && self.indexes(&last, &node) => {
                // An index axis turns with the tool at the reference, not somewhere over the part.
                let last = self.leave_part(leg, last);
                self.push(leg.line, Event::Release);
                self.push(leg.line, Event::Home);
                self.tally.go(&last.trace.joints, &node.trace.joints);
                self.first(leg, &node);
                self.spare = Some(last);
            }
            Some(last) => self.spare = Some(self.go(leg, last, &mut node, gathers)),
        }
        self.on_part = cuts;
        self.last = Some(node);
    }

    /// The first position after the start or a tool change.
    fn first(&mut self, leg: &Leg<'_>, node: &Node) {
        let line = leg.line;
        let none = node.trace.joints;
        let feed = match leg.motion.pace {
            Pace::Rapid => None,
            // A time for a way that nobody knows has no meaning; the way is made at rapid.
            Pace::InverseTime(_) => None,
            Pace::PerMinute(_) => {
                let due = self.feeds.due(leg.motion.pace, 1.0, &none, &none);
                let paced = self.feeds.cut(leg.motion.pace, due, [1.0; 2], &none, &none);
                Some(paced.feed)
            }
        };
        let count = self.format.words.len();
        self.tally
            .reach(&node.trace.joints, self.machine.axes.len());
        self.tally.blocks += 1;
        if let (false, Some(spindle)) = (self.turning, self.commanded) {
            // The tool change stopped it, and the CL file takes it to be turning.
            self.turning = true;
            self.push(line, Event::Spindle(spindle));
            self.find(
                line,
                Diagnostic::warning(
                    "spindle",
                    "no SPINDL since the tool change; the spindle was switched on again as before it",
                )
                .help("check that the speed fits the new tool"),
            );
        }
        if let (true, Some(coolant)) = (std::mem::take(&mut self.coolant_due), self.coolant) {
            self.push(line, Event::Coolant(coolant));
        }
        // Nobody knows whether they are clamped.
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, false, true);
        }
        self.push(
            line,
            Event::Position {
                tool: Some(tool_pose(self.machine, node)),
                feed,
                words: &node.words[..count],
            },
        );
        self.positioned = true;
        // What was turned on the way is clamped before the tool goes on.
        for joint in 0..self.machine.axes.len() {
            self.set_clamp(line, joint, true, false);
        }
    }

    /// A move from where the tool stands to `node`; gives the node that it left.
    #[inline]
    fn go(
        &mut self,
        leg: &Leg<'_>,
        mut last: Box<Node>,
        node: &mut Node,
        gathers: bool,
    ) -> Box<Node> {
        if leg.loose && self.on_part {
            // The tool leaves the part as it stands, and turns when it is away.
            let placer = self.route.placer(leg.setting);
            if let Ok(stay) = placer.place(node.target, 1.0, &last.trace.joints)
                && self.turn_between(&last, &stay) + TURN < self.turn_between(&last, node)
            {
                self.cut(leg, &last, &stay);
                *last = stay;
            }
        }
        if self.machine.stages && self.special(&last, node) {
            self.by_stages(leg, &last, node);
        } else if gathers {
            self.gather(leg, &last, node);
        } else {
            self.cut(leg, &last, node);
        }
        last
    }

    /// Before the way to the reference, which goes along the depth axis: a tool that leans in the part is drawn
    /// back along its own axis.
    fn leave_part(&mut self, leg: &Leg<'_>, last: Box<Node>) -> Box<Node> {
        let leaning = angle(self.in_machine(&last), self.machine.tool_axis) > 1e-3;
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
            self.find(
                leg.line,
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
            ..*leg
        };
        let placer = self.route.placer(leg.setting);
        // The rotary axes as they stand, the index axis among them.
        match placer.settled(pose(&motion), 1.0, &last.trace.joints) {
            Ok(node) => {
                self.on_part = false;
                self.cut(&out, &last, &node);
                Box::new(node)
            }
            Err(refused) => {
                self.find(leg.line, refusal::refused(self.machine, &refused));
                last
            }
        }
    }

    /// The tool axis in the machine frame, as the head holds it.
    fn in_machine(&self, node: &Node) -> Vector3<f64> {
        let mut joints = node.trace.joints;
        for (value, axis) in joints.iter_mut().zip(&self.machine.axes) {
            if axis.carries_part {
                *value = 0.0;
            }
        }
        self.route.present().solver().chain().forward(&joints).axis
    }

    /// An indexed axis stands differently.
    pub(super) fn indexes(&self, from: &Node, to: &Node) -> bool {
        let axes = self.machine.axes.iter().zip(&from.trace.joints);
        axes.zip(&to.trace.joints)
            .any(|((axis, from), to)| axis.indexed.is_some() && (from - to).abs() > TURN)
    }

    /// The sum of all rotary moves between two nodes, radians.
    pub(super) fn turn_between(&self, from: &Node, to: &Node) -> f64 {
        let axes = self.machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.joint.rotary)
            .map(|(joint, _)| (to.trace.joints[joint] - from.trace.joints[joint]).abs())
            .sum()
    }

    /// The move cannot be made in one go: an axis shown over one turn would take the other way round, or axes
    /// that exclude one another would move together.
    #[inline]
    pub(super) fn special(&self, from: &Node, to: &Node) -> bool {
        let way = |joint: usize| (to.trace.joints[joint] - from.trace.joints[joint]).abs();
        let mut axes = self.machine.axes.iter().enumerate();
        axes.any(|(joint, axis)| axis.range.is_some() && way(joint) > LONGEST)
            || !self.excluded(from, to).is_empty()
    }

    /// Axes that exclude one another and would move together, group by group.
    fn excluded(&self, from: &Node, to: &Node) -> Vec<Vec<usize>> {
        let moves =
            |joint: &usize| (to.trace.joints[*joint] - from.trace.joints[*joint]).abs() > EQUAL;
        let groups = self.machine.solution.exclusive.iter();
        groups
            .map(|group| group.iter().copied().filter(moves).collect::<Vec<_>>())
            .filter(|moving| moving.len() > 1)
            .collect()
    }

    fn by_stages(&mut self, leg: &Leg<'_>, from: &Node, to: &Node) {
        let (first, last) = (from.trace.joints, to.trace.joints);
        let mut at = *from;
        let excluded = self.excluded(from, to);
        if !excluded.is_empty() && leg.loose && self.on_part {
            // Away from the part first, as the tool stands.
            self.stage(leg, &mut at, to.target, 1.0, &first);
        }
        let turned_at = at.target;
        for moving in excluded {
            if !leg.loose {
                let names: Vec<&str> = moving
                    .iter()
                    .map(|joint| self.machine.axes[*joint].name.as_str())
                    .collect();
                self.find(
                    leg.line,
                    Diagnostic::error(
                        "exclusive",
                        format!(
                            "this cut moves {} at once, and the machine moves one of them at a time",
                            names.join(" and ")
                        ),
                    )
                    .help("it can be reached in a rapid; or the machine file's [solution] exclusive is wrong"),
                );
                return;
            }
            // One after the other, the tip where it was.
            for joint in &moving[..moving.len() - 1] {
                let mut joints = at.trace.joints;
                joints[*joint] = last[*joint];
                self.stage(leg, &mut at, turned_at, 1.0, &joints);
            }
        }
        let begin = at.trace.joints;
        let longest = self
            .machine
            .axes
            .iter()
            .enumerate()
            .filter(|(_, axis)| axis.range.is_some())
            .map(|(joint, _)| (last[joint] - begin[joint]).abs())
            .fold(0.0, f64::max);
        let count = libm::ceil(longest / LONGEST).max(1.0) as u32;
        for part in 1..count {
            let t = f64::from(part) / f64::from(count);
            let joints: Joints =
                std::array::from_fn(|joint| begin[joint] * (1.0 - t) + last[joint] * t);
            let target = Pose {
                tip: turned_at.tip * (1.0 - t) + to.target.tip * t,
                axis: (from.target.axis * (1.0 - t) + to.target.axis * t)
                    .try_normalize(1e-6)
                    .unwrap_or(to.target.axis),
                ..to.target
            };
            self.stage(leg, &mut at, target, t, &joints);
        }
        self.cut(leg, &at, to);
    }

    /// A stop on the way of a move that is made in stages.
    fn stage(&mut self, leg: &Leg<'_>, at: &mut Node, target: Pose, t: f64, joints: &Joints) {
        let settled = self.route.placer(leg.setting).settled(target, t, joints);
        match settled {
            Ok(node) => {
                self.cut(leg, at, &node);
                *at = node;
            }
            Err(refused) => self.find(leg.line, refusal::refused(self.machine, &refused)),
        }
    }

    /// Draws the tool back along its axis, turns it to `joints`, and brings it back.
    fn rewind(&mut self, leg: &Leg<'_>, joints: &Joints) {
        let (Some(rewind), Some(last)) = (self.machine.rewind, self.last.take()) else {
            return;
        };
        self.tally.rewinds += 1;
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
                ..*leg
            };
            let placer = self.route.placer(leg.setting);
            match placer.settled(pose(leg.motion), 1.0, &joints) {
                Ok(mut node) => {
                    self.on_part = false;
                    self.go(&leg, at, &mut node, false);
                    at = Box::new(node);
                }
                Err(refused) => {
                    self.find(leg.line, refusal::refused(self.machine, &refused));
                    break;
                }
            }
        }
        self.on_part = true;
        self.last = Some(at);
    }

    /// A straight move, cut into pieces where it strays.
    #[inline]
    pub(super) fn cut(&mut self, leg: &Leg<'_>, last: &Node, node: &Node) {
        let placer = self.route.placer(leg.setting);
        let whole = planned(self.machine, placer, leg.motion, leg.loose, last, node);
        if let (false, Some(watch)) = (leg.loose, &mut self.watch) {
            watch.cut(leg.line, &whole);
        }
        match whole.whole() {
            Some(bound) => {
                let slots = Slots::of(leg);
                // The cheap bound decides whether the block can be the worst one; the tight one is kept.
                let bound = if self.worst(&slots, values(leg, bound)) {
                    whole.measured().least(bound)
                } else {
                    bound
                };
                let due = self.due_of(leg, last, node);
                self.piece(leg, last, node, due, bound);
            }
            None => self.split(&[*leg], &[*last, *node]),
        }
    }

    /// Legs, one after the other, that need points or can do without some of their own.
    pub(super) fn split(&mut self, legs: &[Leg<'_>], nodes: &[Node]) {
        let Some(first) = legs.first() else {
            return;
        };
        let mut linearise = std::mem::take(&mut self.linearise);
        let (machine, placer) = (self.machine, self.route.placer(first.setting));
        let planned = planned(
            machine,
            placer,
            first.motion,
            first.loose,
            &nodes[0],
            &nodes[1],
        );
        let moves = nodes
            .windows(2)
            .any(|pair| (pair[1].target.tip - pair[0].target.tip).norm() > STILL);
        let run = Run {
            placer,
            nodes,
            tolerances: planned.tolerances,
            control_keeps_tip: planned.control_keeps_tip,
            // A rapid has no surface to be balanced about. A tip that stands still must seem to: its feed is taken
            // along the axes.
            balances: !first.loose && moves,
        };
        match linearise.split(&run, self.model) {
            Ok(()) => {
                let mut due = std::mem::take(&mut self.due);
                due.clear();
                for (leg, pair) in legs.iter().zip(nodes.windows(2)) {
                    due.push(self.due_of(leg, &pair[0], &pair[1]));
                }
                let mut from = nodes[0];
                let (mut at, mut kept) = ((0, 0.0), 0);
                for piece in linearise.pieces() {
                    let on_point = piece.to.t == 1.0;
                    kept += usize::from(on_point);
                    self.tally.points_added += u64::from(!on_point);
                    let end = (piece.leg, piece.to.t);
                    let between = due_between(&due, at, end);
                    self.piece(&legs[piece.leg], &from, &piece.to, between, piece.bound);
                    (from, at) = (piece.to, end);
                }
                self.due = due;
                self.tally.points_dropped += (legs.len() - kept.min(legs.len())) as u64;
            }
            Err((leg, stuck)) => {
                let leg = &legs[leg];
                let finding = refusal::stuck(self.machine, &stuck, leg.motion);
                self.find(leg.line, finding);
            }
        }
        self.linearise = linearise;
    }

    /// What a move is due.
    #[inline]
    fn due_of(&self, leg: &Leg<'_>, from: &Node, to: &Node) -> Due {
        let length = (to.tip - from.tip).norm();
        let (first, last) = (&from.trace.joints, &to.trace.joints);
        self.feeds.due(leg.motion.pace, length, first, last)
    }

    /// One block.
    #[inline]
    fn piece(&mut self, leg: &Leg<'_>, from: &Node, to: &Node, due: Due, bound: Bound) {
        self.mark(leg, bound);
        // A block without a changed word moves nothing and is not written.
        if from.words == to.words {
            return;
        }
        let (first, last) = (&from.trace.joints, &to.trace.joints);
        self.tally.reach(last, self.machine.axes.len());
        self.tally.go(first, last);
        let words = &to.words[..self.format.words.len()];
        let tool = Some(tool_pose(self.machine, to));
        let rapid = leg.motion.pace == Pace::Rapid;
        let event = if rapid {
            self.tally.other += self.feeds.least_time(first, last);
            Event::Rapid { tool, words }
        } else {
            // Between the printed tips: that is the way that the control will time.
            let along = self.machine.control_point.along;
            let turned = (to.trace.pose.axis - from.trace.pose.axis) * along;
            let way = to.tip - from.tip;
            let lengths = [way.norm(), (way - turned).norm()];
            let paced = self.feeds.cut(leg.motion.pace, due, lengths, first, last);
            self.tally.limited += u64::from(paced.limited);
            self.tally.cutting += paced.minutes;
            Event::Linear {
                tool,
                feed: paced.feed,
                words,
            }
        };
        self.tally.blocks += 1;
        if self.machine.clamps {
            self.clamp(leg, from, to);
        }
        self.push(leg.line, event);
    }

    /// Lets go the axes that this block moves, and clamps the others before the tool cuts.
    fn clamp(&mut self, leg: &Leg<'_>, from: &Node, to: &Node) {
        for joint in 0..self.machine.axes.len() {
            let moves = from.trace.joints[joint] != to.trace.joints[joint];
            if moves {
                self.set_clamp(leg.line, joint, false, false);
            } else if leg.motion.pace != Pace::Rapid {
                self.set_clamp(leg.line, joint, true, false);
            }
        }
    }

    /// Writes the word that clamps an axis or lets it go, unless it is so already.
    fn set_clamp(&mut self, line: u64, joint: usize, on: bool, unknown: bool) {
        let Some(clamp) = &self.machine.axes[joint].clamp else {
            return;
        };
        let bit = 1 << joint;
        if unknown || (self.clamped & bit != 0) != on {
            self.clamped = self.clamped & !bit | if on { bit } else { 0 };
            let text = if on { &clamp.on } else { &clamp.off };
            self.push(line, Event::Word { text });
        }
    }

    /// Can a block with these deviations be the worst one?
    #[inline]
    fn worst(&self, slots: &Slots, values: [f64; 3]) -> bool {
        let deviations = &self.tally.deviations;
        slots
            .0
            .iter()
            .any(|slot| values[*slot] > deviations[*slot].value)
    }

    /// Keeps the largest deviations.
    #[inline]
    fn mark(&mut self, leg: &Leg<'_>, bound: Bound) {
        let slots = Slots::of(leg);
        let values = values(leg, bound);
        for &slot in slots.0 {
            let deviation = &mut self.tally.deviations[slot];
            // Of blocks that are equal but for rounding errors, the first is named.
            if values[slot] > deviation.value + EQUAL {
                *deviation = Deviation {
                    value: values[slot],
                    block: 0,
                    line: leg.line,
                };
                self.marks[slot] = Some(self.batch.len());
            } else {
                deviation.value = deviation.value.max(values[slot]);
            }
        }
    }

    /// Radius compensation works in the plane of X and Y of the machine (of the part, where the control keeps
    /// the tip): a tool that does not stand upright in it would be moved sideways into the part.
    fn check_compensation(&mut self, line: u64, node: &Node) {
        let machine = self.machine;
        let axis = match machine.control.tcp {
            Tcp::Control => node.trace.pose.axis,
            Tcp::Post => self.in_machine(node),
        };
        let tilt = angle(axis, machine.tool_axis);
        let turned = self
            .last
            .as_ref()
            .is_some_and(|last| self.turn_between(last, node) > 0.0);
        let what = if tilt > 1e-3 {
            format!("the tool tilted by {:.3}°", tilt.to_degrees())
        } else if turned {
            "rotary axes turning".to_owned()
        } else {
            return;
        };
        self.compensating = false;
        if std::mem::replace(&mut self.told_compensation, true) {
            return;
        }
        self.find(
            line,
            Diagnostic::error(
                "compensation",
                format!("cutter radius compensation (CUTCOM) with {what}: the control would offset in the wrong plane"),
            )
            .help("let the CAM system write the tool centre path, with CUTCOM/OFF"),
        );
    }
}
