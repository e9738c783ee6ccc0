//! `post predict`: what an NC program does on its machine, before it is run there.

mod measured_arguments;

use clap::Args;
use post_readback::interpret::Limits;

use measured_arguments::MeasuredArguments;
use post_cli::arguments::flag_values;
use post_cli::arguments::flag_values::file;
use post_cli::arguments::{Flags, JobFlags};
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::predict::{self, PredictRequest};
use post_job::session::Session;
use post_job::settings::{ReportSettings, ThreadSettings};

/// Predicts what an NC program does on its machine: cycle time, true feed, and how far the tool strays.
///
/// The program is read back as its control reads it and becomes set-points of the axes, with the limits of the axes, the
/// look-ahead and the corners of the control (`[motion]` of the machine file); the servos (`[servo]`) follow them; where
/// the axes then are is held against the commanded path, and with --against against the path of the CL file. Axes without
/// a servo are where they are commanded: times and feeds are predicted all the same.
///
/// Give the same options as for `post` (--mount, --tool-length, …), or name the job file in place of the program.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post predict part.nc --machine ac-trunnion
  post predict part.nc -m my-mill.toml --against part.cls --tool-length 120 --pictures prediction
  post predict part.nc -m my-mill.toml --period 0.004 --csv set-points.csv --summary prediction.json
  post predict part.nc -m my-mill.toml --set axis.X.max_accel=2000
  post predict part.nc -m my-mill.toml --measured log.csv --fit X.kv,Y.kv --pictures prediction

Exit codes: 0 predicted; 1 something could not be read, the messages say what; 2 the command line is wrong.")]
pub struct PredictArguments {
    /// The NC program, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file())]
    program: PathArg,

    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    machine: String,

    #[command(flatten)]
    job: JobFlags,

    /// Time from one set-point to the next, seconds, over `[motion] period` of the machine file.
    #[arg(long, value_name = "SECONDS", value_parser = flag_values::period, help_heading = "Machine")]
    period: Option<f64>,

    /// What stands in the control's tables, a TOML file: work offsets, lengths by register or tool. Without it lengths are
    /// those of --tool-length, the machine file and the CL file.
    #[arg(long, value_name = "FILE", value_parser = file(), help_heading = "Machine")]
    offsets: Option<PathArg>,

    /// Writes every set-point as a row: time (s), lines of the program and of the CL file, whether the tool cuts, each axis
    /// commanded and actual as the control shows it, tip commanded and actual (mm, part frame), contour error as a vector
    /// (mm) and of the tool axis (degrees), feed of the tip and of the program (mm/min); `-` is standard output, alone
    /// there.
    #[arg(long, value_name = "FILE", value_parser = file())]
    csv: Option<PathArg>,

    /// Writes the result as JSON; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    summary: Option<PathArg>,

    /// Draws into this folder, as SVG: errors of the axes and feed over time, contour error along the path, magnified on
    /// it and by its size, and the spectrum of the axes' errors; with --measured also the log's errors, those predicted for
    /// it and their difference; and writes the summary beside them.
    #[arg(long, value_name = "FOLDER", value_parser = file())]
    pictures: Option<PathArg>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    #[command(flatten)]
    threads: Flags<ThreadSettings>,

    /// The CL file that the program was made from: how far the tool strays from its path.
    #[arg(long, value_name = "CL-FILE", value_parser = file())]
    against: Option<PathArg>,

    #[command(flatten)]
    measured: MeasuredArguments,

    /// So many blocks are run once more, by loops, jumps and subprograms; more are refused.
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks)]
    most_blocks: u64,

    /// Prints messages only, no table.
    #[arg(short, long)]
    quiet: bool,
}

/// Predicts as the arguments say.
pub fn run(session: &Session, arguments: &PredictArguments) -> Result<(), Failure> {
    let against = arguments.against.as_ref();
    let input = against.unwrap_or(&PathArg::Standard);
    let request = PredictRequest {
        job: arguments.job.settings(&arguments.machine, input),
        program: arguments.program.clone(),
        against: arguments.against.clone(),
        offsets: arguments.offsets.clone(),
        most_blocks: arguments.most_blocks,
        period: arguments.period,
        measured: arguments.measured.request(),
        csv: arguments.csv.clone(),
        summary: arguments.summary.clone(),
        pictures: arguments.pictures.clone(),
        report: arguments.report.0.clone(),
        threads: arguments.threads.0.clone(),
    };
    let predicted = predict::predict_program(session, &request)?;
    session.findings(&predicted.findings);
    if !arguments.quiet {
        let text = predict::text(&predicted.found);
        terminal::print_beside(session, &text, predicted.printed);
    }
    Ok(())
}
