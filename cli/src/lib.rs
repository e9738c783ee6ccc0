//! What commands share: flags that are made of the settings of a job, findings and results on a terminal, and how a
//! process ends.

pub mod arguments;
pub mod failure;
mod stack;
pub mod terminal;

use std::hint::black_box;

use failure::CommandFault;
use post_host::{Isolation, Limits};
use post_job::failure::Failure;
use post_job::session::Session;
use post_job::{files, plugin_finder};
use post_machine::diagnostic::{Diagnostic, Severity};
use terminal::Terminal;

/// What tests reach; no part of the face.
#[doc(hidden)]
pub mod internals {
    pub use crate::terminal::plain;
}

/// All results count on the processor's rounding to the nearest number: another mode (of a library that was loaded into
/// this process) is refused before anything is computed.
fn check_rounding() -> Result<(), CommandFault> {
    let little = black_box(f64::EPSILON / 16.0);
    let sums = [black_box(1.0) + little, black_box(-1.0) - little, black_box(1.0) - little];
    if sums == [1.0, -1.0, 1.0] {
        return Ok(());
    }
    let message = "the processor does not round to the nearest number: this process was started with another rounding mode";
    let help = "a library that is loaded into every process sets it (LD_PRELOAD, DYLD_INSERT_LIBRARIES): start post without it";
    Err(Failure::from(Diagnostic::error("rounding-mode", message).help(help)).into())
}

/// Does `job`, tells why it failed, and ends the process. A process that was started for a library serves that instead.
pub fn run_to_end(job: impl FnOnce(&Session) -> Result<(), CommandFault> + Send) -> ! {
    post_host::serve_if_asked();
    files::delete_on_signals();
    #[cfg(unix)]
    post_host::watch_for_crash();
    let session = Session::new(Terminal);
    session.isolate(Isolation::new(Limits::default()));
    // A plugin that ends the process would else look like a command that has done its work.
    let told = session.clone();
    let _watch = post_host::watch_for_exit(move |fault| {
        files::delete_temporary_files();
        told.findings(&[plugin_finder::diagnostic(fault, &[], None)]);
    });
    let done = check_rounding()
        .and_then(|()| stack::with_room(|| job(&session)))
        .and_then(|()| Ok(terminal::all_printed(&session)?));
    let unclosed = session.isolation().map_or_else(Vec::new, |isolation| isolation.close_faults());
    let warnings = unclosed.iter().map(|fault| Diagnostic {
        severity: Severity::Warning,
        ..plugin_finder::diagnostic(fault, &[], None)
    });
    let warnings: Vec<Diagnostic> = warnings.collect();
    if !warnings.is_empty() {
        session.findings(&warnings);
    }
    let code = done.map_or_else(|fault| terminal::explain(&session, fault), |()| 0);
    post_host::leave(code)
}
