//! What a program is predicted with, and who looks on.

use std::io::BufReader;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::Arc;
use std::thread;

use post_host::Finder;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Solver;
use post_readback::interpret::Limits;
use post_readback::{BlockEffect, Offsets};

use super::cl_path;
use super::prediction::Prediction;
use super::sample::Sample;
use super::set_point_stream::SetPointStream;
use super::stages::Stages;
use super::trajectory::Trajectory;
use crate::beside::Work;
use crate::cl_facts::ClFacts;
use crate::failure::Failure;
use crate::files::{ClSource, FileFault, Watched};
use crate::nc_program::{self, NcControl, ProgramText};
use crate::read_back;
use crate::session::Session;
use crate::settings::JobSettings;

/// News of a trajectory that are handed over together: fewer are worth less than waking a thread.
const TOGETHER: usize = 256;

/// What a program is predicted with.
pub struct PredictionSetup<'a> {
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
    pub lines: Option<Vec<Range<u64>>>,
    /// Threads that it is predicted on at most.
    pub threads: NonZeroUsize,
}

impl PredictionSetup<'_> {
    /// Time between set-points, s.
    pub fn period(&self) -> f64 {
        self.period.unwrap_or(self.machine.motion.period)
    }
}

/// What the tool is held against, besides the path that is commanded.
pub enum PredictReference<'a> {
    /// Nothing.
    Nothing,
    /// The path of a CL file.
    Cl(&'a mut ClSource),
}

/// Who looks on while a program is predicted.
pub trait PredictWatch {
    /// What the program does next, before its set-points; told if it [sees blocks](Self::sees_blocks).
    fn done(&mut self, _done: &BlockEffect) {}

    /// It wants to know what blocks do.
    fn sees_blocks(&self) -> bool {
        false
    }

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
pub fn predict(
    asked: &PredictionSetup<'_>,
    against: PredictReference<'_>,
    name: &str,
    input: ProgramText<'_>,
    watch: &mut dyn PredictWatch,
) -> Result<Predicted, Failure> {
    let spoken = nc_program::spoken(asked.finder, asked.machine)?;
    let mut tools = Vec::new();
    // Nothing wrong was found when it was read before: what is found now is a disk that fails.
    let mut faults = Vec::new();
    let path = match against {
        PredictReference::Nothing => None,
        PredictReference::Cl(source) => {
            tools = ClFacts::of_job(asked.arguments, asked.machine, source)?.tools;
            Some(cl_path::open(asked, source, &mut faults)?)
        }
    };
    let offsets = match &asked.offsets {
        Some(offsets) => offsets.clone(),
        None => read_back::offsets(asked.arguments, asked.machine, &tools),
    };
    // The control's own period stays: it says how corners are passed, and not how closely we look.
    let control = NcControl::of(asked.machine, spoken, offsets, asked.limits);
    let unreadable = |error| FileFault::Read { name: name.to_owned(), error };
    let (input, length) = Watched::new(input).map_err(unreadable)?;
    let position = input.position();
    let run = control.run(name, BufReader::new(input)).map_err(|fault| *fault)?;
    let (machine, period) = (&control.machine, asked.period());
    let stages = Stages::new(machine, period, path)?;
    let mut stream = SetPointStream::new(name, machine, stages);
    let trajectory = Trajectory::new(name, run, machine, period, watch.sees_blocks());
    let mut trajectory = trajectory.stoppable(asked.session);
    let mut progress = asked.session.progress(Some(length));
    let beside = asked.threads > NonZeroUsize::MIN;
    thread::scope(|scope| {
        let mut work = Work::start(scope, &mut trajectory, beside.then_some(TOGETHER));
        let mut batch = Vec::new();
        while work.next(&mut batch) {
            progress.some_records(batch.len() as u64, || position.get());
            for news in &mut batch {
                asked.session.go_on().map_err(unreadable)?;
                stream.take(news, watch)?;
            }
        }
        asked.session.go_on().map_err(unreadable)?;
        Ok::<(), Failure>(())
    })?;
    progress.finish();
    let predicted = stream.finish(trajectory, watch)?;
    match faults.is_empty() {
        true => Ok(predicted),
        false => Err(faults.into()),
    }
}
