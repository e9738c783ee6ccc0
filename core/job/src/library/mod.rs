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

use std::sync::{Arc, Mutex, PoisonError};

use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;
use crate::files::Texts;
use crate::session::{Face, Session};

pub use crate::columns::Kind;
pub use crate::settings::{MachineSettings, Value};
pub use blocks::{Array, Blocks, KINDS, REASONS, block_arrays};
pub use kinematics::{AxisFacts, Deviations, Kinematics, Solutions, Wanted};
pub use loaded_machine::{LoadedMachine, MachineTold};
pub use program::{Found, MadeProgram, ReportTold};
pub use study::{Column, Progressed, StudyJobs, StudyPart, StudyTable, Values};

/// An option of the command, with underscores for its hyphens, and its value.
pub type OptionTold = (String, Value);

/// Why a job was not done: findings, an error among them.
pub type Refused = Vec<Diagnostic>;

/// Says that a job shall end; it is asked as its CL file is read.
pub type Stop = Arc<dyn Fn() -> bool + Send + Sync>;

/// A face that keeps findings for whoever called.
struct Gathering {
    stop: Stop,
    found: Arc<Mutex<Vec<Diagnostic>>>,
}

impl Face for Gathering {
    fn findings(&self, findings: &[Diagnostic], _: &Texts) {
        // A list is whole whatever a thread died of.
        let mut found = self.found.lock().unwrap_or_else(PoisonError::into_inner);
        found.extend_from_slice(findings);
    }

    fn is_stopped(&self) -> bool {
        (self.stop)()
    }
}

/// Does a job in a session of its own: what it finds on the way comes back with what it gives.
fn quietly<T>(
    stop: &Stop,
    job: impl FnOnce(&Session) -> Result<T, Failure>,
) -> Result<(T, Vec<Diagnostic>), Refused> {
    let found = Arc::default();
    let done = job(&Session::new(Gathering { stop: Arc::clone(stop), found: Arc::clone(&found) }));
    let mut findings = std::mem::take(&mut *found.lock().unwrap_or_else(PoisonError::into_inner));
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
    failure.findings()
}

/// An argument that cannot be used.
fn option(message: String) -> Refused {
    vec![Diagnostic::error("option", message)]
}
