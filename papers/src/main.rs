//! `papers`: the comparisons of the papers that `post` stands on, and their figures.

mod curve;
mod deviations;
mod plan;
mod study;

use clap::{Parser, Subcommand};
use post_cli::failure::CommandFault;
use post_cli::run_to_end;

use plan::PlanArguments;
use study::StudyArguments;

/// Compares what papers say of deviations and feeds with what `post` makes of them.
///
/// Machines, CL files and flags are those of `post`; no program is written.
#[derive(Debug, Parser)]
#[command(
    name = "papers",
    version,
    after_help = "Examples:
  papers study part.cls --machine ac-trunnion
  papers plan curve.json --pictures plan

Exit codes: 0 done; 1 refused, the messages say why; 2 the command line is wrong.",
    max_term_width = 100
)]
struct PapersCommandLine {
    #[command(subcommand)]
    verb: PapersVerb,
}

#[derive(Debug, Subcommand)]
enum PapersVerb {
    Study(Box<StudyArguments>),
    Plan(Box<PlanArguments>),
}

fn main() {
    run_to_end(|session| {
        match PapersCommandLine::try_parse().map_err(CommandFault::Usage)?.verb {
            PapersVerb::Study(arguments) => study::run(session, &arguments)?,
            PapersVerb::Plan(arguments) => plan::run(session, &arguments)?,
        }
        Ok(())
    })
}
