//! The verb that has no name: one CL file on one machine becomes one program, or several.

mod parts;
mod said_settings;
mod setup_sheet;
mod shown;

use clap::Args;
use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, Severity};

use parts::{Caller, WholeJob};
use post_cli::arguments::flag_values::file;
use post_cli::arguments::{Flags, JobArguments};
use post_cli::terminal;
use post_job::channels::{self, ChannelProgram};
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, ClSource, OwnFolder, PathArg, Role};
use post_job::job_file::{self, JobMark, SavedJob};
use post_job::making::{self, ProgramMaker, ProgramOutcome, ProgramPart, ProgramRequest};
use post_job::old_summary::OldSummary;
use post_job::operations;
use post_job::predict::Prediction;
use post_job::session::Session;
use post_job::settings::{
    JobSettings, MakingSettings, OutputSettings, ReportSettings, ThreadSettings,
};
use post_job::summary::{self, SummaryJson};
use post_job::{caller, compensate, plan_rounds, plugin_finder, predict};
use said_settings::SaidSettings;
use setup_sheet::SheetJob;
use shown::{PictureFolder, Places};

const SETUP_SHEET: Role =
    Role { what: "setup sheet", remedy: "name another file with --setup-sheet" };

const PREDICTION: Role = Role { what: "prediction", remedy: "name another file with --predict=" };

const JOB: Role = Role { what: "job file", remedy: "name another file with --save-job" };

#[derive(Debug, Args)]
pub struct PostArguments {
    /// All settings that were said; before the flags, whose values are taken as they are read.
    #[command(flatten)]
    said: SaidSettings,

    #[command(flatten)]
    job: JobArguments,

    #[command(flatten)]
    outputs: Flags<OutputSettings>,

    #[command(flatten)]
    making: Flags<MakingSettings>,

    #[command(flatten)]
    threads: Flags<ThreadSettings>,

    #[command(flatten)]
    report: Flags<ReportSettings>,

    /// Takes the settings of an earlier run from its summary (--summary): dialect, TCP by control or post, tolerances,
    /// error model, where the part sat (--mount, --turn), and --tool-length if it was given. Other flags override them.
    /// Other keys of the machine file are not in a summary.
    #[arg(long, value_name = "FILE", value_parser = file())]
    like: Option<PathArg>,

    /// Saves this command line as a job file, which every verb takes in place of machine and CL file; its name ends in
    /// `.job.toml`.
    #[arg(long, value_name = "FILE", value_parser = file())]
    save_job: Option<PathArg>,

    /// Prints no summary, only warnings and errors.
    #[arg(short, long)]
    quiet: bool,

    /// The job file that says all of it, if one does.
    #[arg(skip)]
    mark: Option<JobMark>,
}

impl PostArguments {
    /// The same, posted from a job file.
    pub fn marked(self, mark: JobMark) -> Self {
        Self { mark: Some(mark), ..self }
    }

    /// What the programs depend on, as a text that is another if they may be.
    pub fn what_is_made(&self) -> String {
        let making = &self.making.0;
        let outputs = &self.outputs.0;
        let caller = if outputs.caller { " caller" } else { "" };
        format!("{:?} {making:?} {:?}{caller}", self.job.settings(), outputs.split)
    }

    /// The job, with what names its job file.
    fn marked_job(&self) -> JobSettings {
        JobSettings { mark: self.mark.clone(), ..self.job.settings() }
    }

    /// Text of the job file that is asked for.
    fn job_text(&self) -> Result<Option<String>, Failure> {
        let Some(target) = &self.save_job else {
            return Ok(None);
        };
        let job = self.job.settings();
        let said = &self.said.0;
        let saved = SavedJob { machine: &job.machine, cl: &job.input, said };
        Ok(Some(job_file::text(&saved, target)?))
    }

    /// A first pass over the CL file is made.
    fn looks_ahead(&self, machine: &Machine) -> bool {
        machine.program.looks_ahead
            || self.outputs.0.split.is_some()
            || self.outputs.0.setup_sheet.is_some()
    }

    /// The CL file is read more than once.
    fn reads_twice(&self, machine: &Machine) -> bool {
        let making = &self.making.0;
        making.compensate_servo
            || making.plan
            || self.looks_ahead(machine)
            || machine.wants_planes(true)
            || machine.has_modes()
            || self.outputs.0.verify
            || self.outputs.0.clearance
            || self.report.0.report.is_some()
            || self.outputs.0.predict.is_some()
    }
}

/// The files of a run, opened before the work begins: a program without its summary would be half a result.
#[derive(Default)]
struct OutputFiles {
    programs: Vec<AtomicFile>,
    maps: Vec<AtomicFile>,
    pages: Vec<AtomicFile>,
    summary: Option<AtomicFile>,
    sheet: Option<AtomicFile>,
    caller: Option<AtomicFile>,
    prediction: Option<AtomicFile>,
    job: Option<AtomicFile>,
}

impl OutputFiles {
    fn create(
        session: &Session,
        arguments: &PostArguments,
        parts: &[ProgramPart],
        caller: Option<&Caller>,
        maps: &[PathArg],
    ) -> Result<Self, Failure> {
        let outputs = &arguments.outputs.0;
        let pages = parts::each(&arguments.report.0.report, outputs.split, parts.len());
        let prediction = outputs.predict.as_ref().and_then(Option::as_ref);
        let mut targets: Vec<(Role, &PathArg)> =
            parts.iter().map(|part| (Role::PROGRAM, &part.target)).collect();
        targets.extend(maps.iter().map(|map| (shown::MAP, map)));
        targets.extend(pages.iter().map(|page| (Role::REPORT, page)));
        targets.extend(outputs.summary.iter().map(|summary| (Role::SUMMARY, summary)));
        targets.extend(outputs.setup_sheet.iter().map(|sheet| (SETUP_SHEET, sheet)));
        targets.extend(caller.map(|caller| (Role::PROGRAM, &caller.target)));
        targets.extend(prediction.map(|target| (PREDICTION, target)));
        targets.extend(arguments.save_job.iter().map(|target| (JOB, target)));
        let mut files = AtomicFile::create(session, &targets)?.into_iter();
        let mut take = |count| files.by_ref().take(count).collect::<Vec<_>>();
        Ok(Self {
            programs: take(parts.len()),
            maps: take(maps.len()),
            pages: take(pages.len()),
            summary: take(outputs.summary.iter().len()).pop(),
            sheet: take(outputs.setup_sheet.iter().len()).pop(),
            caller: take(caller.iter().len()).pop(),
            prediction: take(prediction.iter().len()).pop(),
            job: take(arguments.save_job.iter().len()).pop(),
        })
    }

    /// All of them, in the order in which they were opened.
    fn all(self) -> Vec<AtomicFile> {
        let Self { programs, maps, pages, summary, sheet, caller, prediction, job } = self;
        let single = [summary, sheet, caller, prediction, job].into_iter().flatten();
        programs.into_iter().chain(maps).chain(pages).chain(single).collect()
    }
}

/// A run that is about to make its programs.
struct BegunRun<'a> {
    arguments: &'a PostArguments,
    maker: ProgramMaker<'a>,
    source: ClSource,
    parts: Vec<ProgramPart>,
    caller: Option<Caller>,
    places: Places,
    saved: Option<String>,
}

/// A run whose programs are made, and not yet written.
struct MadeRun<'a> {
    arguments: &'a PostArguments,
    maker: &'a ProgramMaker<'a>,
    parts: &'a [ProgramPart],
    caller: Option<&'a Caller>,
    saved: Option<&'a str>,
    texts: OutputFiles,
    outcomes: Vec<ProgramOutcome>,
    findings: Vec<Diagnostic>,
    folders: Vec<OwnFolder<'a>>,
    drawn: Vec<PictureFolder>,
}

/// Posts as the arguments say.
pub fn run(session: &Session, arguments: &PostArguments) -> Result<(), Failure> {
    let job = arguments.marked_job();
    let mut begun = begin(session, &job, arguments)?;
    let made = make(session, &mut begun)?;
    write(session, vec![made])
}

/// Posts the programs of channels that run at the same time, all of them or none.
pub fn run_channels(session: &Session, channels: &[PostArguments]) -> Result<(), Failure> {
    if channels.iter().any(|arguments| arguments.outputs.0.split.is_some()) {
        let message = "the program of a channel is one, and --split makes several";
        return Err(Diagnostic::error("split", message).into());
    }
    let jobs: Vec<JobSettings> = channels.iter().map(PostArguments::marked_job).collect();
    let begun = jobs.iter().zip(channels);
    let mut begun: Vec<BegunRun<'_>> =
        begun.map(|(job, arguments)| begin(session, job, arguments)).collect::<Result<_, _>>()?;
    let mut made: Vec<MadeRun<'_>> =
        begun.iter_mut().map(|begun| make(session, begun)).collect::<Result<_, _>>()?;
    let programs = made.iter_mut().zip(&jobs).flat_map(|(made, job)| {
        let name = job.input.path().map(|path| path.display().to_string()).unwrap_or_default();
        let each = made.outcomes.iter_mut().zip(made.parts);
        each.map(move |(outcome, part)| ChannelProgram {
            cl_file: name.clone(),
            source: &job.machine,
            machine: &part.machine,
            outcome,
        })
    });
    let joined = channels::join(&mut programs.collect::<Vec<_>>())?;
    let quiet = channels.iter().any(|arguments| arguments.quiet);
    write(session, made)?;
    if !quiet {
        terminal::print_beside(session, &channels::text(&joined), false);
    }
    Ok(())
}

/// Reads what is needed before the programs are made.
fn begin<'a>(
    session: &'a Session,
    job: &'a JobSettings,
    arguments: &'a PostArguments,
) -> Result<BegunRun<'a>, Failure> {
    let outputs = &arguments.outputs.0;
    let saved = arguments.job_text()?;
    let (mut maker, machine) = ProgramMaker::open(session, job, &arguments.making.0)?;
    if let Some(like) = &arguments.like {
        let other = OldSummary::read(session, like)?.other_machine(&machine.name);
        session.findings(&other.into_iter().collect::<Vec<_>>());
    }
    maker.threads = arguments.threads.0.most();
    maker.keeps_clear = outputs.clearance;
    let mut source = ClSource::of_job(session, job, arguments.reads_twice(&machine))?;
    let chosen = operations::chosen(job, &mut source)?;
    if arguments.looks_ahead(&machine) {
        maker.look_ahead(&machine, &mut source, chosen.as_ref())?;
    }
    let whole = WholeJob { begins: source.further(), chosen };
    let (parts, caller) = the_parts(&maker, arguments, machine, whole)?;
    let places = Places::of(outputs, parts.len());
    Ok(BegunRun { arguments, maker, source, parts, caller, places, saved })
}

/// Makes the programs, in files that nobody sees yet.
fn make<'a>(session: &'a Session, begun: &'a mut BegunRun<'_>) -> Result<MadeRun<'a>, Failure> {
    let BegunRun { arguments, maker, source, parts, caller, places, saved } = begun;
    let (arguments, maker, parts, places) = (*arguments, &*maker, &*parts, &*places);
    let outputs = &arguments.outputs.0;
    let folders = places.folders(session)?;
    let mut texts = OutputFiles::create(session, arguments, parts, caller.as_ref(), &places.maps)?;
    let mut outcomes = Vec::new();
    let mut findings = Vec::new();
    let mut drawn = Vec::new();
    let (mut maps, mut pages) = (texts.maps.iter_mut(), texts.pages.iter_mut());
    for (part, text) in parts.iter().zip(&mut texts.programs) {
        let draws = !folders.is_empty();
        let ready = maker.prepare(part, source, draws || !places.maps.is_empty())?;
        let page = pages.next().map(|page| (page, arguments.report.0.most()));
        let (map, source) = (maps.next(), &mut *source);
        let (outcome, pictures) = shown::show(&part.machine, &part.target, map, draws, |watch| {
            let wanted = ProgramRequest {
                verify: outputs.verify,
                clearance: outputs.clearance,
                predict: outputs.predict.is_some(),
                summary: outputs.summary.is_some(),
                watch,
                observer: None,
                page,
            };
            maker.make(part, ready, source, text, wanted, &mut findings)
        })?;
        drawn.extend(pictures);
        outcomes.push(outcome);
    }
    let (caller, saved) = (caller.as_ref(), saved.as_deref());
    Ok(MadeRun {
        arguments,
        maker,
        parts,
        caller,
        saved,
        texts,
        outcomes,
        findings,
        folders,
        drawn,
    })
}

/// Writes all programs and what stands beside them, or nothing, and tells of them.
fn write(session: &Session, mut all: Vec<MadeRun<'_>>) -> Result<(), Failure> {
    let mut files = Vec::new();
    for made in &mut all {
        let MadeRun { arguments, maker, parts, outcomes, texts, .. } = made;
        write_besides(arguments, maker, parts, outcomes, texts)?;
        if let (Some(caller), Some(file)) = (made.caller, &mut texts.caller) {
            file.write_bytes(caller.text(maker)?.as_bytes())?;
        }
        if let (Some(text), Some(file)) = (made.saved, &mut texts.job) {
            file.write_bytes(text.as_bytes())?;
        }
        files.extend(std::mem::take(texts).all());
    }
    // Standard output is for a program or for JSON, alone there.
    let taken = files.iter().any(AtomicFile::is_standard);
    let drawn = || all.iter().flat_map(|made| made.folders.iter().zip(&made.drawn));
    for (folder, pictures) in drawn() {
        folder.add(pictures, &mut files)?;
    }
    AtomicFile::finish(session, files)?;
    for (folder, pictures) in drawn() {
        folder.tidy(pictures)?;
    }
    for made in &all {
        let MadeRun { arguments, maker, parts, outcomes, findings, .. } = made;
        debug_assert!(findings.iter().all(|finding| finding.severity == Severity::Warning));
        session.findings(findings);
        if !arguments.quiet {
            print(maker, parts, outcomes, taken);
        }
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
        let json = match (arguments.outputs.0.split, told.as_slice()) {
            (None, [told]) => files::json(told),
            (_, told) => files::json(&told),
        };
        file.write_bytes(json.as_bytes())?;
    }
    if let (Some(sheet), Some(ahead), Some(file)) =
        (&arguments.outputs.0.setup_sheet, &maker.ahead, &mut texts.sheet)
    {
        let reports = outcomes.iter().map(|outcome| &outcome.report);
        let programs: Vec<_> = parts.iter().map(|part| &part.target).zip(reports).collect();
        let machine = &parts[0].machine;
        let job = SheetJob {
            machine,
            cl_files: maker.job.files().collect(),
            left_out: parts.iter().find_map(|part| part.lines.as_ref()?.remark()),
            work_offset: plugin_finder::work_offset(&maker.finder, machine),
            relies_on: plugin_finder::relies_on(&maker.finder, machine)?,
            ahead,
        };
        let text = setup_sheet::text(sheet, &job, &programs);
        file.write_bytes(text.as_bytes())?;
    }
    if let Some(file) = &mut texts.prediction {
        let predictions: Vec<&Prediction> =
            outcomes.iter().filter_map(|outcome| outcome.prediction.as_ref()).collect();
        let json = match (arguments.outputs.0.split, predictions.as_slice()) {
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
    let further = maker.job.reading.then.iter().filter_map(PathArg::path);
    let name = further.fold(name, |name, path| format!("{name}, {}", path.display()));
    for (part, outcome) in parts.iter().zip(outcomes) {
        let mut text = summary::text(&outcome.told(), &name, &part.target);
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

/// The programs of the run, one, or as many as the CL file has operations or tools; and what calls them.
fn the_parts(
    maker: &ProgramMaker<'_>,
    arguments: &PostArguments,
    machine: Machine,
    whole: WholeJob,
) -> Result<(Vec<ProgramPart>, Option<Caller>), Failure> {
    let ProgramMaker { session, job, finder, ahead, .. } = maker;
    let outputs = &arguments.outputs.0;
    let target = making::target(job, outputs.output.as_ref(), &machine, finder)?;
    let (Some(split), Some(ahead)) = (outputs.split, ahead) else {
        if outputs.caller {
            let message = "--caller calls several programs, and there is one";
            let help = "--split operations or --split tools makes several";
            return Err(Diagnostic::error("caller", message).help(help).into());
        }
        return Ok((vec![ProgramPart { lines: whole.chosen, target, machine }], None));
    };
    if target == PathArg::Standard {
        return Err(Diagnostic::error(
            "split",
            "--split writes several programs, and standard output takes one",
        )
        .help("name a file with -o")
        .into());
    }
    let lines = parts::lines(split, ahead, &whole)?;
    let count = lines.len();
    // Programs of one number would take each other's place in the control.
    let number = plugin_finder::program_number(finder, &machine);
    let numbers = number.map(|first| first + i64::from(outputs.caller));
    // A name that is called has letters, digits and `_`.
    let dash = if outputs.caller && number.is_none() { "_" } else { "-" };
    let programs: Result<Vec<ProgramPart>, Failure> = lines
        .into_iter()
        .enumerate()
        .map(|(index, lines)| {
            let number = numbers.map(|first| first + index as i64);
            let mut machine = making::numbered(session, job, number)?;
            if outputs.caller {
                caller::end_as_subprogram(finder, &mut machine, number)?;
            }
            let target = parts::target(&target, dash, index + 1, count);
            Ok(ProgramPart { lines: Some(lines), target, machine })
        })
        .collect();
    let programs = programs?;
    let caller = match outputs.caller {
        true => Some(Caller::of(&programs, ahead, number, target, machine)),
        false => None,
    };
    Ok((programs, caller))
}
