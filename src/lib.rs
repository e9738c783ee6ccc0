//! What the command `post` does. The binary runs it; the Python package does the same jobs through it.

mod arguments;
mod editor;
mod failure;
mod files;
mod job;
pub mod library;
mod terminal;
mod verbs;

use clap::Parser;

use failure::Failure;
use job::plugin_finder;
use post_host::PluginFault;
use verbs::CommandLine;

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    files::delete_on_signals();
    let _watch = post_host::watch_for_exit(ended_by_a_plugin);
    let done = CommandLine::try_parse()
        .map_err(|fault| Failure::Usage(verbs::misspelt().unwrap_or(fault)))
        .and_then(CommandLine::run)
        .and_then(|()| terminal::all_printed());
    let code = done.as_ref().map_or_else(Failure::exit_code, |()| 0);
    if let Err(failure) = done {
        terminal::explain(failure);
    }
    post_host::leave(code)
}

/// A plugin that ends the process would else look like a command that has done its work.
fn ended_by_a_plugin(fault: &PluginFault) {
    files::delete_temporary_files();
    terminal::findings(&[plugin_finder::diagnostic(fault, &[], None)]);
}
