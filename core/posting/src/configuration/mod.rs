//! Which of several solutions is taken at each point, decided over whole passes.
//!
//! Points wait here until the choice is made, and the commands between them wait with them, in their places.
//! A command that takes the tool off the part has everything before it decided. The points of a curve or a hole are
//! decided among all others, and put together again after that.

mod backtrace;
mod clear;
mod columns;
mod cost;
mod cycle_time;
mod ease;
mod full_turns;
mod lattice;
mod lengths;
mod metric;
mod pending_element;
mod recovery;
mod route;
mod settle;
mod solution;
mod surplus;
mod taut;
mod tool_length;
mod trellis;
mod whole_pass;

use std::collections::VecDeque;
use std::f64::consts::TAU;
use std::rc::Rc;

use nalgebra::Vector3;
use post_machine::description::{Machine, Positions, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;
use post_machine::kinematics::travel::{AT_END, passed};
use post_plugin::{Capabilities, Format, Spindle};

use crate::accuracy::Placer;
use crate::curve::CurveMoves;
use crate::expand::{FixedAxis, PathMove};
use crate::findings::Findings;
use crate::program::{Command, StraightMove, ToolChange};
use crate::stream::{BatchSink, HoleMoves, StreamItem, StreamPoint};
pub use clear::{BodyClearance, ClearTool, Contact, TrialWay, TrialWayKind};
pub(crate) use cycle_time::DriveLimits;
use lengths::LengthAxisCheck;
use pending_element::PendingElement;
pub(crate) use route::ChosenPoint;
use route::{DroppedPoint, Route};
pub use tool_length::{LengthSource, ReportedTool};
pub(crate) use trellis::pose;
pub use whole_pass::whole_pass;

/// What this stage says to the next of the elements from there on.
#[derive(Clone, Debug)]
pub(crate) enum ChoiceNote {
    /// What solves the points.
    Placer(Rc<Placer>),
    /// The tool axis stays, or does not any more.
    FixedAxis(FixedAxis),
    /// The path ended in a fault; the next point begins one anew.
    Broken,
}

impl StreamPoint for ChosenPoint {
    type Curve = CurveMoves<Self>;
    type Note = ChoiceNote;

    fn line(&self) -> u64 {
        self.line
    }

    fn moves(curve: &Self::Curve) -> usize {
        curve.moves.len()
    }
}

/// What is not decided yet.
#[derive(Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "runs of points and what stands between them alternate, and a box would be allocated for each"
)]
enum WaitingItem {
    /// A number of points.
    Points(u64),
    /// What stands between them: a command, a note, or a curve or a hole whose points come from here on.
    Between(StreamItem<ChosenPoint>),
    /// The points of the hole are those into it from here on.
    Enters,
    /// The curve or the hole is whole.
    Ends,
}

/// More than this does not wait between points for one to be decided.
const MOST_WAITING: usize = 4096;

/// What leaves this stage.
type ConfiguredSink<'o> = BatchSink<'o, StreamItem<ChosenPoint>>;

/// The stage that chooses axis values.
#[derive(Debug)]
pub(crate) struct ConfigurationStage<'a> {
    machine: &'a Machine,
    /// The machine with the head that it starts with.
    base: &'a Machine,
    route: Route<'a>,
    /// The placer that the next stage knows of.
    setting: Option<usize>,
    waiting: VecDeque<WaitingItem>,
    /// What stands between points among them.
    between: usize,
    /// The curve or hole whose points are handed on now.
    pending: Option<PendingElement>,
    chosen: Vec<ChosenPoint>,
    /// Along which axis the control puts lengths.
    lengths: LengthAxisCheck,
    /// What the user says of every tool.
    told_length: Option<f64>,
    /// Length of the tool in use, if anybody gave it.
    length: Option<f64>,
    /// Where the length comes from.
    source: LengthSource,
    /// The tools that were used, each with the length that was assumed.
    tools: Vec<ReportedTool>,
    /// The tool, with the head and the length that it has now, is among them.
    in_use: bool,
    /// The last speed of the spindle, rpm.
    speed: Option<f64>,
    /// The tool in use.
    tool: Option<ToolChange>,
    /// Points taken.
    moves: u64,
    findings: Findings,
}

/// The control is told the tool axis as a vector, and finds rotary values of its own for it.
pub(crate) fn tells_vectors(machine: &Machine, writes: Capabilities) -> bool {
    machine.control.tcp == Tcp::Control && writes.has(Capabilities::TOOL_VECTOR)
}

impl<'a> ConfigurationStage<'a> {
    /// Begins where the machine file says.
    ///
    /// # Errors
    /// What the machine lacks for being solved.
    pub(crate) fn new(
        machine: &'a Machine,
        format: &Format,
        told_length: Option<f64>,
        writes: Capabilities,
        findings: &Findings,
    ) -> Result<Self, Box<Diagnostic>> {
        let route = Route::new(machine, format, told_length.unwrap_or(0.0))?;
        Ok(Self {
            lengths: LengthAxisCheck::new(writes),
            machine,
            base: machine,
            route: match tells_vectors(machine, writes) {
                true => route.by_vector(),
                false => route,
            },
            setting: None,
            waiting: VecDeque::new(),
            between: 0,
            pending: None,
            chosen: Vec::new(),
            told_length,
            length: told_length,
            source: match told_length {
                Some(_) => LengthSource::Option,
                None => LengthSource::Unknown,
            },
            tools: Vec::new(),
            in_use: false,
            speed: None,
            tool: None,
            moves: 0,
            findings: findings.clone(),
        })
    }

    /// Has ways of the machine chosen on which its bodies stay clear of one another, as far as `bodies` says.
    pub(crate) fn keep_clear(&mut self, bodies: &'a mut dyn BodyClearance) {
        self.route.keep_clear_of(bodies);
        self.take_tool();
    }

    /// Points taken so far.
    pub(crate) fn moves(&self) -> u64 {
        self.moves
    }

    /// The tools that were used, in the order in which they came.
    pub(crate) fn tools(&self) -> &[ReportedTool] {
        &self.tools
    }

    /// Line of the first element that is not decided.
    pub(crate) fn first_line(&self) -> Option<u64> {
        let pending = self.pending.as_ref().map(|pending| pending.element.line());
        let between = self.waiting.iter().find_map(|waiting| match waiting {
            WaitingItem::Between(next) => Some(next.line()),
            _ => None,
        });
        [pending, between, self.route.first_line()].into_iter().flatten().min()
    }

    /// Takes a batch, which is empty then.
    pub(crate) fn take(
        &mut self,
        batch: &mut Vec<StreamItem<PathMove>>,
        out: &mut ConfiguredSink<'_>,
    ) {
        for next in batch.drain(..) {
            match next {
                StreamItem::Point(at) => self.point(&at, out),
                StreamItem::Curve { line, curve } => self.curve(line, *curve, out),
                StreamItem::Hole(hole) => self.hole(*hole, out),
                StreamItem::Command { line, command } => {
                    let command = StreamItem::Command { line, command };
                    self.arrange(WaitingItem::Between(command), out);
                }
                StreamItem::Note { line, note } => {
                    let note = StreamItem::Note { line, note: ChoiceNote::FixedAxis(note) };
                    self.arrange(WaitingItem::Between(note), out);
                }
            }
        }
    }

    /// The points of a curve are decided among all others.
    #[inline(never)]
    fn curve(&mut self, line: u64, curve: CurveMoves<PathMove>, out: &mut ConfiguredSink<'_>) {
        let CurveMoves { curve, mut moves } = curve;
        let begins = Box::new(CurveMoves { curve, moves: Vec::with_capacity(moves.len()) });
        let begins = StreamItem::Curve { line, curve: begins };
        self.arrange(WaitingItem::Between(begins), out);
        self.take(&mut moves, out);
        self.arrange(WaitingItem::Ends, out);
    }

    /// Those of a hole likewise.
    #[inline(never)]
    fn hole(&mut self, mut hole: HoleMoves<PathMove>, out: &mut ConfiguredSink<'_>) {
        let begins = hole.remade(|part| Vec::with_capacity(part.len()));
        self.arrange(WaitingItem::Between(StreamItem::Hole(Box::new(begins))), out);
        self.take(&mut hole.above, out);
        self.arrange(WaitingItem::Enters, out);
        self.take(&mut hole.into, out);
        self.arrange(WaitingItem::Ends, out);
    }

    /// The file ends: everything is decided.
    pub(crate) fn finish(&mut self, out: &mut ConfiguredSink<'_>) {
        self.route.departs = true;
        self.settle(out);
    }

    #[inline]
    fn point(&mut self, at: &PathMove, out: &mut ConfiguredSink<'_>) {
        self.moves += 1;
        let line = at.line;
        if !self.in_use {
            self.take_into_use(line);
        }
        let motion = self.guided(at.motion);
        if self.waiting.is_empty()
            && let Some(chosen) = self.route.step(line, &motion)
        {
            self.hand_on(chosen, out);
            return;
        }
        match self.route.add(line, &motion) {
            Ok(()) => match self.waiting.back_mut() {
                Some(WaitingItem::Points(count)) => *count += 1,
                _ => self.waiting.push_back(WaitingItem::Points(1)),
            },
            Err(DroppedPoint::Point(fault)) => self.findings.at(line, *fault),
            Err(DroppedPoint::Path(fault)) => {
                self.findings.at(line, *fault);
                self.drain(out);
                let note = ChoiceNote::Broken;
                self.put(StreamItem::Note { line, note }, out);
            }
        }
        if self.route.has_chosen() {
            self.drain(out);
        }
    }

    /// Moves a point of the path to the control point of the tool.
    #[inline]
    fn guided(&self, motion: StraightMove) -> StraightMove {
        StraightMove { tip: self.control_point(motion.tip, motion.axis), ..motion }
    }

    #[inline]
    fn control_point(&self, tip: Vector3<f64>, axis: Vector3<f64>) -> Vector3<f64> {
        tip + axis * self.machine.control_point.along
    }

    /// What stands between points is carried out between them.
    fn arrange(&mut self, next: WaitingItem, out: &mut ConfiguredSink<'_>) {
        let leaves = match &next {
            WaitingItem::Between(StreamItem::Command { command, .. }) => command.leaves(),
            WaitingItem::Between(StreamItem::Note { .. }) => true,
            _ => false,
        };
        if leaves || self.between >= MOST_WAITING {
            self.route.departs = leaves;
            self.settle(out);
        }
        if self.waiting.is_empty() {
            self.carry_out(next, out);
        } else {
            self.between += 1;
            self.waiting.push_back(next);
        }
    }

    /// The turn of what stands between points has come.
    fn carry_out(&mut self, next: WaitingItem, out: &mut ConfiguredSink<'_>) {
        match next {
            WaitingItem::Between(StreamItem::Command { line, command }) => {
                self.command(line, command, out);
            }
            WaitingItem::Between(note @ StreamItem::Note { .. }) => {
                // The tool is retracted before and after: nothing is turned early on its behalf.
                self.route.leave();
                self.put(note, out);
            }
            WaitingItem::Between(element) => self.pending = Some(PendingElement::new(element)),
            WaitingItem::Enters => self.pending.iter_mut().for_each(PendingElement::enter),
            WaitingItem::Ends => {
                self.pending.take().into_iter().for_each(|it| out.element(it.element))
            }
            WaitingItem::Points(_) => {}
        }
    }

    /// Hands on, or puts into the curve or hole that it is part of.
    #[inline]
    fn put(&mut self, next: StreamItem<ChosenPoint>, out: &mut ConfiguredSink<'_>) {
        match &mut self.pending {
            None => out.push(next),
            Some(pending) => pending.push(next),
        }
    }

    /// Has everything decided, and hands it on.
    fn settle(&mut self, out: &mut ConfiguredSink<'_>) {
        self.route.settle_all();
        self.route.departs = false;
        self.drain(out);
    }

    /// Hands on what was decided, and the commands that stand between.
    fn drain(&mut self, out: &mut ConfiguredSink<'_>) {
        let mut chosen = std::mem::take(&mut self.chosen);
        self.route.take_chosen(&mut chosen);
        for (line, finding) in self.route.told.drain(..) {
            self.findings.at(line, finding);
        }
        for next in chosen.drain(..) {
            let arrives = next.arrives;
            self.hand_on(next, out);
            if arrives {
                self.arrived(out);
            }
        }
        self.chosen = chosen;
    }

    /// A point that is decided, after what solves it.
    #[inline]
    fn hand_on(&mut self, next: ChosenPoint, out: &mut ConfiguredSink<'_>) {
        if self.setting != Some(next.setting) {
            self.setting = Some(next.setting);
            let note = ChoiceNote::Placer(Rc::clone(self.route.placer(next.setting)));
            self.put(StreamItem::Note { line: next.line, note }, out);
        }
        self.put(StreamItem::Point(next), out);
    }

    /// One more point is decided: the commands after it follow.
    #[inline]
    fn arrived(&mut self, out: &mut ConfiguredSink<'_>) {
        match self.waiting.front_mut() {
            Some(WaitingItem::Points(count)) if *count > 1 => {
                *count -= 1;
                return;
            }
            Some(WaitingItem::Points(_)) => {
                self.waiting.pop_front();
            }
            _ => {}
        }
        let between = |next: &mut WaitingItem| !matches!(next, WaitingItem::Points(_));
        while let Some(next) = self.waiting.pop_front_if(between) {
            self.between -= 1;
            self.carry_out(next, out);
        }
    }

    /// Carries out what a command means for the choice, and hands it on.
    fn command(&mut self, line: u64, mut command: Command, out: &mut ConfiguredSink<'_>) {
        match &mut command {
            Command::From { tip, axis } => self.stand(*tip, *axis),
            Command::Tool(tool) => {
                self.park(&self.machine.frame.change);
                self.measure(tool);
                self.tool = Some(tool.clone());
                tool.length = self.length;
                self.take_tool();
                self.equip(line);
            }
            Command::Index { axis, angle } => self.index(line, *axis, *angle),
            Command::Head(name) => {
                let Some(machine) = self.base.changed_to(name) else {
                    self.findings.at(line, no_head(self.base, name));
                    return;
                };
                self.route.leave();
                self.machine = machine;
                if self.base.has_modes() {
                    self.change_mode(line);
                    self.put(StreamItem::Command { line, command }, out);
                    return;
                }
                self.lengths.swap_head(name);
                // Its bodies are not known.
                self.route.judge.bodies = None;
                // A head may have lengths of its own, and a spindle of its own.
                if let Some(tool) = self.tool.take() {
                    self.measure(&tool);
                    self.tool = Some(tool);
                }
                self.in_use = false;
                self.equip(line);
                self.check_speed(line);
            }
            Command::Home => self.park(&self.machine.frame.park),
            Command::WorkOffset(number) => {
                self.lengths.work_offset(*number);
                self.park(&[]);
            }
            Command::Retract { forgets: true } => {
                let start = self.start_anew();
                self.park(&start);
            }
            Command::Subprogram(_)
            | Command::Smoothing(_)
            | Command::Retract { .. }
            | Command::Leave => self.park(&[]),
            Command::SurfaceSpeed { most, .. } => {
                self.speed = None;
                match self.machine.spindle.limit(*most) {
                    Ok(limit) => *most = Some(limit),
                    Err(finding) => self.findings.at(line, *finding),
                }
            }
            Command::Spindle(Spindle::On { rpm, .. }) => {
                self.speed = Some(*rpm);
                self.check_speed(line);
                self.check_tool_speed(line);
            }
            Command::Spindle(_) => self.speed = None,
            _ => {}
        }
        self.put(StreamItem::Command { line, command }, out);
    }

    /// The axes are those of a mode of the control from here on, or those of the machine again: it begins and ends with
    /// the turning axis next to zero.
    fn change_mode(&mut self, line: u64) {
        let mut stands = *self.route.stands_at();
        for (value, axis) in stands.iter_mut().zip(&self.base.axes) {
            if axis.joint.rotary {
                *value = 0.0;
            }
        }
        self.route.judge.bodies = None;
        self.equip(line);
        self.route.begin_at(stands);
    }

    /// Where a further file has the rotary axes as it begins: as a file of its own, at the full turn next to where they
    /// stand. An upright tool leaves them there.
    fn start_anew(&self) -> Vec<(usize, f64)> {
        let stands = self.route.stands_at();
        let axes = self.machine.axes.iter().enumerate();
        let free = axes.filter(|(_, axis)| axis.joint.rotary && axis.indexed.is_none());
        let start = free.map(|(joint, axis)| {
            let start = self.machine.solution.start[joint];
            let near = start + TAU * libm::round((stands[joint] - start) / TAU);
            let inside = axis.travel.is_none_or(|[least, most]| (least..=most).contains(&near));
            (joint, if inside { near } else { start })
        });
        start.collect()
    }

    /// The tool is retracted and axes are sent to positions of the machine: what comes after begins there.
    fn park(&mut self, positions: &[(usize, f64)]) {
        let mut near = *self.route.stands_at();
        let frame = &self.machine.frame;
        let left = frame.retract.iter().chain(&frame.aside);
        let left = left.filter(|_| frame.leave.is_some());
        for (joint, value) in left.chain(positions) {
            near[*joint] = *value;
        }
        self.route.begin_at(near);
    }

    /// A speed that the spindle of the head in use cannot turn at.
    fn check_speed(&self, line: u64) {
        let refused = self.speed.and_then(|rpm| self.machine.spindle.refuse(rpm));
        if let Some(finding) = refused {
            self.findings.at(line, finding);
        }
    }

    /// The tool stands there: solutions near to it are wanted, but nothing moves.
    fn stand(&mut self, tip: Vector3<f64>, axis: Vector3<f64>) {
        let pose =
            Pose { tip: self.control_point(tip, axis), axis, edge: self.route.edge_at_rest() };
        let placed = self.route.present().place(pose, 1.0, self.route.stands_at());
        if let Ok(node) = placed {
            self.route.begin_at(node.trace.joints);
        }
    }

    /// The tool in use is another body.
    fn take_tool(&mut self) {
        let Some(bodies) = &mut self.route.judge.bodies else {
            return;
        };
        let tool = self.tool.as_ref().map(|tool| ClearTool {
            number: tool.number,
            length: self.length,
            diameter: tool.diameter,
        });
        bodies.equip(tool.as_ref());
    }

    /// Takes machine and tool length into the route.
    fn equip(&mut self, line: u64) {
        self.setting = None;
        if let Err(fault) = self.route.equip(self.machine, self.length.unwrap_or(0.0)) {
            self.findings.at(line, *fault);
        }
    }

    /// An index move of the program: it sets the redundant axis of that name, if there is one. (The others
    /// follow from the tool axis.)
    fn index(&mut self, line: u64, axis: char, angle: f64) {
        let named = |name: &str| name.len() == 1 && name.starts_with(axis);
        let Some(joint) = self.machine.axes.iter().position(|axis| named(&axis.name)) else {
            return;
        };
        let axis = &self.machine.axes[joint];
        let value = angle - axis.zero;
        let positions = axis.indexed.as_ref().map(|indexed| &indexed.positions);
        let possible = positions
            .is_none_or(|positions| positions.holds(value, axis.travel.is_none()))
            && passed(axis.travel, value, AT_END).is_none();
        // Indices of settings may have changed.
        self.setting = None;
        match self.route.index(joint, value, possible) {
            Ok(true) if !possible => {
                let fault = Diagnostic::error(
                    "index",
                    format!(
                        "{} cannot stand at {:.3}°, where ROTABL wants it",
                        axis.name,
                        axis.reading(value)
                    ),
                );
                let help = match positions {
                    Some(positions) if *positions != Positions::Any => format!(
                        "the nearest of its positions is {:.3}°",
                        axis.reading(positions.nearest(value, axis.travel.is_none()))
                    ),
                    _ => "it is outside the travel of the axis".to_owned(),
                };
                self.findings.at(line, fault.help(help));
            }
            Ok(_) => {}
            Err(fault) => self.findings.at(line, *fault),
        }
    }
}

/// `HEAD` names a head that the machine does not have.
fn no_head(machine: &Machine, name: &str) -> Diagnostic {
    let heads = machine.named_heads();
    let known: Vec<&str> = heads.map(|head| head.name.as_str()).collect();
    Diagnostic::error("head", format!("{} has no head {name}", machine.name)).help(
        if known.is_empty() {
            "its file describes no [head.NAME]".to_owned()
        } else {
            format!("its heads are: {}", known.join(", "))
        },
    )
}
