//! `papers study`: how far the tool strays on a CL file, and what each model and each placement makes of it.

mod move_pictures;
mod notation;
mod path_picture;
mod pictures;
mod study_csv;
mod study_text;
mod sweep;
mod sweep_values;

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::deviations::{CutSurvey, Distribution, Keeper, KeptMove, MoveRow};
use clap::Args;
use post_host::OpenedModel;
use post_machine::description::{Machine, Method, Setting};
use post_machine::diagnostic::Diagnostic;
use post_plugin::ModelSession;
use post_posting::report::PostingReport;

use post_cli::arguments::JobArguments;
use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::files::{AtomicFile, FolderMark, OwnFolder, PathArg, Role};
use post_job::session::Session;
use post_job::{DryRun, plugin_finder, say_what_is_left};
use sweep::Swept;
use sweep_values::Sweep;

const STUDY: Role = Role { what: "study", remedy: "name another folder with -o" };

/// Moves before and behind the one that is looked at, in the pictures that show several.
const AROUND: usize = 4;

/// Studies the deviation of a CL file on a machine: table, CSV and pictures, and no program.
///
/// For every cut: how far the control point strays if nothing is done, what the error models foresee and leave, and
/// what comes of putting points in. The comparisons are those of Li 2024 (harmonic model, compensation) and of Sha
/// et al. 2022 (parabolic model, bisection, swing length, edge radius).
///
/// Written into the folder: moves.csv (every move), summary.csv (distributions), blocks.csv (the whole program by
/// each placement), sweep.csv, and pictures as SVG. Deviations are in µm, turns in degrees: the root of the sum of
/// squares over the rotary axes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  papers study part.cls --machine ac-trunnion
  papers study blade.cls --machine disc-cutter --sweep Lm=100:400:50
  papers study part.cls --machine my-mill.toml --tcp post --move 17 -o compare

Exit codes: 0 the study is written; 1 refused, the messages say why; 2 the command line is wrong.")]
pub struct StudyArguments {
    #[command(flatten)]
    job: JobArguments,

    /// The folder that everything is written to. [default: beside the CL file, with -study behind its name]
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,

    /// Goes over the file with a parameter of the machine, or any key, at each of these values, both ends included.
    #[arg(long, value_name = "NAME=FROM:TO:STEP", value_parser = sweep_values::parse)]
    sweep: Option<Sweep>,

    /// The move to look at closely, by its number in moves.csv. [default: the one that strays farthest]
    #[arg(long = "move", value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    number: Option<u32>,

    /// Takes axis values as they are solved, not as the dialect rounds them: as the papers do.
    #[arg(long)]
    exact: bool,
}

/// All that was found out.
pub struct DeviationStudy {
    pub file: String,
    pub machine: Machine,
    pub exact: bool,
    /// Names of the models, in the order of [`MoveRow::models`].
    pub models: Vec<String>,
    pub rows: Vec<MoveRow>,
    /// Largest deviation of every piece after each placement, mm.
    pub pieces: [Vec<f64>; 3],
    /// Deviations, mm: of the moves, what each model leaves, after compensation with each, after each placement.
    pub spreads: Vec<NamedDistribution>,
    /// The whole program by each way.
    pub programs: Vec<PostedVariant>,
    /// Which of the rows is looked at.
    pub focus: usize,
    /// It and its neighbours.
    pub kept: Vec<KeptMove>,
    pub sweep: Option<(String, Vec<Swept>)>,
}

impl DeviationStudy {
    /// The CL file without its folder, for titles.
    pub fn part(&self) -> String {
        let name = Path::new(&self.file).file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }
}

/// How deviations are spread.
pub struct NamedDistribution {
    pub name: String,
    pub distribution: Distribution,
    /// Points put in; none where the question does not arise.
    pub points: Option<u64>,
}

/// What came of posting the whole file in one way.
pub struct PostedVariant {
    pub name: String,
    pub reduce: bool,
    /// Why it cannot be done, if it cannot.
    pub report: Result<PostingReport, String>,
}

/// Error models at work.
pub struct Models {
    pub opened: Vec<OpenedModel>,
    /// The machine's own, which placements ask.
    pub own: OpenedModel,
}

/// Studies as the arguments say.
pub fn run(session: &Session, arguments: &StudyArguments) -> Result<(), Failure> {
    let job = &arguments.job.settings();
    let dry_run = DryRun::new(session, "study", "papers", job, arguments.exact)?;
    let machine = self::machine(&dry_run, &[])?;
    say_what_is_left(session, job, &machine, &dry_run.finder);
    let folder = folder(arguments, &job.input);
    let names = [&study_csv::NAMES[..], &pictures::NAMES[..]].concat();
    let mark = FolderMark { name: "moves.csv", begins: study_csv::BEGIN };
    let own = OwnFolder::open(session, &folder, STUDY, mark, &names).map_err(|fault| *fault)?;
    let (names, mut models) = models(&dry_run, &machine)?;
    let (surveyed, findings) = survey(&dry_run, &machine, &names, &mut models)?;
    let Surveyed { rows, pieces, spreads } = surveyed;
    let focus = focus(arguments, &rows)?;
    let around = focus.saturating_sub(AROUND)..(focus + AROUND + 1).min(rows.len());
    let study = DeviationStudy {
        kept: keep(&dry_run, &machine, around)?,
        programs: programs(&dry_run, &names)?,
        sweep: match &arguments.sweep {
            Some(sweep) => Some((sweep.name.clone(), sweep::run(&dry_run, sweep, focus)?)),
            None => None,
        },
        file: dry_run.name.clone(),
        exact: arguments.exact,
        models: names,
        machine,
        rows,
        pieces,
        spreads,
        focus,
    };
    session.findings(&findings);
    let mut files = study_csv::files(&study);
    files.extend(pictures::files(&study, &mut models));
    let mut texts = Vec::new();
    own.add(&files, &mut texts)?;
    AtomicFile::finish(session, texts)?;
    own.tidy(&files)?;
    let shown = folder.path().unwrap_or(Path::new("."));
    print(session, &study_text::text(&study, shown, &files));
    Ok(())
}

fn folder(arguments: &StudyArguments, source: &PathArg) -> PathArg {
    arguments.output.clone().map_or_else(
        || {
            let stem = source.stem().unwrap_or_default();
            source.map(|path| path.with_file_name(format!("{stem}-study")))
        },
        PathArg::from,
    )
}

/// The machine with `more` set, every CL point of its cuts kept.
fn machine(dry_run: &DryRun<'_>, more: &[Setting]) -> Result<Machine, Failure> {
    let mut settings = vec![Setting::Reduce(false)];
    settings.extend_from_slice(more);
    let mut machine = dry_run.machine(&settings)?;
    // The path is studied, not the way off the part behind it.
    machine.frame.retract.clear();
    Ok(machine)
}

/// Opens the models that are compared.
fn models(dry_run: &DryRun<'_>, machine: &Machine) -> Result<(Vec<String>, Models), Failure> {
    let own = &machine.accuracy.model;
    // All that are part of the command; the machine's own comes to them.
    let mut names: Vec<String> =
        plugin_finder::built_in(true).into_iter().map(str::to_owned).collect();
    if !names.contains(own) {
        names.push(own.clone());
    }
    let open = |name: &String| {
        if name == own {
            return plugin_finder::model(&dry_run.finder, machine).map(|(model, _)| model);
        }
        plugin_finder::plain_model(&dry_run.finder, name)
    };
    Ok((
        names.clone(),
        Models { opened: names.iter().map(open).collect::<Result<_, _>>()?, own: open(own)? },
    ))
}

/// What a look at every move gives.
struct Surveyed {
    rows: Vec<MoveRow>,
    pieces: [Vec<f64>; 3],
    spreads: Vec<NamedDistribution>,
}

/// Looks at every move.
fn survey(
    dry_run: &DryRun<'_>,
    machine: &Machine,
    names: &[String],
    models: &mut Models,
) -> Result<(Surveyed, Vec<Diagnostic>), Failure> {
    let sessions = models.opened.iter_mut();
    let sessions = sessions.map(|model| model as &mut dyn ModelSession);
    let mut survey = CutSurvey::new(machine, &mut models.own, sessions.collect());
    let (_, findings) = dry_run.pass(machine, Some(&mut survey))?;
    if let Some(fault) = survey.fault {
        return Err(Diagnostic::error("model", fault).into());
    }
    if survey.rows.is_empty() {
        let message = format!("{} has no cut between two positions", dry_run.name);
        return Err(Diagnostic::error("study", message).into());
    }
    let rows = survey.rows;
    let mut spreads = Vec::new();
    let mut spread = |name: String, mut values: Vec<f64>, points: Option<u64>| {
        spreads.push(NamedDistribution {
            name,
            distribution: Distribution::of(&mut values),
            points,
        });
    };
    let of_rows = |value: &dyn Fn(&MoveRow) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    spread("uncompensated".to_owned(), of_rows(&|row| row.raw.size), None);
    for (index, name) in names.iter().enumerate() {
        let left = of_rows(&|row| row.models[index].residual);
        spread(format!("left by {name}"), left, None);
    }
    for ((index, name), pieces) in names.iter().enumerate().zip(survey.compensated) {
        let placed = rows.iter().filter_map(|row| row.models[index].compensated);
        let points = placed.map(|placed| u64::from(placed.points)).sum();
        spread(format!("compensated, {name}"), pieces, Some(points));
    }
    for ((index, placement), pieces) in CutSurvey::PLACEMENTS.iter().enumerate().zip(&survey.pieces)
    {
        let placed = rows.iter().filter_map(|row| row.placed[index]);
        let points = placed.map(|placed| u64::from(placed.points)).sum();
        let name = placement.name().to_owned();
        spread(name, pieces.clone(), Some(points));
    }
    Ok((Surveyed { rows, pieces: survey.pieces, spreads }, findings))
}

/// Which move is looked at.
fn focus(arguments: &StudyArguments, rows: &[MoveRow]) -> Result<usize, Failure> {
    if let Some(number) = arguments.number {
        let focus = number as usize - 1;
        return if focus < rows.len() {
            Ok(focus)
        } else {
            let message = format!("--move {number}: the file has {} cuts", rows.len());
            Err(Diagnostic::error("study", message).into())
        };
    }
    // Of moves that are equal, the first.
    let mut worst = 0;
    for (index, row) in rows.iter().enumerate() {
        if row.raw.size > rows[worst].raw.size {
            worst = index;
        }
    }
    Ok(worst)
}

fn keep(
    dry_run: &DryRun<'_>,
    machine: &Machine,
    wanted: Range<usize>,
) -> Result<Vec<KeptMove>, Failure> {
    let mut keeper = Keeper::new(wanted);
    dry_run.pass(machine, Some(&mut keeper))?;
    Ok(keeper.kept)
}

/// Posts the whole file by each placement, with and without leaving out CL points, and compensated with each model.
fn programs(dry_run: &DryRun<'_>, models: &[String]) -> Result<Vec<PostedVariant>, Failure> {
    let mut programs = Vec::new();
    let mut post = |name: String, reduce: bool, settings: &[Setting]| {
        let machine = self::machine(dry_run, settings)?;
        let report = match dry_run.pass(&machine, None) {
            Ok((report, _)) => Ok(report),
            Err(failure) => Err(failure
                .findings()
                .into_iter()
                .next()
                .map_or_else(|| "refused".to_owned(), |finding| finding.message)),
        };
        programs.push(PostedVariant { name, reduce, report });
        Ok::<(), Failure>(())
    };
    for placement in CutSurvey::PLACEMENTS {
        for reduce in [false, true] {
            let settings = [
                Setting::Method(Method::Linearise),
                Setting::Placement(placement),
                Setting::Reduce(reduce),
            ];
            post(placement.name().to_owned(), reduce, &settings)?;
        }
    }
    for model in models {
        let settings = [Setting::Method(Method::Compensate), Setting::Model(model.clone())];
        post(format!("compensate, {model}"), false, &settings)?;
    }
    Ok(programs)
}

/// A file of the study: its name and its text.
pub type NamedText = (&'static str, String);
