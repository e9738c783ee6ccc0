//! An NC program that is predicted, and what is made of its set-points as they come: a table, a page, pictures, and a
//! recorded log laid over them.

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_readback::BlockEffect;
use post_readback::interpret::Limits;

use super::measured::{self, Log, LogForm, LogZeros, MeasuredPoint, Overlay};
use super::page::PredictPage;
use super::pictures::{self, MeasuredRoom, PredictRooms};
use super::run::{PredictReference, PredictWatch, Predicted, PredictionSetup, predict};
use super::{Prediction, Sample, set_points_csv};
use crate::JobMachine;
use crate::columns::CsvTable;
use crate::failure::Failure;
use crate::files::{self, AtomicFile, ClSource, FolderMark, OwnFolder, PathArg, Role};
use crate::nc_program::{self, ProgramFile};
use crate::operations;
use crate::report::{ClWindow, ExtraColumns, MotionRows, PredictedLines};
use crate::result_files::ResultFiles;
use crate::session::Session;
use crate::settings::{JobSettings, ReportSettings, ThreadSettings};

const SET_POINTS: Role =
    Role { what: "table of set-points", remedy: "name another file with --csv" };

const PICTURES: Role = Role { what: "prediction", remedy: "name another folder with --pictures" };

/// The file by which a folder of pictures is known, and how it begins.
const MARK: FolderMark<'_> = FolderMark { name: "prediction.json", begins: "{\n  \"program\": " };

/// A log that is laid over a prediction.
#[derive(Clone, Debug)]
pub struct MeasuredRequest {
    /// The log.
    pub log: PathArg,
    /// How it is read.
    pub form: LogForm,
    /// What it counts more than the program.
    pub zeros: LogZeros,
    /// Numbers of the servos that are adjusted to it.
    pub fit: Vec<String>,
}

/// A program that is to be predicted, and what is wanted of it.
#[derive(Clone, Debug)]
pub struct PredictRequest {
    /// The machine, and how the CL file is read if there is one.
    pub job: JobSettings,
    /// The program.
    pub program: PathArg,
    /// The CL file that it was made from.
    pub against: Option<PathArg>,
    /// What stands in the control's tables; none: as the machine file, the command line and the CL file say.
    pub offsets: Option<PathArg>,
    /// So many blocks are run once more.
    pub most_blocks: u64,
    /// Time between set-points, s, over the machine file's.
    pub period: Option<f64>,
    /// A recorded log.
    pub measured: Option<MeasuredRequest>,
    /// Where the table of set-points goes.
    pub csv: Option<PathArg>,
    /// Where what was found goes, as JSON.
    pub summary: Option<PathArg>,
    /// The folder of the pictures.
    pub pictures: Option<PathArg>,
    /// The page.
    pub report: ReportSettings,
    /// How many threads work.
    pub threads: ThreadSettings,
}

/// What came of it.
pub struct PredictedProgram {
    /// What was found.
    pub found: Prediction,
    /// What the user should know.
    pub findings: Vec<Diagnostic>,
    /// A text went to standard output.
    pub printed: bool,
}

/// Predicts a program, and writes what is wanted of it.
///
/// # Errors
/// A file that cannot be read or written, a machine that cannot be used, or a block that is refused.
pub fn predict_program(
    session: &Session,
    request: &PredictRequest,
) -> Result<PredictedProgram, Failure> {
    let JobMachine { machine, finder } = JobMachine::load(session, &request.job, &[])?;
    request.refuse_one_stream_for_two()?;
    let folder = request.folder(session)?;
    let program = ProgramFile::open(session, &request.program)?;
    let offsets = match &request.offsets {
        Some(file) => Some(nc_program::offsets(session, file, &machine)?),
        None => None,
    };
    let mut source = match &request.against {
        Some(_) => Some(ClSource::of_job(session, &request.job, true)?),
        None if request.job.reading.is_chosen() => {
            let message = "--then and --operations say of CL files what the program is made of, and none is named";
            return Err(Diagnostic::error("option", message).help("name it with --against").into());
        }
        None => None,
    };
    let chosen = match &mut source {
        Some(source) => operations::chosen(&request.job, source)?,
        None => None,
    };
    let asked = PredictionSetup {
        session,
        arguments: &request.job,
        machine: &machine,
        finder: &finder,
        offsets,
        limits: Limits { blocks: request.most_blocks, ..Limits::default() },
        period: request.period,
        lines: chosen.map(|lines| lines.ranges),
        threads: request.threads.most(),
    };
    let mut overlay = match &request.measured {
        Some(measured) => Some(measured.overlay(session, &machine, asked.period())?),
        None => None,
    };
    let csv = request.csv.as_ref().map(|csv| (SET_POINTS, csv));
    let mut texts = ResultFiles::create(session, csv, request.summary.as_ref(), &request.report)?;
    let csv = texts.table.as_mut();
    let mut watch = SetPointOutputs {
        overlay: overlay.as_mut(),
        rows: match &texts.page {
            Some(_) => Some(rows(&asked, source.as_ref())?),
            None => None,
        },
        rooms: folder.as_ref().map(|_| PredictRooms::new(&machine, asked.period())),
        csv: csv.map(|file| CsvTable::new(set_points_csv::columns(&machine), file)),
    };
    let against = source.as_mut().map_or(PredictReference::Nothing, PredictReference::Cl);
    let predicted = predict(&asked, against, &program.name, Box::new(program.text()?), &mut watch)?;
    let SetPointOutputs { rooms, rows, csv, .. } = watch;
    csv.map_or(Ok(()), CsvTable::finish)?;
    let laid = request.laid_over(&machine, overlay.as_ref(), predicted)?;
    let PredictionWithLog { found, findings, picture } = laid;
    let json = files::json(&found);
    if let Some(file) = &mut texts.summary {
        file.write_bytes(json.as_bytes())?;
    }
    if let (Some(page), Some((rows, lines))) = (&mut texts.page, rows) {
        let told = PredictPage {
            session,
            machine: &machine,
            found: &found,
            findings: &findings,
            program: &request.program,
            against: request.against.as_ref(),
            threads: request.threads.most(),
        };
        told.write(rows, lines, source.as_mut(), &program, request.report.most(), page)?;
    }
    let mut texts = texts.all();
    let printed = texts.iter().any(AtomicFile::is_standard);
    if let (Some(folder), Some(rooms)) = (&folder, &rooms) {
        let mut files = rooms.files(&found);
        files.extend(picture);
        files.push((MARK.name, json));
        folder.add(&files, &mut texts)?;
        AtomicFile::finish(session, texts)?;
        folder.tidy(&files)?;
    } else {
        AtomicFile::finish(session, texts)?;
    }
    Ok(PredictedProgram { found, findings, printed })
}

/// What the page hears of a program.
fn rows<'m>(
    asked: &PredictionSetup<'m>,
    source: Option<&ClSource>,
) -> Result<(MotionRows<'m>, PredictedLines), Failure> {
    let machine = asked.machine;
    let cl = source.map(|source| ClWindow::of(asked.arguments, machine, source));
    let besides = ExtraColumns { predicted: true, ..ExtraColumns::default() };
    let rows = MotionRows::new(machine, cl.transpose()?, besides)?;
    Ok((rows, PredictedLines::new(machine, asked.period())?))
}

/// A prediction with the log that was laid over it, if there is one.
struct PredictionWithLog {
    found: Prediction,
    findings: Vec<Diagnostic>,
    /// The picture of the log: name and text.
    picture: Option<pictures::PredictionFile>,
}

impl PredictRequest {
    /// Refuses two inputs that are both standard input.
    fn refuse_one_stream_for_two(&self) -> Result<(), Failure> {
        let (program, against) = (&self.program, self.against.as_ref());
        nc_program::not_both_standard("program and CL file", program, against)?;
        let mut others = [Some(program), against].into_iter().flatten();
        let log = self.measured.as_ref().map(|measured| &measured.log);
        if log.is_some_and(|log| log.path().is_none()) && others.any(|file| file.path().is_none()) {
            let message = "the log and another input cannot both be standard input";
            let help = "name one of them";
            return Err(Diagnostic::error("input", message).help(help).into());
        }
        Ok(())
    }

    /// The folder of the pictures, in which nothing of others lies.
    fn folder<'a>(&'a self, session: &'a Session) -> Result<Option<OwnFolder<'a>>, Failure> {
        let Some(folder) = &self.pictures else {
            return Ok(None);
        };
        let folder = OwnFolder::open(session, folder, PICTURES, MARK, &pictures::NAMES);
        Ok(Some(folder.map_err(|fault| *fault)?))
    }

    /// Lays the log over a prediction, and adjusts servos to it.
    fn laid_over(
        &self,
        machine: &Machine,
        overlay: Option<&Overlay>,
        predicted: Predicted,
    ) -> Result<PredictionWithLog, Failure> {
        let Predicted { mut found, mut findings, chains } = predicted;
        let mut picture = None;
        if let (Some(overlay), Some(measured)) = (overlay, &self.measured) {
            let mut room = MeasuredRoom::new(machine, overlay.log().clock.period);
            let mut listen = |point: &MeasuredPoint| room.take(point);
            let laid = overlay.finish(machine, &chains, &mut listen, &mut findings)?;
            picture = room.file(&found, &laid);
            found.measured = Some(laid);
            found.fitted = measured::fitted(machine, overlay.log(), &measured.fit)?;
        }
        Ok(PredictionWithLog { found, findings, picture })
    }
}

impl MeasuredRequest {
    /// The log, to be laid over a prediction every `period` seconds.
    fn overlay(
        &self,
        session: &Session,
        machine: &Machine,
        period: f64,
    ) -> Result<Overlay, Failure> {
        let zeros = self.zeros.clone();
        let zeros = zeros.by_axis(machine).map_err(|fault| *fault)?;
        let (name, input) = nc_program::open_table(session, "the log", &self.log)?;
        let log = Log::read(machine, &self.form, &name, input)?;
        Ok(Overlay::new(log, zeros, period))
    }
}

/// What is made of set-points as they come.
struct SetPointOutputs<'a, 'm, 'f> {
    overlay: Option<&'a mut Overlay>,
    rooms: Option<PredictRooms>,
    rows: Option<(MotionRows<'m>, PredictedLines)>,
    csv: Option<CsvTable<'f, Sample>>,
}

impl PredictWatch for SetPointOutputs<'_, '_, '_> {
    fn done(&mut self, done: &BlockEffect) {
        if let Some((rows, _)) = &mut self.rows {
            rows.take(done);
        }
    }

    fn sees_blocks(&self) -> bool {
        self.rows.is_some()
    }

    fn sample(&mut self, sample: &Sample) -> Result<(), Failure> {
        if let Some(overlay) = &mut self.overlay {
            overlay.take(sample)?;
        }
        if let Some(rooms) = &mut self.rooms {
            rooms.take(sample);
        }
        if let Some((rows, lines)) = &mut self.rows
            && let Some((line, heard)) = lines.take(sample)
        {
            rows.hear(line, &heard);
        }
        match &mut self.csv {
            Some(csv) => Ok(csv.row(sample)?),
            None => Ok(()),
        }
    }
}
