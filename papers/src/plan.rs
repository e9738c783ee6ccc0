//! `papers plan`: the fastest feed along a curve.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use post_machine::description::Setting;

use post_cli::arguments::flag_values::{
    feed, file, length, not_negative, period, point, positive, setting, word,
};
use post_cli::terminal::print_beside;
use post_job::failure::Failure;
use post_job::files::{AtomicFile, FolderMark, OwnFolder, PathArg, Role, json};
use post_job::machine_files;
use post_job::plan::pictures;
use post_job::session::Session;

use crate::curve::{self, CurveJob, CurveOverrides, SolverChoice, SolverRequest};

/// Plans the fastest feed along a curve that keeps the limits of machine, servos and control.
///
/// The curve is a NURBS of the tip, five axes with a second spline for the tool axis, or points that a smooth curve is laid
/// through. Kept are the feed, velocity and acceleration of axes and tip, the chord error of one interpolation period, the
/// contour error of the servos, and with --solver jerk the jerk too: everywhere along the path, not at samples alone (Chen,
/// Ren, Sun 2016). Limits stand in the curve file, or are those of --machine, with the time of its control for a block: of
/// a NURBS each span between two knots is one, of points the way from one to the next.
#[derive(Debug, Args)]
#[command(after_help = "A curve file is JSON, in mm and s:
  degree, knots, control_points_mm (or P_tool_tip), weights    the tip, a NURBS
  second_points_mm (or H_second_point_on_axis), tool_axis,     the tool axis over the same knots: points on it,
    or rotary_deg: {\"A\": [...], \"C\": [...]}                    directions, or control values of rotary axes
  points_mm: [[x, y, z], ...] or [[x, y, z, i, j, k], ...]      instead of all these: points of the path
  limits: {\"XYZ\": {\"v\": 100, \"a\": 500, \"j\": 3000},         axes by their names; without a key: no limit
           \"A\": {\"v\": 0.4, \"a\": 0.5, \"unit\": \"rad\"},      rotary axes in rad (if not said) or deg
           \"tip\": {\"v\": 50, \"a\": 800, \"j\": 9000},          v is the feed
           \"chord_error_um\": 0.5, \"contour_error_um\": 20, \"interp_period_s\": 0.004,
           \"servo\": {\"X\": {\"pid\": {\"kp\": 10, ...}}}}        as [servo.X] of a machine file
  name; source, axis, kinematics, computed, published_times_s  notes, not read

Examples:
  papers plan butterfly.json
  papers plan butterfly.json --solver interior --contour-error off --simulate
  papers plan five-axis.json --solver jerk -o plan.json --pictures plan
  papers plan curve.json --machine my-mill.toml --feed 2000 --samples 20000 -o plan.csv

Exit codes: 0 planned; 1 something could not be read, or no feed keeps the limits, the messages say what; 2 the command
line is wrong.")]
pub struct PlanArguments {
    /// The curve file, `-` for standard input.
    #[arg(value_name = "CURVE", value_parser = file())]
    curve: PathArg,

    /// What plans.
    #[arg(long, value_parser = word::<SolverWord, SolverChoice>(), value_name = "SOLVER", default_value = "reach")]
    solver: SolverChoice,

    /// So many samples of the path, evenly between each knot and the next; limits are kept between them too. 20000 if not
    /// said, 2000 for jerk.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(5..=2_000_000))]
    samples: Option<u32>,

    /// Simulates the servos on the planned motion, and tells their contour error beside that of the formula.
    #[arg(long)]
    simulate: bool,

    /// Writes the plan: a table of its points as CSV where the name ends in .csv; else JSON, with all that was found, the
    /// points and the feed as a spline along the path. `-` is standard output, JSON.
    #[arg(short, long, value_name = "FILE", value_parser = file())]
    output: Option<PathArg>,

    /// Draws into this folder, as SVG: feed, velocity, acceleration and jerk of the axes, chord error and contour error
    /// along the path, limits drawn in; and writes the plan beside them.
    #[arg(long, value_name = "FOLDER", value_parser = file())]
    pictures: Option<PathArg>,

    /// No table, messages alone.
    #[arg(short, long)]
    quiet: bool,

    /// Largest feed of the tip, mm/min.
    #[arg(long, value_name = "MM_A_MINUTE", value_parser = feed, help_heading = "Limits")]
    feed: Option<f64>,

    /// Largest contour error of the servos, mm; `off`: it is not limited.
    #[arg(long, value_name = "MM", value_parser = error, help_heading = "Limits")]
    contour_error: Option<f64>,

    /// By how much the way of one interpolation period may stray from the path, mm; `off`: it is not limited.
    #[arg(long, value_name = "MM", value_parser = error, help_heading = "Limits")]
    chord_error: Option<f64>,

    /// Interpolation period of the control, seconds.
    #[arg(long, value_name = "SECONDS", value_parser = period, help_heading = "Limits")]
    period: Option<f64>,

    /// Feed at the beginning, mm/min; at rest if not said.
    #[arg(long, value_name = "MM_A_MINUTE", value_parser = not_negative, default_value_t = 0.0, help_heading = "Limits")]
    start_feed: f64,

    /// Feed at the end, mm/min; at rest if not said.
    #[arg(long, value_name = "MM_A_MINUTE", value_parser = not_negative, default_value_t = 0.0, help_heading = "Limits")]
    end_feed: f64,

    /// The machine whose axes go along the curve, in place of the limits of the curve file: a TOML file, or the name of
    /// one in a machine folder or built in (`post machines`).
    #[arg(short, long, value_name = "MACHINE", help_heading = "Machine")]
    machine: Option<String>,

    /// Where the part origin sits for this job, all axes at zero, machine frame, mm.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point, requires = "machine", help_heading = "Machine")]
    mount: Option<[f64; 3]>,

    /// Length of the tool from the gauge point to the tip, mm.
    #[arg(long, value_name = "MM", value_parser = length, requires = "machine", default_value_t = 0.0, help_heading = "Machine")]
    tool_length: f64,

    /// Sets a parameter of the machine (`Lm=312`) or any key (`axis.X.max_accel=2000`).
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting, requires = "machine", help_heading = "Machine")]
    set: Vec<Setting>,

    /// A further folder of machine files; the environment variable POST_MACHINES adds more.
    #[arg(long, value_name = "FOLDER", help_heading = "Machine")]
    machines: Vec<PathBuf>,
}

/// `--solver`.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum SolverWord {
    /// Reachability analysis: two passes, linear time
    Reach,
    /// The linear program of the paper, the largest Σ f², by an interior point with a banded matrix, linear time an iteration
    Interior,
    /// Jerk is kept too
    Jerk,
}

impl From<SolverWord> for SolverChoice {
    fn from(word: SolverWord) -> Self {
        match word {
            SolverWord::Reach => Self::Reach,
            SolverWord::Interior => Self::Interior,
            SolverWord::Jerk => Self::Jerk,
        }
    }
}

/// An error in mm, or `off`, which is infinite.
fn error(text: &str) -> Result<f64, String> {
    match text {
        "off" => Ok(f64::INFINITY),
        text => positive(text).map_err(|message| format!("{message}; mm or `off` are meant")),
    }
}

const PLAN: Role = Role { what: "plan", remedy: "name another file with -o" };

const PICTURES: Role = Role { what: "plan", remedy: "name another folder with --pictures" };

/// The file by which a folder of pictures is known, and how it begins.
const MARK: FolderMark<'_> = FolderMark { name: "plan.json", begins: "{\n  \"curve\": " };

/// Plans as the arguments say.
pub fn run(session: &Session, arguments: &PlanArguments) -> Result<(), Failure> {
    let machine = match &arguments.machine {
        Some(name) => {
            let mut settings = arguments.set.clone();
            settings.extend(arguments.mount.map(Setting::Mount));
            Some(machine_files::load(session, name, &arguments.machines, &settings)?)
        }
        None => None,
    };
    let folder = match &arguments.pictures {
        Some(folder) => {
            let folder = OwnFolder::open(session, folder, PICTURES, MARK, &pictures::NAMES);
            Some(folder.map_err(|fault| *fault)?)
        }
        None => None,
    };
    let (curve, findings) = CurveJob::read(session, &arguments.curve, machine)?;
    let targets: Vec<(Role, &PathArg)> =
        arguments.output.iter().map(|target| (PLAN, target)).collect();
    let mut texts = AtomicFile::create(session, &targets)?;
    let samples = match arguments.solver {
        SolverChoice::Reach | SolverChoice::Interior => 20_000,
        SolverChoice::Jerk => 2000,
    };
    let asked = SolverRequest {
        solver: arguments.solver,
        samples: arguments.samples.unwrap_or(samples) as usize,
        start_feed: arguments.start_feed / 60.0,
        end_feed: arguments.end_feed / 60.0,
    };
    let over = CurveOverrides {
        feed: arguments.feed.map(|feed| feed / 60.0),
        chord_error: arguments.chord_error,
        contour_error: arguments.contour_error,
        period: arguments.period,
    };
    let planned = curve.plan(asked, over, arguments.tool_length, arguments.simulate)?;
    let found = &planned.found;
    let text = match texts.is_empty() && folder.is_none() {
        true => String::new(),
        false => json(found),
    };
    if let (Some(target), Some(file)) = (&arguments.output, texts.first_mut()) {
        let ending = target.path().and_then(|path| path.extension());
        if ending.is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            file.write_bytes(curve::csv(&found.axes, &found.rows).as_bytes())?;
        } else {
            file.write_bytes(text.as_bytes())?;
        }
    }
    let taken = texts.iter().any(AtomicFile::is_standard);
    if let Some(folder) = &folder {
        let mut files = planned.rooms.files(&planned.note);
        files.push((MARK.name, text));
        folder.add(&files, &mut texts)?;
        AtomicFile::finish(session, texts)?;
        folder.tidy(&files)?;
    } else {
        AtomicFile::finish(session, texts)?;
    }
    session.findings(&findings);
    if !arguments.quiet {
        let text = curve::text(found);
        print_beside(session, &text, taken);
    }
    Ok(())
}
