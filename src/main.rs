//! `post`: turns a cutter-location file into the NC program of one machine.

mod arguments;
mod files;
mod job;
mod terminal;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use job::machine_files as machines;
use terminal::findings as render;
use verbs::{check, list_words as words, new, post as posting, study, test_plugin};

/// All is good.
const GOOD: u8 = 0;
/// Refused: nothing was written, and the messages say why. (Usage faults are clap's: 2.)
const REFUSED: u8 = 1;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Some(Command::Words { file, unknown_only }) => words::print(file, *unknown_only),
        Some(Command::Machines { machines }) => machines::print(machines),
        Some(Command::Schema) => {
            machines::print_schema();
            Ok(())
        }
        Some(Command::Check(arguments)) => check::run(arguments),
        Some(Command::New(arguments)) => new::run(arguments),
        Some(Command::Study(arguments)) => study::run(arguments),
        Some(Command::Plugin(arguments)) => test_plugin::run(arguments),
        None => posting::run(&arguments.post),
    };
    match done {
        Ok(()) => GOOD.into(),
        Err(findings) => {
            render::findings(&findings);
            REFUSED.into()
        }
    }
}
