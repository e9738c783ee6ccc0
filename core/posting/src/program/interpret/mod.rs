//! Settles what is modal in a CL file: units, axis, feed, frames, cycles; curves keep their shape.

mod cam_system;
mod control;
mod curves;
mod cycles;
mod ending;
mod feeds;
mod files;
mod frames;
mod modal;
mod moves;
mod readiness;
mod reading;
mod tools;
mod turned;
pub(crate) mod words;

use nalgebra::Vector3;
use post_grammar::text::{as_remark, excerpt};
use post_grammar::{
    ArcMove, CircleRecord, CoolantWord, Delay, Record, Statement, Units, WordUsage,
};
use post_machine::description::Smoothing;
use post_plugin::{Coolant, SpindleSense};

pub use reading::{DefaultSpindle, ReadingOptions};

use super::frame::ClFrame;
use super::limits::{LONGEST_DWELL, MOST_WORDS, direction};
use super::word_census::WordCensus;
use super::{Command, MoveFeed, ProgramStep};
use cam_system::CamSystem;
use files::LeftByFile;
use frames::millimetres;
use modal::{FileCompensation, FileCycles, FileSpindle, FileTools};
use post_machine::diagnostic::{Diagnostic, Short, SourcePlace};
use readiness::{EndAxis, ONE_AXIS};
use turned::ArcAxisConvention;
use words::SuspectRecord;

/// Where the steps go that a record means.
type StepSink<'e> = dyn FnMut(ProgramStep) + 'e;

/// Turns records into steps.
#[derive(Debug)]
pub struct ClInterpreter {
    reading: ReadingOptions,
    /// How it is to be read, before anything was.
    told: ReadingOptions,
    /// Files behind the first that are begun.
    files_begun: usize,
    /// Lines before the next of them.
    next_file: Option<u64>,
    left: LeftByFile,
    /// The head that the file named last.
    head: Option<String>,
    /// Units that the file names.
    units: Option<Units>,
    /// Millimetres in one unit of the file.
    scale: f64,
    /// Some feed word names a metric or an inch unit.
    feed_units: Option<Units>,
    /// Modal tool axis, frame of the file.
    axis: Vector3<f64>,
    /// Modal leading edge, frame of the file; zero until the file gives one.
    edge: Vector3<f64>,
    /// `TLAXIS`, part frame.
    told_axis: Option<Vector3<f64>>,
    /// An index move came since the last move: see whether it agrees with `TLAXIS`.
    check_axis: bool,
    /// How the operation ended before the one that has not moved yet.
    axis_before: Option<EndAxis>,
    /// The tool axis with which the operation began to move, unit vector, part frame.
    begun_with: Option<Vector3<f64>>,
    /// Last point, mm, frame of the file.
    tip: Option<Vector3<f64>>,
    rapid: bool,
    /// `FEDRAT/RAPID` is in force.
    rapid_feed: bool,
    feed: Option<ModalFeed>,
    frame: ClFrame,
    pending: Option<UnfinishedCurve>,
    cycles: FileCycles,
    tools: FileTools,
    spindle: FileSpindle,
    compensation: FileCompensation,
    /// Something is to be seen to before the next move.
    due: bool,
    coolant: Coolant,
    /// The work offset that the file named last.
    offset: Option<u32>,
    /// Tolerance by which the control may leave the path.
    smoothing: Option<Smoothing>,
    /// Some number was read that the units gave its meaning.
    measured: bool,
    /// Some move was read.
    moved: bool,
    /// Records after a move that may carry a path, and are not known here: none may be left out where a further
    /// move follows.
    suspects: Vec<SuspectRecord>,
    /// What the file has shown of who wrote it.
    writer: CamSystem,
    /// `INDIRV`, unit vector, frame of the file.
    set_out: Option<Vector3<f64>>,
    /// Normal of the plane that `AUTOPS` or `PSIS` names, unit vector, frame of the file.
    part_surface: Option<Vector3<f64>>,
    arc_axes: ArcAxisConvention,
    /// The operation that is open (NX), its paths must be ended.
    path: Option<String>,
    /// Some operation was begun (NX).
    paths: bool,
    /// Whether the file is of a system that ends every file with FINI.
    wants_fini: bool,
    finished: bool,
    /// It was said that records behind FINI are left out.
    told_after_fini: bool,
    findings: Vec<Diagnostic>,
    census: WordCensus,
}

/// A cutter as the file describes it.
#[derive(Clone, Debug, PartialEq)]
struct CutterDescription {
    /// Where its length stands among the numbers: that tells the words apart.
    length: usize,
    numbers: Vec<f64>,
    /// The tool's name (NX).
    name: String,
}

/// A feed as the file has it; one a revolution waits for the speed of the spindle at the move.
#[derive(Clone, Copy, Debug, PartialEq)]
enum ModalFeed {
    Pace(MoveFeed),
    /// Feed a revolution, mm.
    PerRevolution(f64),
}

/// Largest part of a name or a text of the file that is shown in a message, in bytes.
const SHOWN_NAME: usize = 80;

/// A curve that is not yet complete.
#[derive(Clone, Debug)]
enum UnfinishedCurve {
    Arc(CircleRecord),
    Turned(ArcMove),
    Spline { knots: Vec<f64>, points: Vec<Vector3<f64>> },
}

impl ClInterpreter {
    /// Nothing read yet.
    pub fn new(reading: ReadingOptions) -> Self {
        let scale = reading.units.map_or(1.0, millimetres);
        let frame = ClFrame::new(reading.apply_msys, reading.turn);
        let smoothing = reading.smoothing.default;
        let may_cut = reading.knife || reading.spindle == DefaultSpindle::Still;
        let next_file = reading.further.first().map(|file| file.before);
        Self {
            told: reading.clone(),
            reading,
            files_begun: 0,
            next_file,
            left: LeftByFile::default(),
            head: None,
            units: None,
            scale,
            feed_units: None,
            axis: Vector3::z(),
            edge: Vector3::zeros(),
            told_axis: None,
            check_axis: false,
            axis_before: None,
            begun_with: None,
            tip: None,
            rapid: false,
            rapid_feed: false,
            feed: None,
            frame,
            pending: None,
            cycles: FileCycles::default(),
            tools: FileTools::default(),
            spindle: FileSpindle {
                rpm: None,
                surface_speed: None,
                sense: SpindleSense::Clockwise,
                may_cut,
                said: false,
            },
            compensation: FileCompensation::default(),
            due: true,
            coolant: Coolant::Flood,
            offset: None,
            smoothing,
            measured: false,
            moved: false,
            suspects: Vec::new(),
            writer: CamSystem::default(),
            set_out: None,
            part_surface: None,
            arc_axes: ArcAxisConvention::default(),
            path: None,
            paths: false,
            wants_fini: false,
            finished: false,
            told_after_fini: false,
            findings: Vec::new(),
            census: WordCensus::default(),
        }
    }

    /// Findings since the last call.
    pub fn take_findings(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.findings)
    }

    /// Whether there are findings.
    #[inline]
    pub fn has_findings(&self) -> bool {
        !self.findings.is_empty()
    }

    /// Words that were ignored, and how often.
    pub fn ignored(&self) -> impl Iterator<Item = (&str, u64)> {
        self.census.ignored()
    }

    /// Takes one record and gives the steps it means to `emit`, in order.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>, emit: &mut impl FnMut(ProgramStep)) {
        if let Statement::Goto { point, axis } = &record.statement
            && self.pending.is_none()
            && self.cycles.in_force.is_none()
            && !self.cycles.lost
            && !self.finished
        {
            self.plain_goto(record, *point, *axis, emit);
            return;
        }
        self.statement(record, emit);
    }

    /// What is left open at the end of the file, and what was found of its words.
    pub fn finish(&mut self) {
        if self.files_begun > 0 {
            self.end_file();
        } else {
            self.left_open();
        }
        self.findings.extend(self.census.unknown(self.reading.unknown));
        self.findings.extend(self.census.allowed());
        self.findings.extend(self.census.slips(&self.reading.allowed));
    }

    /// What is left open at the end of a file.
    fn left_open(&mut self) {
        match self.pending.take() {
            None => {}
            Some(UnfinishedCurve::Arc(_) | UnfinishedCurve::Turned(_)) => self.findings.push(
                Diagnostic::error("arc", "the file ends with a CIRCLE or MOVARC that no GOTO ends"),
            ),
            Some(UnfinishedCurve::Spline { .. }) => self.findings.push(Diagnostic::error(
                "spline",
                "the file ends within a NURBS: no GOTO, END-OF-PATH or FINI follows it",
            )),
        }
        if self.set_out.is_some() {
            self.findings.push(Diagnostic::error(
                "arc",
                "the file ends with an INDIRV that no TLON follows",
            ));
        }
        self.clear_suspects();
        if self.tip.is_some() && self.units.is_none() && self.reading.units.is_none() {
            match self.feed_units {
                Some(Units::Inch) => self.findings.push(
                    Diagnostic::warning(
                        "units",
                        "the file has no UNITS; its points were taken as mm, but its feeds are in inches",
                    )
                    .help("say --units inch or --units mm"),
                ),
                Some(_) => {}
                None => self.findings.push(
                    Diagnostic::warning("units", "the file has no UNITS; its numbers were taken as mm")
                        .help("say --units inch or --units mm"),
                ),
            }
        }
    }

    /// Carries out what a record says.
    fn statement(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        if self.finished {
            self.after_fini(record);
            return;
        }
        match &record.statement {
            Statement::Goto { point, axis } => self.goto(record, *point, *axis, emit),
            Statement::GotoEdge { point, axis, edge } => {
                self.goto_edge(record, *point, *axis, *edge, emit);
            }
            Statement::Head(name) => {
                self.tip = None;
                self.head = Some(name.clone());
                emit(ProgramStep::Command(Command::Head(name.clone())));
            }
            Statement::Godlta(delta) => self.godlta(record, delta, emit),
            Statement::From { point, axis } => self.starting_point(record, *point, *axis, emit),
            Statement::Gohome(home) => self.gohome(record, *home, emit),
            Statement::Rapid => self.rapid = true,
            Statement::Feed(feed) => self.set_feed(record, *feed),
            Statement::Spindle(spindle) => {
                self.load_told(record, emit);
                self.spindle(record, *spindle, emit);
            }
            // The kind stands in the record after it.
            Statement::Coolant(CoolantWord::On) if self.writer.autodesk => {}
            Statement::Coolant(word) => self.set_coolant(record, word, emit),
            Statement::LoadTool(tool) => self.load_read(record, tool, emit),
            Statement::SelectTool(number) => self.select_tool(*number, emit),
            Statement::ToolData { kinds, numbers } => {
                self.tools.threads = kinds.iter().any(|kind| kind == "THREAD");
                self.cutter(record, numbers, 2);
            }
            Statement::Cutter(numbers) => self.cutter(record, numbers, 6),
            Statement::Units(units) => self.set_units(record, *units),
            Statement::Multax(true) => {}
            Statement::Multax(false) => self.axis = Vector3::z(),
            Statement::Milling => self.writer.milling = true,
            Statement::Turning => self.turning(record),
            Statement::Mcs { axes, origin } => self.mcs(record, axes, origin),
            Statement::Msys { origin, x, y } => self.msys(record, *origin, [*x, *y]),
            Statement::Circle(circle) => {
                self.wait_for_end(record, UnfinishedCurve::Arc(circle.clone()));
            }
            Statement::ArcMove(arc) => self.wait_for_end(record, UnfinishedCurve::Turned(*arc)),
            Statement::SetOut(along) => self.set_out_along(record, *along),
            Statement::PartSurface(normal) => {
                self.part_surface = direction(Vector3::from(normal.unwrap_or([0.0, 0.0, 1.0])));
            }
            Statement::AlongArc(along) => self.along_arc(record, along, emit),
            Statement::Nurbs => self.begin_spline(record, emit),
            Statement::Knot(_) | Statement::Control { .. } => self.spline_data(record),
            Statement::WorkOffset { number, set } => self.work_offset(record, *number, *set, emit),
            Statement::Subprogram(number) => self.subprogram(record, *number, emit),
            Statement::Cycle(cycle) => self.cycle(record, cycle, emit),
            Statement::Cutcom(cutcom) => self.cutcom(record, *cutcom, emit),
            Statement::CutcomOnCentre(on_centre) => self.writer.says_points(*on_centre),
            Statement::Rotate(rotate) => self.rotate(record, rotate, emit),
            Statement::ToolAxis(axis) => self.tool_axis(record, *axis),
            Statement::Delay(delay) => self.delay(record, delay, emit),
            Statement::Stop => emit(ProgramStep::Command(Command::Stop)),
            Statement::Sync(mark) => self.sync(record, mark, emit),
            Statement::OptionalStop => emit(ProgramStep::Command(Command::OptionalStop)),
            Statement::ToolPath { name, tool } => {
                self.begin_operation(record, name, tool.as_deref(), emit);
            }
            Statement::EndOfPath => self.end_operation(record, emit),
            Statement::Print(text) => self.print(record, text, emit),
            Statement::PartName(text) => {
                emit(ProgramStep::Command(Command::Comment(as_remark(text.clone()))));
            }
            Statement::Insert(text) => self.insert(record, text, emit),
            Statement::ToolName(name) => self.tools.name = as_remark(name.clone()),
            Statement::Csys(_) => self.ignore(record),
            Statement::Remark(text) => {
                self.writer.remark(text);
                self.ignore(record);
            }
            Statement::Fini => self.fini(record, emit),
            Statement::Other { word, arguments, directive } => {
                self.other_word(record, word, arguments, *directive, emit);
            }
        }
    }

    /// Notes a record without a meaning for the program.
    fn ignore(&mut self, record: &Record<'_>) {
        self.count(record.statement.word(), record, WordUsage::Ignored);
    }

    /// Begins an operation of the CAM system.
    fn begin_operation(
        &mut self,
        record: &Record<'_>,
        name: &str,
        tool: Option<&str>,
        emit: &mut StepSink<'_>,
    ) {
        self.end_spline(record, emit);
        if self.tip.is_some() {
            let axis = self.frame.direction_to_part(self.axis);
            let begun = self.begun_with.take();
            let positions = begun.is_some_and(|begun| (begun - axis).norm() < ONE_AXIS);
            self.axis_before.get_or_insert(EndAxis { axis, positions });
        }
        self.due = true;
        // Every path of NX stands by itself: its first GOTO gives the axis if it is not Z.
        self.axis = Vector3::z();
        self.tools.name = as_remark(tool.unwrap_or_default().to_owned());
        let name = as_remark(name.to_owned());
        self.path = Some(excerpt(&name, SHOWN_NAME).into_owned());
        self.paths = true;
        let smoothing = self.reading.smoothing.of(&name);
        emit(ProgramStep::Command(Command::Operation(name)));
        self.smooth(smoothing, emit);
    }

    fn end_operation(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        self.end_spline(record, emit);
        self.path = None;
        emit(ProgramStep::Command(Command::OperationEnd));
    }

    fn delay(&mut self, record: &Record<'_>, delay: &Delay, emit: &mut StepSink<'_>) {
        match (delay, self.spindle.rpm) {
            (Delay::Seconds(seconds), _) => self.dwell(record, *seconds, emit),
            (Delay::Revolutions(turns), Some(rpm)) if rpm > 0.0 => {
                self.dwell(record, turns * 60.0 / rpm, emit);
            }
            (Delay::Revolutions(_), _) => self.fault(
                record,
                "dwell",
                "a dwell in revolutions needs a spindle speed".to_owned(),
                "put a SPINDL before it",
            ),
        }
    }

    fn dwell(&mut self, record: &Record<'_>, seconds: f64, emit: &mut StepSink<'_>) {
        if !(0.0..=LONGEST_DWELL).contains(&seconds) {
            self.fault(
                record,
                "dwell",
                format!("a dwell of {} s: from 0 to {LONGEST_DWELL} s is possible", Short(seconds)),
                "let the CAM system write another; a stop is OPSTOP or STOP",
            );
            return;
        }
        emit(ProgramStep::Command(Command::Dwell(seconds)));
    }

    fn count(&mut self, word: &str, record: &Record<'_>, usage: WordUsage) {
        let file = &self.reading.file;
        let counted = self.census.count(word, usage, || record_place(file, record));
        if !counted {
            self.fault(
                record,
                "words",
                format!("more than {MOST_WORDS} different words that post does not know"),
                "is this a cutter-location file?",
            );
        }
    }

    fn place(&self, record: &Record<'_>) -> Option<SourcePlace> {
        Some(record_place(&self.reading.file, record))
    }

    /// A word that is not carried out because the user takes it upon himself.
    fn allow(&mut self, word: &str, instead: &'static str, record: &Record<'_>) {
        let place = record_place(&self.reading.file, record);
        self.census.allow(word, instead, place);
    }

    #[cold]
    fn fault(&mut self, record: &Record<'_>, code: &'static str, message: String, help: &str) {
        let mut diagnostic = Diagnostic::error(code, message).at(self.place(record));
        if !help.is_empty() {
            diagnostic = diagnostic.help(help);
        }
        self.findings.push(diagnostic);
    }

    #[cold]
    fn warn(&mut self, record: &Record<'_>, code: &'static str, message: String) {
        let place = self.place(record);
        self.findings.push(Diagnostic::warning(code, message).at(place));
    }
}

/// Where a record stands.
pub(crate) fn record_place(file: &str, record: &Record<'_>) -> SourcePlace {
    let text = record.text();
    SourcePlace::new(file, record.line, &text, 0..text.len())
}
