//! `post clearance`: whether anything hits anything while an NC program runs.

use clap::Args;

use post_cli::arguments::ProgramArguments;
use post_cli::arguments::flag_values::file;
use post_cli::terminal;
use post_job::clearance::{self, ClearanceRequest};
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::nc_program::NcControl;
use post_job::session::Session;
use post_machine::diagnostic::{Diagnostic, Severity};

/// Proves that nothing hits anything while an NC program runs, rapids and ways between the cuts among it.
///
/// Bodies are those of the machine file: `[solids]`, `[fixture.NAME]`, `[stock]`, and the outlines of its tools
/// (`[tools.N]`). Of each pair that moves against one another it is proven that they keep the distance of `[clearance]` at
/// every instant of every motion, not at samples of it; what is not proven counts as a hit. Cutters may be in the stock at
/// feed. The stock is that before the first cut, unless `[stock] cut = true`: then what is certainly cut is taken from it.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post clearance part.h --machine dmu50-with-vise.toml
  post clearance part.nc --machine my-mill.toml --cl part.cls
  post clearance part.nc -m my-mill.toml --set clearance.keep=2
  post clearance part.nc -m my-mill.toml --set stock.cut=true --stock-stl left.stl --csv cuts.csv

Exit codes: 0 proven: nothing that has a body hits anything; 1 something hits, or that it does not is not proven, or a
block was refused; 2 the command line is wrong.")]
pub struct ClearanceArguments {
    #[command(flatten)]
    program: ProgramArguments,

    /// The NC program, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file())]
    input: PathArg,

    /// The CL file of the program: how thick the cutters are that the machine file does not describe (CUTTER).
    #[arg(long, value_name = "CL-FILE", value_parser = file())]
    cl: Option<PathArg>,

    /// Writes a row of each line that moves as CSV: how near any two bodies come on it, and of a stock that is cut how much is
    /// taken of it, and how deep and wide the cut is; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    csv: Option<PathArg>,

    /// Writes what may be left of a stock that is cut (`[stock] cut = true`) as an STL file: closed, mm, as the CL file has
    /// the part, exact to within a cell; `-` is standard output. Of several stocks each becomes a file of its own, FILE-NAME.
    #[arg(long, value_name = "FILE", value_parser = file())]
    stock_stl: Option<PathArg>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &ClearanceArguments) -> Result<(), Failure> {
    let control = NcControl::new(session, &arguments.program.settings())?;
    let ClearanceArguments { input, cl, csv, .. } = arguments;
    let request = ClearanceRequest { input: input.clone(), cl: cl.clone(), csv: csv.clone() };
    let mut found = clearance::clearance(session, &control, &request)?;
    let table = *csv == Some(PathArg::Standard);
    let printed = table
        | match (&arguments.stock_stl, found.left.as_slice()) {
            (None, _) => false,
            (Some(_), []) => {
                let message = "there is no stock that is cut: no STL file is written";
                let help = "[stock] of the machine file has its shape, and cut = true";
                found.findings.push(Diagnostic::error("clearance-body", message).help(help));
                false
            }
            (Some(path), left) => {
                clearance::write_stl(left, session, path)?;
                *path == PathArg::Standard
            }
        };
    terminal::print_beside(session, &clearance::text::text(&found), printed);
    let (errors, warnings): (Vec<_>, Vec<_>) =
        found.findings.into_iter().partition(|finding| finding.severity == Severity::Error);
    session.findings(&warnings);
    if errors.is_empty() { Ok(()) } else { Err(errors.into()) }
}
