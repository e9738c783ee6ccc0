//! A job file: machine, CL files, settings and outputs of programs, said once for every verb.
//!
//! Its keys are the names of settings ([`JobKeys`]), its paths count from its folder. It may come from a stranger: its text
//! has an end, it opens no library, and what it has written stands in its folder or below.

mod job_keys;
mod job_program;
mod mark;
mod paths;
mod reading;
mod saving;
mod schema;
mod told_setting;

pub use job_keys::JobKeys;
pub use job_program::JobProgram;
pub use mark::{JobMark, is_marked, is_titled, job_of_program};
pub use reading::read;
pub use saving::{SavedJob, text};
pub use schema::schema;
pub use told_setting::ToldSetting;

use std::path::Path;

use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;

/// How the name of a job file ends.
pub const ENDING: &str = ".job.toml";

/// Most programs of one job file.
const MOST_PROGRAMS: usize = 1_000;

/// Refuses to make the programs of channels one by one.
///
/// # Errors
/// The job has channels.
pub fn refuse_channels(job: &JobFile) -> Result<(), Failure> {
    if !job.channels {
        return Ok(());
    }
    let message = format!("{}: its channels are made together, and not one by one", job.name);
    let help = "post JOB.job.toml makes them";
    Err(Diagnostic::error("job-file", message).help(help).into())
}

/// What the programs of a job are, in the order of the file.
#[derive(Clone, Debug)]
pub struct JobFile {
    /// As the user named it.
    pub name: String,
    /// What names it in the head of its programs.
    pub mark: JobMark,
    /// Its programs run at the same time, one a channel of the machine.
    pub channels: bool,
    /// Its programs, one at least; of channels in their order from 1.
    pub programs: Vec<JobProgram>,
}

/// The path is that of a job file, by its name.
pub fn is_job_file(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str());
    name.is_some_and(|name| name.ends_with(ENDING) && name.len() > ENDING.len())
}
