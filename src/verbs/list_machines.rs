//! `post machines`: the machines that a bare name finds.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;

use crate::failure::Failure;
use crate::job::machine_files;
use crate::terminal;

/// Lists the machines that a bare name finds.
#[derive(Debug, Args)]
pub struct MachinesArguments {
    /// A further folder of machine files.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,
}

/// Lists them.
pub fn run(arguments: &MachinesArguments) -> Result<(), Failure> {
    let mut text = String::new();
    for (name, origin) in machine_files::list(&arguments.machines) {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{name:<20} {origin}");
    }
    terminal::print(&text);
    Ok(())
}
