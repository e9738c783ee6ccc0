//! The stages of a prediction, one after the other, in batches: a program becomes tasks, tasks become set-points, servos
//! follow them, and the tool is held against its path. Memory does not grow with the program.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::{Solver, Unreachable};
use post_motion::trajectory::{FillOutcome, Planner, TaskTime};
use post_motion::{SetPoints, Task};
use post_readback::tasks::{ProgramTask, ProgramTasks};
use post_readback::{BlockEffect, ProgramEvent, ProgramRun};

use super::found;
use super::prediction::Prediction;
use super::run::{PredictWatch, Predicted};
use super::stages::Stages;
use crate::failure::Failure;
use crate::nc_program;
use crate::nc_program::RunningProgram;
use crate::text::number;

/// Set-points of a batch.
const BATCH: usize = 256;

/// A tool that strays by more from a CL file, mm, hardly cuts its part.
const OTHER_PART: f64 = 1.0;

/// A program on the way to set-points, and what is made of them.
pub struct SetPointStream<'a> {
    /// The program, as messages call it.
    name: &'a str,
    machine: &'a Machine,
    /// Time between set-points, s.
    period: f64,
    reading: TaskReader<'a>,
    planner: Planner,
    stages: Stages<'a>,
    /// The batch in work; none before the first move.
    points: Option<SetPoints>,
    times: Vec<TaskTime>,
    /// The chains that the axes moved by, and the time from which each did, s.
    chains: Vec<(f64, Arc<Solver>)>,
}

impl<'a> SetPointStream<'a> {
    /// At the beginning of the program `name`, with set-points every `period` seconds.
    pub fn new(
        name: &'a str,
        run: ProgramRun<RunningProgram<'a>>,
        machine: &'a Machine,
        period: f64,
        stages: Stages<'a>,
    ) -> Self {
        Self {
            name,
            machine,
            period,
            reading: TaskReader {
                run,
                tasks: ProgramTasks::new(machine),
                planned: Vec::new(),
                ended: false,
            },
            planner: Planner::new(machine),
            stages,
            points: None,
            times: Vec::new(),
            chains: Vec::new(),
        }
    }

    /// Hands on a batch, or reads on where the planner wants more; false once all is done.
    ///
    /// # Errors
    /// Axes that cannot follow, or whoever listens fails.
    pub fn step(&mut self, watch: &mut dyn PredictWatch) -> Result<bool, Failure> {
        match self.fill(watch)? {
            FillOutcome::Full => Ok(true),
            FillOutcome::Ended => Ok(false),
            FillOutcome::Wants => self.read_on(watch),
        }
    }

    /// Makes set-points of what is planned, and hands them on.
    fn fill(&mut self, watch: &mut dyn PredictWatch) -> Result<FillOutcome, Failure> {
        let filled = match &mut self.points {
            None => FillOutcome::Wants,
            Some(points) => {
                let filled = self.planner.fill(points, BATCH, &mut self.times);
                let line = points.at.last().map_or(0, |at| at.line);
                filled.map_err(|fault| unreachable(fault, self.name, line))?
            }
        };
        self.stages.done(self.machine, &mut self.times);
        if let Some(points) = &mut self.points
            && filled != FillOutcome::Wants
        {
            let known = self.chains.last();
            if !points.is_empty()
                && known.is_none_or(|(_, known)| !Arc::ptr_eq(known, &points.solver))
            {
                self.chains.push((points.time(0), Arc::clone(&points.solver)));
            }
            self.stages.batch(points, &mut |sample| watch.sample(sample))?;
            points.clear();
        }
        Ok(filled)
    }

    /// Hands further tasks to the planner; false if the program ends without a move.
    fn read_on(&mut self, watch: &mut dyn PredictWatch) -> Result<bool, Failure> {
        let name = self.name;
        self.reading.more(watch, name);
        for planned in self.reading.planned.drain(..) {
            if let (None, Task::Move(first)) = (&self.points, &planned.task) {
                self.points = Some(SetPoints::new(Arc::clone(&first.solver), self.period));
                self.stages.servos.settle(&first.from.joints);
            }
            self.stages.ahead(&planned);
            let line = match &planned.task {
                Task::Move(task) => task.line,
                Task::Wait { line, .. } => *line,
            };
            let pushed = self.planner.push(planned.task);
            pushed.map_err(|fault| unreachable(fault, name, line))?;
        }
        if self.reading.ended {
            if self.points.is_none() {
                return Ok(false);
            }
            self.planner.end();
        }
        Ok(true)
    }

    /// What was found.
    ///
    /// # Errors
    /// A block of the program is refused, or whoever listens fails.
    pub fn finish(self, watch: &mut dyn PredictWatch) -> Result<Predicted, Failure> {
        let Self { name, machine, reading, stages, points, chains, .. } = self;
        if !reading.run.faults().is_empty() {
            // What stands behind a block that is not run counts from elsewhere.
            return Err(reading.run.into_faults().into());
        }
        let mut findings = reading.tasks.notes();
        if points.is_none() {
            findings.push(no_motion(name));
        }
        let report = reading.run.program().report();
        findings.extend(report.notes.iter().cloned());
        findings.extend(nc_program::unknown_words(name, report));
        found::warn(machine, &mut findings);
        let listen = &mut |sample: &_| watch.sample(sample);
        let found = stages.finish(machine, name, report.blocks, listen)?;
        findings.extend(other_part(name, &found));
        Ok(Predicted { found, findings, chains })
    }
}

/// Nothing moves in the program `name`.
fn no_motion(name: &str) -> Diagnostic {
    let message = "nothing moves in this program: no time, no feed and no error can be predicted";
    let help = "is it the program of this machine's control? `post read` says what is read of it";
    let place = SourcePlace::new(name, 1, "", 0..0);
    Diagnostic::warning("no-motion", message).help(help).at(Some(place))
}

/// The tool strays so far from a CL file that this is perhaps that of another part.
fn other_part(name: &str, found: &Prediction) -> Option<Diagnostic> {
    let tip = &found.contour.tip_mm;
    let file = found.against.as_ref().filter(|_| tip.largest > OTHER_PART)?;
    let message = format!("the tool strays by {:.3} mm from the path of {file}", tip.largest);
    let help = "is it the CL file that the program was made from, with the same tool length, mount and units? `post verify` says where they part";
    let place = SourcePlace::new(name, tip.nc_line, "", 0..0);
    Some(Diagnostic::warning("contour-far", message).help(help).at(Some(place)))
}

/// A program on the way to tasks.
struct TaskReader<'a> {
    run: ProgramRun<RunningProgram<'a>>,
    tasks: ProgramTasks,
    planned: Vec<ProgramTask>,
    ended: bool,
}

impl TaskReader<'_> {
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
