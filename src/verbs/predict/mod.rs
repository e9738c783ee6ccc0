//! `post predict`: what an NC program does on its machine, before it is run there.

mod measured_arguments;
mod measured_pictures;
mod path_pictures;
mod pictures;
mod predict_page;
mod set_points_csv;
mod spectrum;
mod trail;

use clap::Args;
use post_machine::diagnostic::Diagnostic;
use post_readback::BlockEffect;
use post_readback::interpret::Limits;

use crate::arguments::flag_values;
use crate::arguments::flag_values::file;
use crate::arguments::{Flags, JobFlags};
use crate::terminal;
use measured_arguments::MeasuredArguments;
use measured_pictures::MeasuredRoom;
use pictures::Rooms;
use post_job::columns::CsvTable;
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, OwnFolder, PathArg, Role};
use post_job::predict::measured::{MeasuredPoint, Overlay};
use post_job::predict::{self, Against, PredictWatch, Predicted, Sample};
use post_job::report::{Besides, ClWindow, MotionRows, PredictedLines};
use post_job::session::Session;
use post_job::settings::ReportSettings;
use post_job::{self as job, nc_program, plugin_finder};

/// Predicts what an NC program does on its machine: cycle time, true feed, and how far the tool strays.
///
/// The program is read back as its control reads it and becomes set-points of the axes, with the limits of the axes, the
/// look-ahead and the corners of the control (`[motion]` of the machine file); the servos (`[servo]`) follow them; where
/// the axes then are is held against the commanded path, and with --against against the path of the CL file. Axes without
/// a servo are where they are commanded: times and feeds are predicted all the same.
///
/// What `post` was told for the job must be told here too (--mount, --tool-length, …).
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

    /// Writes what was found as JSON for programs to read; `-` is standard output.
    #[arg(long, value_name = "FILE", value_parser = file())]
    summary: Option<PathArg>,

    /// Draws into this folder, as SVG: errors of the axes and feed over time, contour error along the path, magnified on
    /// it and by its size, and the spectrum of the axes' errors; with --measured also the log's errors, those predicted for
    /// it and their difference; and writes the summary beside them.
    #[arg(long, value_name = "FOLDER", value_parser = file())]
    pictures: Option<PathArg>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    /// The CL file that the program was made from: how far the tool strays from its path.
    #[arg(long, value_name = "CL-FILE", value_parser = file())]
    against: Option<PathArg>,

    #[command(flatten)]
    measured: MeasuredArguments,

    /// So many blocks are run once more, by loops, jumps and subprograms; more are refused.
    #[arg(long, value_name = "N", default_value_t = Limits::default().blocks)]
    most_blocks: u64,

    /// No table, messages alone.
    #[arg(short, long)]
    quiet: bool,
}

const SET_POINTS: Role =
    Role { what: "table of set-points", remedy: "name another file with --csv" };

const PICTURES: Role = Role { what: "prediction", remedy: "name another folder with --pictures" };

/// The file by which a folder of pictures is known, and how it begins.
const MARK: (&str, &str) = ("prediction.json", "{\n  \"program\": ");

/// What is made of set-points as they come.
struct Watch<'a, 'm, 'f> {
    overlay: Option<&'a mut Overlay>,
    rooms: Option<Rooms>,
    rows: Option<(MotionRows<'m>, PredictedLines)>,
    csv: Option<CsvTable<'f, Sample>>,
}

impl PredictWatch for Watch<'_, '_, '_> {
    fn done(&mut self, done: &BlockEffect) {
        if let Some((rows, _)) = &mut self.rows {
            rows.take(done);
        }
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

/// Predicts as the arguments say.
pub fn run(session: &Session, arguments: &PredictArguments) -> Result<(), Failure> {
    let against = arguments.against.as_ref();
    let input = against.unwrap_or(&PathArg::Standard);
    let job = &arguments.job.settings(&arguments.machine, input);
    let machine = job::machine(session, job, &[])?;
    let finder = plugin_finder::finder(session, &job.over.plugins)?;
    job::say_what_is_left(session, job, &machine, &finder);
    let named = &arguments.program;
    nc_program::not_both_standard(named, against)?;
    let mut others = [Some(named), against].into_iter().flatten();
    if arguments.measured.is_standard() && others.any(|file| file.path().is_none()) {
        let message = "the log and another input cannot both be standard input";
        let help = "name one of them";
        return Err(Diagnostic::error("input", message).help(help).into());
    }
    let folder = match &arguments.pictures {
        Some(folder) => {
            let folder = OwnFolder::open(session, folder, PICTURES, MARK, &pictures::NAMES);
            Some(folder.map_err(|fault| *fault)?)
        }
        None => None,
    };
    let (name, program) = nc_program::open(session, named)?;
    let offsets = match &arguments.offsets {
        Some(file) => Some(nc_program::offsets(session, file, &machine)?),
        None => None,
    };
    let period = arguments.period.unwrap_or(machine.motion.period);
    let mut overlay = arguments.measured.overlay(session, &machine, period)?;
    let mut targets: Vec<(Role, &PathArg)> = Vec::new();
    targets.extend(arguments.csv.iter().map(|target| (SET_POINTS, target)));
    targets.extend(arguments.summary.iter().map(|target| (Role::SUMMARY, target)));
    targets.extend(arguments.report.0.report.iter().map(|page| (Role::REPORT, page)));
    let mut texts = AtomicFile::create(session, &targets)?;
    let page = arguments.report.0.report.as_ref().and_then(|_| texts.pop());
    let again = nc_program::again(&name, &program)?;
    let asked = predict::Asked {
        session,
        arguments: job,
        machine: &machine,
        finder: &finder,
        offsets,
        limits: Limits { blocks: arguments.most_blocks, ..Limits::default() },
        period: arguments.period,
        lines: None,
    };
    let mut source = match against {
        Some(file) => Some(files::ClSource::new(session, file, true)?),
        None => None,
    };
    let rows = match &page {
        Some(_) => {
            let cl = source.as_ref().map(|source| ClWindow::of(job, &machine, source));
            let besides = Besides { predicted: true, ..Besides::default() };
            let rows = MotionRows::new(&machine, cl.transpose()?, besides)?;
            Some((rows, PredictedLines::new(&machine, period)?))
        }
        None => None,
    };
    let against = match &mut source {
        Some(source) => Against::Cl(source),
        None => Against::Nothing,
    };
    let csv = arguments.csv.as_ref().and(texts.first_mut());
    let mut watch = Watch {
        overlay: overlay.as_mut(),
        rooms: folder.as_ref().map(|_| Rooms::new(&machine, period)),
        rows,
        csv: csv.map(|file| CsvTable::new(set_points_csv::columns(&machine), file)),
    };
    let predicted = predict::predict(&asked, against, &name, program, &mut watch)?;
    let Watch { rooms, rows, csv, .. } = watch;
    csv.map_or(Ok(()), CsvTable::finish)?;
    let Predicted { mut found, mut findings, chains } = predicted;
    let mut measured_picture = None;
    if let Some(overlay) = &overlay {
        let mut room = MeasuredRoom::new(&machine, overlay.log().clock.period);
        let mut listen = |point: &MeasuredPoint| room.take(point);
        let laid = overlay.finish(&machine, &chains, &mut listen, &mut findings)?;
        measured_picture = room.file(&found, &laid);
        found.measured = Some(laid);
        found.fitted = arguments.measured.fitted(&machine, overlay.log())?;
    }
    let json = files::json(&found);
    if let (Some(_), Some(file)) = (&arguments.summary, texts.last_mut()) {
        file.write_bytes(json.as_bytes())?;
    }
    if let (Some(mut page), Some((rows, lines))) = (page, rows) {
        let shown = predict_page::Shown {
            session,
            machine: &machine,
            found: &found,
            findings: &findings,
            program: named,
            against: arguments.against.as_ref(),
        };
        let text = nc_program::again(&name, &again)?;
        let texts_of = (source.as_mut(), name.as_str(), text);
        shown.write((rows, lines), texts_of, arguments.report.0.most(), &mut page)?;
        texts.push(page);
    }
    let taken = texts.iter().any(AtomicFile::is_standard);
    if let (Some(folder), Some(rooms)) = (&folder, &rooms) {
        let mut files = rooms.files(&found);
        files.extend(measured_picture);
        files.push((MARK.0, json));
        folder.add(&files, &mut texts)?;
        AtomicFile::finish(session, texts)?;
        folder.tidy(&files)?;
    } else {
        AtomicFile::finish(session, texts)?;
    }
    session.findings(&findings);
    if !arguments.quiet {
        let text = predict::text(&found);
        if taken {
            terminal::tell(&text);
        } else {
            terminal::print(session, &text);
        }
    }
    Ok(())
}
