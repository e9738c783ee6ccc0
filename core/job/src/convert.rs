//! An NC program moved to another machine: run as its control runs it, written as a CL file, posted, and held against the
//! path of the first.

use std::num::NonZeroUsize;
use std::sync::Arc;

use post_host::Finder;
use post_machine::description::{Machine, Setting};
use post_machine::diagnostic::{Diagnostic, SourceFiles};
use post_posting::report::PostingReport;
use post_readback::FedRapids;
use post_readback::course::CourseFacts;
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::program::{Chords, ProgramCourse};
use post_readback::interpret::Limits;
use post_readback::verify::CutPath;

use super::JobMachine;
use super::making::{ProgramInput, ProgramMaker, ProgramPart};
use super::nc_program::{NcControl, ProgramFile};
use super::nc_to_cl::{self, Tools};
use super::posting_pass::PostingExtras;
use super::read_back::{self, ReadingSetup, Unwatched, VerifiedProgram, VerifyReference};
use super::report::{self, PageTexts, PostPage};
use super::text::{clock, number};
use crate::failure::Failure;
use crate::files::{AtomicFile, ClSource, PathArg, Role};
use crate::nc_program::RunningProgram;
use crate::session::Session;
use crate::settings::{JobSettings, MakingSettings, ProgramSettings, ReportSettings};
use crate::text_table::NamedValues;

/// Of the tolerance so much is left for the CL file's chords: the rest is what posting may use.
const CHORDS: f64 = 0.1;

/// The path that the new program is held against has chords so much finer than the CL file's.
const FINER: f64 = 0.1;

/// A conversion that is asked for.
#[derive(Clone, Debug)]
pub struct ConvertRequest {
    /// The machine that the program was made for, and how it is read.
    pub from: ProgramSettings,
    /// The program, the machine that it shall run on, and how its path is posted.
    pub to: JobSettings,
    /// Where the new program goes.
    pub output: PathArg,
    /// Where the CL file goes that stands between the two programs.
    pub cl: Option<PathArg>,
    /// The page.
    pub report: ReportSettings,
}

/// What came of it.
pub struct Converted {
    /// The first program and the new one, as messages call them.
    pub names: [String; 2],
    /// The machine of each.
    pub machines: [Machine; 2],
    /// What posting came to.
    pub report: PostingReport,
    /// What the new program does, held against the first.
    pub held: VerifiedProgram,
    /// What the path consists of.
    pub facts: CourseFacts,
    /// What the user should know.
    pub findings: Vec<Diagnostic>,
    /// A text went to standard output.
    pub printed: bool,
}

/// Moves a program to another machine. The new program and what stands beside it are written, whole or not at all.
///
/// # Errors
/// Why it is refused, or a file that cannot be read or written.
pub fn convert(session: &Session, request: &ConvertRequest) -> Result<Converted, Failure> {
    let conversion = Conversion::open(session, request)?;
    let mut targets = vec![(Role::PROGRAM, &request.output)];
    targets.extend(request.cl.iter().map(|cl| (Role::CL, cl)));
    targets.extend(request.report.report.iter().map(|page| (Role::REPORT, page)));
    let mut files = AtomicFile::create(session, &targets)?;
    let page = request.report.report.as_ref().and_then(|_| files.pop());
    let (program, cl_file) = files.split_at_mut(1);
    let mut findings = Vec::new();
    let mut source = conversion.write_cl(cl_file.first_mut(), &mut findings)?;
    let (mut converted, page) = conversion.make(&mut source, &mut program[0], page, findings)?;
    files.extend(page);
    converted.printed = files.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, files)?;
    Ok(converted)
}

/// A program and both machines, opened.
struct Conversion<'a> {
    session: &'a Session,
    request: &'a ConvertRequest,
    from: NcControl,
    /// The first program.
    program: ProgramFile,
    /// The machine that it shall run on, which may use a part of the tolerance.
    machine: Machine,
    finder: Finder,
    /// Of that machine, tip (mm) and tool axis (rad).
    tolerances: [f64; 2],
}

impl<'a> Conversion<'a> {
    fn open(session: &'a Session, request: &'a ConvertRequest) -> Result<Self, Failure> {
        let job = &request.to;
        let from = NcControl::new(session, &request.from)?;
        let program = ProgramFile::open(session, &job.input)?;
        let asked = super::machine(session, job, &[])?;
        [&from.machine, &asked].into_iter().try_for_each(refuse_turned)?;
        let tolerances = [asked.accuracy.tolerance, asked.accuracy.axis_tolerance];
        let [tip, axis] = tolerances.map(|tolerance| tolerance * (1.0 - CHORDS));
        let value = axis.to_degrees();
        let more = [
            Setting::Tolerance(tip),
            Setting::Number { name: "accuracy.axis_tolerance".to_owned(), value },
        ];
        let JobMachine { machine, finder } = JobMachine::load(session, job, &more)?;
        Ok(Self { session, request, from, program, machine, finder, tolerances })
    }

    /// The first program, from its beginning.
    fn run(&self) -> Result<FedRapids<RunningProgram<'static>>, Failure> {
        let program = &self.program;
        self.from.program_with_rapids(&program.name, Box::new(program.text()?))
    }

    /// Chords of the CL file.
    fn chords(&self) -> Chords {
        let [tip, axis] = self.tolerances.map(|tolerance| tolerance * CHORDS);
        Chords::within(tip, axis)
    }

    /// Writes the path of the first program as a CL file, to `file` too.
    fn write_cl(
        &self,
        mut file: Option<&mut AtomicFile>,
        findings: &mut Vec<Diagnostic>,
    ) -> Result<ClSource, Failure> {
        let chords = self.chords();
        let part = self.request.to.input.stem().unwrap_or_default();
        let mut course = ProgramCourse::new(self.run()?, chords);
        let edges = self.from.lexicon.tools_have_edges();
        let tools = Tools { length: self.request.from.tool_length, edges };
        let name = format!("{} as CL file", self.program.name);
        let (source, written) = ClSource::of_text(self.session, name, |copy| {
            nc_to_cl::write(&mut course, &part, chords.tip, tools, &mut |text| {
                copy(text)?;
                match &mut file {
                    Some(file) => file.write_bytes(text),
                    None => Ok(()),
                }
            })
        })?;
        findings.extend(written.notes);
        findings.extend(nc_to_cl::fed(course.program().left()));
        findings.extend(course.program().program().report().notes.iter().cloned());
        if !written.faults.is_empty() {
            findings.extend(written.faults);
            return Err(std::mem::take(findings).into());
        }
        Ok(source)
    }

    /// Posts the path, and holds the new program against the first; the page comes back written.
    fn make(
        &self,
        source: &mut ClSource,
        program: &mut AtomicFile,
        mut page: Option<AtomicFile>,
        mut findings: Vec<Diagnostic>,
    ) -> Result<(Converted, Option<AtomicFile>), Failure> {
        let Self { session, request, machine, .. } = self;
        let making = MakingSettings::default();
        let mut maker = ProgramMaker::new(session, &request.to, &making, self.finder.clone());
        maker.look_ahead_where_needed(machine, source)?;
        let part =
            ProgramPart { lines: None, target: request.output.clone(), machine: machine.clone() };
        let ready = maker.prepare(&part, source, false)?;
        let mut rows = match &page {
            Some(_) => Some(maker.rows(&part, source, false)?),
            None => None,
        };
        let observer = rows.as_mut().map(|rows| rows as _);
        let beside = PostingExtras { observer, ..PostingExtras::default() };
        let report = maker.write(ready, source, program, beside, &mut findings)?.report;
        if machine.clearance.shortens_ways() {
            let (name, text) = (program.name().to_owned(), Box::new(program.reread()?));
            let input = ProgramInput { name, text };
            let proven = maker.prove(&part, false, source, input, None)?;
            let wrong = proven.is_wrong();
            findings.extend(proven.findings);
            if wrong {
                return Err(findings.into());
            }
        }
        let (held, facts) = self.hold(source, program)?;
        findings.extend(held.findings.iter().cloned());
        if held.is_wrong() {
            return Err(findings.into());
        }
        let names = [self.program.name.clone(), program.name().to_owned()];
        let machines = [self.from.machine.clone(), machine.clone()];
        let made = Converted { names, machines, report, held, facts, findings, printed: false };
        if let (Some(page), Some(rows)) = (&mut page, rows) {
            let (named, mut text) = (program.name().to_owned(), program.reread()?);
            let texts = PageTexts { source, name: &named, text: &mut text };
            self.page(&made).write(rows, None, None, texts, request.report.most(), page)?;
        }
        Ok((made, page))
    }

    /// Runs the new program as well, and holds it against the path of the first: not against the CL file, in which chords
    /// stand already.
    fn hold(
        &self,
        source: &mut ClSource,
        program: &mut AtomicFile,
    ) -> Result<(VerifiedProgram, CourseFacts), Failure> {
        let (name, machine) = (&self.program.name, &self.machine);
        let chords = self.chords();
        let finer = Chords { tip: chords.tip * FINER, axis: chords.axis * FINER, ..chords };
        let mut read = ClCourse::new(ClSettings::of(machine, name), source.open()?.bytes);
        let (facts, _) = CourseFacts::of(&mut read);
        let mut again = ClCourse::new(ClSettings::of(machine, name), source.open()?.bytes);
        let (cut_path, _) = CutPath::of(&mut again, machine.control_point.along);
        let against = VerifyReference {
            course: ProgramCourse::new(self.run()?, finer),
            files: SourceFiles::new(name, Arc::default()),
            tools: read.tools().to_vec(),
            own_lines: Vec::new(),
            cut_path: Some(cut_path),
        };
        let reading = ReadingSetup {
            session: self.session,
            arguments: &self.request.to,
            machine,
            finder: &self.finder,
            offsets: None,
            limits: Limits::default(),
            tolerances: self.tolerances.map(Some),
            planned: false,
            solutions: false,
            any_coolant: false,
            any_work_offset: false,
            own: false,
            lines: None,
            threads: NonZeroUsize::MIN,
        };
        let told = program.name().to_owned();
        let text = Box::new(program.reread()?);
        let held = read_back::hold(&reading, against, &told, text, &mut Unwatched)?;
        Ok((held, facts))
    }

    /// What a page is told of the new program.
    fn page<'p>(&'p self, made: &'p Converted) -> PostPage<'p> {
        let ConvertRequest { to: JobSettings { input, .. }, output, .. } = self.request;
        PostPage {
            session: self.session,
            machine: &self.machine,
            cl: format!("{} as CL file", report::name_of(input)),
            program: output,
            report: &made.report,
            verification: Some(&made.held.found),
            clearance: None,
            left: &[],
            prediction: None,
            findings: &made.findings,
            job: "convert",
            threads: NonZeroUsize::MIN,
            // The same job gives the same page wherever its files lie.
            facts: made.summary([input, output].map(report::name_of)).into_rows(),
        }
    }
}

/// A part that sits turned is refused.
fn refuse_turned(machine: &Machine) -> Result<(), Failure> {
    if machine.turn == 0.0 {
        return Ok(());
    }
    let message = format!(
        "on {} the part sits turned by {}° about its Z: the paths of the two programs have no frame in common",
        machine.name,
        number(machine.turn.to_degrees(), 3)
    );
    Err(Diagnostic::error("convert", message)
        .help("--from-set workpiece.turn=0 or --set workpiece.turn=0, and the part clamped along the machine's axes")
        .into())
}

impl Converted {
    /// What was done, as a table, the two programs called so.
    pub fn summary(&self, [name, target]: [String; 2]) -> NamedValues {
        let Self { machines: [from, to], report, held, facts, .. } = self;
        let found = &held.found;
        let mut rows = NamedValues::default();
        rows.row("from", format_args!("{name}, {} ({})", from.name, from.control.dialect));
        rows.row("to", format_args!("{target}, {} ({})", to.name, to.control.dialect));
        rows.row(
            "path",
            format_args!(
                "{} pieces at feed ({} arcs, {} splines), {} rapids, {} holes",
                facts.cuts, facts.arcs, facts.splines, facts.rapids, facts.holes
            ),
        );
        rows.row(
            "program",
            format_args!("{} blocks, {} points put in", report.blocks, report.points_added),
        );
        rows.row(
            "tip",
            format_args!(
                "within {} mm of the first program's path, tolerance {} mm",
                number(found.tip.value, 6),
                number(report.tolerance_mm / (1.0 - CHORDS), 6)
            ),
        );
        rows.row("tool axis", format_args!("within {}°", number(found.axis.value, 5)));
        rows.row("time", clock(report.time_s));
        rows
    }
}
