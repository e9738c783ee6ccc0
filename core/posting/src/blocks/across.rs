//! The way across between two passes, from where the tool has left the part to the next first position, as bodies of the
//! machine leave it: retracted only as high as it is proven clear, or past them.
//!
//! What is made from where the tool departs on is held back until the first position is known, so that the last stage knows
//! of the way before it retracts. Ahead of a tool change, at stops, and where no shorter way is proven, the retract is that
//! of the machine file. What is chosen here is proven once more of the program as it is written.

use post_machine::axis_words::{self, unit_length};
use post_machine::dependent_limit::DependentLimit;
use post_machine::description::{Axis, Machine};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, Solver};

use super::free_way::{FreeWay, Room};
use super::low_rapids::moves_nothing;
use super::{BlockNote, BlockSink, BlockStage, MotionBlock};
use crate::accuracy::{PathNode, Placer};
use crate::configuration::{
    BodyClearance, ClearTool, Contact, DriveLimits, TrialWay, TrialWayKind,
};
use crate::program::{Command, ToolChange};
use crate::report::{Unlinked, WaysAcross};
use crate::stream::StreamItem;

/// Elements that are held back at most; of a longer pause nothing is shortened.
const MOST_HELD: usize = 256;

/// Heights that are tried besides the lowest one.
const TRIALS: u32 = 9;

/// A retract that is lower by less is not worth it, mm.
const WORTH: f64 = 1.0;

/// How far the tool is drawn back to where a way past bodies begins and ends, mm: the first that is clear.
const DRAWN_BACK: [f64; 7] = [0.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0];

/// The place of a way over a height that is over the first position, or that position itself.
const OVER: usize = 3;

/// Rotary axes of a way past bodies stand on whole numbers of these, degrees.
const TURN_STEP: f64 = 0.1;

/// A way of the axes across.
#[derive(Clone, Debug, PartialEq)]
pub struct WayAcross {
    /// The depth axis, by its place in the chain, and where it stands when the tool is retracted, mm.
    pub retract: (usize, f64),
    /// Where the axes go then, one place after the other; the first position is come to from the last.
    pub through: Vec<Joints>,
}

/// Chooses ways across.
pub(super) struct AcrossChoice<'a> {
    bodies: &'a mut dyn BodyClearance,
    drives: DriveLimits,
    /// Ways past bodies are looked for.
    links: bool,
    /// The tool in the spindle.
    tool: Option<ToolChange>,
    /// The tool whose bodies are in use, and its length, mm.
    equipped: Option<(u32, f64)>,
    /// Where the tool has departed from the part.
    departed: Option<Joints>,
    chosen: Option<WayAcross>,
    held: Vec<StreamItem<MotionBlock>>,
    found: WaysAcross,
}

/// A way that may be taken.
struct Candidate {
    way: WayAcross,
    /// Where the depth axis stands over the first position, mm.
    entry: f64,
    /// How long the axes take from where they depart to the first position, s.
    seconds: f64,
}

/// Whether ways are clear, for one tool.
pub(super) struct Trials<'t> {
    bodies: &'t mut dyn BodyClearance,
    solver: &'t Solver,
    drives: &'t DriveLimits,
    /// What must hold between axes.
    limits: &'t [DependentLimit],
}

/// From where the tool departs to the next first position.
struct Crossing<'c> {
    /// Line of the first position in the CL file.
    line: u64,
    placer: &'c Placer,
    from: &'c Joints,
    node: &'c PathNode,
    /// The axis that retracts the tool.
    depth: usize,
    /// Where it does, mm.
    highest: f64,
}

impl Crossing<'_> {
    /// The sense of the depth axis towards the retract.
    fn up(&self) -> f64 {
        libm::copysign(1.0, self.highest - self.from[self.depth])
    }

    /// A value of the depth axis drawn back, mm; none beyond the retract.
    fn drawn_back(&self, from: f64, by: f64) -> Option<f64> {
        let back = from + self.up() * by;
        (self.up() * (self.highest - back) >= 0.0).then_some(back)
    }
}

impl Trials<'_> {
    fn contact_of(&mut self, from: &Joints, to: &Joints, kind: TrialWayKind) -> Option<Contact> {
        self.bodies.contact(&TrialWay { solver: self.solver, ends: [from, to], kind })
    }

    /// What a way that begins where the tool departs does not stay clear of; it goes on as ways of this kind. Off the part,
    /// as it stands, nothing is left to hit with the cutter where the cut has been.
    fn contact(&mut self, places: &[Joints], kind: TrialWayKind) -> Option<Contact> {
        let kinds = [TrialWayKind::Rapid].into_iter().chain(std::iter::repeat(kind));
        let mut ways = places.windows(2).zip(kinds).filter(|(ends, _)| ends[0] != ends[1]);
        ways.find_map(|(ends, kind)| self.contact_of(&ends[0], &ends[1], kind))
    }

    /// What a way does not stay clear of that is chosen here, from where the tool departs to the first position: how near it
    /// comes to the part at that, along its last piece, is up to the CL file.
    fn own_contact(&mut self, places: &[Joints]) -> Option<Contact> {
        let across = self.contact(&places[..=OVER], TrialWayKind::Across);
        across.or_else(|| self.comes_down(&places[OVER..]))
    }

    /// What the tool does not stay clear of on its way from over a first position to it.
    fn comes_down(&mut self, places: &[Joints]) -> Option<Contact> {
        let last = places.len().saturating_sub(2);
        let mut ways = places.windows(2).enumerate().filter(|(_, ends)| ends[0] != ends[1]);
        ways.find_map(|(place, ends)| {
            let kind = if place == last { TrialWayKind::Turn } else { TrialWayKind::Across };
            self.contact_of(&ends[0], &ends[1], kind)
        })
    }

    /// Nothing is hit on a piece of a way that is chosen here, or at a place of it, and what must hold between axes does.
    pub(super) fn goes(&mut self, from: &Joints, to: &Joints) -> bool {
        self.keeps_limits(&[*from, *to])
            && self.contact_of(from, to, TrialWayKind::Across).is_none()
    }

    /// What must hold between axes does all along a way, each axis of a piece for itself: so the program is held to it.
    fn keeps_limits(&self, places: &[Joints]) -> bool {
        let keeps = |limit: &DependentLimit| {
            let mut ways = places.windows(2);
            ways.all(|ends| limit.passed_by_each([&ends[0], &ends[1]]).is_none())
        };
        self.limits.iter().all(keeps)
    }

    /// The time of a way from rest to rest at each place, s.
    pub(super) fn seconds(&self, places: &[Joints]) -> f64 {
        let ways = places.windows(2);
        ways.map(|ends| self.drives.rest_to_rest(&ends[0], &ends[1], 1.0, |_| true)).sum()
    }
}

impl<'a> AcrossChoice<'a> {
    pub(super) fn new(machine: &Machine, bodies: &'a mut dyn BodyClearance) -> Self {
        Self {
            bodies,
            drives: DriveLimits::new(machine),
            links: machine.clearance.link,
            tool: None,
            equipped: None,
            departed: None,
            chosen: None,
            held: Vec::new(),
            found: WaysAcross::default(),
        }
    }

    /// What came of it.
    pub(super) fn found(&self) -> WaysAcross {
        self.found
    }

    /// Ways past bodies are looked for, and rapids between cuts may go lower.
    pub(super) fn links(&self) -> bool {
        self.links
    }

    /// Whether ways are clear for the tool in the spindle; none where it is not known how long it is.
    pub(super) fn trials<'t>(
        &'t mut self,
        machine: &'t Machine,
        solver: &'t Solver,
    ) -> Option<Trials<'t>> {
        self.equip(machine, solver).then_some(Trials {
            bodies: &mut *self.bodies,
            solver,
            drives: &self.drives,
            limits: &machine.limits,
        })
    }

    /// Rapids between two cuts go lower, and take so much less time, s.
    pub(super) fn lowered(&mut self, saves: f64) {
        self.found.rapids += 1;
        self.found.saved_s += saves;
    }

    /// A way between cuts is no other than ever.
    pub(super) fn stays(&mut self, why: Unlinked) {
        self.found.stays(why);
    }

    /// The tool has departed from `joints`.
    pub(super) fn depart(&mut self, joints: &Joints) {
        self.departed = Some(*joints);
    }

    /// Line of the first element that is held back.
    pub(super) fn first_line(&self) -> Option<u64> {
        self.held.first().map(StreamItem::line)
    }

    /// A command that comes by; where it asks for more than words in between, the tool is retracted as ever.
    pub(super) fn command(&mut self, command: &Command) {
        if let Command::Tool(tool) = command {
            self.tool = Some(tool.clone());
        }
        let passes = moves_nothing(command)
            || matches!(
                command,
                Command::Compensate(_)
                    | Command::Smoothing(_)
                    | Command::Index { .. }
                    | Command::Leave
                    | Command::Retract { forgets: false }
            );
        if !passes && self.departed.take().is_some() && !matches!(command, Command::Tool(_)) {
            self.stays(Unlinked::Stops);
        }
    }

    /// Hands on what is `made` of an element, or holds it back while the next first position is not known.
    pub(super) fn hand_on(
        &mut self,
        line: u64,
        made: Vec<StreamItem<MotionBlock>>,
        out: &mut BlockSink<'_>,
    ) {
        if let Some(way) = self.chosen.take() {
            out.note(line, BlockNote::Across(Box::new(way)));
        } else if self.departed.is_some() && self.held.len() < MOST_HELD {
            self.held.extend(made);
            return;
        }
        self.departed = None;
        self.held.drain(..).chain(made).for_each(|element| out.element(element));
    }

    /// The file ends: the next retract is that of the machine file.
    pub(super) fn hand_on_all(&mut self, line: u64, out: &mut BlockSink<'_>) {
        self.departed = None;
        self.hand_on(line, Vec::new(), out);
    }

    /// The bodies of the tool; false where it is not known how long it is.
    fn equip(&mut self, machine: &Machine, solver: &Solver) -> bool {
        let length = (machine.gauge - solver.chain().tip()).dot(&machine.tool_axis);
        let Some(tool) = self.tool.as_ref().filter(|_| length > 0.0) else {
            return false;
        };
        let known = (tool.number, length);
        if self.equipped.replace(known) != Some(known) {
            let ToolChange { number, diameter, .. } = *tool;
            self.bodies.equip(Some(&ClearTool { number, length: Some(length), diameter }));
        }
        true
    }
}

impl<'a> BlockStage<'a> {
    /// Has ways across go as bodies leave them.
    pub(crate) fn go_across(&mut self, bodies: &'a mut dyn BodyClearance) {
        self.across = Some(Box::new(AcrossChoice::new(self.machine, bodies)));
    }

    /// What came of ways across; none where they are those of the machine file.
    pub(crate) fn ways_across(&self) -> Option<WaysAcross> {
        self.across.as_ref().map(|across| across.found())
    }

    /// The tool has departed from where it stands at `node`.
    pub(super) fn departs_from(&mut self, node: &PathNode) {
        if let Some(across) = &mut self.across {
            across.depart(&node.trace.joints);
        }
    }

    /// Chooses the way to a first position, and how high the tool comes over it.
    pub(super) fn choose_across(&mut self, line: u64, placer: &Placer, node: &PathNode) {
        let Some(mut across) = self.across.take() else {
            return;
        };
        if let Some(from) = &across.departed.take() {
            let equipped = across.equip(self.machine, placer.solver());
            let best = match self.shortened() {
                None => Err(Unlinked::Machine),
                Some(_) if !equipped => Err(Unlinked::Length),
                Some((depth, highest)) => {
                    let crossing = Crossing { line, placer, from, node, depth, highest };
                    self.way_across(&mut across, &crossing)
                }
            };
            match best {
                Ok(best) => {
                    self.lowered = Some(best.entry);
                    across.chosen = Some(best.way);
                }
                Err(why) => across.stays(why),
            }
        }
        self.across = Some(across);
    }

    /// The one axis that retracts the tool, and where it does, of a machine whose ways across are no others.
    fn shortened(&self) -> Option<(usize, f64)> {
        let machine = self.machine;
        let [retract] = *machine.frame.retract.as_slice() else {
            return None;
        };
        let plain = machine.frame.leave.is_none()
            && machine.frame.aside.is_empty()
            && !machine.is_opened()
            && machine.control_point.along == 0.0
            && std::ptr::eq(machine, self.base);
        (plain && axis_words::depth(machine) == Some(retract.0)).then_some(retract)
    }

    /// The quickest way that is proven clear.
    ///
    /// # Errors
    /// Why it is the one over the retract.
    fn way_across(
        &mut self,
        across: &mut AcrossChoice<'_>,
        crossing: &Crossing<'_>,
    ) -> Result<Candidate, Unlinked> {
        let AcrossChoice { bodies, drives, links, found, .. } = across;
        let solver = crossing.placer.solver();
        let limits = &self.machine.limits;
        let mut trials = Trials { bodies: &mut **bodies, solver, drives, limits };
        let ever = self.over(crossing, crossing.highest);
        let seconds = trials.seconds(&ever);
        let low = self.low_way(&mut trials, crossing);
        let mut hits = || trials.contact(&ever, TrialWayKind::Turn);
        let low = low.filter(|low| low.seconds < seconds || hits().is_some());
        let blocked = if low.is_some() { None } else { hits() };
        let than = match (&low, &blocked) {
            (Some(low), _) => low.seconds,
            (None, Some(_)) => f64::INFINITY,
            (None, None) => seconds,
        };
        let past = match *links && self.stands_anywhere() {
            true => self.way_past(&mut trials, crossing),
            false => None,
        };
        let past = past.filter(|past| past.seconds < than);
        if let (None, Some(contact)) = (&past, &blocked) {
            self.findings.at(crossing.line, leads_nowhere(self.machine, contact));
        }
        match past {
            Some(_) => found.past += 1,
            None => found.low += u64::from(low.is_some()),
        }
        let why = if seconds > 0.0 { Unlinked::Slower } else { Unlinked::Feeds };
        let best = past.or(low).ok_or(why)?;
        found.saved_s += seconds - best.seconds;
        Ok(best)
    }

    /// No axis has index positions between which it stands nowhere, or is shown over a turn, of which the control takes either
    /// way.
    fn stands_anywhere(&self) -> bool {
        self.machine.axes.iter().all(|axis| axis.indexed.is_none() && axis.range.is_none())
    }

    /// The places that the axes come by over a height: up, turned there, across, and down to the first position.
    fn over(&mut self, crossing: &Crossing<'_>, height: f64) -> Vec<Joints> {
        let approach = self.approach(crossing, height);
        let mut up = *crossing.from;
        up[crossing.depth] = height;
        let mut turned = up;
        for (place, axis) in self.machine.axes.iter().enumerate() {
            if axis.joint.rotary {
                turned[place] = approach[0][place];
            }
        }
        [*crossing.from, up, turned].into_iter().chain(approach).collect()
    }

    /// The places that the tool comes by to the first position from where it is retracted to `height`, that one the last.
    fn approach(&mut self, crossing: &Crossing<'_>, height: f64) -> Vec<Joints> {
        let Crossing { placer, node, depth, .. } = *crossing;
        self.lowered = Some(height);
        let mut places: Vec<Joints> = match self.comes_from_above(placer, node) {
            true => self.stops_above(placer, node).iter().map(|stop| stop.trace.joints).collect(),
            false => {
                let mut over = node.trace.joints;
                over[depth] = height;
                vec![over]
            }
        };
        self.lowered = None;
        places.push(node.trace.joints);
        places
    }

    /// The lowest height that is found clear: the higher one of both ends, or by halving what is left up to the retract.
    fn low_way(&mut self, trials: &mut Trials<'_>, crossing: &Crossing<'_>) -> Option<Candidate> {
        let Crossing { depth, highest, .. } = *crossing;
        let up = crossing.up();
        let [one, other] = [crossing.from[depth], crossing.node.trace.joints[depth]];
        let lowest = if up > 0.0 { one.max(other) } else { one.min(other) };
        let step = self.step();
        let axis = &self.machine.axes[depth];
        let [least, most] = [lowest, highest].map(|at| axis.reading(at) * up / step);
        // Whole steps as the control shows them, towards the retract.
        let [mut low, mut high] = [libm::ceil(least), libm::floor(most - WORTH / step)];
        let mut best = None;
        let mut height = low;
        for _ in 0..=TRIALS {
            if high < low {
                break;
            }
            let at = highest + (height * step * up - axis.reading(highest));
            let places = self.over(crossing, at);
            if trials.keeps_limits(&places) && trials.own_contact(&places).is_none() {
                let way = WayAcross { retract: (depth, at), through: Vec::new() };
                best = Some(Candidate { way, entry: at, seconds: trials.seconds(&places) });
                high = height - 1.0;
            } else {
                low = height + 1.0;
            }
            height = libm::floor(0.5 * (low + high));
        }
        best
    }

    /// A way past bodies, from a little over where the tool departs to a little over the first position.
    fn way_past(&mut self, trials: &mut Trials<'_>, crossing: &Crossing<'_>) -> Option<Candidate> {
        let Crossing { from, node, depth, highest, .. } = *crossing;
        let left = DRAWN_BACK.iter().find_map(|by| {
            let mut left = *from;
            left[depth] = crossing.drawn_back(from[depth], *by)?;
            let leaves = trials.goes(&left, &left)
                && trials.keeps_limits(&[*from, left])
                && trials.contact(&[*from, left], TrialWayKind::Across).is_none();
            leaves.then_some(left)
        })?;
        let (entry, approach) = DRAWN_BACK.iter().find_map(|by| {
            let height = crossing.drawn_back(node.trace.joints[depth], *by)?;
            let approach = self.approach(crossing, height);
            let comes = trials.goes(&approach[0], &approach[0])
                && trials.keeps_limits(&approach)
                && trials.comes_down(&approach).is_none();
            comes.then_some((height, approach))
        })?;
        let ends = [&left, &approach[0]];
        let room = Room::new(self.machine, ends, (depth, highest));
        let step = self.step();
        let axes = &self.machine.axes;
        let printed = |joints: &Joints| {
            let mut printed = *joints;
            for (value, axis) in printed.iter_mut().zip(axes) {
                *value = shown(axis, *value, if axis.joint.rotary { TURN_STEP } else { step });
            }
            room.held(printed)
        };
        let drives = trials.drives;
        let way = FreeWay {
            room: &room,
            printed: &printed,
            seconds: &|ends| drives.rest_to_rest(ends[0], ends[1], 1.0, |_| true),
        };
        let found = way.find(ends, &mut |from, to| from == to || trials.goes(from, to))?;
        let all = [from].into_iter().chain(&found).chain(&approach[1..]);
        let seconds = trials.seconds(&all.copied().collect::<Vec<_>>());
        let way = WayAcross { retract: (depth, left[depth]), through: found[1..].to_vec() };
        Some(Candidate { way, entry, seconds })
    }

    /// Linear axes stand on whole numbers of this, mm: a millimetre, or a twentieth of an inch.
    fn step(&self) -> f64 {
        let unit = unit_length(self.machine.control.units);
        if unit > 1.0 { unit / 20.0 } else { unit }
    }
}

/// No way across is found clear, that of the machine file among them.
fn leads_nowhere(machine: &Machine, contact: &Contact) -> Diagnostic {
    let [one, other] = &contact.bodies;
    let message = format!(
        "no way to here is found on which {one} stays clear of {other}; over the retract they do not (on the way to {})",
        machine.shown(&contact.joints)
    );
    let help = match machine.clearance.link {
        true => "another fixture, mount or order of the operations, or a way of the CL file's own",
        false => {
            "[clearance] link = true looks for a way past them; else another fixture, mount or order of the operations"
        }
    };
    Diagnostic::warning("clearance", message).help(help)
}

/// The value of an axis nearest to `value` that it shows as a whole number of steps, mm or degrees.
fn shown(axis: &Axis, value: f64, step: f64) -> f64 {
    let reading = axis.reading(value);
    value + (libm::rint(reading / step) * step - reading) * axis.unit()
}
