//! What an NC program makes its machine do: in numbers, as rows, and as a CL file.

pub(crate) mod beyond_travel;
mod motions_csv;
mod summary;
mod survey;

use post_machine::diagnostic::{Diagnostic, Severity};
use post_readback::course::program::{Chords, ProgramCourse};
use post_readback::interpret::ReadReport;
use post_readback::{FedRapids, MOST_FAULTS};

use super::nc_program::{self, NcControl, ProgramFile};
use super::nc_to_cl::{self, Tools};
use super::unsaid::no_program;
use crate::failure::Failure;
use crate::files::{AtomicFile, PathArg, Role};
use crate::nc_program::RunningProgram;
use crate::session::Session;
use beyond_travel::BeyondTravel;
use motions_csv::MotionsCsv;

pub use summary::{ReadSummary, ToolUseSummary};
pub use survey::{ProgramSurvey, ToolUse};

/// Of the machine's tolerance so much is used by chords of curves that no record of a CL file has.
const CHORDS: f64 = 0.1;

const MOTIONS: Role = Role { what: "table of motions", remedy: "name another file with --csv" };

/// A program that is to be read, and what is wanted of it.
#[derive(Clone, Debug)]
pub struct ReadRequest {
    /// The program.
    pub input: PathArg,
    /// Where the table of its motions goes.
    pub csv: Option<PathArg>,
    /// Where its path goes as a CL file.
    pub cl: Option<PathArg>,
}

/// What came of it.
pub struct ReadProgram<'m> {
    /// What the program did.
    pub survey: ProgramSurvey<'m>,
    /// What was read.
    pub report: ReadReport,
    /// What is wrong with it.
    pub refused: Vec<Diagnostic>,
    /// A text went to standard output.
    pub printed: bool,
}

/// Reads a program as its control does.
///
/// # Errors
/// A file that cannot be read or written, or a machine that cannot be used.
pub fn read<'m>(
    session: &Session,
    control: &'m NcControl,
    request: &ReadRequest,
) -> Result<ReadProgram<'m>, Failure> {
    let ReadRequest { input, csv, cl } = request;
    let program = ProgramFile::open(session, input)?;
    let name = &program.name;
    let mut run = control.run(name, program.text()?).map_err(|fault| *fault)?;
    let mut targets: Vec<(Role, &PathArg)> = Vec::new();
    targets.extend(csv.iter().map(|target| (MOTIONS, target)));
    targets.extend(cl.iter().map(|target| (Role::CL, target)));
    let mut files = AtomicFile::create(session, &targets)?;
    let (tables, cl_files) = files.split_at_mut(usize::from(csv.is_some()));
    let mut table = tables.first_mut().map(|file| MotionsCsv::new(&control.machine, file));
    let mut survey = ProgramSurvey::new(&control.machine);
    let mut beyond = BeyondTravel::new(&control.machine);
    while let Some(done) = run.block() {
        for what in done {
            survey.take(what);
            beyond.take(&control.machine, what);
            if let Some(table) = &mut table {
                table.take(what)?;
            }
        }
    }
    let mut refused = run.faults().to_vec();
    if refused.is_empty() && run.program().report().blocks == 0 {
        refused.push(no_program(name));
    }
    if refused.len() == MOST_FAULTS {
        refused.push(nc_program::given_up());
    }
    if let Some(table) = table {
        table.finish()?;
    }
    if let (Some(file), true) = (cl_files.first_mut(), refused.is_empty()) {
        let program = control.program_with_rapids(&program.name, Box::new(program.text()?))?;
        write_cl(session, input, control, program, file, &mut refused)?;
    }
    if !refused.is_empty() {
        // A path with gaps is none.
        files.truncate(usize::from(csv.is_some()));
    }
    // How fast it goes is the control's.
    let beyond = beyond.findings(name);
    refused.extend(beyond.filter(|finding| finding.severity == Severity::Error));
    let printed = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, files)?;
    let report = run.program().report().clone();
    Ok(ReadProgram { survey, report, refused, printed })
}

/// Runs the program once more, and writes its path.
fn write_cl(
    session: &Session,
    input: &PathArg,
    control: &NcControl,
    program: FedRapids<RunningProgram<'static>>,
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
    let part = input.stem().unwrap_or_default();
    let tools = Tools { length: control.offsets.length, edges: control.lexicon.tools_have_edges() };
    let written =
        nc_to_cl::write(&mut course, &part, tip, tools, &mut |text| file.write_bytes(text))?;
    session.findings(&written.notes);
    session.findings(nc_to_cl::fed(course.program().left()).as_slice());
    refused.extend(written.faults);
    Ok(())
}
