//! `post read`: what an NC program makes its machine do.

mod read_text;

use clap::Args;

use post_cli::arguments::ProgramArguments;
use post_cli::arguments::flag_values::file;
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::PathArg;
use post_job::nc_program::NcControl;
use post_job::read::{self, ReadRequest};
use post_job::session::Session;

/// Reads an NC program: what it makes the machine do, block by block.
///
/// The words of the control come from its dialect, the axes from the machine file. A block that is not understood is
/// refused by its line, never guessed; words that move nothing and that are not known are listed by name. What stands
/// in the control and not in the program (work offsets, tool lengths, reference positions) is taken from --offsets, from
/// --tool-length and `[tools]` of the machine file, and from where `mount` has the part: the work offsets are those with
/// which the tip of the tool stands on the part origin.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post read part.nc --machine ac-trunnion
  post read part.nc --machine ac-trunnion --cl part.cls
  post read part.h --machine dmu50 --offsets control.toml --csv motions.csv
  post read part.ngc --machine xyzac-trt --dialect linuxcnc --tool-length 40 --csv - | head

A file of offsets:
  [work.G54]            # where the program's zero is against the part origin of the machine file, mm, along the
  X = 10.0              # machine's linear axes; what a rotary axis shows there, degrees
  C = 90.0
  [work.\"G54.1 P3\"]
  Z = -2.5
  [length]              # by register (H), mm
  1 = 120.0
  [tool]                # by tool number, for controls that take the length from the tool's own table
  1 = 120.0
  [radius]              # by register (D), mm
  1 = 5.0
  [reference.1]         # where G28 leads, machine coordinates; [reference.2]: G30
  Z = 500.0

Exit codes: 0 read; 1 a block was refused, the messages say which and why; 2 the command line is wrong.")]
pub struct ReadArguments {
    #[command(flatten)]
    program: ProgramArguments,

    /// The NC program, `-` for standard input.
    #[arg(value_name = "NC-FILE", value_parser = file())]
    input: PathArg,

    /// Writes every motion as a row: line, block, kind, way, the axes as the control shows them, tip (mm) and tool axis
    /// in the part frame, feed (mm/min), minutes, tool, spindle (1/min), and whether the control keeps the tip; `-` is
    /// standard output, alone there.
    #[arg(long, value_name = "FILE", value_parser = file())]
    csv: Option<PathArg>,

    /// Writes the path of the tool against the part as a CL file: points with the tool axis, feeds of the tip, tools,
    /// speeds, curves, cycles and remarks. What the machine does for itself (ways in machine coordinates, the turn of
    /// rotary axes on the way to an approach) is left out; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    cl: Option<PathArg>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &ReadArguments) -> Result<(), Failure> {
    let control = NcControl::new(session, &arguments.program.settings())?;
    let ReadArguments { input, csv, cl, .. } = arguments;
    let request = ReadRequest { input: input.clone(), csv: csv.clone(), cl: cl.clone() };
    let found = read::read(session, &control, &request)?;
    session.findings(&found.report.notes);
    let refused = found.refused;
    let text = read_text::text(&control, &found.survey, &found.report, refused.len());
    terminal::print_beside(session, &text, found.printed);
    if refused.is_empty() { Ok(()) } else { Err(refused.into()) }
}
