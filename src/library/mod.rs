//! The jobs of the command for programs: values come back instead of files and printed text.
//!
//! Whoever calls holds a [`LoadedMachine`] and asks it. What is refused comes back as a list of [`Diagnostic`]s, whatever
//! it was: a file that cannot be read, an option that nobody knows, a program that must not run. Nothing is printed, no
//! signal is caught, and nothing is written but what a call names.

mod kinematics;
mod loaded_machine;

use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;
use crate::files::read_files;
use crate::terminal;

pub use kinematics::{AxisFacts, Deviations, Kinematics, Solutions, Wanted};
pub use loaded_machine::{LoadedMachine, MachineTold};

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
        Failure::Usage(fault) => vec![Diagnostic::error("option", usage(&fault))],
        other => other.findings(),
    }
}

/// What is wrong with an option, without what a command line would be told besides.
fn usage(fault: &clap::Error) -> String {
    let text = fault.render().to_string();
    let first = text.split("\n\n").next().unwrap_or_default();
    first.trim_start_matches("error: ").trim().to_owned()
}
