//! The stages of a prediction, one behind the other, in batches: a program becomes tasks, tasks become set-points, servos
//! follow them, and the tool is held against its path. Memory does not grow with the program.

use std::io::{BufReader, Read, Seek};
use std::ops::Range;
use std::sync::Arc;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::{Solver, Unreachable};
use post_motion::trajectory::{FillOutcome, Planner};
use post_motion::{SetPoints, Task};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::tasks::{ProgramTask, ProgramTasks};
use post_readback::{BlockEffect, Offsets, ProgramEvent, ProgramRun};

use super::prediction::Prediction;
use super::sample::Sample;
use super::stages::Stages;
use super::{cl_path, found};
use crate::failure::Failure;
use crate::files::Watched;
use crate::files::{ClSource, FileFault};
use crate::nc_program::{self, NcControl};
use crate::read_back;
use crate::session::Session;
use crate::settings::JobSettings;
use crate::text::number;

/// Set-points of a batch.
const BATCH: usize = 256;

/// A tool that strays by more from a CL file, mm, hardly cuts its part.
const OTHER_PART: f64 = 1.0;

/// What a program is predicted with.
pub struct Asked<'a> {
    /// The run.
    pub session: &'a Session,
    /// What the job is.
    pub arguments: &'a JobSettings,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// Its plugins.
    pub finder: &'a Finder,
    /// What stands in the control's tables; none: as the machine file, the command line and the CL file say.
    pub offsets: Option<Offsets>,
    /// How far a program may go.
    pub limits: Limits,
    /// Time between set-points, s, over the machine file's.
    pub period: Option<f64>,
    /// Lines of the CL file that the program is made of; none: all.
    pub lines: Option<Range<u64>>,
}

impl Asked<'_> {
    /// Time between set-points, s.
    pub fn period(&self) -> f64 {
        self.period.unwrap_or(self.machine.motion.period)
    }
}

/// What the tool is held against, besides the path that is commanded.
pub enum Against<'a> {
    /// Nothing.
    Nothing,
    /// The path of a CL file.
    Cl(&'a mut ClSource),
}

/// Who looks on while a program is predicted.
pub trait PredictWatch {
    /// What the program does next, before its set-points.
    fn done(&mut self, _done: &BlockEffect) {}

    /// The next set-point.
    ///
    /// # Errors
    /// What is made of it cannot be kept.
    fn sample(&mut self, sample: &Sample) -> Result<(), Failure>;
}

impl<F: FnMut(&Sample) -> Result<(), Failure>> PredictWatch for F {
    fn sample(&mut self, sample: &Sample) -> Result<(), Failure> {
        self(sample)
    }
}

/// What came of it.
pub struct Predicted {
    /// What was found.
    pub found: Prediction,
    /// What was taken for granted: warnings.
    pub findings: Vec<Diagnostic>,
    /// The chains that the axes moved by, and the time from which each did, s.
    pub chains: Vec<(f64, Arc<Solver>)>,
}

/// Predicts the program `name` from `input`; every set-point is told in order.
///
/// # Errors
/// The machine cannot be used, a block of the program or the CL file cannot be read, or whoever listens fails.
pub fn predict<R: Read + Seek>(
    asked: &Asked<'_>,
    against: Against<'_>,
    name: &str,
    input: R,
    watch: &mut dyn PredictWatch,
) -> Result<Predicted, Failure> {
    let period = asked.period();
    let spoken = nc_program::spoken(asked.finder, asked.machine)?;
    let mut tools = Vec::new();
    // The file was read once before: what is wrong with it is known.
    let mut faults = Vec::new();
    let path = match against {
        Against::Nothing => None,
        Against::Cl(source) => {
            tools = cl_path::tools(asked, source)?;
            Some(cl_path::open(asked, source, &mut faults)?)
        }
    };
    let offsets = match &asked.offsets {
        Some(offsets) => offsets.clone(),
        None => read_back::offsets(asked.arguments, asked.machine, &tools),
    };
    // The control's own period stays: it says how corners are passed, and not how closely we look.
    let control = NcControl::of(asked.machine, spoken, offsets, asked.limits);
    let machine = &control.counted;
    let unreadable = |error| FileFault::Read { name: name.to_owned(), error };
    let (input, length) = Watched::new(input).map_err(unreadable)?;
    let position = input.position();
    let input = BufReader::new(input);
    let mut reading = Reading {
        run: control.run(name, input).map_err(|fault| *fault)?,
        tasks: ProgramTasks::new(machine),
        planned: Vec::new(),
        ended: false,
    };
    let mut stages = Stages::new(machine, period, path)?;
    let mut planner = Planner::new(machine);
    let mut points: Option<SetPoints> = None;
    let mut times = Vec::new();
    let mut chains: Vec<(f64, Arc<Solver>)> = Vec::new();
    let mut progress = asked.session.progress(Some(length));
    loop {
        progress.record(|| position.get());
        let filled = match &mut points {
            None => FillOutcome::Wants,
            Some(points) => {
                let filled = planner.fill(points, BATCH, &mut times);
                let line = points.at.last().map_or(0, |at| at.line);
                filled.map_err(|fault| unreachable(fault, name, line))?
            }
        };
        stages.done(machine, &mut times);
        if let Some(points) = &mut points
            && filled != FillOutcome::Wants
        {
            let known = chains.last();
            if !points.is_empty()
                && known.is_none_or(|(_, known)| !Arc::ptr_eq(known, &points.solver))
            {
                chains.push((points.time(0), Arc::clone(&points.solver)));
            }
            stages.batch(points, &mut |sample| watch.sample(sample))?;
            points.clear();
        }
        match filled {
            FillOutcome::Full => {}
            FillOutcome::Ended => break,
            FillOutcome::Wants => {
                reading.more(watch, name);
                for planned in reading.planned.drain(..) {
                    if let (None, Task::Move(first)) = (&points, &planned.task) {
                        points = Some(SetPoints::new(Arc::clone(&first.solver), period));
                        stages.servos.settle(&first.from.joints);
                    }
                    stages.ahead(&planned);
                    let line = match &planned.task {
                        Task::Move(task) => task.line,
                        Task::Wait { line, .. } => *line,
                    };
                    planner.push(planned.task).map_err(|fault| unreachable(fault, name, line))?;
                }
                if reading.ended {
                    if points.is_none() {
                        break;
                    }
                    planner.end();
                }
            }
        }
    }
    progress.finish();
    if !reading.run.faults().is_empty() {
        // What stands behind a block that is not run counts from elsewhere.
        return Err(reading.run.into_faults().into());
    }
    let mut findings = reading.tasks.notes();
    if points.is_none() {
        let message =
            "nothing moves in this program: no time, no feed and no error can be predicted";
        let help =
            "is it the program of this machine's control? `post read` says what is read of it";
        let place = SourcePlace::new(name, 1, "", 0..0);
        let finding = Diagnostic::warning("no-motion", message).help(help);
        findings.push(finding.at(Some(place)));
    }
    let report = reading.run.program().report();
    findings.extend(report.notes.iter().cloned());
    findings.extend(nc_program::unknown_words(name, report));
    found::warn(machine, &mut findings);
    let found = stages.finish(machine, name, report.blocks, &mut |sample| watch.sample(sample))?;
    if let Some(file) = &found.against
        && found.contour.tip_mm.largest > OTHER_PART
    {
        let message = format!(
            "the tool strays by {:.3} mm from the path of {file}",
            found.contour.tip_mm.largest
        );
        let help = "is it the CL file that the program was made from, with the same tool length, mount and units? `post verify` says where they part";
        let place = SourcePlace::new(name, found.contour.tip_mm.nc_line, "", 0..0);
        let finding = Diagnostic::warning("contour-far", message).help(help);
        findings.push(finding.at(Some(place)));
    }
    Ok(Predicted { found, findings, chains })
}

/// A program on the way to tasks.
struct Reading<R> {
    run: ProgramRun<Interpreter<R>>,
    tasks: ProgramTasks,
    planned: Vec<ProgramTask>,
    ended: bool,
}

impl<R: Read + Seek> Reading<R> {
    /// Runs blocks until there is a task, or the program ends.
    fn more(&mut self, watch: &mut dyn PredictWatch, name: &str) {
        while self.planned.is_empty() && !self.ended {
            let Some(done) = self.run.block() else {
                self.tasks.end(&mut self.planned);
                self.ended = true;
                return;
            };
            done.iter().for_each(|done| watch.done(done));
            let head = head(done, name);
            self.tasks.take(done, &mut self.planned);
            if let Some(head) = head {
                self.run.refuse(head);
            }
        }
    }
}

/// A head was swapped in: from here on the axes are others.
fn head(done: &[BlockEffect], name: &str) -> Option<Diagnostic> {
    done.iter().find_map(|done| match done {
        BlockEffect::Event { line, event: ProgramEvent::Head(head) } => {
            let message = format!("head {head} is swapped in: other axes move from here on");
            let help = "predict the programs of its heads one by one (post --split tools)";
            let place = SourcePlace::new(name, *line, "", 0..0);
            Some(Diagnostic::error("head", message).help(help).at(Some(place)))
        }
        _ => None,
    })
}

/// The axes cannot follow a move.
fn unreachable(fault: Unreachable, name: &str, line: u64) -> Diagnostic {
    let message = match fault {
        Unreachable::Axis { miss } => format!(
            "on this way no rotary angles give the tool axis, by {}°",
            number(miss.to_degrees(), 4)
        ),
        Unreachable::Linear => "on this way the linear axes lie in a plane".to_owned(),
        Unreachable::Numeric { miss } => format!(
            "on this way no axis values were found that give tip and tool axis, by {} mm",
            number(miss, 4)
        ),
    };
    let place = SourcePlace::new(name, line, "", 0..0);
    let help = "tool lengths and work offsets may be others: --tool-length, --offsets, --mount";
    Diagnostic::error("motion-unreachable", message).help(help).at(Some(place))
}
