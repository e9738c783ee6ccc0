//! The verb that has no name: one CL file on one machine becomes one program, or several.

mod parts;
mod setup_sheet;
mod shown;

use clap::Args;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity};

use parts::Split;
use post_cli::arguments::flag_values::file;
use post_cli::arguments::{Flags, JobArguments};
use post_cli::terminal;
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, ClSource, PathArg, Role};
use post_job::making::{self, ProgramMaker, ProgramOutcome, ProgramPart, ProgramRequest};
use post_job::predict::Prediction;
use post_job::session::Session;
use post_job::settings::{MakingSettings, ReportSettings, ThreadSettings};
use post_job::summary::{self, SummaryJson};
use post_job::{compensate, plan_rounds, plugin_finder, predict};
use shown::ShownArguments;

const SETUP_SHEET: Role =
    Role { what: "setup sheet", remedy: "name another file with --setup-sheet" };

const PREDICTION: Role = Role { what: "prediction", remedy: "name another file with --predict=" };

#[derive(Debug, Args)]
pub struct PostArguments {
    #[command(flatten)]
    job: JobArguments,

    /// The NC program, `-` for standard output. [default: beside the CL file, with the dialect's ending]
    #[arg(short, long, value_name = "FILE", value_parser = file())]
    output: Option<PathArg>,

    /// Writes the summary as JSON for programs to read; `-` is standard output. Of several programs a list.
    #[arg(long, value_name = "FILE", value_parser = file())]
    summary: Option<PathArg>,

    /// Writes a sheet for whoever sets the machine up: tools, extents, times, options; as HTML if the file's name ends
    /// so, else as Markdown.
    #[arg(long, value_name = "FILE", value_parser = file())]
    setup_sheet: Option<PathArg>,

    /// Writes a program of its own for each operation, or for each tool: part-1.nc, part-2.nc, …
    #[arg(long, value_name = "WHERE", value_enum)]
    split: Option<Split>,

    /// Reads each program back before it takes its name, runs it as the control does and holds it against the CL file
    /// (`post verify`): what strays from it is not written.
    #[arg(long)]
    verify: bool,

    #[command(flatten)]
    making: Flags<MakingSettings>,

    #[command(flatten)]
    threads: Flags<ThreadSettings>,

    #[command(flatten)]
    shown: ShownArguments,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    /// Predicts what each program does on the machine (`post predict`): cycle time, true feed, axes, and how far the tool
    /// strays; with =FILE as JSON too, of several programs a list.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true, value_parser = file())]
    predict: Option<Option<PathArg>>,

    /// No summary, warnings and errors alone.
    #[arg(short, long)]
    quiet: bool,
}

impl PostArguments {
    /// A first pass over the CL file is made.
    fn looks_ahead(&self, machine: &Machine) -> bool {
        machine.program.looks_ahead || self.split.is_some() || self.setup_sheet.is_some()
    }

    /// The CL file is read more than once.
    fn reads_twice(&self, machine: &Machine) -> bool {
        let making = &self.making.0;
        making.compensate_servo
            || making.plan
            || self.looks_ahead(machine)
            || machine.control.planes
            || self.verify
            || self.report.0.report.is_some()
            || self.predict.is_some()
    }
}

/// The files of a run, opened before the work begins: a program without its summary would be half a result.
struct OutputFiles {
    programs: Vec<AtomicFile>,
    maps: Vec<AtomicFile>,
    pages: Vec<AtomicFile>,
    summary: Option<AtomicFile>,
    sheet: Option<AtomicFile>,
    prediction: Option<AtomicFile>,
}

impl OutputFiles {
    fn create(
        session: &Session,
        arguments: &PostArguments,
        parts: &[ProgramPart],
        maps: &[PathArg],
    ) -> Result<Self, Failure> {
        let pages = parts::each(&arguments.report.0.report, arguments.split, parts.len());
        let prediction = arguments.predict.as_ref().and_then(Option::as_ref);
        let mut targets: Vec<(Role, &PathArg)> =
            parts.iter().map(|part| (Role::PROGRAM, &part.target)).collect();
        targets.extend(maps.iter().map(|map| (shown::MAP, map)));
        targets.extend(pages.iter().map(|page| (Role::REPORT, page)));
        targets.extend(arguments.summary.iter().map(|summary| (Role::SUMMARY, summary)));
        targets.extend(arguments.setup_sheet.iter().map(|sheet| (SETUP_SHEET, sheet)));
        targets.extend(prediction.map(|target| (PREDICTION, target)));
        let mut files = AtomicFile::create(session, &targets)?.into_iter();
        let mut take = |count| files.by_ref().take(count).collect::<Vec<_>>();
        Ok(Self {
            programs: take(parts.len()),
            maps: take(maps.len()),
            pages: take(pages.len()),
            summary: take(arguments.summary.iter().len()).pop(),
            sheet: take(arguments.setup_sheet.iter().len()).pop(),
            prediction: take(prediction.iter().len()).pop(),
        })
    }

    /// All of them, in the order in which they were opened.
    fn all(self) -> Vec<AtomicFile> {
        let Self { programs, maps, pages, summary, sheet, prediction } = self;
        let single = [summary, sheet, prediction].into_iter().flatten();
        programs.into_iter().chain(maps).chain(pages).chain(single).collect()
    }
}

/// Posts as the arguments say.
pub fn run(session: &Session, arguments: &PostArguments) -> Result<(), Failure> {
    let job = &arguments.job.settings();
    let (mut maker, machine) = ProgramMaker::open(session, job, &arguments.making.0)?;
    maker.threads = arguments.threads.0.most();
    let mut source = ClSource::new(session, &job.input, arguments.reads_twice(&machine))?;
    if arguments.looks_ahead(&machine) {
        maker.look_ahead(&machine, &mut source)?;
    }
    let maker = maker;
    let parts = the_parts(&maker, arguments, machine)?;
    let places = arguments.shown.places(arguments.split, parts.len());
    let folders = places.folders(session)?;
    let mut texts = OutputFiles::create(session, arguments, &parts, &places.maps)?;
    let mut outcomes = Vec::new();
    let mut findings = Vec::new();
    let mut drawn = Vec::new();
    let (mut maps, mut pages) = (texts.maps.iter_mut(), texts.pages.iter_mut());
    for (part, text) in parts.iter().zip(&mut texts.programs) {
        let draws = !folders.is_empty();
        let ready = maker.prepare(part, &mut source, draws || !places.maps.is_empty())?;
        let page = pages.next().map(|page| (page, arguments.report.0.most()));
        let (map, source) = (maps.next(), &mut source);
        let (outcome, pictures) = shown::show(&part.machine, &part.target, map, draws, |watch| {
            let (verify, predict) = (arguments.verify, arguments.predict.is_some());
            let wanted = ProgramRequest { verify, predict, watch, observer: None, page };
            maker.make(part, ready, source, text, wanted, &mut findings)
        })?;
        drawn.extend(pictures);
        outcomes.push(outcome);
    }
    write_besides(arguments, &maker, &parts, &outcomes, &mut texts)?;
    let mut files = texts.all();
    // Standard output is for a program or for JSON, alone there.
    let taken = files.iter().any(AtomicFile::is_standard);
    for (folder, pictures) in folders.iter().zip(&drawn) {
        folder.add(pictures, &mut files)?;
    }
    AtomicFile::finish(session, files)?;
    for (folder, pictures) in folders.iter().zip(&drawn) {
        folder.tidy(pictures)?;
    }
    debug_assert!(findings.iter().all(|finding| finding.severity == Severity::Warning));
    session.findings(&findings);
    if !arguments.quiet {
        print(&maker, &parts, &outcomes, taken);
    }
    Ok(())
}

/// Writes what stands beside the programs: summary, set-up sheet and prediction.
fn write_besides(
    arguments: &PostArguments,
    maker: &ProgramMaker<'_>,
    parts: &[ProgramPart],
    outcomes: &[ProgramOutcome],
    texts: &mut OutputFiles,
) -> Result<(), Failure> {
    if let Some(file) = &mut texts.summary {
        let told: Vec<SummaryJson<'_>> = outcomes.iter().map(ProgramOutcome::told).collect();
        let json = match (arguments.split, told.as_slice()) {
            (None, [told]) => files::json(told),
            (_, told) => files::json(&told),
        };
        file.write_bytes(json.as_bytes())?;
    }
    if let (Some(sheet), Some(ahead), Some(file)) =
        (&arguments.setup_sheet, &maker.ahead, &mut texts.sheet)
    {
        let reports = outcomes.iter().map(|outcome| &outcome.report);
        let programs: Vec<_> = parts.iter().map(|part| &part.target).zip(reports).collect();
        let input = &maker.job.input;
        let text = setup_sheet::text(sheet, &parts[0].machine, input, ahead, &programs);
        file.write_bytes(text.as_bytes())?;
    }
    if let Some(file) = &mut texts.prediction {
        let predictions: Vec<&Prediction> =
            outcomes.iter().filter_map(|outcome| outcome.prediction.as_ref()).collect();
        let json = match (arguments.split, predictions.as_slice()) {
            (None, [prediction]) => files::json(prediction),
            (_, predictions) => files::json(&predictions),
        };
        file.write_bytes(json.as_bytes())?;
    }
    Ok(())
}

/// Prints the summary of each program; to standard error if standard output is taken.
fn print(
    maker: &ProgramMaker<'_>,
    parts: &[ProgramPart],
    outcomes: &[ProgramOutcome],
    taken: bool,
) {
    let name = maker.job.input.path();
    let name = name.map_or("standard input".to_owned(), |path| path.display().to_string());
    for (part, outcome) in parts.iter().zip(outcomes) {
        let read_back = outcome.verification.as_ref();
        let mut text = summary::text(&outcome.report, read_back, &name, &part.target);
        if let Some(found) = &outcome.compensation {
            text.push_str(&compensate::text(found));
        }
        if let Some(found) = &outcome.plan_rounds {
            text.push_str(&plan_rounds::text(found));
        }
        if let Some(found) = &outcome.prediction {
            text.push('\n');
            text.push_str(&predict::text(found));
        }
        terminal::print_beside(maker.session, &text, taken);
    }
}

/// The programs of the run: one, or as many as the CL file has operations or tools.
fn the_parts(
    maker: &ProgramMaker<'_>,
    arguments: &PostArguments,
    machine: Machine,
) -> Result<Vec<ProgramPart>, Failure> {
    let ProgramMaker { session, job, finder, ahead, .. } = maker;
    let target = making::target(job, arguments.output.as_ref(), &machine, finder)?;
    let (Some(split), Some(ahead)) = (arguments.split, ahead) else {
        return Ok(vec![ProgramPart { lines: None, target, machine }]);
    };
    if target == PathArg::Standard {
        return Err(Diagnostic::error(
            "split",
            "--split writes several programs, and standard output takes one",
        )
        .help("name a file with -o")
        .into());
    }
    let lines = parts::lines(split, ahead)?;
    let count = lines.len();
    // Programs of one number would take each other's place in the control.
    let number = plugin_finder::program_number(finder, &machine);
    lines
        .into_iter()
        .enumerate()
        .map(|(index, lines)| {
            let number = number.map(|first| first + index as i64);
            Ok(ProgramPart {
                lines: Some(lines),
                target: parts::target(&target, index + 1, count),
                machine: making::numbered(session, job, number)?,
            })
        })
        .collect()
}
