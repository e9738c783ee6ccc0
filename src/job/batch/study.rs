//! The jobs of a study, and what is asked of each.

use std::path::PathBuf;

use clap::Args;
use post_host::Finder;
use post_machine::diagnostic::Diagnostic;

use super::columns::{self, Head};
use super::inputs::Inputs;
use super::job_line::JobLine;
use crate::arguments::ReadingArguments;
use crate::failure::Failure;
use crate::job::plugin_finder;
use crate::session::Session;

/// What is asked of every job.
#[derive(Clone, Debug, Default, Args)]
pub struct StudyArguments {
    #[command(flatten)]
    pub reading: ReadingArguments,

    /// Plans the feed of each program, as `post --plan`.
    #[arg(long, help_heading = "Jobs")]
    pub plan: bool,

    /// Reads each program back and holds it against its CL file, as `post --verify`: what strays is a refused job.
    #[arg(long, help_heading = "Jobs")]
    pub verify: bool,

    /// Predicts what each program does, as `post --predict`: true cycle time and contour error.
    #[arg(long, help_heading = "Jobs")]
    pub predict: bool,

    /// Takes the error model's word where the certificate finds more, and only reports it.
    #[arg(long, help_heading = "Jobs")]
    pub trust_model: bool,

    /// Adds a column of how long each job took to compute, s: the bytes of the results are not the same every time then.
    #[arg(long, help_heading = "Jobs")]
    pub timings: bool,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machine")]
    pub machines: Vec<PathBuf>,

    /// A folder of plugin libraries; the environment variable POST_PLUGINS adds more. Opening a library runs
    /// its code, so no folder is looked into that is not named here.
    #[arg(long, value_name = "FOLDER", help_heading = "Plugins")]
    pub plugins: Vec<PathBuf>,
}

/// One of so many parts of a study, counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub index: usize,
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
pub struct Study {
    pub jobs: Vec<JobLine>,
    pub options: StudyArguments,
    pub finder: Finder,
    pub columns: Vec<Head>,
}

impl Study {
    /// Of these jobs, with the texts that they read.
    ///
    /// # Errors
    /// No job, or a folder of plugins that cannot be looked into.
    pub fn new(
        session: &Session,
        jobs: Vec<JobLine>,
        options: StudyArguments,
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
        options: StudyArguments,
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
            "{:?} {} {} {} {}",
            options.reading, options.plan, options.verify, options.predict, options.trust_model
        )
    }
}
