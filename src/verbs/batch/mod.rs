//! `post batch`: many CL files on many machines with many settings.

mod batch_text;

use std::ffi::OsStr;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use post_machine::diagnostic::Diagnostic;

use post_cli::arguments::Flags;
use post_cli::arguments::flag_values::file;
use post_cli::terminal::{self, JobsProgress};
use post_job::batch::{
    self, Grid, JobLine, JobStudy, Journal, MapAxes, Shard, StudyTable, ValueText,
};
use post_job::disk;
use post_job::failure::Failure;
use post_job::files::{self, AtomicFile, FileFault, PathArg, Role};
use post_job::job_file;
use post_job::session::Session;
use post_job::settings::{ReadingSettings, StudySettings};

const RESULTS: Role = Role { what: "table of results", remedy: "name another file with -o" };

const JOURNAL: Role = Role { what: "journal", remedy: "name another file with --resume=" };

/// Posts many CL files on many machines with many settings: a grid of jobs, and a table with one row for each.
///
/// Flags of the grid take several values, parted by commas (outside brackets), or as FROM:TO:STEP; a job is made of every
/// value with every other. A file that ends in .jsonl is a list of jobs, a line of JSON each; the grid is laid over what a
/// line does not say: {"file": "part.cls", "machine": "dmu50", "set": {"Lm": 200}, "mount": [0, 0, 100], "turn": 90,
/// "tool_length": 120, "tolerance": 0.01, "tcp": "post", "dialect": "fanuc"}.
///
/// A job that is refused is a row with its codes and first message; the others go on. No program is written: the table
/// has its length and hash.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  post batch *.cls --machine dmu50 --machine ac-trunnion -o results.parquet
  post batch disc-blade.cls -m disc-cutter --set Lm=200:300:25 --tolerance 0.005,0.01 -o results.csv
  post batch part.cls -m dmu50 --mount 0,0,50:250:50 --predict -o results.parquet --resume
  post batch part.cls -m dmu50 --mount -100:100:50,0,50:250:50 -o results.csv --svg map.svg --x mount_x_mm --y mount_z_mm
  post batch jobs.jsonl -m vmc --shard 3/16 -o part-3.parquet

Exit codes: 0 the table is written, whatever came of its jobs; 1 refused, the messages say why; 2 the command line is wrong.")]
pub struct BatchArguments {
    /// CL files, lists of jobs that end in .jsonl, and job files, .job.toml: each of their programs is a job.
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,

    /// The table: Parquet, CSV or lines of JSON, as its name ends (.parquet, .csv, .jsonl); `-` is CSV on standard output.
    #[arg(short, long, value_name = "FILE", value_parser = file())]
    output: PathArg,

    /// A machine: a TOML file, or the name of one in a machine folder or built in. Repeatable.
    #[arg(short, long, value_name = "MACHINE", help_heading = "Grid")]
    machine: Vec<String>,

    /// Values of a parameter of the machine (`Lm=200,250`) or of any key (`accuracy.placement=bisect,fewest`). Repeatable.
    #[arg(long, value_name = "NAME=VALUES", value_parser = set, help_heading = "Grid")]
    set: Vec<(String, Vec<ValueText>)>,

    /// Where the part origin sits, all axes at zero, machine frame, mm; each coordinate may be a range. Repeatable.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = mounts, help_heading = "Grid")]
    mount: Vec<Mounts>,

    /// How the part is turned about its Z, degrees.
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = listed, help_heading = "Grid")]
    turn: Option<FlagValues>,

    /// Length of every tool from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", allow_hyphen_values = true, value_parser = listed, help_heading = "Grid")]
    tool_length: Option<FlagValues>,

    /// Largest deviation of the tip in a cut, mm.
    #[arg(long, value_name = "MM", value_parser = listed, help_heading = "Grid")]
    tolerance: Option<FlagValues>,

    /// Who keeps the tip on its path: control (RTCP, TCP, TCPM), post.
    #[arg(long, value_name = "WHO", value_parser = listed, help_heading = "Grid")]
    tcp: Option<FlagValues>,

    /// Dialects other than the machine file's.
    #[arg(long, value_name = "NAMES", value_parser = listed, help_heading = "Grid")]
    dialect: Option<FlagValues>,

    #[command(flatten)]
    reading: Flags<ReadingSettings>,

    #[command(flatten)]
    study: Flags<StudySettings>,

    /// Jobs at a time. [default: number of processors]
    #[arg(short, long, value_name = "N")]
    jobs: Option<NonZeroUsize>,

    /// Does one part of the jobs, I of N: they are dealt out one by one, by their numbers in the whole study. The parts
    /// have the same columns, and all rows together are those of the whole.
    #[arg(long, value_name = "I/N", value_parser = Shard::read)]
    shard: Option<Shard>,

    /// Takes from the journal what was done before with the same content: CL file, machine with all that it extends,
    /// settings, plugins, version. The journal is a file that only grows, a line of JSON a job, beside the table
    /// (results.parquet.journal) unless it is named here; it is written in any case, so that a run that was interrupted can
    /// be resumed.
    #[arg(long, value_name = "FILE", num_args = 0..=1, require_equals = true)]
    resume: Option<Option<PathBuf>>,

    /// Draws one column over two others, a map a machine: the shade tells the value, a cross what is refused.
    #[arg(long, value_name = "FILE", value_parser = file(), requires_all = ["x", "y"])]
    svg: Option<PathArg>,

    /// What goes across in the map: a column.
    #[arg(long, value_name = "COLUMN", requires = "svg")]
    x: Option<String>,

    /// What goes up in the map: a column.
    #[arg(long, value_name = "COLUMN", requires = "svg")]
    y: Option<String>,

    /// What the map shows: a column of numbers.
    #[arg(long, value_name = "COLUMN", default_value = "cycle_time_s")]
    value: String,

    /// Large values of it are the good ones.
    #[arg(long, requires = "svg")]
    most: bool,

    /// Prints messages only.
    #[arg(short, long)]
    quiet: bool,
}

/// Values of a flag.
#[derive(Clone, Debug)]
struct FlagValues(Vec<ValueText>);

fn listed(text: &str) -> Result<FlagValues, String> {
    batch::values(text).map(FlagValues)
}

fn set(text: &str) -> Result<(String, Vec<ValueText>), String> {
    let Some((name, values)) = text.split_once('=') else {
        return Err("NAME=VALUE,VALUE,… is meant".to_owned());
    };
    Ok((name.trim().to_owned(), batch::values(values)?))
}

/// Mounts of one flag.
#[derive(Clone, Debug)]
struct Mounts(Vec<[ValueText; 3]>);

/// Each coordinate with every other.
fn mounts(text: &str) -> Result<Mounts, String> {
    let parts: Vec<&str> = text.split(',').collect();
    let [x, y, z] = parts[..] else {
        return Err(format!("three numbers are needed, X,Y,Z; there are {}", parts.len()));
    };
    let (xs, ys, zs) = (batch::values(x)?, batch::values(y)?, batch::values(z)?);
    let count = xs.len().saturating_mul(ys.len()).saturating_mul(zs.len());
    if count > batch::MOST_JOBS {
        return Err(format!("these are {count} mounts, {} are allowed", batch::MOST_JOBS));
    }
    let mut mounts = Vec::new();
    for x in &xs {
        for y in &ys {
            mounts.extend(zs.iter().map(|z| [x.clone(), y.clone(), z.clone()]));
        }
    }
    Ok(Mounts(mounts))
}

/// Does the study as the arguments say.
pub fn run(session: &Session, arguments: &BatchArguments) -> Result<(), Failure> {
    let ending = ending(&arguments.output)?;
    let reading = arguments.reading.0.clone();
    let options = StudySettings { reading, ..arguments.study.0.clone() };
    let jobs = jobs(session, arguments, &options)?;
    let (study, inputs) = JobStudy::new(session, jobs, options)?;
    let map = map(arguments, &study)?;
    for job in &study.jobs {
        session.read_files().note("the CL file", job.file.as_ref());
    }
    let journal = journal(session, arguments)?;
    let mut targets = vec![(RESULTS, &arguments.output)];
    targets.extend(arguments.svg.iter().map(|svg| (Role::PICTURE, svg)));
    // All are opened before the work begins.
    let mut texts = AtomicFile::create(session, &targets)?;
    let numbers = study.numbers(arguments.shard);
    let progress = JobsProgress::new(numbers.len() as u64);
    let mut done = batch::Done::default();
    let outcomes =
        batch::run(&study, &inputs, &numbers, arguments.jobs, journal.as_ref(), &mut |now| {
            done = now;
            progress.at(now.jobs as u64, now.refused as u64);
            Ok(())
        })?;
    progress.finish();
    let table = StudyTable::new(&study, &numbers, &outcomes.unwrap_or_default());
    texts[0].write_bytes(&table.bytes(&ending).unwrap_or_default())?;
    if let (Some(map), Some(file)) = (&map, texts.get_mut(1)) {
        file.write_bytes(map.draw(&table).as_bytes())?;
    }
    let taken = texts.iter().any(AtomicFile::is_standard);
    AtomicFile::finish(session, texts)?;
    if !arguments.quiet {
        let text = batch_text::text(&table, done.known, &arguments.output);
        terminal::print_beside(session, &text, taken);
    }
    Ok(())
}

/// How the table is written.
fn ending(output: &PathArg) -> Result<String, Failure> {
    let Some(path) = output.path() else {
        return Ok("csv".to_owned());
    };
    let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
    match ending.to_ascii_lowercase().as_str() {
        known @ ("parquet" | "csv" | "json" | "jsonl" | "ndjson") => Ok(known.to_owned()),
        _ => {
            let message =
                format!("{}: the name of the table says how it is written", path.display());
            Err(Diagnostic::error("output", message)
                .help("let it end in .parquet, .csv or .jsonl")
                .into())
        }
    }
}

/// The jobs of the files and lists, the grid laid over them.
fn jobs(
    session: &Session,
    arguments: &BatchArguments,
    options: &StudySettings,
) -> Result<Vec<JobLine>, Failure> {
    let mut seeds = Vec::new();
    for file in &arguments.files {
        if job_file::is_job_file(file) {
            let job = job_file::read(session, file)?;
            seeds.extend(JobLine::of_job_file(&job, options)?);
            continue;
        }
        if file.extension().is_none_or(|ending| ending != "jsonl") {
            seeds.push(JobLine::of_file(file.to_string_lossy().into_owned()));
            continue;
        }
        let text = disk::read_table(file).map_err(|error| FileFault::read(file, error))?;
        session.read_files().note("the list of jobs", file);
        seeds.extend(JobLine::read(&file.display().to_string(), &text)?);
    }
    let values = |flag: &Option<FlagValues>| -> Vec<Vec<ValueText>> {
        let listed = flag.iter().flat_map(|listed| listed.0.clone());
        listed.map(|value| vec![value]).collect()
    };
    let mounts = arguments.mount.iter().flat_map(|mounts| mounts.0.clone());
    let grid = Grid {
        machines: arguments.machine.clone(),
        set: arguments.set.clone(),
        settings: vec![
            ("mount", mounts.map(Vec::from).collect()),
            ("turn", values(&arguments.turn)),
            ("tool_length", values(&arguments.tool_length)),
            ("tolerance", values(&arguments.tolerance)),
            ("tcp", values(&arguments.tcp)),
            ("dialect", values(&arguments.dialect)),
        ],
    };
    let jobs = grid.jobs(seeds)?;
    // What is no value of its kind is a slip of the command line and no finding of the study.
    for job in &jobs {
        job.settings(&arguments.reading.0).map_err(|fault| Diagnostic::error("job", fault))?;
    }
    Ok(jobs)
}

/// The journal: where the user says, or beside the table; none of a table that goes to standard output or a device.
fn journal(session: &Session, arguments: &BatchArguments) -> Result<Option<Journal>, Failure> {
    let beside = || {
        let path = arguments.output.absolute()?;
        let is_file = !disk::exists(path) || disk::is_file(path);
        let mut name = path.as_os_str().to_owned();
        name.push(".journal");
        is_file.then(|| PathBuf::from(name))
    };
    let named = arguments.resume.clone().flatten();
    let Some(path) = named.or_else(beside) else {
        return match arguments.resume {
            Some(_) => Err(Diagnostic::error(
                "journal",
                "there is no file beside which a journal could be",
            )
            .help("name it: --resume=FILE")
            .into()),
            None => Ok(None),
        };
    };
    // It must be no file that the run reads or writes otherwise.
    let target = PathArg::from(path.clone());
    let mut targets = vec![(JOURNAL, &target), (RESULTS, &arguments.output)];
    targets.extend(arguments.svg.iter().map(|svg| (Role::PICTURE, svg)));
    files::check_targets(session, &targets)?;
    Ok(Some(Journal::open(&path, arguments.resume.is_some())?))
}

/// The map that is asked for, of columns that there are.
fn map(arguments: &BatchArguments, study: &JobStudy) -> Result<Option<MapAxes>, Failure> {
    let (Some(_), Some(x), Some(y)) = (&arguments.svg, &arguments.x, &arguments.y) else {
        return Ok(None);
    };
    for name in [x, y, &arguments.value] {
        if study.columns.iter().all(|head| head.name != *name) {
            let names: Vec<&str> = study.columns.iter().map(|head| head.name.as_str()).collect();
            let message = format!("there is no column {name} to draw");
            return Err(Diagnostic::error("map", message)
                .help(post_machine::diagnostic::meant(name, "the columns are", &names))
                .into());
        }
    }
    Ok(Some(MapAxes {
        x: x.clone(),
        y: y.clone(),
        value: arguments.value.clone(),
        most: arguments.most,
    }))
}
