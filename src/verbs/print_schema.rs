//! `post schema`: the JSON Schema of machine files.

use clap::Args;
use post_machine::description;

use crate::failure::Failure;
use crate::terminal;

/// Prints the JSON Schema of machine files, by which an editor completes and checks them.
#[derive(Debug, Args)]
pub struct SchemaArguments {}

/// Prints it.
pub fn run(_: &SchemaArguments) -> Result<(), Failure> {
    terminal::print(&format!("{:#}\n", description::schema()));
    Ok(())
}
