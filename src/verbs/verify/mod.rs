//! `post verify`: an NC program held against the CL file that it was made from.

mod verify_text;

use clap::{Args, ValueEnum};
use post_readback::interpret::Limits;

use post_cli::arguments::flag_values::file;
use post_cli::arguments::flag_values::positive;
use post_cli::arguments::{Flags, JobFlags};
use post_cli::terminal;
use post_job::clearance;
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::session::Session;
use post_job::settings::{ReportSettings, ThreadSettings};
use post_job::verify::{Verified, VerifyRequest, verify};

/// Verifies an NC program against a CL file: does the machine do what was asked?
///
/// Each block is run as the control runs it, and the chain of the machine says where the tool goes. The program keeps to
/// the CL file if tip and tool axis can be gone along together with its path, in order and never back, within the
/// tolerance. Between the cuts rapids pass the points of the CL file and keep to its ways; else they lead along the tool's
/// own line, or where the machine file retracts, changes and parks; tool, spindle, coolant, feed, dwells and stops are
/// those that it asks for; no axis leaves its travel or passes its largest feed.
///
/// Give the same options as for `post` (--mount, --tool-length, --units, …), or name the job file in place of the
/// program (or of the machine, for another program). A program posted from a job file beside it needs neither.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post verify part.nc --machine dmu50 --against part.cls
  post verify part.job.toml
  post verify part.nc -m ac-trunnion --against part.cls --tool-length 120 --map map.json
  post verify part.nc -m my-mill.toml --against part.cls --tolerance 0.01 --summary -
  post verify part.nc -m mill-with-vise.toml --against part.cls --clearance

Exit codes: 0 the program does what the CL file asks for; 1 it does not, the messages say where, or something could not be
read; 2 the command line is wrong.")]
pub struct VerifyArguments {
    /// The NC program, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file())]
    program: PathArg,

    /// The machine: a TOML file, or the name of one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE")]
    machine: String,

    #[command(flatten)]
    job: JobFlags,

    /// Largest deviation of the tool axis in a cut, degrees, over the machine file's.
    #[arg(long, value_name = "DEG", value_parser = positive, help_heading = "Machine")]
    axis_tolerance: Option<f64>,

    /// What stands in the control's tables, a TOML file: work offsets, lengths by register or tool. Without it lengths are
    /// those of --tool-length, the machine file and the CL file; beside it --tool-length is how long the tools really are,
    /// and what is compensated is held against that.
    #[arg(long, value_name = "FILE", value_parser = file(), help_heading = "Machine")]
    offsets: Option<PathArg>,

    /// Writes a table as JSON: of each line of the program the line of the CL file that asks for it, the solution of the
    /// machine, the deviation, and what makes it slower than asked; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    map: Option<PathArg>,

    /// Writes the result as JSON; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    summary: Option<PathArg>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    #[command(flatten)]
    threads: Flags<ThreadSettings>,

    /// The program was posted for this machine file: also checks what posting promises of rapids. Rotary axes turn only
    /// where the tool is retracted or on its own line, it is retracted at each tool change and at the end, and the program
    /// sets the modes that it stands on. A program whose head names its job file is held to that by itself.
    #[arg(long)]
    posted: bool,

    /// The feed was planned (`post --plan`): it may be below that of the CL file.
    #[arg(long)]
    planned: bool,

    /// Proves besides that nothing hits anything (`post clearance`): the bodies of the machine file are held against one
    /// another along all motions.
    #[arg(long)]
    clearance: bool,

    /// Is not compared: `coolant`, where words of the machine or of yours (`[codes]`, `INSERT`, a plugin) switch it, and the
    /// control knows more of them than the CL file names; `work-offset`, where the CL file names none and the program cuts in
    /// another than the dialect's option `work_offset` (Heidenhain's `preset`). Repeatable.
    #[arg(long, value_name = "WHAT", value_enum)]
    ignore: Vec<Ignored>,

    /// So many blocks are run once more, by loops, jumps and subprograms; more are refused.
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks)]
    most_blocks: u64,

    /// Prints messages only, no table.
    #[arg(short, long)]
    quiet: bool,

    /// The CL file, `-` for standard input.
    #[arg(long, value_name = "CL-FILE", value_parser = file())]
    against: PathArg,
}

/// What need not be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Ignored {
    /// Which coolant flows, and whether.
    Coolant,
    /// Which work offset is cut in, where the CL file names none.
    WorkOffset,
}

/// Verifies as the arguments say.
pub fn run(session: &Session, arguments: &VerifyArguments) -> Result<(), Failure> {
    let request = VerifyRequest {
        job: arguments.job.settings(&arguments.machine, &arguments.against),
        program: arguments.program.clone(),
        offsets: arguments.offsets.clone(),
        most_blocks: arguments.most_blocks,
        axis_tolerance: arguments.axis_tolerance.map(f64::to_radians),
        planned: arguments.planned,
        posted: arguments.posted,
        any_coolant: arguments.ignore.contains(&Ignored::Coolant),
        any_work_offset: arguments.ignore.contains(&Ignored::WorkOffset),
        clearance: arguments.clearance,
        map: arguments.map.clone(),
        summary: arguments.summary.clone(),
        report: arguments.report.0.clone(),
        threads: arguments.threads.0.clone(),
    };
    let Verified { name, machine, held, clearance, tolerances, printed } =
        verify(session, &request)?;
    if !arguments.quiet {
        let mut text = verify_text::text(&held, &machine, &name, tolerances);
        if let Some(proven) = &clearance {
            text.push('\n');
            text.push_str(&clearance::text::text(proven));
        }
        terminal::print_beside(session, &text, printed);
    }
    if held.is_wrong() {
        return Err(held.findings.into());
    }
    session.findings(&held.findings);
    Ok(())
}
