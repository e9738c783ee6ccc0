//! The path: takes steps, chooses axis values, puts points in, paces blocks and hands events to the dialect.

use post_plugin::{Batch, Compensation, DialectSession, Event, Format, ModelSession, Spindle};

use crate::accuracy::{Bound, Linearise, Move, Node, Placer, Stuck, Tolerances, Which};
use crate::diagnostic::{Diagnostic, Place};
use crate::feed::Feeds;
use crate::kinematics::{Joints, MAX_AXES, NoClosedForm, Pose};
use crate::machine::{Machine, Tcp, ToolLength};
use crate::program::{Motion, Pace, Step, Tool};
use crate::refusal;
use crate::report::Deviation;
use crate::words::Words;

/// Where the text of the program goes.
pub trait Output {
    /// Takes text.
    ///
    /// # Errors
    /// Why it cannot.
    fn write(&mut self, text: &[u8]) -> Result<(), String>;
}

/// Deviations that differ by less are the same: mm or radians.
const EQUAL: f64 = 1e-9;

/// Events are handed over in runs of this length: from some dozens on, the plugin boundary costs nothing.
const BATCH: usize = 128;

/// Everything between the steps of a program and its text.
pub struct Path<'a> {
    machine: &'a Machine,
    dialect: &'a mut dyn DialectSession,
    model: &'a mut dyn ModelSession,
    output: &'a mut dyn Output,
    format: Format,
    placer: Placer,
    feeds: Feeds,
    linearise: Linearise,
    tool_length: Option<f64>,
    /// The tool's length matters and nobody gave it.
    length_unknown: bool,
    /// Where the tool stands; none before the first position.
    last: Option<Box<Node>>,
    /// The node before that, to be filled again.
    spare: Option<Box<Node>>,
    /// Axis values that the next solution should be near to.
    near: Joints,
    /// Length compensation or TCP is in force.
    positioned: bool,
    compensating: bool,
    /// The spindle was switched on since the last tool change.
    turning: bool,
    /// What the CL file last said of it.
    commanded: Option<Spindle>,
    /// That it was not is told once a program.
    told_spindle: bool,
    /// That compensation cannot be, likewise.
    told_compensation: bool,
    batch: Batch,
    text: Vec<u8>,
    ends: Vec<usize>,
    tally: Tally,
    /// Where the largest deviations stand in the present batch: event index.
    marks: [Option<usize>; 3],
    findings: Vec<Diagnostic>,
    /// Something is wrong: no more text is made, but checking goes on.
    failed: bool,
}

/// Sums and extremes for the report.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Moves taken.
    pub moves: u64,
    /// Blocks with a motion.
    pub blocks: u64,
    /// Points put in.
    pub points_added: u64,
    /// Cuts: tip (mm), tool axis (radians); rapids: tip (mm).
    pub deviations: [Deviation; 3],
    /// Least axis values.
    pub least: Joints,
    /// Largest axis values.
    pub most: Joints,
    /// Minutes of cuts.
    pub cutting: f64,
    /// Minutes of rapids and dwells.
    pub other: f64,
    /// Blocks slowed down by an axis.
    pub limited: u64,
    /// Lines of text.
    pub lines: u64,
}

const TIP: usize = 0;
const AXIS: usize = 1;
const RAPID: usize = 2;

impl<'a> Path<'a> {
    /// A path that begins.
    ///
    /// # Errors
    /// What machine and dialect cannot do together.
    pub fn new(
        machine: &'a Machine,
        dialect: &'a mut dyn DialectSession,
        model: &'a mut dyn ModelSession,
        output: &'a mut dyn Output,
        tool_length: Option<f64>,
        trust_model: bool,
    ) -> Result<Self, Box<Diagnostic>> {
        let format = dialect.format().clone();
        let feeds = Feeds::new(machine, &format).ok_or_else(|| {
            Diagnostic::error(
                "feed-mode",
                format!(
                    "[control] asks for inverse time feeds, and the dialect {} has none",
                    machine.control.dialect
                ),
            )
            .help("feed = \"per-minute\"")
            .boxed()
        })?;
        let placer = placer(machine, &format, tool_length.unwrap_or(0.0))?;
        Ok(Self {
            machine,
            dialect,
            model,
            output,
            format,
            placer,
            feeds,
            linearise: Linearise::new(trust_model),
            tool_length,
            length_unknown: tool_length.is_none(),
            last: None,
            spare: None,
            near: [0.0; MAX_AXES],
            positioned: false,
            compensating: false,
            turning: false,
            commanded: None,
            told_spindle: false,
            told_compensation: false,
            batch: Batch::default(),
            text: Vec::new(),
            ends: Vec::new(),
            tally: Tally {
                least: [f64::INFINITY; MAX_AXES],
                most: [f64::NEG_INFINITY; MAX_AXES],
                ..Tally::default()
            },
            marks: [None; 3],
            findings: Vec::new(),
            failed: false,
        })
    }

    /// Findings since the last call; their places are yet to be filled in.
    pub fn take_findings(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.findings)
    }

    /// There are findings.
    #[inline]
    pub fn has_findings(&self) -> bool {
        !self.findings.is_empty()
    }

    /// No text is to be made any more; checking goes on.
    pub fn fail(&mut self) {
        self.failed = true;
    }

    /// Sums and extremes so far.
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Points that the certificate asked for over the model's head.
    pub fn overruled(&self) -> u64 {
        self.linearise.overruled()
    }

    /// The tool length mattered, and was taken as 0 because nobody gave it.
    pub fn length_unknown(&self) -> bool {
        self.length_unknown && self.length_matters()
    }

    /// The first event.
    pub fn start(&mut self) {
        self.push(0, Event::Start);
    }

    /// The last events.
    pub fn end(&mut self, line: u64) {
        self.release(line);
        self.push(line, Event::End);
        self.flush();
    }

    /// Takes a step that comes from `line`.
    #[inline]
    pub fn step(&mut self, line: u64, step: Step) {
        match step {
            Step::Move(motion) => self.motion(line, &motion),
            other => self.command(line, other),
        }
    }

    fn command(&mut self, line: u64, step: Step) {
        match step {
            Step::Move(motion) => self.motion(line, &motion),
            Step::From { tip, axis } => {
                // The tool stands there: solutions near to it are wanted, but nothing moves.
                if let Ok(node) = self.placer.place(
                    Pose {
                        tip,
                        axis,
                        ..Pose::default()
                    },
                    1.0,
                    &self.near,
                ) {
                    self.near = node.trace.joints;
                }
            }
            Step::Tool(tool) => self.change(line, &tool),
            Step::Preselect(number) => self.push(line, Event::Preselect { number }),
            Step::Spindle(spindle) => {
                self.turning = matches!(spindle, Spindle::On { .. });
                self.commanded = self.turning.then_some(spindle);
                self.push(line, Event::Spindle(spindle));
            }
            Step::Coolant(coolant) => self.push(line, Event::Coolant(coolant)),
            Step::Compensate(compensation) => {
                self.compensating = compensation != Compensation::Off;
                self.push(line, Event::Compensate(compensation));
            }
            Step::Comment(text) => self.push(line, Event::Comment { text: &text }),
            Step::Literal(text) => self.push(line, Event::Literal { text: &text }),
            Step::Dwell(seconds) => {
                self.tally.other += seconds / 60.0;
                self.push(line, Event::Dwell { seconds });
            }
            Step::Stop => self.push(line, Event::Stop),
            Step::OptionalStop => self.push(line, Event::OptionalStop),
            Step::Home => {
                self.release(line);
                self.push(line, Event::Home);
            }
        }
    }

    /// Cancels compensation, if any is in force; the next move is a first position again.
    fn release(&mut self, line: u64) {
        if self.positioned {
            self.push(line, Event::Release);
            self.positioned = false;
        }
        if let Some(last) = self.last.take() {
            self.near = last.trace.joints;
        }
    }

    fn change(&mut self, line: u64, tool: &Tool) {
        self.release(line);
        self.turning = false;
        let told = self.tool_length;
        let table = || {
            let tools = &self.machine.tools;
            tools
                .iter()
                .find(|(number, _)| *number == tool.number)
                .map(|(_, length)| *length)
        };
        let length = told.or_else(table).or(tool.length);
        self.length_unknown |= length.is_none();
        if length.is_some() && self.tally.moves == 0 {
            self.length_unknown = false;
        }
        match placer(self.machine, &self.format, length.unwrap_or(0.0)) {
            Ok(placer) => self.placer = placer,
            Err(diagnostic) => self.findings.push(*diagnostic),
        }
        self.push(
            line,
            Event::ToolChange {
                number: tool.number,
                register: tool.register,
                name: &tool.name,
            },
        );
    }

    /// Does the program depend on the tool length? On a machine whose head turns, if the control does not
    /// keep the tip.
    fn length_matters(&self) -> bool {
        let machine = self.machine;
        if machine.control.tcp == Tcp::Control || machine.control.tool_length == ToolLength::Cl {
            return false;
        }
        let first_linear = machine.axes.iter().position(|axis| !axis.joint.rotary);
        machine
            .axes
            .iter()
            .skip(first_linear.unwrap_or(0))
            .any(|axis| axis.joint.rotary)
    }

    #[inline]
    fn motion(&mut self, line: u64, motion: &Motion) {
        self.tally.moves += 1;
        let target = Pose {
            tip: motion.tip,
            axis: motion.axis,
            ..Pose::default()
        };
        let mut node = self.spare.take().unwrap_or_default();
        let near = self
            .last
            .as_ref()
            .map_or(&self.near, |last| &last.trace.joints);
        if let Err(refused) = self
            .placer
            .fill(&mut node, target, 1.0, near, Which::Nearest)
        {
            self.spare = Some(node);
            self.findings.push(refusal::refused(self.machine, &refused));
            return;
        }
        if self.compensating {
            self.check_compensation(&node);
        }
        if !self.turning && motion.pace != Pace::Rapid && !self.told_spindle {
            self.told_spindle = true;
            self.findings.push(
                Diagnostic::warning(
                    "spindle",
                    "the tool cuts, and the spindle was not switched on",
                )
                .help("the CAM system should write SPINDL before this line"),
            );
        }
        match self.last.take() {
            None => self.first(line, motion, &node),
            Some(last) => {
                self.cut(line, motion, &last, &mut node);
                self.spare = Some(last);
            }
        }
        self.last = Some(node);
    }

    /// The first position after the start or a tool change.
    fn first(&mut self, line: u64, motion: &Motion, node: &Node) {
        let none = self.near;
        let feed = match motion.pace {
            Pace::Rapid => None,
            // A time for a way that nobody knows has no meaning; the way is made at rapid.
            Pace::InverseTime(_) => None,
            Pace::PerMinute(_) => Some(self.feeds.cut(motion.pace, 1.0, 1.0, &none, &none).feed),
        };
        let count = self.format.words.len();
        self.keep_range(node);
        self.tally.blocks += 1;
        if let (false, Some(spindle)) = (self.turning, self.commanded) {
            // The tool change stopped it, and the CL file takes it to be turning.
            self.turning = true;
            self.push(line, Event::Spindle(spindle));
            self.findings.push(
                Diagnostic::warning(
                    "spindle",
                    "no SPINDL since the tool change; the spindle was switched on again as before it",
                )
                .help("check that the speed fits the new tool"),
            );
        }
        self.push(
            line,
            Event::Position {
                words: &node.words[..count],
                feed,
            },
        );
        self.positioned = true;
    }

    /// A move from where the tool stands to `node`, or to another solution for the same point.
    #[inline]
    fn cut(&mut self, line: u64, motion: &Motion, last: &Node, node: &mut Node) {
        let whole = planned(self.machine, &self.placer, motion, last, node).whole();
        match whole {
            Some(bound) => self.piece(line, motion, last, node, 1.0, bound),
            None => self.split(line, motion, last, node),
        }
    }

    /// A move that needs points. Beside a pole the axes can follow the path on one of the two solutions only,
    /// and it need not be the one whose end is nearer: then the other is tried.
    fn split(&mut self, line: u64, motion: &Motion, last: &Node, node: &mut Node) {
        let mut linearise = std::mem::take(&mut self.linearise);
        let (machine, placer) = (self.machine, &self.placer);
        let mut done = linearise.split(&planned(machine, placer, motion, last, node), self.model);
        if let Err(Stuck::Jump { .. }) = done
            && let Ok(other) = placer.place_other(node.target, 1.0, &last.trace.joints)
            && linearise
                .split(&planned(machine, placer, motion, last, &other), self.model)
                .is_ok()
        {
            *node = other;
            done = Ok(());
        }
        match done {
            Ok(()) => {
                let mut from = *last;
                from.t = 0.0;
                for (index, piece) in linearise.pieces().iter().enumerate() {
                    self.tally.points_added += u64::from(index > 0);
                    let share = piece.to.t - from.t;
                    self.piece(line, motion, &from, &piece.to, share, piece.bound);
                    from = piece.to;
                }
            }
            Err(stuck) => {
                self.findings
                    .push(refusal::stuck(self.machine, &stuck, motion));
            }
        }
        self.linearise = linearise;
    }

    /// One block, a `share` of its move.
    #[inline]
    fn piece(
        &mut self,
        line: u64,
        motion: &Motion,
        from: &Node,
        to: &Node,
        share: f64,
        bound: Bound,
    ) {
        self.keep_range(to);
        let rapid = motion.pace == Pace::Rapid;
        let (first, last) = (&from.trace.joints, &to.trace.joints);
        let words = &to.words[..self.format.words.len()];
        let event = if rapid {
            self.tally.other += self.feeds.least_time(first, last);
            Event::Rapid { words }
        } else {
            // Between the printed tips: that is the way that the control will time.
            let length = (to.tip - from.tip).norm();
            let paced = self.feeds.cut(motion.pace, length, share, first, last);
            self.tally.limited += u64::from(paced.limited);
            self.tally.cutting += paced.minutes;
            Event::Linear {
                words,
                feed: paced.feed,
            }
        };
        // A block without a changed word moves nothing and is not written.
        if from.words == to.words {
            return;
        }
        self.tally.blocks += 1;
        self.mark(line, motion, from, to, bound);
        self.push(line, event);
    }

    /// Keeps the largest deviations: the cheap bound decides whether a block can hold one, the tight one is kept.
    #[inline]
    fn mark(&mut self, line: u64, motion: &Motion, from: &Node, to: &Node, bound: Bound) {
        let values = |bound: Bound| {
            [
                bound.tip + motion.chord,
                bound.axis,
                bound.tip + motion.chord,
            ]
        };
        let slots: &[usize] = if motion.pace == Pace::Rapid {
            &[RAPID]
        } else {
            &[TIP, AXIS]
        };
        let cheap = values(bound);
        if slots
            .iter()
            .all(|slot| cheap[*slot] <= self.tally.deviations[*slot].value)
        {
            return;
        }
        let tight = planned(self.machine, &self.placer, motion, from, to).measured();
        let tight = values(Bound {
            tip: bound.tip.min(tight.tip),
            axis: bound.axis.min(tight.axis),
        });
        for &slot in slots {
            let deviation = &mut self.tally.deviations[slot];
            // Of blocks that are equal but for rounding errors, the first is named.
            if tight[slot] > deviation.value + EQUAL {
                *deviation = Deviation {
                    value: tight[slot],
                    block: 0,
                    line,
                };
                self.marks[slot] = Some(self.batch.len());
            } else {
                deviation.value = deviation.value.max(tight[slot]);
            }
        }
    }

    /// Radius compensation works in the plane of X and Y of the machine (of the part, where the control keeps
    /// the tip): a tool that does not stand upright in it would be moved sideways into the part.
    fn check_compensation(&mut self, node: &Node) {
        let machine = self.machine;
        let chain = self.placer.solver().chain();
        let axis = match machine.control.tcp {
            Tcp::Control => node.trace.pose.axis,
            Tcp::Post => {
                let mut joints = node.trace.joints;
                for (value, axis) in joints.iter_mut().zip(&machine.axes) {
                    if axis.carries_part {
                        *value = 0.0;
                    }
                }
                chain.forward(&joints).axis
            }
        };
        let tilt = crate::kinematics::orientation::angle(axis, machine.tool_axis);
        let turned = self.last.as_ref().is_some_and(|last| {
            let joints = machine.axes.iter().enumerate();
            joints
                .filter(|(_, axis)| axis.joint.rotary)
                .any(|(joint, _)| last.trace.joints[joint] != node.trace.joints[joint])
        });
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
        self.findings.push(
            Diagnostic::error(
                "compensation",
                format!("cutter radius compensation (CUTCOM) with {what}: the control would offset in the wrong plane"),
            )
            .help("let the CAM system write the tool centre path, with CUTCOM/OFF"),
        );
    }

    #[inline]
    fn keep_range(&mut self, node: &Node) {
        let Tally { least, most, .. } = &mut self.tally;
        let axes = self.machine.axes.len();
        for (index, value) in node.trace.joints.iter().take(axes).enumerate() {
            least[index] = least[index].min(*value);
            most[index] = most[index].max(*value);
        }
    }

    fn push(&mut self, line: u64, event: Event<'_>) {
        if self.failed {
            return;
        }
        self.batch.push(line, event);
        if self.batch.len() >= BATCH {
            self.flush();
        }
    }

    /// Hands the batch to the dialect and its text to the output.
    fn flush(&mut self) {
        let Self {
            batch,
            text,
            ends,
            tally,
            ..
        } = self;
        text.clear();
        ends.clear();
        if let Err(fault) = self.dialect.write_batch(batch, text, ends) {
            let line = batch.line(fault.index.min(batch.len().saturating_sub(1)));
            self.findings
                .push(Diagnostic::error("dialect", fault.message).at(Some(Place {
                    file: String::new(),
                    line,
                    text: String::new(),
                    span: 0..0,
                })));
            self.failed = true;
        }
        for (slot, mark) in self.marks.iter_mut().enumerate() {
            if let Some(index) = mark.take() {
                let end = ends.get(index).copied().unwrap_or(text.len());
                tally.deviations[slot].block = tally.lines + newlines(&text[..end]);
            }
        }
        tally.lines += newlines(text);
        if !self.failed
            && let Err(message) = self.output.write(text)
        {
            self.findings.push(Diagnostic::error("output", message));
            self.failed = true;
        }
        batch.clear();
    }
}

/// A motion between two nodes, and what it must keep.
#[inline]
fn planned<'n>(
    machine: &Machine,
    placer: &'n Placer,
    motion: &Motion,
    from: &'n Node,
    to: &'n Node,
) -> Move<'n> {
    let accuracy = &machine.accuracy;
    let (tip, axis) = if motion.pace == Pace::Rapid {
        (accuracy.rapid_tolerance, f64::INFINITY)
    } else {
        (accuracy.tolerance, accuracy.axis_tolerance)
    };
    Move {
        placer,
        from,
        to,
        tolerances: Tolerances {
            tip: tip - motion.chord,
            axis,
        },
        control_keeps_tip: machine.control.tcp == Tcp::Control,
    }
}

/// A solver and words for the machine with a tool of `length` mm.
fn placer(machine: &Machine, format: &Format, length: f64) -> Result<Placer, Box<Diagnostic>> {
    let fault = |lack: NoClosedForm| {
        Diagnostic::error(
            "machine-chain",
            format!("the chain cannot be solved: {lack:?}"),
        )
        .boxed()
    };
    let solver = machine.solver(length).map_err(fault)?;
    let mut words = Words::new(machine, format);
    words.set_zero(&solver).ok_or_else(|| {
        Diagnostic::error(
            "machine-chain",
            "with every rotary axis at zero the linear axes do not span the space",
        )
        .boxed()
    })?;
    Ok(Placer::new(machine, solver, words))
}

fn newlines(text: &[u8]) -> u64 {
    memchr::memchr_iter(b'\n', text).count() as u64
}
