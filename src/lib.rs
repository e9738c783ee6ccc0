//! What the command `post` does. The binary runs it.

mod codes;
mod flag_words;
mod isolation;
mod job_lines;
mod verbs;

use std::ffi::OsString;

use post_cli::failure::CommandFault;
use post_job::session::Session;

/// Runs the command with the arguments of the process, to its end.
pub fn run() -> ! {
    post_cli::run_to_end(|session| match verbs::moved() {
        Some(fault) => Err(CommandFault::Usage(fault)),
        None => verbs::run(session, &std::env::args_os().collect::<Vec<_>>(), |fault| {
            verbs::misspelt().unwrap_or(fault)
        }),
    })
}

/// Does what the words of a command line say, the name of the command first, for whom is no process of its own: results
/// go to standard output, findings to the face of the session, and nothing ends.
///
/// # Errors
/// What the command would end with.
pub fn run_words(session: &Session, words: &[OsString]) -> Result<(), CommandFault> {
    verbs::run(session, words, |fault| fault)?;
    Ok(post_cli::terminal::all_printed(session)?)
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
