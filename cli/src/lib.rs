//! What commands share: flags that are made of the settings of a job, findings and results on a terminal, and how a
//! process ends.

pub mod arguments;
pub mod failure;
pub mod terminal;

use failure::CommandFault;
use post_host::{Isolation, Limits};
use post_job::session::Session;
use post_job::{files, plugin_finder};
use terminal::Terminal;

/// What tests reach; no part of the face.
#[doc(hidden)]
pub mod internals {
    pub use crate::terminal::plain;
}

/// Does `job`, tells why it failed, and ends the process. A process that was started for a library serves that instead.
pub fn run_to_end(job: impl FnOnce(&Session) -> Result<(), CommandFault>) -> ! {
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
    let done = job(&session).and_then(|()| Ok(terminal::all_printed(&session)?));
    let code = done.as_ref().map_or_else(CommandFault::exit_code, |()| 0);
    if let Err(fault) = done {
        terminal::explain(&session, fault);
    }
    post_host::leave(code)
}
