//! An NC program held against the CL file that it was made from.

mod page;
mod summary;

use post_machine::description::Machine;
use post_readback::BlockEffect;
use post_readback::interpret::Limits;
use post_readback::verify::BlockReport;

use super::JobMachine;
use super::nc_program::{self, ProgramFile};
use super::read_back::{self, ReadingSetup, VerifiedProgram, VerifyWatch};
use super::report::{ClWindow, ClearanceRows, ExtraColumns, MotionRows};
use super::result_files::ResultFiles;
use crate::clearance::{self, ClearanceFound, Heard, Hearer};
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, JsonRows, PathArg, Role};
use crate::job_file::is_marked;
use crate::operations;
use crate::session::Session;
use crate::settings::{JobSettings, ReportSettings, ThreadSettings};
use page::VerifyPage;

pub use summary::{RefusalReason, VerifySummary};

const MAP: Role = Role { what: "map", remedy: "name another file with --map" };

/// A program that is to be verified, and what is wanted of it.
#[derive(Clone, Debug)]
pub struct VerifyRequest {
    /// The CL file and the machine.
    pub job: JobSettings,
    /// The program.
    pub program: PathArg,
    /// What stands in the control's tables; none: as the machine file, the command line and the CL file say.
    pub offsets: Option<PathArg>,
    /// So many blocks are run once more.
    pub most_blocks: u64,
    /// Largest deviation of the tool axis over the machine file's, radians.
    pub axis_tolerance: Option<f64>,
    /// The feed was planned: it may be below that of the CL file.
    pub planned: bool,
    /// The program was posted for this machine file; it says so itself where its head names a job file.
    pub posted: bool,
    /// Which coolant flows is the program's own business.
    pub any_coolant: bool,
    /// Which work offset it cuts in, where the CL file names none, is the program's own business.
    pub any_work_offset: bool,
    /// It is proven besides that nothing hits anything.
    pub clearance: bool,
    /// Where the table of its lines goes.
    pub map: Option<PathArg>,
    /// Where what was found goes, as JSON.
    pub summary: Option<PathArg>,
    /// The page.
    pub report: ReportSettings,
    /// How many threads work.
    pub threads: ThreadSettings,
}

/// What came of it.
pub struct Verified {
    /// The program, as messages call it.
    pub name: String,
    /// The machine with its settings.
    pub machine: Machine,
    /// What was found, and what is wrong: what is not clear too, where that was asked for.
    pub held: VerifiedProgram,
    /// What was proven: nothing hits anything.
    pub clearance: Option<ClearanceFound>,
    /// Largest deviations that are other than the machine file's: mm, radians.
    pub tolerances: [Option<f64>; 2],
    /// A text went to standard output.
    pub printed: bool,
}

/// Holds a program against a CL file; what is wanted beside is written whether it is right or wrong.
///
/// # Errors
/// A file that cannot be read or written, or a machine that cannot be used.
pub fn verify(session: &Session, request: &VerifyRequest) -> Result<Verified, Failure> {
    let job = &request.job;
    let JobMachine { machine, finder } = JobMachine::load(session, job, &[])?;
    nc_program::not_both_standard("program and CL file", &request.program, Some(&job.input))?;
    let program = ProgramFile::open(session, &request.program)?;
    let offsets = match &request.offsets {
        Some(file) => Some(nc_program::offsets(session, file, &machine)?),
        None => None,
    };
    let mut source = ClSource::of_job(session, job, true)?;
    let chosen = operations::chosen(job, &mut source)?;
    let map = request.map.as_ref().map(|map| (MAP, map));
    let mut texts = ResultFiles::create(session, map, request.summary.as_ref(), &request.report)?;
    let reading = ReadingSetup {
        session,
        arguments: job,
        machine: &machine,
        finder: &finder,
        offsets,
        limits: Limits { blocks: request.most_blocks, ..Limits::default() },
        tolerances: [None, request.axis_tolerance],
        planned: request.planned,
        solutions: request.map.is_some(),
        any_coolant: request.any_coolant,
        any_work_offset: request.any_work_offset,
        own: request.posted || is_marked(&request.program),
        lines: chosen.map(|lines| lines.ranges),
        threads: request.threads.most(),
    };
    let rows = match &texts.page {
        Some(_) => {
            let cl = ClWindow::of(job, &machine, &source)?;
            let besides = ExtraColumns { deviations: true, ..ExtraColumns::default() };
            Some(MotionRows::new(&machine, Some(cl), besides)?)
        }
        None => None,
    };
    let map = texts.table.as_mut().map(|file| (JsonRows::default(), file));
    let mut watch = VerifyOutputs { map, rows };
    let name = &program.name;
    let mut held =
        read_back::verify(&reading, &mut source, name, Box::new(program.text()?), &mut watch)?;
    let VerifyOutputs { map, rows } = watch;
    if let Some((map, file)) = map {
        map.end(file)?;
    }
    // Which ways across bodies leave is seen by proving it alone.
    let clearance = request.clearance || machine.clearance.shortens_ways();
    let mut near = match (&texts.page, clearance) {
        (Some(_), true) => Some(ClearanceRows::new(clearance::cuts_stock(&machine))?),
        _ => None,
    };
    let clearance = match clearance {
        // It is run once more: rapids at feed are told from cuts, and what is refused of it was said.
        true => {
            let text = Box::new(program.text()?);
            let mut hear = near.as_mut().map(|near| |heard: &Heard| near.hear(heard));
            let hear = hear.as_mut().map(|hear| hear as &mut Hearer<'_>);
            let mut proven = clearance::of_job(&reading, &mut source, name, text, hear)?;
            proven.findings.retain(|finding| !held.findings.contains(finding));
            held.findings.append(&mut proven.findings);
            Some(proven)
        }
        false => None,
    };
    if let Some(file) = &mut texts.summary {
        let clearance = clearance.as_ref().map(ClearanceFound::summary);
        let told = VerifySummary { clearance, ..VerifySummary::of(&held.found, &held.findings) };
        file.write_bytes(files::json(&told).as_bytes())?;
    }
    let tolerances = reading.tolerances;
    if let (Some(page), Some(rows)) = (&mut texts.page, rows) {
        let names = [&request.program, &job.input];
        let threads = reading.threads;
        let held = &held;
        let (machine, clearance) = (&machine, clearance.as_ref());
        let told = VerifyPage { session, machine, held, clearance, names, tolerances, threads };
        told.write(rows, near, &mut source, &program, request.report.most(), page)?;
    }
    source.refuse_written()?;
    let texts = texts.all();
    let printed = texts.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, texts)?;
    Ok(Verified { name: program.name, machine, held, clearance, tolerances, printed })
}

/// What is made of the lines of the program while it is held against the CL file.
struct VerifyOutputs<'m, 'f> {
    map: Option<(JsonRows, &'f mut AtomicFile)>,
    rows: Option<MotionRows<'m>>,
}

impl VerifyWatch for VerifyOutputs<'_, '_> {
    fn done(&mut self, done: &BlockEffect) {
        if let Some(rows) = &mut self.rows {
            rows.take(done);
        }
    }

    fn wants_lines(&self) -> bool {
        self.map.is_some() || self.rows.is_some()
    }

    fn line(&mut self, line: &BlockReport) {
        if let Some((map, file)) = &mut self.map {
            map.row(line, file);
        }
        if let Some(rows) = &mut self.rows {
            rows.hear(line.nc_line, &page::heard(line));
        }
    }

    fn runs_on(&mut self) -> bool {
        self.rows.as_mut().map(MotionRows::alone).is_some()
    }
}
