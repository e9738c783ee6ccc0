//! One run: records in, text and a report out.

use std::ops::Range;
use std::rc::Rc;
use std::sync::Arc;
use std::thread::Scope;

use post_grammar::{GotoRun, Record, SyntaxFault};
use post_machine::axis_words;
use post_machine::description::{Machine, Tcp};
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::part_anywhere::AxisWay;
use post_machine::work_spindle;
use post_plugin::{DialectSession, ModelSession};

use crate::accuracy::RunColumns;
use crate::blocks::{BlockStage, MotionBlock};
use crate::configuration::{BodyClearance, ChosenPoint, ConfigurationStage};
use crate::emit::{EmitStage, SpareWork};
use crate::expand::{ExpandStage, PathMove};
use crate::findings::Findings;
use crate::job_facts::JobFacts;
use crate::observer::{Observer, Observers, TextSink};
use crate::part_anywhere;
use crate::plan::{PlanStage, PlanWatch};
use crate::preview::{self, FilePreview, wants_planes};
use crate::program::{ClInterpreter, MoveFeed, ProgramStep, ReadingOptions};
use crate::refusal;
use crate::report::{AxisRange, DriveRange, PostingReport, ReportedDeviation, WaysAcross};
use crate::run_stages::RunBuffers;
use crate::shift::{PathShift, ShiftStage};
use crate::stream::{BATCH, BatchSink, StreamItem};
use crate::tightening::Tightening;
use crate::timing::TimingStage;
use crate::window::LineWindow;

/// How one CL file is to be posted.
#[derive(Clone, Debug, Default)]
pub struct PostingRequest {
    /// How it is read.
    pub reading: ReadingOptions,
    /// Length of every tool, mm, over what machine and CL file say.
    pub tool_length: Option<f64>,
    /// Take the model's word over the certificate's.
    pub trust_model: bool,
    /// What a first pass found out; without one the tool is taken to turn anywhere.
    pub ahead: Option<Arc<FilePreview>>,
    /// What texts of the program can speak of.
    pub facts: JobFacts,
    /// Every hole goes by its moves, a thread too, which only the control's own cycle can cut: for a run of which nothing
    /// is written.
    pub holes_as_moves: bool,
    /// The feed is planned: `[plan]`.
    pub plans: bool,
    /// Where that plan may use less than the limit of the contour error.
    pub tightening: Option<Arc<Tightening>>,
    /// Most points that go through the stages together: what is written does not depend on it. As many as are worth it,
    /// if nothing is said.
    pub longest_run: Option<usize>,
    /// Lines of the CL file that become the program, if not all: those before them set the state that it begins in.
    pub lines: Option<Vec<Range<u64>>>,
}

/// Posts one CL file, record by record: the stages, and what lies between them.
pub struct Post<'a> {
    machine: &'a Machine,
    interpreter: ClInterpreter,
    window: Option<LineWindow>,
    /// Steps that the stages have not seen yet, each with its line.
    steps: Vec<(u64, ProgramStep)>,
    stages: PostStages<'a>,
    findings: Findings,
    records: u64,
    last_line: u64,
}

/// The stages after the interpreter, and the batches between them.
pub(crate) struct PostStages<'a> {
    pub(crate) expand: ExpandStage,
    pub(crate) shift: Option<ShiftStage<'a>>,
    lines: Vec<StreamItem<PathMove>>,
    pub(crate) configuration: ConfigurationStage<'a>,
    configured: Vec<StreamItem<ChosenPoint>>,
    pub(crate) blocks: BlockStage<'a>,
    made: Vec<StreamItem<MotionBlock>>,
    pub(crate) plan: Option<PlanStage<'a>>,
    planned: Vec<StreamItem<MotionBlock>>,
    pub(crate) timing: TimingStage<'a>,
    pub(crate) observers: Rc<Observers<'a>>,
    pub(crate) emit: EmitStage<'a>,
    pub(crate) runs: RunBuffers,
}

/// What the stages are to do.
enum StageInput<'s> {
    /// Take these steps.
    Take(&'s [(u64, ProgramStep)]),
    /// The file ended on this line.
    Finish(u64),
}

impl PostStages<'_> {
    /// Runs a batch through all stages. Nothing is left between them; what a stage cannot decide yet it keeps.
    fn run(&mut self, work: StageInput<'_>) {
        let Self {
            expand,
            shift,
            lines,
            configuration,
            configured,
            blocks,
            made,
            plan,
            planned,
            timing,
            emit,
            ..
        } = self;
        let last_line = match &work {
            StageInput::Take(_) => None,
            StageInput::Finish(line) => Some(*line),
        };
        let finish = last_line.is_some();
        // A batch goes through the stages by calls: what a stage hands on is the input of the closure before it here, so
        // that the stages are joined from the last to the first.
        let mut to_emit = |made: &mut Vec<StreamItem<MotionBlock>>| {
            timing.take(made);
            emit.take(made);
        };
        let mut planned = BatchSink::new(planned, &mut to_emit);
        let mut to_plan = |made: &mut Vec<StreamItem<MotionBlock>>| match plan {
            Some(plan) => plan.take(made, &mut planned),
            None => planned.pass(made),
        };
        let mut made = BatchSink::new(made, &mut to_plan);
        let mut to_blocks =
            |configured: &mut Vec<StreamItem<ChosenPoint>>| blocks.take(configured, &mut made);
        let mut configured = BatchSink::new(configured, &mut to_blocks);
        let mut to_configuration = |lines: &mut Vec<StreamItem<PathMove>>| {
            if let Some(shift) = shift {
                shift.take(lines);
            }
            configuration.take(lines, &mut configured);
        };
        let mut lines = BatchSink::new(lines, &mut to_configuration);
        match work {
            StageInput::Take(steps) => expand.take(steps, &mut lines),
            StageInput::Finish(line) => expand.finish(line, &mut lines),
        }
        // From the first stage to the last: what a stage still holds goes on before the next stage is finished.
        lines.flush();
        if finish {
            configuration.finish(&mut configured);
        }
        configured.flush();
        if let Some(line) = last_line {
            blocks.finish(line, &mut made);
        }
        made.flush();
        if let (Some(plan), true) = (plan, finish) {
            plan.finish(&mut planned);
        }
        planned.flush();
        if let Some(line) = last_line {
            emit.finish(line);
        }
    }

    /// Runs steps through all stages, one by one.
    pub(crate) fn take_alone(&mut self, steps: &[(u64, ProgramStep)]) {
        self.run(StageInput::Take(steps));
    }

    /// Line of the CL file before which no finding will be made any more.
    fn settled_line(&self) -> Option<u64> {
        let kept = [
            self.expand.first_line(),
            self.configuration.first_line(),
            self.blocks.first_line(),
            self.plan.as_ref().and_then(PlanStage::first_line),
            self.emit.first_line(),
        ];
        kept.into_iter().flatten().min()
    }
}

impl<'a> Post<'a> {
    /// Opens a run; the header goes out with the first batch.
    ///
    /// # Errors
    /// What machine and dialect cannot do together.
    pub fn new(
        machine: &'a Machine,
        mut job: PostingRequest,
        dialect: &'a mut dyn DialectSession,
        model: &'a mut dyn ModelSession,
        output: &'a mut dyn TextSink,
    ) -> Result<Self, Box<Diagnostic>> {
        job.reading = ReadingOptions { plans: job.plans, ..job.reading.on(machine) };
        let format = dialect.format().clone();
        let fault = refusal::too_fine(machine, &format)
            .or_else(|| refusal::depth_counts_down(machine))
            .or_else(|| refusal::no_way_off(machine))
            .or_else(|| refusal::retract_not_said(machine, dialect.capabilities()))
            .or_else(|| refusal::no_park(machine, dialect.capabilities()))
            .or_else(|| refusal::no_smoothing(machine, dialect.capabilities()))
            .or_else(|| refusal::no_instead(machine, dialect.capabilities()))
            .or_else(|| refusal::no_word_letter(machine, dialect.capabilities()))
            .or_else(|| refusal::no_signed_way(machine, dialect.capabilities()))
            .or_else(|| refusal::plane_of_turned_slide(machine, dialect.capabilities()))
            .or_else(|| refusal::no_poses(machine, dialect.capabilities(), job.plans));
        if let Some(fault) = fault {
            return Err(fault.boxed());
        }
        let writes = dialect.capabilities();
        let planes = wants_planes(machine, writes);
        let ahead = job.ahead.filter(|_| preview::is_wanted(machine, writes));
        let findings = Findings::new(job.reading.files());
        let expand =
            ExpandStage::new(machine, job.reading.chord_tolerance, writes, ahead, &findings);
        let mut stages = PostStages {
            expand: if job.holes_as_moves { expand.by_moves_alone() } else { expand },
            shift: None,
            lines: Vec::new(),
            timing: TimingStage::new(machine, &format, writes, &findings)?,
            configuration: ConfigurationStage::new(
                machine,
                &format,
                job.tool_length,
                writes,
                &findings,
            )?,
            configured: Vec::new(),
            blocks: BlockStage::new(machine, writes, &format, model, job.trust_model, &findings),
            made: Vec::new(),
            plan: job.plans.then(|| PlanStage::new(machine, &format, job.tightening, &findings)),
            planned: Vec::new(),
            observers: Rc::default(),
            emit: EmitStage::new(machine, &job.facts, dialect, output, &findings),
            // A word that goes with the way is written block by block.
            runs: RunBuffers::new(match machine.along {
                Some(_) => 0,
                None => job.longest_run.unwrap_or(usize::MAX),
            }),
        };
        if job.plans {
            stages.blocks.plans();
        }
        if machine.control.planes == Some(true) && !planes {
            findings.add(refusal::no_planes(machine));
        }
        Ok(Self {
            machine,
            findings,
            interpreter: ClInterpreter::new(job.reading),
            window: job.lines.map(LineWindow::new),
            steps: Vec::with_capacity(BATCH),
            stages,
            records: 0,
            last_line: 0,
        })
    }

    /// Shows what is made to `observer` from here on.
    pub fn watch(&mut self, observer: &'a mut dyn Observer) {
        let stages = &mut self.stages;
        stages.observers.add(observer);
        stages.blocks.watch(Rc::clone(&stages.observers));
        stages.emit.watch(Rc::clone(&stages.observers));
    }

    /// Has dialect and output at work on a thread of `scope` from here on, beside all before them: program, report and
    /// findings are the same. Where no thread can be started they stay here. While no text waits the thread does `spare`
    /// work.
    pub fn write_beside<'s>(&mut self, scope: &'s Scope<'s, '_>, spare: SpareWork<'s>)
    where
        'a: 's,
    {
        self.stages.emit.write_beside(scope, spare);
    }

    /// Shows the planned feed to `watch`, where one is planned.
    pub fn watch_plan(&mut self, watch: &'a mut dyn PlanWatch) {
        if let Some(plan) = &mut self.stages.plan {
            plan.watch(watch);
        }
    }

    /// Has the points of cuts moved by `shift`, none by more than `[accuracy] servo_compensation`. What is certified is
    /// then the path of the moved points.
    pub fn shift(&mut self, shift: &'a mut dyn PathShift) {
        let bound = self.machine.accuracy.servo_compensation.unwrap_or(0.0);
        self.stages.shift = Some(ShiftStage::new(shift, bound));
    }

    /// Has solutions chosen with which bodies of the machine stay clear of one another, as far as `bodies` says.
    pub fn keep_clear(&mut self, bodies: &'a mut dyn BodyClearance) {
        self.stages.configuration.keep_clear(bodies);
    }

    /// Has ways between passes go only as high as `bodies` asks for, or past them.
    pub fn go_across(&mut self, bodies: &'a mut dyn BodyClearance) {
        self.stages.blocks.go_across(bodies);
    }

    /// Takes a record.
    #[inline]
    pub fn record(&mut self, record: &Record<'_>) {
        if self.interpreter.file_begins(record.line) {
            self.begin_file(record.line);
        }
        self.records += 1;
        self.last_line = record.line;
        let (stages, steps) = (&self.stages, &self.steps);
        let waiting = steps.first().map(|(line, _)| *line);
        self.findings.read(record, || [waiting, stages.settled_line()].into_iter().flatten().min());
        self.interpret(record);
    }

    /// The file behind the one that is read begins on this line.
    #[cold]
    fn begin_file(&mut self, line: u64) {
        self.run();
        self.end_of_file(self.interpreter.ends_in_line_end());
        self.interpreter.end_file();
        let Self { interpreter, window, steps, .. } = self;
        interpreter.begin_file(&mut |step| match window {
            None => steps.push((line, step)),
            Some(window) => window.step(line, step, steps),
        });
        self.gather();
        self.run();
    }

    /// Says where the file that ends here may be cut off.
    fn end_of_file(&self, line_end: bool) {
        let last = self.findings.text(self.last_line);
        if let Some(finding) = self.interpreter.cut_off(&last, line_end) {
            self.findings.at(self.last_line, finding);
        }
    }

    /// Takes a record whose text is kept.
    #[inline]
    fn interpret(&mut self, record: &Record<'_>) {
        let steps = &mut self.steps;
        match &mut self.window {
            None => self.interpreter.record(record, &mut |step| steps.push((record.line, step))),
            Some(window) => self.interpreter.record(record, &mut |step| {
                window.step(record.line, step, steps);
            }),
        }
        if let Some(window) = &mut self.window
            && let Some(line) = window.take_cut_from_outside()
        {
            self.findings.at(line, refusal::cut_from_outside());
        }
        if self.interpreter.has_findings() {
            // What the stages find in the lines before comes before it.
            self.run();
            self.gather();
        }
        if self.steps.len() >= BATCH {
            self.run();
        }
    }

    /// Takes the records of a run, whose text this is: [`Self::record`] of each, until it is given up.
    pub fn gotos(&mut self, run: &GotoRun, text: &[u8]) {
        let (stages, steps) = (&self.stages, &self.steps);
        let waiting = steps.first().map(|(line, _)| *line);
        let settled = || [waiting, stages.settled_line()].into_iter().flatten().min();
        self.findings.read_run(run, text, settled);
        let mut pace = self.plain_pace();
        let taken = pace.map_or(0, |pace| self.take_columns(run, pace));
        for place in taken..run.count() {
            self.records += 1;
            self.last_line = run.line(place);
            let plain = |pace| self.interpreter.plain_move(&run.point(place), run.has_axis(), pace);
            match pace.and_then(plain) {
                Some(motion) => self.steps.push((self.last_line, ProgramStep::Move(motion))),
                None => {
                    self.interpret(&run.record(place, text));
                    pace = self.plain_pace();
                }
            }
            if self.steps.len() >= BATCH {
                self.run();
            }
            if self.gave_up() {
                return;
            }
        }
    }

    /// The pace of plain `GOTO`s whose moves need not be looked at one by one.
    fn plain_pace(&self) -> Option<MoveFeed> {
        self.interpreter.plain_pace().filter(|_| self.window.is_none())
    }

    /// Takes the first records of a run straight into the columns of the stages; gives how many.
    fn take_columns(&mut self, run: &GotoRun, pace: MoveFeed) -> usize {
        let MoveFeed::PerMinute(feed) = pace else {
            return 0;
        };
        // What waits goes before it, and few steps are better off among others.
        let waits = !self.steps.is_empty();
        let few = waits && run.count() < GotoRun::MOST;
        if few || !self.stages.takes_columns(run.count(), run.last_line(), &self.findings) {
            return 0;
        }
        if waits {
            self.run();
        }
        let (stages, interpreter) = (&mut self.stages, &mut self.interpreter);
        let fill = |columns: &mut RunColumns| {
            interpreter.plain_columns(run, &mut columns.tip, &mut columns.axis)
        };
        let taken = stages.take_gotos(run, feed, &self.findings, fill);
        if let Some(last) = taken.checked_sub(1) {
            // The interpreter stands at the end of what was taken.
            interpreter.plain_move(&run.point(last), run.has_axis(), pace);
            self.records += taken as u64;
            self.last_line = run.line(last);
        }
        taken
    }

    fn run(&mut self) {
        self.stages.take_steps(&self.steps, &self.findings);
        self.steps.clear();
        if self.findings.failed() {
            // Whether it is given up hangs on what is wrong with the text before.
            self.stages.emit.settle();
        }
    }

    /// Takes a line that could not be read.
    pub fn unreadable(&mut self, fault: &SyntaxFault) {
        self.run();
        self.records += 1;
        self.last_line = fault.line;
        self.findings.unreadable(fault);
    }

    /// The input has ended; `line_end` says whether a line end stands after its last line. Of a file that was cut off
    /// no program is made.
    pub fn ended(&mut self, line_end: bool) {
        if self.records == 0 {
            return;
        }
        self.run();
        self.end_of_file(line_end);
    }

    /// Whether there are so many faults that reading on would only repeat them.
    #[inline]
    pub fn gave_up(&self) -> bool {
        self.findings.too_many()
    }

    /// Ends the run: the report, if all is good, and every finding, in the order of the lines.
    pub fn finish(mut self) -> (Option<PostingReport>, Vec<Diagnostic>) {
        if !self.gave_up() {
            self.run();
            self.interpreter.finish();
            self.gather();
            let end = StageInput::Finish(self.last_line);
            self.stages.run(end);
        }
        self.stages.emit.settle();
        let configuration = &self.stages.configuration;
        if !self.findings.failed() && configuration.moves() == 0 {
            let file = self.findings.file();
            self.findings.add(
                Diagnostic::error("empty", format!("{file} has no move"))
                    .help("is it a cutter-location file (APT, CLSF, NCL), or a list of points?"),
            );
        }
        if let Some(warning) = self.stages.timing.low_feeds() {
            self.findings.add(warning);
        }
        if let Some(warning) = work_spindle::beside(self.machine) {
            self.findings.add(warning);
        }
        let mut report = (!self.findings.failed()).then(|| self.report());
        let found = report.as_ref().and_then(|report| {
            let too_long = |way: &AxisWay<'_>| self.fits_nowhere(way);
            part_anywhere::judge(self.machine, &report.axes, &report.tools, too_long)
        });
        if let Some(found) = found {
            self.findings.add(found);
            report = report.filter(|_| !self.findings.failed());
        }
        (report, self.findings.sorted())
    }

    /// The program goes farther than an axis, on which lines.
    fn fits_nowhere(&self, way: &AxisWay<'_>) -> Diagnostic {
        let joint = self.machine.axes.iter().position(|axis| axis.name == way.name);
        let lines = self.stages.emit.extremes().lines_of(joint.unwrap_or_default());
        let [first, last] = lines.map(|line| self.findings.files().line(line));
        // The text of a line that went by is known or not, as the runs fall.
        let place = SourcePlace::new(self.findings.file(), lines[0].max(lines[1]), "", 0..0);
        way.too_long([&first, &last]).at(Some(place))
    }

    /// Takes the findings of the interpreter.
    #[cold]
    fn gather(&mut self) {
        for finding in self.interpreter.take_findings() {
            // Of several files the sentence must say which.
            match self.interpreter.files_begun() > 0 && finding.place.is_none() {
                true => self.findings.at(self.last_line, finding),
                false => self.findings.add(finding),
            }
        }
    }

    fn report(&self) -> PostingReport {
        let machine = self.machine;
        let stages = &self.stages;
        let counts = stages.blocks.counts();
        let durations = stages.timing.statistics();
        let extremes = stages.emit.extremes();
        let between = stages.blocks.between_words();
        let [tip, axis, rapid] = extremes.deviations;
        let axes = axis_words::order(machine)
            .into_iter()
            .map(|index| {
                let (axis, travel) = (&machine.axes[index], machine.travel_of(index));
                AxisRange {
                    name: axis.name.clone(),
                    min: tidy(axis.reading(extremes.least[index].min(between.least(index)))),
                    max: tidy(axis.reading(extremes.most[index].max(between.most(index)))),
                    travel: travel.map(|travel| travel.map(|end| tidy(axis.reading(end)))),
                    way: tidy((extremes.travel[index] + between.beside(index)) / axis.unit()),
                }
            })
            .collect();
        let drives = stages.emit.drives().iter().map(|drive| DriveRange {
            min: tidy(drive.min),
            max: tidy(drive.max),
            travel: drive.travel.map(|travel| travel.map(tidy)),
            ..drive.clone()
        });
        PostingReport {
            drives: drives.collect(),
            machine: machine.name.clone(),
            dialect: machine.control.dialect.clone(),
            tcp: match machine.control.tcp {
                Tcp::Control => "control",
                Tcp::Post => "post",
            }
            .to_owned(),
            model: machine.accuracy.model.clone(),
            mount_mm: machine.mount_said.then(|| machine.mount.into()),
            turn_deg: Some(machine.turn.to_degrees()).filter(|turn| *turn != 0.0).map(tidy),
            cl_files: self.findings.files().clone(),
            left_out: Vec::new(),
            records: self.records,
            moves: stages.configuration.moves(),
            blocks: extremes.blocks,
            curves: extremes.curves,
            nc_lines: stages.emit.lines(),
            points_added: counts.points_added,
            points_dropped: counts.points_dropped,
            model_asked: stages.blocks.asked(),
            model_overruled: stages.blocks.overruled(),
            tip_deviation_mm: tip,
            axis_deviation_deg: ReportedDeviation { value: axis.value.to_degrees(), ..axis },
            rapid_deviation_mm: rapid,
            rapids_along_axes: counts.along_axes,
            control_point: machine.control_point,
            tolerance_mm: machine.accuracy.tolerance,
            axis_tolerance_deg: machine.accuracy.axis_tolerance.to_degrees(),
            axes,
            tools: stages.configuration.tools().to_vec(),
            branch_changes: counts.branch_changes,
            plan: stages.plan.as_ref().map(PlanStage::report),
            rewinds: counts.rewinds + stages.expand.rewinds(),
            points_eased: counts.eased,
            time_s: (durations.cutting + durations.other) * 60.0,
            cutting_time_s: durations.cutting * 60.0,
            blocks_limited: durations.limited,
            blocks_capped: durations.capped,
            fast_rapids: stages.timing.rapids().found().clone(),
            ways_across: stages
                .blocks
                .ways_across()
                .map(|ways| WaysAcross { saved_s: tidy(ways.saved_s), ..ways }),
            ignored_words: self
                .interpreter
                .ignored()
                .map(|(word, count)| (word.to_owned(), count))
                .collect(),
            plugins: Vec::new(),
            waits: stages.timing.waits().to_vec(),
            warnings: self.findings.warnings(),
        }
    }
}

/// Without what radians and sums leave in the last bits: -119.99999999999999° is -120°, and no zero is negative.
fn tidy(value: f64) -> f64 {
    libm::rint(value * 1e9) / 1e9 + 0.0
}
