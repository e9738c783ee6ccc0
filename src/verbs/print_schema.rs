//! `post schema`: the JSON Schema of machine files, and that of job files.

use clap::Args;

use post_cli::terminal;
use post_job::failure::Failure;
use post_job::job_file;
use post_job::machine_schema;
use post_job::session::Session;

/// Prints the JSON Schema of machine files, by which an editor completes and checks them; the options of the plugins
/// that are built in are part of it.
#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// The schema of job files, `part.job.toml`, in place of that of machine files.
    #[arg(long)]
    job: bool,
}

/// Prints it.
pub fn run(session: &Session, arguments: &SchemaArguments) -> Result<(), Failure> {
    let schema = match arguments.job {
        true => job_file::schema(),
        false => machine_schema::schema(),
    };
    terminal::print(session, &format!("{schema:#}\n"));
    Ok(())
}
