//! The jobs of the command for programs: values come back instead of files and printed text.
//!
//! Whoever calls holds a [`LoadedMachine`] and asks it. What is refused comes back as a list of [`Diagnostic`]s, whatever
//! it was: a file that cannot be read, an option that nobody knows, a program that must not run. Nothing is printed, no
//! signal is caught, and nothing is written but what a call names.

mod blocks;
mod kinematics;
mod loaded_machine;
mod nc_program;
mod program;
mod study;

use std::sync::{Arc, Mutex, PoisonError};

use post_machine::diagnostic::Diagnostic;

use crate::failure::Failure;
use crate::files::TextOutcomes;
use crate::session::{Face, Session};

pub use crate::columns::ColumnKind;
pub use crate::settings::{MachineSettings, SettingValue};
pub use blocks::{Array, Blocks, KINDS, REASONS, block_arrays};
pub use kinematics::{AxisFacts, Deviations, MachineKinematics, Solutions, ToolPoses};
pub use loaded_machine::{LoadedMachine, MachineSelection};
pub use nc_program::{ReadTargets, VerifyOptions};
pub use program::{MadeProgram, ProgramFindings, ReportOptions};
pub use study::{Progressed, StudyColumn, StudyJobs, StudyPart, StudyTable, StudyValues};

/// An option of the command, with underscores for its hyphens, and its value.
pub type NamedOption = (String, SettingValue);

/// Why a job was not done: findings, an error among them.
pub type Refusal = Vec<Diagnostic>;

/// Says that a job shall end; it is asked as its files are read, from batch to batch of a prediction, and from point to point
/// of kinematics: it takes no longer than a look at a flag.
pub type StopSignal = Arc<dyn Fn() -> bool + Send + Sync>;

/// A face that keeps findings for whoever called.
struct FindingsCollector {
    stop: StopSignal,
    found: Arc<Mutex<Vec<Diagnostic>>>,
}

impl Face for FindingsCollector {
    fn findings(&self, findings: &[Diagnostic], _: &TextOutcomes) {
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
    stop: &StopSignal,
    job: impl FnOnce(&Session) -> Result<T, Failure>,
) -> Result<(T, Vec<Diagnostic>), Refusal> {
    let found = Arc::default();
    let done =
        job(&Session::new(FindingsCollector { stop: Arc::clone(stop), found: Arc::clone(&found) }));
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
fn refused(failure: Failure) -> Refusal {
    failure.findings()
}

/// An argument that cannot be used.
fn option(message: String) -> Refusal {
    vec![Diagnostic::error("option", message)]
}
