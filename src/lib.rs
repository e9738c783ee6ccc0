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

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    files::delete_on_signals();
    let session = Session::new(Terminal);
    // A plugin that ends the process would else look like a command that has done its work.
    let told = session.clone();
    let _watch = post_host::watch_for_exit(move |fault| {
        files::delete_temporary_files();
        told.findings(&[plugin_finder::diagnostic(fault, &[], None)]);
    });
    let done = CommandLine::try_parse()
        .map_err(|fault| Failure::Usage(verbs::misspelt().unwrap_or(fault)))
        .and_then(|line| line.run(&session))
        .and_then(|()| terminal::all_printed(&session));
    let code = done.as_ref().map_or_else(Failure::exit_code, |()| 0);
    if let Err(failure) = done {
        terminal::explain(&session, failure);
    }
    post_host::leave(code)
}
