//! The path: takes steps, has axis values chosen, puts points in, paces blocks and hands events to the dialect.
//!
//! Moves wait until the route has decided them; commands between them (spindle, coolant, remarks) wait with them.

mod moves;
mod run;
mod tally;

use std::collections::VecDeque;

use post_plugin::{
    Batch, Compensation, Coolant, DialectSession, Event, Format, ModelSession, Spindle,
};

use crate::accuracy::{Linearise, Move, Node};
use crate::feed::{Due, Feeds};
use crate::program::{Edges, Motion, Step, Tool};
use crate::route::{Chosen, Route};
use post_machine::description::{Machine, Positions, Tcp, ToolLength};
use post_machine::diagnostic::{Diagnostic, Place};
use post_machine::kinematics::Pose;

use run::Gathered;
pub use tally::Tally;

/// Where the text of the program goes.
pub trait Output {
    /// Takes text.
    ///
    /// # Errors
    /// Why it cannot.
    fn write(&mut self, text: &[u8]) -> Result<(), String>;
}

/// Looks on while a path is made.
pub trait Watch {
    /// Takes a cut between two CL points, before any point is put in. Chords of arcs, splines and cycles come one by
    /// one. Where `reduce` gathers CL points, cuts go by unseen.
    fn cut(&mut self, line: u64, cut: &Move<'_>);
}

/// Events are handed over in runs of this length: from some dozens on, the plugin boundary costs nothing.
const BATCH: usize = 128;

/// More commands than this do not wait for a move to be decided.
const MOST_WAITING: usize = 4096;

/// Everything between the steps of a program and its text.
pub struct Path<'a> {
    machine: &'a Machine,
    /// The machine with the head that it starts with.
    base: &'a Machine,
    dialect: &'a mut dyn DialectSession,
    model: &'a mut dyn ModelSession,
    output: &'a mut dyn Output,
    format: Format,
    /// For a tool with a leading edge.
    edges: Option<Edges>,
    route: Route<'a>,
    /// Moves that the route has taken, and of them those that it has decided.
    taken: u64,
    decided: u64,
    /// Commands, each with the number of moves that come before it.
    waiting: VecDeque<(u64, u64, Step)>,
    chosen: Vec<Chosen>,
    feeds: Feeds,
    linearise: Linearise,
    /// Who looks on.
    watch: Option<&'a mut dyn Watch>,
    /// CL points that wait for those behind them.
    gathered: Gathered,
    /// What each leg of the run in hand is due.
    due: Vec<Due>,
    /// What the user says of every tool.
    told_length: Option<f64>,
    /// Length of the tool in use.
    length: f64,
    /// The same, if anybody gave it.
    length_known: Option<f64>,
    /// The tool's length matters and nobody gave it.
    length_unknown: bool,
    /// Where the tool stands; none before the first position.
    last: Option<Box<Node>>,
    /// The node before that, to be filled again.
    spare: Option<Box<Node>>,
    /// The last move was a cut: the tool is on the part.
    on_part: bool,
    /// Axes that are known to be clamped, one bit each.
    clamped: u8,
    /// Length compensation or TCP is in force.
    positioned: bool,
    compensating: bool,
    /// The spindle was switched on since the last tool change.
    turning: bool,
    /// What the CL file last said of it.
    commanded: Option<Spindle>,
    /// What the CL file last said of coolant, and that it was switched off in between.
    coolant: Option<Coolant>,
    coolant_due: bool,
    /// The tool in use.
    tool: Option<Tool>,
    /// That it was not is told once a program.
    told_spindle: bool,
    /// That compensation cannot be, likewise.
    told_compensation: bool,
    batch: Batch,
    text: String,
    ends: Vec<usize>,
    tally: Tally,
    /// Where the largest deviations stand in the present batch: event index.
    marks: [Option<usize>; 3],
    findings: Vec<Diagnostic>,
    /// Something is wrong: no more text is made, but checking goes on.
    failed: bool,
}

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
        let length = tool_length.unwrap_or(0.0);
        let route = Route::new(machine, &format, length)?;
        Ok(Self {
            machine,
            base: machine,
            dialect,
            model,
            output,
            format,
            edges: Edges::new(machine),
            route,
            taken: 0,
            decided: 0,
            waiting: VecDeque::new(),
            chosen: Vec::new(),
            feeds,
            linearise: Linearise::new(&machine.accuracy, trust_model),
            watch: None,
            gathered: Gathered::default(),
            due: Vec::new(),
            told_length: tool_length,
            length,
            length_known: tool_length,
            length_unknown: tool_length.is_none(),
            last: None,
            spare: None,
            on_part: false,
            clamped: 0,
            positioned: false,
            compensating: false,
            turning: false,
            commanded: None,
            coolant: None,
            coolant_due: false,
            tool: None,
            told_spindle: false,
            told_compensation: false,
            batch: Batch::default(),
            text: String::new(),
            ends: Vec::new(),
            tally: Tally::new(),
            marks: [None; 3],
            findings: Vec::new(),
            failed: false,
        })
    }

    /// Shows every cut to `watch`.
    pub fn watch(&mut self, watch: &'a mut dyn Watch) {
        self.watch = Some(watch);
    }

    /// Findings since the last call; of their places only the line is filled in.
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

    /// Line of the CL file before which everything is settled.
    pub fn settled_line(&self) -> Option<u64> {
        let command = self.waiting.front().map(|(_, line, _)| *line);
        [command, self.route.first_line(), self.gathered.first_line()]
            .into_iter()
            .flatten()
            .min()
    }

    /// The first event.
    pub fn start(&mut self) {
        self.push(0, Event::Start);
    }

    /// The last events.
    pub fn end(&mut self, line: u64) {
        self.with_edge(|edges, emit| edges.finish(emit));
        self.settle();
        self.end_run();
        self.release(line);
        self.push(line, Event::End);
        self.flush();
    }

    /// Takes a step that comes from `line`.
    #[inline]
    pub fn step(&mut self, line: u64, step: Step) {
        if self.edges.is_some() {
            self.with_edge(|edges, emit| edges.step(line, step, emit));
        } else {
            self.enter(line, step);
        }
    }

    #[inline]
    fn enter(&mut self, line: u64, step: Step) {
        match step {
            Step::Move(motion) => self.take(line, &motion),
            other => self.arrange(line, other),
        }
    }

    /// Lets the edges' stage work; what it settles comes in.
    fn with_edge(&mut self, work: impl FnOnce(&mut Edges, &mut dyn FnMut(u64, Step))) {
        let Some(mut edges) = self.edges.take() else {
            return;
        };
        work(&mut edges, &mut |line, step| self.enter(line, step));
        for (line, fault) in edges.take_faults() {
            self.find(
                line,
                Diagnostic::error("edge", fault)
                    .help("[rewind] and [solution] edge say how a leading edge is turned"),
            );
        }
        self.edges = Some(edges);
    }

    #[inline]
    fn take(&mut self, line: u64, motion: &Motion) {
        self.tally.moves += 1;
        // From here on a point of the path is the control point.
        let along = self.machine.control_point.along;
        let motion = &Motion {
            tip: motion.tip + motion.axis * along,
            ..*motion
        };
        match self.route.add(line, motion) {
            Ok(()) => self.taken += 1,
            Err(diagnostic) => {
                let restarts = diagnostic.code == "jump";
                self.find(line, *diagnostic);
                if restarts {
                    // The path goes on behind the fault as if it began there.
                    self.drain();
                    self.end_run();
                    self.last = None;
                    self.on_part = false;
                }
            }
        }
        if self.route.has_chosen() {
            self.drain();
        }
    }

    /// A command is carried out between the moves that it stands between.
    fn arrange(&mut self, line: u64, step: Step) {
        if step.leaves() || self.waiting.len() >= MOST_WAITING {
            self.settle();
        }
        if self.decided == self.taken {
            self.command(line, step);
        } else {
            self.waiting.push_back((self.taken, line, step));
        }
    }

    /// Has everything decided, and carries it out.
    fn settle(&mut self) {
        self.route.settle_all();
        self.drain();
    }

    /// Carries out what was decided.
    fn drain(&mut self) {
        let mut chosen = std::mem::take(&mut self.chosen);
        self.route.take_chosen(&mut chosen);
        for next in &chosen {
            self.carry_out(next);
            if next.arrives {
                self.decided += 1;
                while self
                    .waiting
                    .front()
                    .is_some_and(|(moves, ..)| *moves <= self.decided)
                {
                    if let Some((_, line, step)) = self.waiting.pop_front() {
                        self.command(line, step);
                    }
                }
            }
        }
        self.chosen = chosen;
    }

    fn command(&mut self, line: u64, step: Step) {
        self.end_run();
        match step {
            // Moves go through the route.
            Step::Move(motion) => self.take(line, &motion),
            Step::From { tip, axis } => {
                // The tool stands there: solutions near to it are wanted, but nothing moves.
                let pose = Pose {
                    tip: tip + axis * self.machine.control_point.along,
                    axis,
                    edge: self.route.edge_at_rest(),
                };
                let placed = self
                    .route
                    .present()
                    .place(pose, 1.0, self.route.stands_at());
                if let Ok(node) = placed {
                    self.route.begin_at(node.trace.joints);
                }
            }
            Step::Tool(tool) => self.change(line, &tool),
            Step::Index { axis, angle } => self.index(line, axis, angle),
            Step::Head(name) => self.swap_head(line, &name),
            Step::Preselect(number) => self.push(line, Event::Preselect { number }),
            Step::Spindle(spindle) => {
                self.turning = matches!(spindle, Spindle::On { .. });
                self.commanded = self.turning.then_some(spindle);
                self.push(line, Event::Spindle(spindle));
            }
            Step::Coolant(coolant) => {
                self.coolant = (coolant != Coolant::Off).then_some(coolant);
                self.coolant_due = false;
                self.push(line, Event::Coolant(coolant));
            }
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
        self.last = None;
        self.on_part = false;
        self.route.leave();
    }

    fn change(&mut self, line: u64, tool: &Tool) {
        self.release(line);
        self.turning = false;
        self.measure(tool);
        self.tool = Some(tool.clone());
        self.equip(line);
        self.push(
            line,
            Event::ToolChange {
                number: tool.number,
                register: tool.register,
                length: self.length_known,
                diameter: None,
                corner_radius: None,
                name: &tool.name,
            },
        );
    }

    /// Finds the length of a tool.
    fn measure(&mut self, tool: &Tool) {
        let table = || {
            let tools = &self.machine.tools;
            tools
                .iter()
                .find(|(number, _)| *number == tool.number)
                .map(|(_, length)| *length)
        };
        let length = self.told_length.or_else(table).or(tool.length);
        self.length_unknown |= length.is_none();
        if length.is_some() && self.tally.moves == 0 {
            self.length_unknown = false;
        }
        self.length_known = length;
        self.length = length.unwrap_or(0.0);
    }

    /// Takes machine and tool length into the route.
    fn equip(&mut self, line: u64) {
        if let Err(diagnostic) = self.route.equip(self.machine, self.length) {
            self.find(line, *diagnostic);
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
            && axis
                .travel
                .is_none_or(|[least, most]| (least - 1e-9..=most + 1e-9).contains(&value));
        match self.route.index(joint, value, possible) {
            Ok(true) if !possible => self.find(
                line,
                Diagnostic::error(
                    "index",
                    format!(
                        "{} cannot stand at {:.3}°, where ROTABL wants it",
                        axis.name,
                        axis.reading(value)
                    ),
                )
                .help(match positions {
                    Some(positions) if *positions != Positions::Any => format!(
                        "the nearest of its positions is {:.3}°",
                        axis.reading(positions.nearest(value, axis.travel.is_none()))
                    ),
                    _ => "it is outside the travel of the axis".to_owned(),
                }),
            ),
            Ok(_) => {}
            Err(diagnostic) => self.find(line, *diagnostic),
        }
    }

    /// Another head: the machine is that of the head from here on.
    fn swap_head(&mut self, line: u64, name: &str) {
        let heads = &self.base.heads;
        let Some(head) = heads.iter().find(|head| head.name == name) else {
            let known: Vec<&str> = heads.iter().map(|head| head.name.as_str()).collect();
            let fault = Diagnostic::error("head", format!("{} has no head {name}", self.base.name));
            let help = if known.is_empty() {
                "its file describes no [head.NAME]".to_owned()
            } else {
                format!("its heads are: {}", known.join(", "))
            };
            self.find(line, fault.help(help));
            return;
        };
        self.release(line);
        self.machine = &head.machine;
        self.linearise.set(&self.machine.accuracy);
        if let Some(feeds) = Feeds::new(self.machine, &self.format) {
            self.feeds = feeds;
        }
        // A head may have lengths of its own.
        if let Some(tool) = self.tool.clone() {
            self.measure(&tool);
        }
        self.equip(line);
        // Away first: a spindle that stops in the part tears. Both are switched on again with the first position,
        // as after a tool change.
        self.push(line, Event::Home);
        if std::mem::take(&mut self.turning) {
            self.push(line, Event::Spindle(Spindle::Off));
        }
        if self.coolant.is_some() {
            self.coolant_due = true;
            self.push(line, Event::Coolant(Coolant::Off));
        }
        match &head.word {
            Some(word) => self.push(line, Event::Word { text: word }),
            None => {
                let text = format!("CHANGE TO HEAD {name}");
                self.push(line, Event::Comment { text: &text });
                self.push(line, Event::Stop);
            }
        }
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

    /// Keeps a finding that stands at `line`.
    #[cold]
    fn find(&mut self, line: u64, finding: Diagnostic) {
        self.findings.push(finding.at(Some(Place {
            file: String::new(),
            line,
            text: String::new(),
            span: 0..0,
        })));
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
        let mut fault = None;
        if let Err(refused) = self.dialect.write_batch(batch, text, ends) {
            let line = batch.line(refused.index.min(batch.len().saturating_sub(1)));
            fault = Some((line, Diagnostic::error("dialect", refused.message)));
        }
        for (slot, mark) in self.marks.iter_mut().enumerate() {
            if let Some(index) = mark.take() {
                let end = ends.get(index).copied().unwrap_or(text.len());
                tally.deviations[slot].block = tally.lines + newlines(&text.as_bytes()[..end]);
            }
        }
        tally.lines += newlines(text.as_bytes());
        if fault.is_none()
            && !self.failed
            && let Err(message) = self.output.write(text.as_bytes())
        {
            self.findings.push(Diagnostic::error("output", message));
            self.failed = true;
        }
        batch.clear();
        if let Some((line, fault)) = fault {
            self.failed = true;
            self.find(line, fault);
        }
    }
}

fn newlines(text: &[u8]) -> u64 {
    memchr::memchr_iter(b'\n', text).count() as u64
}
