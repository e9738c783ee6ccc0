//! What the command `post` does. The binary runs it.

mod codes;
mod flag_words;
mod job_lines;
mod verbs;

use post_cli::failure::CommandFault;

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    post_cli::run_to_end(|session| match verbs::moved() {
        Some(fault) => Err(CommandFault::Usage(fault)),
        None => verbs::run(session, &std::env::args_os().collect::<Vec<_>>(), |fault| {
            verbs::misspelt(&fault).unwrap_or(fault)
        }),
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
