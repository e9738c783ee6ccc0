//! The jobs of the command for programs: values come back instead of files and printed text.
//!
//! Whoever calls holds a [`LoadedMachine`] and asks it. What is refused comes back as a list of [`Diagnostic`]s, whatever
//! it was: a file that cannot be read, an option that nobody knows, a program that must not run. Nothing is printed, no
//! signal is caught, and nothing is written but what a call names.

mod blocks;
mod kinematics;
mod loaded_machine;
mod program;
mod study;

use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;
use crate::files::read_files;
use crate::terminal;

pub use crate::files::interruption::{Stop, stoppable};
pub use blocks::{Blocks, KINDS, REASONS};
pub use kinematics::{AxisFacts, Deviations, Kinematics, Solutions, Wanted};
pub use loaded_machine::{LoadedMachine, MachineTold};
pub use program::{Found, MadeProgram, OptionTold, ReportTold};
pub use study::{Column, Progressed, StudyJobs, StudyPart, StudyTable, Values};

/// Why a job was not done: findings, an error among them.
pub type Refused = Vec<Diagnostic>;

/// Does a job of the command by itself: what it would print is gathered and comes back with what it gives.
fn quietly<T>(job: impl FnOnce() -> Result<T, Failure>) -> Result<(T, Vec<Diagnostic>), Refused> {
    let (done, mut findings) = terminal::gathered(|| read_files::apart(job));
    match done {
        Ok(given) => Ok((given, findings)),
        Err(failure) => {
            findings.extend(refused(failure));
            Err(findings)
        }
    }
}

/// What a failure says, where nobody prints it.
fn refused(failure: Failure) -> Refused {
    match failure {
        Failure::Usage(fault) => vec![usage(&fault)],
        other => other.findings(),
    }
}

/// What is wrong with an option, without what a command line would be told besides.
fn usage(fault: &clap::Error) -> Diagnostic {
    let text = fault.render().to_string();
    let mut parts = text.split("\n\n").map(str::trim);
    let first = parts.next().unwrap_or_default();
    let finding = Diagnostic::error("option", first.trim_start_matches("error: "));
    match parts.find_map(|part| part.strip_prefix("tip: ")) {
        Some(tip) => finding.help(tip),
        None => finding,
    }
}

/// An argument that cannot be used.
fn option(message: String) -> Refused {
    vec![Diagnostic::error("option", message)]
}
