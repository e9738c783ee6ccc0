//! Programs read back: blocks a second, beside LinuxCNC's `rs274` on the same program in the same run, and whether memory
//! grows. `cargo bench --bench read_back`
//!
//! The program is a five-axis path in axis positions, as `post` writes it for LinuxCNC. In this process: `blocks` is the
//! reader alone, `motions` the reader and the interpreter to axis values, tip and tool axis; the commands beside `rs274`
//! are in `peers.rs`. `rs274 -g` interprets the program and prints canonical functions, into nowhere; where it is not
//! installed, that is said. Runs alternate, and medians are compared: of the time by the clock, and of the processor's
//! time, which tells the same while the machine has other work. The peak of the memory is that of `read`, `verify` and
//! `diff` on a tenth of the program, and on all of it.

#[path = "common/job.rs"]
#[expect(dead_code, reason = "nothing is posted in this process")]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

#[path = "common/peak.rs"]
mod peak;

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use post_grammar::nc::{NcBlock, NcReader};
use post_host::{Plugin, ProgramSetup, ProgramWord};
use post_plugin::DialectSession as _;
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_readback::{BlockEffect, Offsets};

/// Blocks of the program; more by the first argument behind `--`.
const BLOCKS: u64 = 1_000_000;
const RUNS: usize = 5;
const MACHINE: &str = "ac-trunnion";
const LENGTH: &str = "100";
const SETTINGS: [&str; 2] = ["control.dialect=\"linuxcnc\"", "control.tcp=\"post\""];

/// What LinuxCNC is to be surpassed by.
const GOAL: f64 = 20.0;

fn main() -> Result<(), Box<dyn Error>> {
    let blocks =
        std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(BLOCKS);
    let folder = tempfile::tempdir()?;
    let whole = Pair::new(folder.path(), "whole", blocks)?;
    let tenth = Pair::new(folder.path(), "tenth", blocks / 10)?;
    let written = fs::read_to_string(&whole.program)?.lines().count() as u64;
    say(&format!(
        "{written} lines, {} MB, median of {RUNS} runs",
        fs::metadata(&whole.program)?.len() / 1_000_000
    ));
    let lexicon = lexicon()?;
    let mut rows: Vec<(&str, Vec<Times>)> = Vec::new();
    let mut time = |name: &'static str, run: &mut dyn FnMut() -> Result<(), Box<dyn Error>>| {
        let (start, busy) = (Instant::now(), processor());
        run()?;
        let took = Times { clock: start.elapsed(), processor: processor().saturating_sub(busy) };
        match rows.iter_mut().find(|(known, _)| *known == name) {
            Some((_, times)) => times.push(took),
            None => rows.push((name, vec![took])),
        }
        Ok::<(), Box<dyn Error>>(())
    };
    let rs274 = rs274(&whole.program).is_ok();
    for _ in 0..RUNS {
        if rs274 {
            time("rs274 -g", &mut || self::rs274(&whole.program))?;
        }
        time("blocks", &mut || read(&whole.program, &lexicon))?;
        time("motions", &mut || interpret(&whole.program, &lexicon))?;
    }
    let medians: Vec<(&str, [f64; 2])> = rows
        .iter()
        .map(|(name, times)| {
            let clock = median(times.iter().map(|times| times.clock));
            (*name, [clock, median(times.iter().map(|times| times.processor))])
        })
        .collect();
    let floor = medians.iter().find(|(name, _)| *name == "rs274 -g");
    say(&format!(
        "\n{:<14} {:>9}  {:>11} {:>9}  {:>11}",
        "", "by clock", "times rs274", "processor", "times rs274"
    ));
    say(&format!("{:<14} {:>9}  {:>11} {:>9}", "", "blocks/s", "", "blocks/s"));
    for (name, seconds) in &medians {
        let columns = [0, 1].map(|column| {
            let times = floor.map_or_else(
                || "-".to_owned(),
                |(_, floor)| format!("{:.1}", floor[column] / seconds[column]),
            );
            format!("{:>9.0}  {times:>11}", written as f64 / seconds[column])
        });
        say(&format!("{name:<14} {}", columns.join(" ")));
    }
    match floor {
        Some(_) => say(&format!("at least {GOAL} times rs274 is asked of `motions`")),
        None => say(
            "rs274 of LinuxCNC is not installed, or does not read the program: nothing to compare with",
        ),
    }
    say("\npeak of the memory, kB       a tenth       all");
    for (name, run) in [
        ("post read", Pair::read as fn(&Pair) -> Result<u64, Box<dyn Error>>),
        ("post verify", Pair::verify),
        ("post diff", Pair::diff),
    ] {
        say(&format!("{name:<24} {:>11} {:>9}", run(&tenth)?, run(&whole)?));
    }
    Ok(())
}

/// A CL file and its program.
struct Pair {
    cl: PathBuf,
    program: PathBuf,
}

impl Pair {
    fn new(folder: &Path, name: &str, points: u64) -> Result<Self, Box<dyn Error>> {
        let pair = Self {
            cl: folder.join(format!("{name}.cls")),
            program: folder.join(format!("{name}.ngc")),
        };
        let mut file = BufWriter::new(File::create(&pair.cl)?);
        generate::write_file(&mut file, points)?;
        file.flush()?;
        let post = post(&[]).arg(&pair.cl).arg("-q").arg("-o").arg(&pair.program).status()?;
        match post.success() {
            true => Ok(pair),
            false => Err(format!("post: {post}").into()),
        }
    }

    fn read(&self) -> Result<u64, Box<dyn Error>> {
        peak::of(post(&["read"]).arg(&self.program))
    }

    fn verify(&self) -> Result<u64, Box<dyn Error>> {
        peak::of(post(&["verify"]).arg(&self.program).arg("--against").arg(&self.cl))
    }

    fn diff(&self) -> Result<u64, Box<dyn Error>> {
        peak::of(post(&["diff"]).args([&self.program, &self.program]))
    }
}

/// The command, with the machine.
fn post(verb: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_post"));
    command.args(verb).args(["--machine", MACHINE, "--tool-length", LENGTH]);
    for setting in SETTINGS {
        command.args(["--set", setting]);
    }
    command
}

fn rs274(program: &Path) -> Result<(), Box<dyn Error>> {
    let code = Command::new("rs274")
        .args(["-g", "-n", "0"])
        .arg(program)
        .current_dir(program.parent().unwrap_or(Path::new(".")))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()?;
    match code.success() {
        true => Ok(()),
        false => Err(format!("rs274: {code}").into()),
    }
}

/// Blocks alone.
fn read(program: &Path, lexicon: &Lexicon) -> Result<(), Box<dyn Error>> {
    let mut reader = NcReader::new(File::open(program)?, lexicon.syntax().clone());
    let mut block = NcBlock::default();
    let mut items = 0;
    while reader.next_block(&mut block).map_err(|fault| format!("{fault:?}"))? {
        items += block.items.len();
    }
    std::hint::black_box(items);
    Ok(())
}

/// Blocks and what they do.
fn interpret(program: &Path, lexicon: &Lexicon) -> Result<(), Box<dyn Error>> {
    let machine = job::machine(MACHINE, &SETTINGS.map(str::to_owned))?;
    let offsets = Offsets { length: Some(LENGTH.parse()?), ..Offsets::default() };
    let file = File::open(program)?;
    let name = "whole.ngc";
    let mut program = Interpreter::new(&machine, lexicon, &offsets, Limits::default(), name, file)
        .map_err(|fault| format!("{fault:?}"))?;
    let mut done: Vec<BlockEffect> = Vec::new();
    let mut count = 0;
    while program.next(&mut done).map_err(|fault| format!("{fault:?}"))? {
        count += done.len();
        done.clear();
    }
    std::hint::black_box(count);
    Ok(())
}

/// The words of LinuxCNC.
fn lexicon() -> Result<Lexicon, Box<dyn Error>> {
    let plugin = post_stock::plugin("linuxcnc").ok_or("linuxcnc is not built in")?;
    let words = ["X", "Y", "Z", "A", "C"].map(|name| ProgramWord {
        name: name.to_owned(),
        rotary: matches!(name, "A" | "C"),
        depth: name == "Z",
        ..ProgramWord::default()
    });
    let setup = ProgramSetup { words: words.to_vec(), ..ProgramSetup::default() };
    let mut dialect = Plugin::linked(plugin)?.dialect(&setup)?;
    let words = dialect.vocabulary()?;
    Ok(Lexicon::new(dialect.format().language, dialect.capabilities(), &words))
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// What a run took.
struct Times {
    /// By the clock.
    clock: Duration,
    /// Of the processor, in this process and in those that it waited for.
    processor: Duration,
}

/// Time of the processor that this process and those that it waited for have taken, where the system tells it.
fn processor() -> Duration {
    // Fields 14 to 17 of proc(5), in hundredths of a second; the name in field 2 may hold blanks.
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = text.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks: u64 = fields.skip(11).take(4).flat_map(str::parse::<u64>).sum();
    Duration::from_millis(10 * ticks)
}

/// Seconds.
fn median(times: impl Iterator<Item = Duration>) -> f64 {
    let mut times: Vec<Duration> = times.collect();
    times.sort();
    times[times.len() / 2].as_secs_f64()
}
