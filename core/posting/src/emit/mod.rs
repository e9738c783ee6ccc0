//! Blocks and commands become the events of the dialect: what is in force, tool changes, approach, clamps.

mod columns;
mod control;
mod cycles;
mod extremes;
mod face;
mod frame;
mod limits;
mod state;
mod text;
mod text_thread;
mod texts;
mod writer;

use std::rc::Rc;
use std::thread::Scope;

use nalgebra::{Rotation3, UnitQuaternion};
use post_machine::axis_words::{self, AxisWords};
use post_machine::description::{Machine, Moves, TextPlace};
use post_machine::kinematics::{AxisBits, Joints, Solver};
use post_plugin::{Capabilities, Compensation, DialectSession, Event, List, ToolPose};

use crate::blocks::{BlockKind, BlockNote, BlockReason, MotionBlock, WayAcross};
use crate::curve::{CurveWords, PrintedCurve};
use crate::findings::Findings;
use crate::job_facts::JobFacts;
use crate::observer::{Observers, TextSink};
use crate::program::Command;
use crate::report::DriveRange;
use crate::stream::StreamItem;
use cycles::{CommandedCycle, CycleWordPlaces};
pub(crate) use extremes::Extremes;
use face::FaceState;
use limits::LimitWatch;
use state::{
    ClampState, CompensationState, CoolantState, PlaneState, ProgramSpindle, SmoothingState,
};
pub use text_thread::{STACK, SpareWork};
use texts::ProgramTexts;
use writer::EventWriter;

/// The last stage.
pub(crate) struct EmitStage<'a> {
    machine: &'a Machine,
    /// The machine with the head that it starts with.
    base: &'a Machine,
    writer: EventWriter<'a>,
    texts: ProgramTexts<'a>,
    extremes: Extremes,
    /// Where the axes stand after the last block.
    last: Joints,
    clamps: ClampState,
    /// Prints positions in machine coordinates.
    words: AxisWords,
    /// The tool is retracted, and nothing is in force that a first position puts in force.
    clear: bool,
    spindle: ProgramSpindle,
    coolant: CoolantState,
    plane: PlaneState,
    /// The way across behind the next retract; none: as the machine file has it.
    across: Option<Box<WayAcross>>,
    face: FaceState,
    /// The cycle in force.
    cycle: Option<CommandedCycle>,
    cycle_words: CycleWordPlaces,
    /// The tool in the spindle.
    tool: Option<u32>,
    /// The work offset that the CL file names; none before it names one.
    offset: Option<u32>,
    /// Whether the mount that travel was checked with was reported.
    told_mount: bool,
    /// Whether it was reported that what a subprogram does is not checked.
    told_subprogram: bool,
    smoothing: SmoothingState,
    /// Last event of a dialect that has one for keeping the tip.
    keeps_tip: Option<bool>,
    /// The tool came near with the control keeping the tip.
    came_with_tcp: bool,
    /// The head in use, by its place among the machine's, once the CL file has named one.
    head: Option<usize>,
    /// The head that the tool was used with last came to the part with its own or the program's work offset.
    worked: bool,
    compensation: CompensationState,
    limits: LimitWatch,
    /// Says how the tool stands where it is led straight.
    straight: Option<Box<Solver>>,
    /// Columns of a run of cuts on their way to an event.
    cuts: Vec<f64>,
    /// Observers of the program; none if nobody looks on.
    observers: Option<Rc<Observers<'a>>>,
    findings: Findings,
}

impl<'a> EmitStage<'a> {
    pub(crate) fn new(
        machine: &'a Machine,
        job: &JobFacts,
        dialect: &'a mut dyn DialectSession,
        output: &'a mut dyn TextSink,
        findings: &Findings,
    ) -> Self {
        let words = AxisWords::new(machine, dialect.format());
        let writer = EventWriter::new(dialect, output);
        let mut emit = Self {
            machine,
            base: machine,
            writer,
            texts: ProgramTexts::new(machine, job),
            extremes: Extremes::new(machine.axes.len(), machine.is_opened()),
            last: Joints::default(),
            words,
            clear: false,
            clamps: ClampState::default(),
            spindle: ProgramSpindle::default(),
            coolant: CoolantState::default(),
            plane: PlaneState::default(),
            across: None,
            face: FaceState::default(),
            cycle: None,
            cycle_words: CycleWordPlaces::new(machine),
            tool: None,
            offset: None,
            told_mount: false,
            told_subprogram: false,
            smoothing: SmoothingState { wanted: machine.smoothing.default, on: None },
            keeps_tip: None,
            came_with_tcp: false,
            head: None,
            worked: false,
            compensation: CompensationState::default(),
            limits: LimitWatch::default(),
            straight: (machine.control.moves == Moves::Straight)
                .then(|| machine.solver(0.0).ok().map(Box::new))
                .flatten(),
            cuts: Vec::new(),
            observers: None,
            findings: findings.clone(),
        };
        emit.say_bare(0, TextPlace::FirstLines);
        emit.writer.push(0, Event::Start);
        for text in &job.remarks {
            emit.writer.push(0, Event::Comment { text });
        }
        emit.say(0, TextPlace::Header);
        // Nothing is known of where the tool stands, nor of what is in force.
        emit.retract(0);
        emit
    }

    /// Extremes so far.
    pub(crate) fn extremes(&self) -> &Extremes {
        &self.extremes
    }

    /// Where the drives that are no axes came to.
    pub(crate) fn drives(&self) -> &[DriveRange] {
        &self.limits.drives
    }

    /// Lines of text so far.
    pub(crate) fn lines(&self) -> u64 {
        self.writer.lines()
    }

    /// Takes a batch, and shows observers what is written of it.
    pub(crate) fn take(&mut self, batch: &mut [StreamItem<MotionBlock>]) {
        self.elements(batch);
        self.flush();
        if let Some(observers) = &self.observers {
            number(batch, &mut self.writer.take_lines());
            observers.blocks(batch);
        }
    }

    fn elements(&mut self, elements: &[StreamItem<MotionBlock>]) {
        for next in elements {
            match next {
                StreamItem::Point(block) => {
                    self.end_cycle(block.line);
                    self.placed_block(block, None);
                }
                StreamItem::Curve { line, curve } => {
                    self.end_cycle(*line);
                    self.placed_block(&curve.block, Some(&curve.printed));
                }
                StreamItem::Hole(hole) => {
                    self.hole(hole);
                    self.extremes.note_line(hole.line);
                }
                StreamItem::Command { line, command } => {
                    self.end_cycle(*line);
                    self.command(*line, command);
                }
                StreamItem::Note { line, note: BlockNote::Plane(plane) } => {
                    self.end_cycle(*line);
                    self.set_plane(*line, plane.clone());
                }
                StreamItem::Note { note: BlockNote::Across(way), .. } => {
                    self.across = Some(way.clone());
                }
                StreamItem::Note { note: BlockNote::Placer(placer), .. } => {
                    self.limits.placer = Some(placer.clone());
                }
            }
            if self.writer.is_full() {
                self.flush();
            }
        }
    }

    /// The last events; `line` is the last of the CL file.
    pub(crate) fn finish(&mut self, line: u64) {
        self.end_cycle(line);
        self.end(line);
        self.flush();
        self.settle();
    }

    /// Writes texts on a thread of `scope` from here on, if one can be started; while none waits it does `spare` work.
    pub(crate) fn write_beside<'s>(&mut self, scope: &'s Scope<'s, '_>, spare: SpareWork<'s>)
    where
        'a: 's,
    {
        self.writer.write_beside(scope, spare);
    }

    /// First line of the CL file whose events are no text yet, though they are handed on.
    pub(crate) fn first_line(&self) -> Option<u64> {
        self.writer.first_line()
    }

    /// Waits until all that was handed on is text, and all is known that is wrong with it.
    pub(crate) fn settle(&mut self) {
        self.writer.settle(&mut self.extremes, &self.findings);
    }

    fn flush(&mut self) {
        self.texts.tell(&self.findings);
        self.writer.flush(&mut self.extremes, &self.findings);
    }

    /// Shows what is written from here on, each block with the line that it ends on.
    pub(crate) fn watch(&mut self, observers: Rc<Observers<'a>>) {
        self.writer.watch();
        self.observers = Some(observers);
    }

    /// Writes a block, and notes where it stands.
    #[inline]
    fn placed_block(&mut self, block: &MotionBlock, printed: Option<&PrintedCurve>) {
        let before = self.writer.next();
        self.block(block, printed);
        self.extremes.note_line(block.line);
        self.writer.place(before);
    }

    #[inline]
    fn block(&mut self, block: &MotionBlock, printed: Option<&PrintedCurve>) {
        let line = block.line;
        if self.spindle.waits.is_some_and(|first| block.kind.cuts() || first.goes_in(block)) {
            self.wake(line);
        }
        match block.kind {
            BlockKind::Position => self.position(block),
            BlockKind::Reference => {
                self.retract(line);
                let [from, to] = self.real_ends(block);
                self.extremes.go(&from, &to);
                self.position(block);
            }
            BlockKind::Arc | BlockKind::Spline => self.curve(block, printed),
            BlockKind::Rapid | BlockKind::Linear => {
                // A block without a changed word moves nothing and is not written.
                if block.still {
                    self.extremes.mark(block, self.writer.next());
                    return;
                }
                let [from, to] = self.real_ends(block);
                match block.reason {
                    BlockReason::Above => self.extremes.reach_above(),
                    _ => self.extremes.reach(&to),
                }
                self.extremes.go(&from, &to);
                if self.clamps() {
                    self.clamp(block);
                }
                self.extremes.mark(block, self.writer.next());
                if let (Some(solver), false, true) =
                    (&self.straight, block.loose, block.time.feed.is_some())
                    && let Some(pose) = pose(solver, self.machine, block)
                {
                    self.writer.push(line, pose);
                }
                let (tool, words) = (stands(block), &block.words[..self.writer.words()]);
                self.writer.push(
                    line,
                    match block.time.feed {
                        Some(feed) => Event::Linear { tool, feed, words },
                        None => Event::Rapid { tool, words },
                    },
                );
            }
        }
        self.keep_limits(block, printed);
        self.last = block.joints;
        if block.reason != BlockReason::Above {
            self.begin_compensation(line);
        }
    }

    /// Cutter compensation. None begins on the way down to a first position.
    fn compensate(&mut self, line: u64, compensation: Compensation) {
        self.compensation.commanded =
            Some(compensation).filter(|asked| *asked != Compensation::Off);
        self.compensation.waits = self.compensation.commanded.filter(|_| self.clear);
        if self.compensation.waits.is_none() {
            self.writer.push(line, Event::Compensate(compensation));
        }
    }

    /// What waits of it.
    fn begin_compensation(&mut self, line: u64) {
        if let Some(compensation) = self.compensation.waits.take() {
            self.writer.push(line, Event::Compensate(compensation));
        }
    }

    /// A block along a curve.
    fn curve(&mut self, block: &MotionBlock, printed: Option<&PrintedCurve>) {
        let (Some(curve), Some(feed)) = (printed, block.time.feed) else {
            return;
        };
        self.extremes.curves += 1;
        self.extremes.reach(&block.joints);
        let mut from = self.last;
        for place in &curve.between {
            self.extremes.cover(place);
            self.extremes.go(&from, place);
            from = *place;
        }
        self.extremes.go(&from, &block.joints);
        if self.clamps() {
            self.clamp(block);
        }
        self.extremes.mark(block, self.writer.next());
        let event = match &curve.words {
            CurveWords::Arc { centre, normal, turn, radius } => Event::Arc {
                tool: stands(block),
                feed,
                centre: *centre,
                normal: *normal,
                turn: *turn,
                radius: *radius,
                words: &block.words[..self.writer.words()],
            },
            CurveWords::Spline { degree, knots, weights, points } => Event::Spline {
                feed,
                degree: *degree,
                knots: List(knots),
                weights: List(weights),
                points: List(points),
            },
        };
        self.writer.push(block.line, event);
    }

    fn command(&mut self, line: u64, command: &Command) {
        let event = match command {
            // These act on the choice of axis values alone.
            Command::From { .. } | Command::Index { .. } => return,
            Command::Tool(tool) => return self.change(line, tool),
            Command::Head(name) => return self.swap_head(line, name),
            Command::Operation(name) => return self.operation(line, name),
            Command::OperationEnd => return self.operation_end(line),
            Command::Preselect(_) if self.texts.preselects() => return,
            Command::Preselect(number) => Event::Preselect { number: *number },
            Command::Spindle(spindle) => return self.spindle(line, *spindle),
            Command::Coolant(coolant) => return self.coolant(line, *coolant),
            Command::Compensate(compensation) => return self.compensate(line, *compensation),
            Command::Comment(text) => Event::Comment { text },
            Command::Literal(text) => {
                // What it does is not known.
                self.clear = false;
                if self.spindle.waits.is_some() {
                    self.wake(line);
                }
                Event::Literal { text }
            }
            Command::Message(text) if self.writer.knows(Capabilities::MESSAGE) => {
                Event::Message { text }
            }
            Command::Message(text) => Event::Comment { text },
            Command::SurfaceSpeed { speed, most, sense } => {
                return self.surface_speed(line, (*speed, *most), *sense);
            }
            Command::WorkOffset(number) => return self.work_offset(line, *number),
            Command::Subprogram(number) => return self.subprogram(line, *number),
            Command::Smoothing(wanted) => {
                self.smoothing.wanted = *wanted;
                return self.leave(line);
            }
            Command::Dwell(seconds) => Event::Dwell { seconds: *seconds },
            Command::Sync(wait) => {
                self.refuse_wait_on_face(line, wait.mark);
                // Others may rely on the spindle.
                if self.spindle.waits.is_some() {
                    self.wake(line);
                }
                Event::Word { text: &wait.line.text }
            }
            Command::Stop => Event::Stop,
            Command::OptionalStop => Event::OptionalStop,
            Command::Home => return self.go_home(line),
            Command::Retract { forgets } => return self.apart(line, *forgets),
            Command::Leave => return self.leave(line),
        };
        self.writer.push(line, event);
    }

    /// An operation begins: of a dialect that does not know operations its name is a remark.
    fn operation(&mut self, line: u64, name: &str) {
        self.texts.operation(Some(name));
        let event = match self.writer.knows(Capabilities::OPERATION) {
            true => Event::Operation { name },
            false => Event::Comment { text: name },
        };
        self.writer.push(line, event);
        self.say(line, TextPlace::BeforeOperation);
    }

    fn operation_end(&mut self, line: u64) {
        self.say(line, TextPlace::AfterOperation);
        self.texts.operation(None);
        if self.writer.knows(Capabilities::OPERATION) {
            self.writer.push(line, Event::OperationEnd);
        }
    }

    /// Lets go the axes that this block moves, and clamps the others before the tool cuts: but for those that turn in the
    /// cuts here, which would be clamped from block to block.
    fn clamp(&mut self, block: &MotionBlock) {
        for joint in 0..self.machine.axes.len() {
            let cuts = block.kind != BlockKind::Rapid;
            if self.last[joint] != block.joints[joint] {
                self.set_clamp(block.line, joint, false, false);
                self.clamps.free |= AxisBits::from(cuts) << joint;
            } else if cuts && self.clamps.free >> joint & 1 == 0 {
                self.set_clamp(block.line, joint, true, false);
            }
        }
    }

    /// Some axis is clamped and let go by words: those of the machine file, or the dialect's.
    fn clamps(&self) -> bool {
        self.machine.clamps || self.writer.knows(Capabilities::CLAMP)
    }

    /// Writes the word that clamps an axis or lets it go, unless it is so already.
    fn set_clamp(&mut self, line: u64, joint: usize, on: bool, unknown: bool) {
        let axis = &self.machine.axes[joint];
        let bit = 1 << joint;
        if !unknown && (self.clamps.on & bit != 0) == on {
            return;
        }
        match &axis.clamp {
            Some(clamp) => {
                let text = if on { &clamp.on } else { &clamp.off };
                self.writer.push(line, Event::Word { text });
            }
            None if axis.joint.rotary && self.writer.knows(Capabilities::CLAMP) => {
                let mut order = axis_words::order(self.machine).into_iter();
                let Some(word) = order.position(|other| other == joint) else {
                    return;
                };
                let word = word as u32;
                self.writer.push(line, Event::Clamp { word, on });
            }
            None => return,
        }
        self.clamps.on = self.clamps.on & !bit | if on { bit } else { 0 };
    }
}

/// Fills in on which line each block ends.
fn number(elements: &mut [StreamItem<MotionBlock>], lines: &mut dyn Iterator<Item = u64>) {
    for next in elements {
        match next {
            StreamItem::Point(block) => block.nc_line = lines.next().unwrap_or(0),
            StreamItem::Curve { curve, .. } => curve.block.nc_line = lines.next().unwrap_or(0),
            StreamItem::Hole(hole) => {
                number(&mut hole.above, lines);
                number(&mut hole.into, lines);
            }
            StreamItem::Command { .. } | StreamItem::Note { .. } => {}
        }
    }
}

/// How a tool that is led straight stands at the end of a block.
fn pose(solver: &Solver, machine: &Machine, block: &MotionBlock) -> Option<Event<'static>> {
    let [axis, x] = solver.stand(&block.joints)?;
    let z = -axis;
    let frame = Rotation3::from_basis_unchecked(&[x, z.cross(&x), z]);
    let quaternion = UnitQuaternion::from_rotation_matrix(&frame);
    let (about_x, about_y, about_z) = frame.euler_angles();
    Some(Event::Pose {
        origin: (block.tip + machine.mount).into(),
        quaternion: [quaternion.w, quaternion.i, quaternion.j, quaternion.k],
        rotation: quaternion.scaled_axis().into(),
        angles: [about_z, about_y, about_x].map(f64::to_degrees),
    })
}

/// Where the tool stands at the end of a block.
#[inline]
fn stands(block: &MotionBlock) -> Option<ToolPose> {
    Some(ToolPose { tip: block.tip.into(), axis: block.axis.into() })
}
