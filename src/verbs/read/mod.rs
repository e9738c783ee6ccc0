//! `post read`: what an NC program makes its machine do.

mod beyond_travel;
mod motions_csv;
mod read_text;
mod survey;

use std::fs::File;

use clap::Args;
use post_machine::diagnostic::Diagnostic;
use post_readback::course::program::{Chords, ProgramCourse};
use post_readback::interpret::Interpreter;
use post_readback::{FedRapids, MOST_FAULTS};

use crate::arguments::ProgramArguments;
use crate::arguments::flag_values::file;
use crate::terminal;
use beyond_travel::BeyondTravel;
use motions_csv::MotionsCsv;
use post_job::failure::Failure;
use post_job::files::{AtomicFile, PathArg, Role};
use post_job::nc_program::{self, NcControl};
use post_job::nc_to_cl::{self, Tools};
use post_job::session::Session;
use survey::Survey;

/// Reads an NC program back: what it makes the machine do, block by block.
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
    /// rotary axes on the way to an approach) is left out; `-` is standard output, alone there.
    #[arg(long, value_name = "FILE", value_parser = file())]
    cl: Option<PathArg>,
}

/// Of the machine's tolerance so much is used by chords of curves that no record of a CL file has.
const CHORDS: f64 = 0.1;

const MOTIONS: Role = Role { what: "table of motions", remedy: "name another file with --csv" };

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &ReadArguments) -> Result<(), Failure> {
    let control = NcControl::new(session, &arguments.program.settings())?;
    let (name, input) = nc_program::open(session, &arguments.input)?;
    let run = control.run(&name, nc_program::again(&name, &input)?);
    let mut run = run.map_err(|fault| *fault)?;
    let mut targets: Vec<(Role, &PathArg)> = Vec::new();
    targets.extend(arguments.csv.iter().map(|target| (MOTIONS, target)));
    targets.extend(arguments.cl.iter().map(|target| (Role::CL, target)));
    let mut files = AtomicFile::create(session, &targets)?;
    let (tables, cl_files) = files.split_at_mut(usize::from(arguments.csv.is_some()));
    let mut csv = tables.first_mut().map(|file| MotionsCsv::new(&control.machine, file));
    let mut survey = Survey::new(&control.machine);
    let mut beyond = BeyondTravel::default();
    while let Some(done) = run.block() {
        for what in done {
            survey.take(what);
            beyond.take(&control.machine, what);
            if let Some(csv) = &mut csv {
                csv.take(what)?;
            }
        }
    }
    let mut refused = run.faults().to_vec();
    if refused.len() == MOST_FAULTS {
        refused.push(nc_program::given_up());
    }
    if let Some(csv) = csv {
        csv.finish()?;
    }
    if let (Some(file), true) = (cl_files.first_mut(), refused.is_empty()) {
        let program = control.program_with_rapids(&name, &input)?;
        write_cl(session, arguments, &control, program, file, &mut refused)?;
    }
    if !refused.is_empty() {
        // A path with gaps is none.
        files.truncate(usize::from(arguments.csv.is_some()));
    }
    refused.extend(beyond.findings(&name));
    let taken = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, files)?;
    let report = run.program().report();
    session.findings(&report.notes);
    let text = read_text::text(&control.machine, &survey, report, refused.len());
    if taken {
        terminal::tell(&text);
    } else {
        terminal::print(session, &text);
    }
    if refused.is_empty() { Ok(()) } else { Err(refused.into()) }
}

/// Runs the program once more, and writes its path.
fn write_cl(
    session: &Session,
    arguments: &ReadArguments,
    control: &NcControl,
    program: FedRapids<Interpreter<File>>,
    file: &mut AtomicFile,
    refused: &mut Vec<Diagnostic>,
) -> Result<(), Failure> {
    let machine = &control.machine;
    if machine.turn != 0.0 {
        let message = format!(
            "on {} the part sits turned by {:.3}° about its Z: posted again, this CL file would be turned once more",
            machine.name,
            machine.turn.to_degrees()
        );
        return Err(Diagnostic::error("turned-part", message)
            .help("--set workpiece.turn=0 writes it in the frame of the machine's axes")
            .into());
    }
    let accuracy = &machine.accuracy;
    let [tip, axis] = [accuracy.tolerance, accuracy.axis_tolerance].map(|mm| mm * CHORDS);
    let mut course = ProgramCourse::new(program, Chords::within(tip, axis));
    let part = arguments.input.stem().unwrap_or_default();
    let tools = Tools { length: control.offsets.length, edges: control.lexicon.tools_have_edges() };
    let written =
        nc_to_cl::write(&mut course, &part, tip, tools, &mut |text| file.write_bytes(text))?;
    session.findings(&written.notes);
    session.findings(nc_to_cl::fed(course.program().left()).as_slice());
    refused.extend(written.faults);
    Ok(())
}
