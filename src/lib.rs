//! What the command `post` does. The binary runs it.

mod codes;
mod flag_words;
mod verbs;

use post_cli::failure::CommandFault;
use verbs::CommandLine;

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    post_cli::run_to_end(|session| match verbs::moved() {
        Some(fault) => Err(CommandFault::Usage(fault)),
        None => CommandLine::read(&std::env::args_os().collect::<Vec<_>>())
            .map_err(|fault| CommandFault::Usage(verbs::misspelt(&fault).unwrap_or(fault)))
            .and_then(|line| line.run(session)),
    })
}

/// What tests reach; no part of the face.
#[doc(hidden)]
pub mod internals {
    use clap::CommandFactory as _;

    /// The whole command line.
    pub fn command_line() -> clap::Command {
        super::verbs::AllVerbs::command()
    }
}
