//! `post`: turns a cutter-location file into the NC program of one machine.

mod arguments;
mod failure;
mod files;
mod job;
mod terminal;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

use failure::Failure;
use verbs::CommandLine;

fn main() -> ExitCode {
    files::delete_on_signals();
    let done = CommandLine::try_parse()
        .map_err(Failure::Usage)
        .and_then(CommandLine::run)
        .and_then(|()| terminal::all_printed());
    let Err(failure) = done else {
        return ExitCode::SUCCESS;
    };
    let code = failure.exit_code();
    terminal::explain(failure);
    code
}
