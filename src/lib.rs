//! What the command `post` does. The binary runs it.

mod arguments;
mod failure;
mod terminal;
mod verbs;

use clap::Parser;

use failure::CommandFault;
use post_job::session::Session;
use post_job::{files, plugin_finder};
use terminal::Terminal;
use verbs::CommandLine;

/// What the comparisons of the papers (`papers`) share with the command.
#[doc(hidden)]
pub mod shared {
    pub use crate::arguments::JobArguments;
    pub use crate::failure::CommandFault;
    pub use crate::run_to_end;
    pub use crate::terminal::{print, tell};
    pub use post_job::failure::Failure;
    pub use post_job::files::{AtomicFile, FileFault, OwnFolder, PathArg, Role, chart, json};
    pub use post_job::nc_program::open_as;
    pub use post_job::session::Session;
    pub use post_job::text::{number, table};
    pub use post_job::{DryRun, machine_files, plugin_finder, say_what_is_left};

    /// Values of flags.
    pub mod flag_values {
        pub use crate::arguments::flag_values::{
            feed, file, finite, length, not_negative, period, point, positive, setting, word,
        };
    }

    /// The plan of a program as it is shown.
    pub mod plan {
        pub use post_job::plan::{drawn, gauges, keep, pictures, rooms, tally};
    }
}

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    run_to_end(|session| match verbs::moved() {
        Some(fault) => Err(CommandFault::Usage(fault)),
        None => CommandLine::try_parse()
            .map_err(|fault| CommandFault::Usage(verbs::misspelt().unwrap_or(fault)))
            .and_then(|line| line.run(session)),
    })
}

/// Does `job`, tells why it failed, and ends the process.
pub fn run_to_end(job: impl FnOnce(&Session) -> Result<(), CommandFault>) -> ! {
    files::delete_on_signals();
    let session = Session::new(Terminal);
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
