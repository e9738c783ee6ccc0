//! `post calibrate`: where the lines of the axes are, from readings of a ball.

mod calibrate_text;

use std::path::PathBuf;

use clap::Args;
use post_cli::arguments::flag_values;
use post_cli::arguments::flag_values::file;
use post_cli::terminal;
use post_job::calibrate::{self, CalibrationRequest};
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::session::Session;
use post_machine::description::Setting;

/// Finds where the lines of the axes are, from axis values at which a ball was found.
///
/// A ball stands still on the table (or wherever the part is), nobody needs to know where. A touch probe measures its middle
/// at several angles of the rotary axes, or an R-test reads how far it is off the tip. The table has a column for each axis,
/// and, where they are needed, `ball` (a name each), `length` (of the tool, mm) and `dX`, `dY`, `dZ` (from the tip to the
/// ball along the machine's axes, mm). Numbers of the machine are adjusted by least squares until all readings say that the
/// ball stands still; each comes with its standard error, and with lines for a file that extends the machine's.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post calibrate ball.csv --machine our-trunnion.toml --tool-length 150
  post calibrate ball.csv -m our-trunnion.toml --fit A.point,C.point
  post calibrate rtest.csv -m measured.toml --fit X0C,Y0A,Z0A

Exit codes: 0 found; 1 refused, the messages say why; 2 the command line is wrong.")]
pub struct CalibrateArguments {
    /// The table of readings, `-` for standard input.
    #[arg(value_name = "CSV-FILE", value_parser = file())]
    points: PathArg,

    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    machine: String,

    /// What is looked for, separated by commas: `C.point`, `C.rotary`, `Y.linear` (each the two coordinates that are not
    /// along the axis), or parameters of the machine file. [default: point and direction of each rotary axis]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    fit: Vec<String>,

    /// Length of the tool from the gauge point to the tip, mm, where the table has no column `length`.
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_hyphen_values = true, value_parser = flag_values::not_negative)]
    tool_length: f64,

    /// Sets a parameter of the machine (`Lm=312`) or any key.
    #[arg(long, value_name = "NAME=VALUE", value_parser = flag_values::setting)]
    set: Vec<Setting>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER")]
    machines: Vec<PathBuf>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &CalibrateArguments) -> Result<(), Failure> {
    let CalibrateArguments { points, machine, fit, tool_length, set, machines } = arguments;
    let request = CalibrationRequest {
        machine: machine.clone(),
        machines: machines.clone(),
        settings: set.clone(),
        points: points.clone(),
        fit: fit.clone(),
        length: *tool_length,
    };
    let found = calibrate::find(session, &request)?;
    session.findings(&found.findings);
    terminal::print(session, &calibrate_text::text(&found));
    Ok(())
}
