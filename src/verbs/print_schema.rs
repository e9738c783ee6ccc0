//! `post schema`: the JSON Schema of machine files.

use clap::Args;

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::machine_schema;
use post_job::session::Session;

/// Prints the JSON Schema of machine files, by which an editor completes and checks them; the options of the plugins
/// that are built in are part of it.
#[derive(Debug, Args)]
pub struct SchemaArguments {}

/// Prints it.
pub fn run(session: &Session, _: &SchemaArguments) -> Result<(), Failure> {
    terminal::print(session, &format!("{:#}\n", machine_schema::schema()));
    Ok(())
}
