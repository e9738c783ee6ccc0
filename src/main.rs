//! `post`: turns a cutter-location file into the NC program of one machine.

mod arguments;
mod check;
mod input;
mod machines;
mod new;
mod output;
mod plugins;
mod posting;
mod progress;
mod render;
mod study;
mod summary;
mod svg;
mod values;
mod word_list;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

/// All is good.
const GOOD: u8 = 0;
/// Refused: nothing was written, and the messages say why. (Usage faults are clap's: 2.)
const REFUSED: u8 = 1;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let done = match &arguments.command {
        Some(Command::Words { file: None, .. }) => {
            word_list::print_all();
            Ok(())
        }
        Some(Command::Words {
            file: Some(file),
            unknown_only,
        }) => word_list::print(file, *unknown_only),
        Some(Command::Machines { machines }) => machines::print(machines),
        Some(Command::Schema) => {
            machines::print_schema();
            Ok(())
        }
        Some(Command::Check(arguments)) => check::run(arguments),
        Some(Command::New(arguments)) => new::run(arguments),
        Some(Command::Study(arguments)) => study::run(arguments),
        Some(Command::Plugin(arguments)) => plugins::kit::run(arguments),
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
