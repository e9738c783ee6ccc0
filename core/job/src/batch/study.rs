//! The jobs of a study, and what is asked of each.

use post_host::Finder;
use post_machine::diagnostic::Diagnostic;

use super::columns::{self, ColumnSource};
use super::inputs::Inputs;
use super::job_line::JobLine;
use crate::failure::Failure;
use crate::plugin_finder;
use crate::session::Session;
use crate::settings::StudySettings;

/// One of so many parts of a study, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which part it is, from 1.
    pub index: usize,
    /// How many parts there are.
    pub of: usize,
}

impl Shard {
    /// Reads `2/8`.
    ///
    /// # Errors
    /// That is none.
    pub fn read(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, of)| {
            let (index, of) = (index.trim().parse().ok()?, of.trim().parse().ok()?);
            (1..=of).contains(&index).then_some(Self { index, of })
        });
        numbers.ok_or_else(|| format!("`{text}` is no part: 2/8 is the second of eight"))
    }

    /// The job with this number belongs to it: jobs are dealt out one by one, so that neighbours, which take as long, go
    /// to all.
    fn has(self, job: usize) -> bool {
        job % self.of == self.index - 1
    }
}

/// Jobs, what is asked of them, and the columns of their results.
#[derive(Debug)]
pub struct JobStudy {
    /// The jobs, in their order.
    pub jobs: Vec<JobLine>,
    /// What is asked of each.
    pub options: StudySettings,
    /// Their plugins.
    pub finder: Finder,
    /// The columns of their results.
    pub columns: Vec<ColumnSource>,
}

impl JobStudy {
    /// Of these jobs, with the texts that they read.
    ///
    /// # Errors
    /// No job, or a folder of plugins that cannot be looked into.
    pub fn new(
        session: &Session,
        jobs: Vec<JobLine>,
        options: StudySettings,
    ) -> Result<(Self, Inputs), Failure> {
        if jobs.is_empty() {
            return Err(Diagnostic::error("batch", "there is no job to do")
                .help("name CL files, or a list of jobs that ends in .jsonl")
                .into());
        }
        let machines = jobs.iter().filter_map(|job| job.machine.as_deref());
        let inputs = Inputs::new(session, machines, &options.machines);
        let study = Self {
            columns: columns::columns(&jobs, &options, &inputs),
            finder: plugin_finder::finder(session, &options.plugins)?,
            jobs,
            options,
        };
        Ok((study, inputs))
    }

    /// A part of the jobs of another study, to be done with texts that were handed over. Its results have no columns.
    ///
    /// # Errors
    /// A folder of plugins that cannot be looked into.
    pub fn part(
        session: &Session,
        jobs: Vec<JobLine>,
        options: StudySettings,
    ) -> Result<Self, Failure> {
        Ok(Self {
            columns: Vec::new(),
            finder: plugin_finder::finder(session, &options.plugins)?,
            jobs,
            options,
        })
    }

    /// The numbers of the jobs of a part, or of all.
    pub fn numbers(&self, shard: Option<Shard>) -> Vec<usize> {
        let all = 0..self.jobs.len();
        all.filter(|job| shard.is_none_or(|shard| shard.has(*job))).collect()
    }

    /// What is asked of every job, as a text that is another if that is.
    pub fn options_text(&self) -> String {
        let options = &self.options;
        format!(
            "{:?} {} {} {} {}{}",
            options.reading,
            options.plan,
            options.verify,
            options.predict,
            options.trust_model,
            if options.clearance { " clearance" } else { "" }
        )
    }
}
