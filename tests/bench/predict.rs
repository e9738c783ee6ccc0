//! Prediction: what each stage costs a set-point, how much faster than the machine it is, and whether memory grows.
//! `cargo bench --bench predict`, or with the number of set-points behind `--`.
//!
//! Five axes of `ac-trunnion` with their servos at a period of 1 ms, in one thread. The `S` is the test piece of
//! `generate`, over and over, once with the tip kept by the control (the axes between the words come from the inverse
//! kinematics, set-point by set-point) and once by the post (they are linear). The `wave` is a finishing pass whose points
//! lie so close that a block takes hardly longer than a period: what a block costs is paid at every set-point there.
//!
//! `reading` is blocks, words and tasks; `trajectory` the limits of the moves, look-ahead and set-points; `servo` and
//! `contour` what they say. Each is timed in this process, batch by batch. `post predict` is the command as a whole, with
//! its report, and the peak of its memory for a tenth of the program and for all of it.

#[path = "common/job.rs"]
#[expect(dead_code, reason = "nothing is posted in this process")]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

#[path = "common/peak.rs"]
mod peak;

use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};

use post_host::{Plugin, ProgramSetup, ProgramWord};
use post_machine::description::Machine;
use post_motion::contour::{Contour, ContourLeg};
use post_motion::servo::Servos;
use post_motion::trajectory::{FillOutcome, Planner};
use post_motion::{SetPoints, Task};
use post_plugin::DialectSession as _;
use post_readback::Offsets;
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::tasks::ProgramTasks;

/// Set-points of the long program; other numbers by the first argument behind `--`.
const SET_POINTS: u64 = 1_000_000;
const MACHINE: &str = "ac-trunnion";
const LENGTH: &str = "0";
const BATCH: usize = 256;
const RUNS: usize = 3;

/// How many times faster than the machine it is to be.
const GOAL: f64 = 1000.0;

fn main() -> Result<(), Box<dyn Error>> {
    let set_points =
        std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(SET_POINTS);
    let folder = tempfile::tempdir()?;
    // An S takes 17.7 s, a point of the wave 1.2 ms.
    let pieces = set_points.div_ceil(17_700);
    let points = set_points * 10 / 12;
    let cases = [
        ("S, the control keeps the tip", "control", Part::S(pieces)),
        ("S, the post keeps the tip", "post", Part::S(pieces)),
        ("wave, the control keeps the tip", "control", Part::Wave(points)),
    ];
    for (name, tcp, part) in cases {
        let whole = program(folder.path(), "whole", tcp, part)?;
        let tenth = program(folder.path(), "tenth", tcp, part.tenth())?;
        let mut best: Option<Costs> = None;
        for _ in 0..RUNS {
            let costs = staged(&whole, tcp)?;
            if best.as_ref().is_none_or(|best| costs.total() < best.total()) {
                best = Some(costs);
            }
        }
        if let Some(costs) = best {
            costs.say(name);
        }
        let start = Instant::now();
        let peak = peak::of(&mut predict(&whole, tcp))?;
        let took = start.elapsed();
        let small = peak::of(&mut predict(&tenth, tcp))?;
        say(&format!(
            "  post predict         {:>7.2} s; peak of the memory {small} kB for a tenth, {peak} kB for all\n",
            took.as_secs_f64()
        ));
    }
    say(&format!("at least {GOAL} times real time is asked of all stages together"));
    Ok(())
}

/// What is made.
#[derive(Clone, Copy)]
enum Part {
    /// So many S-shaped pieces.
    S(u64),
    /// So many points of a wave.
    Wave(u64),
}

impl Part {
    fn tenth(self) -> Self {
        match self {
            Self::S(count) => Self::S(count.div_ceil(10)),
            Self::Wave(count) => Self::Wave(count / 10),
        }
    }
}

/// Writes and posts it.
fn program(folder: &Path, name: &str, tcp: &str, part: Part) -> Result<PathBuf, Box<dyn Error>> {
    let cl = folder.join(format!("{name}.cls"));
    let program = folder.join(format!("{name}.nc"));
    let mut file = BufWriter::new(File::create(&cl)?);
    match part {
        Part::S(count) => {
            for _ in 0..count {
                generate::write_s_piece(&mut file, 240)?;
            }
        }
        Part::Wave(count) => generate::write_file(&mut file, count)?,
    }
    file.flush()?;
    let status = Command::new(env!("CARGO_BIN_EXE_post"))
        .args(["-q", "--machine", MACHINE, "--tool-length", LENGTH])
        .args(["--tcp", tcp, "-o"])
        .args([&program, &cl])
        .status()?;
    match status.success() {
        true => Ok(program),
        false => Err(format!("post: {status}").into()),
    }
}

/// The command on a program.
fn predict(program: &Path, tcp: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_post"));
    command
        .args(["predict", "-q", "--machine", MACHINE])
        .args(["--tool-length", LENGTH, "--tcp", tcp])
        .arg(program);
    command
}

/// What a run cost.
#[derive(Default)]
struct Costs {
    /// Reading, trajectory, servo, contour.
    stages: [Duration; 4],
    set_points: u64,
    blocks: u64,
    period: f64,
}

impl Costs {
    fn total(&self) -> Duration {
        self.stages.iter().sum()
    }

    fn say(&self, name: &str) {
        let each = |time: Duration| time.as_secs_f64() * 1e9 / self.set_points as f64;
        let machine = self.set_points as f64 * self.period;
        say(&format!(
            "{name}: {} blocks, {} set-points, {machine:.0} s on the machine",
            self.blocks, self.set_points
        ));
        let names = ["reading", "trajectory", "servo", "contour"];
        for (name, time) in names.into_iter().zip(self.stages) {
            say(&format!("  {name:<20} {:>7.0} ns a set-point", each(time)));
        }
        say(&format!(
            "  together             {:>7.0} ns a set-point, {:.0} times real time",
            each(self.total()),
            machine / self.total().as_secs_f64()
        ));
    }
}

/// All stages, each timed.
fn staged(path: &Path, tcp: &str) -> Result<Costs, Box<dyn Error>> {
    let machine = job::machine(MACHINE, &[format!("control.tcp=\"{tcp}\"")])?;
    let lexicon = lexicon(&machine)?;
    let offsets = Offsets { length: Some(LENGTH.parse()?), ..Offsets::default() };
    let text = |fault: Box<post_machine::diagnostic::Diagnostic>| format!("{fault:?}");
    let file = BufReader::new(File::open(path)?);
    let limits = Limits { blocks: u64::MAX, ..Limits::default() };
    let mut program =
        Interpreter::new(&machine, &lexicon, &offsets, limits, "program", file).map_err(text)?;
    let mut tasks = ProgramTasks::new(&machine);
    let mut planner = Planner::new(&machine);
    let period = machine.motion.period;
    let mut servos = Servos::new(&machine, period).map_err(text)?;
    let mut contour = Contour::new();
    let mut costs = Costs { period, ..Costs::default() };
    let (mut done, mut planned, mut times) = (Vec::new(), Vec::new(), Vec::new());
    let mut points: Option<SetPoints> = None;
    let mut actual = Vec::new();
    let mut ended = false;
    loop {
        let mut clock = Instant::now();
        let mut lap = |stage: usize, costs: &mut Costs| {
            let now = Instant::now();
            costs.stages[stage] += now - clock;
            clock = now;
        };
        let filled = match &mut points {
            None => FillOutcome::Wants,
            Some(points) => {
                planner.fill(points, BATCH, &mut times).map_err(|fault| format!("{fault:?}"))?
            }
        };
        times.clear();
        lap(1, &mut costs);
        if let Some(points) = &mut points
            && filled != FillOutcome::Wants
        {
            servos.follow(&points.joints, &mut actual);
            lap(2, &mut costs);
            contour.take(points, &actual, &mut |point| {
                std::hint::black_box(point.distance);
            });
            costs.set_points += points.len() as u64;
            points.clear();
            lap(3, &mut costs);
        }
        match filled {
            FillOutcome::Full => {}
            FillOutcome::Ended | FillOutcome::TooLong { .. } => break,
            FillOutcome::Wants => {
                while planned.is_empty() && !ended {
                    if program.next(&mut done).map_err(text)? {
                        tasks.take(&mut done, &mut planned);
                        costs.blocks += 1;
                    } else {
                        tasks.end(&mut planned);
                        ended = true;
                    }
                }
                lap(0, &mut costs);
                for planned in planned.drain(..) {
                    if let (None, Task::Move(first)) = (&points, &planned.task) {
                        points = Some(SetPoints::new(Arc::clone(&first.solver), period));
                        servos.settle(&first.from.joints);
                    }
                    contour.ahead(ContourLeg::of(&planned.task));
                    planner.push(planned.task).map_err(|fault| format!("{fault:?}"))?;
                }
                if ended {
                    planner.end();
                }
                lap(1, &mut costs);
            }
        }
    }
    std::hint::black_box(contour.finish(&mut |_| {}));
    Ok(costs)
}

/// The words of the machine's control.
fn lexicon(machine: &Machine) -> Result<Lexicon, Box<dyn Error>> {
    let name = &machine.control.dialect;
    let plugin = post_stock::plugin(name).ok_or_else(|| format!("{name} is not built in"))?;
    let words = machine.axes.iter().map(|axis| ProgramWord {
        name: axis.name.clone(),
        rotary: axis.joint.rotary,
        depth: axis.name == "Z",
        ..ProgramWord::default()
    });
    let setup = ProgramSetup {
        words: words.collect(),
        tcp: machine.control.tcp == post_machine::description::Tcp::Control,
        ..ProgramSetup::default()
    };
    let mut dialect = Plugin::linked(plugin)?.dialect(&setup)?;
    let words = dialect.vocabulary()?;
    Ok(Lexicon::new(dialect.format().language, dialect.capabilities(), &words))
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
