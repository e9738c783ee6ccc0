//! Studies: many CL files on many machines with many settings, done here or handed over to other computers.

use std::num::NonZeroUsize;
use std::path::Path;

use super::{NamedOption, Refusal, StopSignal, quietly, refused};
use crate::batch::{self, Inputs, JobLine, JobOutcome, JobStudy, Journal};
use crate::files::{self, PathArg, Role};
use crate::session::Session;
use crate::settings::{ReadingSettings, StudySettings, tell};
use post_machine::diagnostic::Diagnostic;

pub use crate::batch::{StudyColumn, StudyTable, StudyValues};

/// Jobs that are done, and of them those that are not written; whoever is told answers whether to go on.
pub type Progressed<'p> = &'p mut dyn FnMut(usize, usize) -> bool;

const RESULTS: Role = Role { what: "table of results", remedy: "name another file" };

/// What is asked of every job, by the names of `post batch`.
fn settings(options: &[NamedOption]) -> Result<StudySettings, Box<Diagnostic>> {
    let mut reading = ReadingSettings::default();
    let mut settings = StudySettings::default();
    tell(options, &mut [&mut reading, &mut settings])?;
    Ok(StudySettings { reading, ..settings })
}

/// The jobs of a study, and what came of those that are done.
#[derive(Debug)]
pub struct StudyJobs {
    study: JobStudy,
    inputs: Inputs,
    journal: Option<Journal>,
    outcomes: Vec<Option<JobOutcome>>,
}

impl StudyJobs {
    /// Of lines of JSON, a job each, as `post batch` has them; `options` are those of `post batch` that are no grid. What the
    /// file `journal` holds is taken from there, and what is done is added.
    ///
    /// # Errors
    /// A line that is no job, an option that is none, or a journal that cannot be read.
    pub fn new(
        stop: &StopSignal,
        lines: &str,
        options: &[NamedOption],
        journal: Option<&Path>,
    ) -> Result<Self, Refusal> {
        let jobs = JobLine::read("the jobs", lines)?;
        let options = settings(options).map_err(|fault| vec![*fault])?;
        let ((study, inputs), _) = quietly(stop, |session| JobStudy::new(session, jobs, options))?;
        let journal = journal
            .map(|path| Journal::open(path, true))
            .transpose()
            .map_err(|fault| refused(fault.into()))?;
        let session = Session::quiet();
        let outcomes = study.jobs.iter().map(|job| {
            let journal = journal.as_ref()?;
            batch::known(&session, &study, job, &inputs, journal)
        });
        Ok(Self { outcomes: outcomes.collect(), study, inputs, journal })
    }

    /// How many jobs there are.
    pub fn count(&self) -> usize {
        self.outcomes.len()
    }

    /// The numbers of the jobs that are not done.
    pub fn open(&self) -> Vec<usize> {
        let outcomes = self.outcomes.iter().enumerate();
        let open = outcomes.filter(|(_, outcome)| outcome.is_none());
        open.map(|(number, _)| number).collect()
    }

    /// The CL file and the line of a job.
    pub fn job(&self, number: usize) -> Option<(&str, String)> {
        let job = self.study.jobs.get(number)?;
        Some((&job.file, files::json_line(job)))
    }

    /// The texts of all machines with what they extend, for a [`StudyPart`] elsewhere.
    pub fn machines(&self) -> String {
        self.inputs.machines_json()
    }

    /// Does what is not done on so many threads (none: as many as there are processors). False if it was given up: what
    /// was done until then is in the journal.
    ///
    /// # Errors
    /// The journal cannot be written.
    pub fn run(
        &mut self,
        threads: Option<NonZeroUsize>,
        progressed: Progressed<'_>,
    ) -> Result<bool, Refusal> {
        let open = self.open();
        let journal = self.journal.as_ref();
        let outcomes =
            batch::run(&self.study, &self.inputs, &open, threads, journal, &mut |done| {
                match progressed(done.jobs, done.refused) {
                    true => Ok(()),
                    false => Err(batch::Cancelled),
                }
            });
        let Some(outcomes) = outcomes.map_err(refused)? else {
            return Ok(false);
        };
        for (number, outcome) in open.into_iter().zip(outcomes) {
            self.outcomes[number] = Some(outcome);
        }
        Ok(true)
    }

    /// Takes what came of jobs elsewhere, as [`StudyPart::run`] tells it. How many of them are not written.
    ///
    /// # Errors
    /// That is no outcome, or the journal cannot be written.
    pub fn take(&mut self, numbers: &[usize], outcomes: &[String]) -> Result<usize, Refusal> {
        let mut not_written = 0;
        for (number, text) in numbers.iter().zip(outcomes) {
            let outcome: JobOutcome = serde_json::from_str(text)
                .map_err(|error| super::option(format!("no outcome of a job: {error}")))?;
            not_written += usize::from(outcome.state() != batch::WRITTEN);
            self.keep(*number, outcome)?;
        }
        Ok(not_written)
    }

    /// A job was lost with the process that did it.
    ///
    /// # Errors
    /// The journal cannot be written.
    pub fn lost(&mut self, number: usize, code: &str, message: &str) -> Result<(), Refusal> {
        self.keep(number, JobOutcome::lost(code, message))
    }

    fn keep(&mut self, number: usize, outcome: JobOutcome) -> Result<(), Refusal> {
        if let Some(journal) = &self.journal {
            journal.add(&outcome).map_err(|fault| refused(fault.into()))?;
        }
        if let Some(place) = self.outcomes.get_mut(number) {
            *place = Some(outcome);
        }
        Ok(())
    }

    /// The rows of the jobs that are done.
    pub fn table(&self) -> StudyTable {
        let outcomes = self.outcomes.iter().enumerate();
        let (numbers, outcomes): (Vec<usize>, Vec<JobOutcome>) =
            outcomes.filter_map(|(number, outcome)| Some((number, outcome.clone()?))).unzip();
        StudyTable::new(&self.study, &numbers, &outcomes)
    }

    /// Writes the table to a file, as its name ends: `.parquet`, `.csv` or `.jsonl`.
    ///
    /// # Errors
    /// Another ending, or it cannot be written.
    pub fn write(&self, stop: &StopSignal, path: &Path) -> Result<(), Refusal> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let Some(bytes) = self.table().bytes(&ending) else {
            let message = format!(
                "{}: the name of the table ends in .parquet, .csv or .jsonl",
                path.display()
            );
            return Err(super::option(message));
        };
        let target = PathArg::from(path.to_owned());
        let written =
            quietly(stop, |session| Ok(files::write_bytes(session, RESULTS, &target, &bytes)?));
        written.map(drop)
    }
}

/// Some jobs of a study, on a computer that has none of its files.
pub struct StudyPart {
    study: JobStudy,
    inputs: Inputs,
}

impl StudyPart {
    /// Of lines of jobs, the options of the study, the CL files by the names that the jobs have for them, and what
    /// [`StudyJobs::machines`] gave.
    ///
    /// # Errors
    /// What of them is none.
    pub fn new(
        stop: &StopSignal,
        lines: &str,
        options: &[NamedOption],
        files: Vec<(String, Vec<u8>)>,
        machines: &str,
    ) -> Result<Self, Refusal> {
        let jobs = JobLine::read("the jobs", lines)?;
        let options = settings(options).map_err(|fault| vec![*fault])?;
        Ok(Self {
            study: quietly(stop, |session| JobStudy::part(session, jobs, options))?.0,
            inputs: Inputs::handed_over(files.into_iter(), machines).map_err(super::option)?,
        })
    }

    /// What came of the jobs, in their order, for [`StudyJobs::take`]; none if it was given up.
    ///
    /// # Errors
    /// No thread can be started.
    pub fn run(
        &self,
        threads: Option<NonZeroUsize>,
        progressed: Progressed<'_>,
    ) -> Result<Option<Vec<String>>, Refusal> {
        let numbers = self.study.numbers(None);
        let (study, inputs) = (&self.study, &self.inputs);
        let mut look = |done: batch::Done| match progressed(done.jobs, done.refused) {
            true => Ok(()),
            false => Err(batch::Cancelled),
        };
        let outcomes = batch::run(study, inputs, &numbers, threads, None, &mut look);
        let outcomes = outcomes.map_err(refused)?;
        Ok(outcomes.map(|outcomes| outcomes.iter().map(files::json_line).collect()))
    }
}
