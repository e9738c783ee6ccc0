//! What the command `post` does. The binary runs it; the Python package does the same jobs through it.

mod arguments;
mod editor;
mod failure;
mod files;
mod job;
pub mod library;
mod session;
mod terminal;
mod verbs;

use clap::Parser;

use failure::Failure;
use job::plugin_finder;
use session::Session;
use terminal::Terminal;
use verbs::CommandLine;

/// What the comparisons of the papers (`papers`) share with the command.
#[doc(hidden)]
pub mod shared {
    pub use crate::arguments::JobArguments;
    pub use crate::failure::Failure;
    pub use crate::files::{AtomicFile, FileFault, OwnFolder, PathArg, Role, chart, json};
    pub use crate::job::nc_program::open_as;
    pub use crate::job::text::{number, table};
    pub use crate::job::{DryRun, machine_files, plugin_finder, say_what_is_left};
    pub use crate::run_to_end;
    pub use crate::session::Session;
    pub use crate::terminal::{print, tell};

    /// Values of flags.
    pub mod flag_values {
        pub use crate::arguments::flag_values::{
            feed, file, finite, length, not_negative, period, point, positive, setting, word,
        };
    }

    /// The plan of a program as it is shown.
    pub mod plan {
        pub use crate::job::plan::{drawn, gauges, keep, pictures, rooms, tally};
    }
}

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    run_to_end(|session| match verbs::moved() {
        Some(fault) => Err(Failure::Usage(fault)),
        None => CommandLine::try_parse()
            .map_err(|fault| Failure::Usage(verbs::misspelt().unwrap_or(fault)))
            .and_then(|line| line.run(session)),
    })
}

/// Does `job`, tells why it failed, and ends the process.
pub fn run_to_end(job: impl FnOnce(&Session) -> Result<(), Failure>) -> ! {
    files::delete_on_signals();
    let session = Session::new(Terminal);
    // A plugin that ends the process would else look like a command that has done its work.
    let told = session.clone();
    let _watch = post_host::watch_for_exit(move |fault| {
        files::delete_temporary_files();
        told.findings(&[plugin_finder::diagnostic(fault, &[], None)]);
    });
    let done = job(&session).and_then(|()| terminal::all_printed(&session));
    let code = done.as_ref().map_or_else(Failure::exit_code, |()| 0);
    if let Err(failure) = done {
        terminal::explain(&session, failure);
    }
    post_host::leave(code)
}
