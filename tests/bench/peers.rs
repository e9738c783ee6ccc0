//! The command beside floors and beside other programs that do the same, in one run. `cargo bench --bench peers`
//! prints the tables and writes them into the page of the book on speed, with the ledger of instructions.
//!
//! Posting stands beside two floors (`common/floor.rs`): what any program must do that reads such a file, parses the six
//! numbers of every line and writes five into a file. Each row is run once a round, the rounds one after another, and a
//! ratio is that of the same round: its median and its least and largest tell how far the machine drifts. Others are
//! FreeCAD's posts on the same moves, LinuxCNC's interpreter on the same program, and TOPPRA on the same path and limits;
//! `peers/install` installs them, and what is not installed is said.

#[path = "common/floor.rs"]
mod floor;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

#[path = "common/peak.rs"]
mod peak;

use std::error::Error;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Points of the file; others by the first argument after `--`.
const POINTS: u64 = 1_000_000;

/// Times that every row of a table is run.
const ROUNDS: usize = 5;

/// Starts that are timed together: one takes a few milliseconds.
const STARTS: usize = 50;

/// Lines of the program that LinuxCNC reads, and moves that each post of FreeCAD takes: one takes time by the square.
const RS274_LINES: usize = 100_000;
const FREECAD_POSTS: [(&str, usize); 2] = [("linuxcnc_post", 50_000), ("fanuc_post", 2_000)];

/// Samples of the path that TOPPRA plans.
const PLANNED: &str = "10000";

/// Machine, and what keeps the tip.
const CASES: [(&str, &str); 5] = [
    ("ac-trunnion", "post"),
    ("ac-trunnion", "control"),
    ("head-head", "post"),
    ("head-head", "control"),
    ("dmu50", "control"),
];

/// The page, and the lines that the tables stand between.
const PAGE: &str = "docs/src/reference/speed.md";
const FIRST: &str = "<!-- written by `cargo bench --bench peers`: -->\n";
const LAST: &str = "<!-- end -->\n";

fn main() -> Result<(), Box<dyn Error>> {
    let points =
        std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(POINTS);
    let folder = tempfile::tempdir()?;
    let wave = Wave::new(folder.path(), points)?;
    let mut tables = String::new();
    for table in [
        Wave::posting as fn(&Wave) -> Result<String, Box<dyn Error>>,
        Wave::memory,
        Wave::starts,
        Wave::freecad,
        Wave::reading,
        Wave::planning,
    ] {
        let table = table(&wave)?;
        say(&table);
        tables.push_str(&table);
        tables.push('\n');
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let ledger = fs::read_to_string(root.join("tests/bench/ledger.txt"))?;
    write!(
        tables,
        "Instructions, which do not drift as times do (`cargo run --example ledger`):\n\n```text\n{ledger}```\n"
    )?;
    let page = fs::read_to_string(root.join(PAGE))?;
    let (Some((before, _)), Some((_, after))) = (page.split_once(FIRST), page.split_once(LAST))
    else {
        return Err(format!("{PAGE} has no place for the tables").into());
    };
    fs::write(root.join(PAGE), format!("{before}{FIRST}\n{tables}\n{LAST}{after}"))?;
    Ok(())
}

/// A finishing pass, and what is made of it.
struct Wave {
    folder: PathBuf,
    points: u64,
    cl: PathBuf,
}

impl Wave {
    fn new(folder: &Path, points: u64) -> Result<Self, Box<dyn Error>> {
        let wave = Self { folder: folder.to_owned(), points, cl: folder.join("wave.cls") };
        wave.write(&wave.cl, points)?;
        Ok(wave)
    }

    fn write(&self, path: &Path, points: u64) -> Result<(), Box<dyn Error>> {
        let mut file = BufWriter::new(File::create(path)?);
        generate::write_file(&mut file, points)?;
        Ok(file.flush()?)
    }

    /// A file of the folder.
    fn at(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Posts the wave; without threads the command has as many as it likes.
    fn post(&self, machine: &str, tcp: &str, threads: Option<usize>) -> Command {
        let mut command = post(machine, tcp);
        command.arg(&self.cl).args(["--quiet", "--set", "control.dialect=fanuc", "--output"]);
        command.arg(self.at("wave.nc"));
        if let Some(threads) = threads {
            command.args(["--jobs", &threads.to_string()]);
        }
        command
    }

    /// Posting by machine and threads, beside the floors.
    fn posting(&self) -> Result<String, Box<dyn Error>> {
        let output = self.at("floor.nc");
        let cores = std::thread::available_parallelism()?.get();
        let mut threads = vec![1, 2, cores];
        threads.sort_unstable();
        threads.dedup();
        let mut rows: Vec<TimedRow<'_>> = vec![
            TimedRow::new("floor, plain loops", self.points, || floor::plain(&self.cl, &output)),
            TimedRow::new("floor, by masks", self.points, || floor::masked(&self.cl, &output)),
        ];
        for (machine, tcp) in CASES {
            for threads in threads.iter().copied() {
                let plural = if threads == 1 { "thread" } else { "threads" };
                let name = format!("`{machine}`, tcp = {tcp}, {threads} {plural}");
                rows.push(TimedRow::new(&name, self.points, move || {
                    run(&mut self.post(machine, tcp, Some(threads)))
                }));
            }
        }
        let title = format!(
            "Posting {} five-axis points into a file, {cores} cores, {ROUNDS} rounds",
            self.points
        );
        timed(&title, "points/s", rows)
    }

    /// The most memory that posting takes, of the file and of one ten times as long.
    fn memory(&self) -> Result<String, Box<dyn Error>> {
        let mut text = "Memory at most while posting (`ac-trunnion`, tcp = control):\n\n| points | MB |\n|---|---|\n".to_owned();
        for points in [self.points, 10 * self.points] {
            let cl = self.at("memory.cls");
            self.write(&cl, points)?;
            let mut command = post("ac-trunnion", "control");
            command.arg(&cl).arg("--quiet").arg("--output").arg(self.at("memory.nc"));
            let most = peak::of(&mut command)?;
            writeln!(text, "| {points} | {:.1} |", most as f64 / 1e3)?;
            fs::remove_file(cl)?;
        }
        Ok(text)
    }

    /// How long it takes until there is anything.
    fn starts(&self) -> Result<String, Box<dyn Error>> {
        let two = self.at("two.cls");
        self.write(&two, 2)?;
        let version =
            || (0..STARTS).try_for_each(|_| run(Command::new(command()).arg("--version")));
        let job = || {
            (0..STARTS).try_for_each(|_| {
                let mut command = post("ac-trunnion", "post");
                run(command.arg(&two).arg("--quiet").arg("--output").arg(self.at("two.nc")))
            })
        };
        let rows = vec![
            TimedRow::new("`post --version`", STARTS as u64, version),
            TimedRow::new("`post` of two points", STARTS as u64, job),
        ];
        timed("Starts", "starts/s", rows)
    }

    /// A program in axis positions, as the posts of FreeCAD write them and LinuxCNC reads them.
    fn program(&self) -> Result<PathBuf, Box<dyn Error>> {
        let program = self.at("wave.ngc");
        let mut command = linuxcnc(&[]);
        run(command.arg(&self.cl).arg("--quiet").arg("--output").arg(&program))?;
        Ok(program)
    }

    /// FreeCAD's posts on the moves of the program.
    fn freecad(&self) -> Result<String, Box<dyn Error>> {
        let program = self.program()?;
        let mut text =
            "Posts of FreeCAD, which take axis positions and check nothing, beside the whole job:\n\n| post | moves | moves/s |\n|---|---|---|\n"
                .to_owned();
        for (name, most) in FREECAD_POSTS {
            let script =
                Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bench/peers/post_by_freecad.py");
            let run = Command::new("freecadcmd")
                .arg(script)
                .env("PEER_PROGRAM", &program)
                .env("PEER_POST", name)
                .env("PEER_MOVES", most.to_string())
                .env("PEER_OUTPUT", self.at("freecad.ngc"))
                .stdin(Stdio::null())
                .output();
            let Ok(run) = run else {
                return Ok("FreeCAD is not installed: nothing to compare with.\n".to_owned());
            };
            let told = String::from_utf8_lossy(&run.stdout).into_owned();
            let figures = told.lines().find_map(|line| line.strip_prefix("posted "));
            let Some((moves, seconds)) = figures.and_then(|figures| figures.split_once(' ')) else {
                return Err(format!("FreeCAD's {name}: {told}").into());
            };
            let (moves, seconds): (f64, f64) = (moves.parse()?, seconds.trim().parse()?);
            writeln!(text, "| FreeCAD, `{name}` | {moves} | {:.0} |", moves / seconds)?;
        }
        let mut command = linuxcnc(&[]);
        command.arg(&self.cl).args(["--quiet", "--jobs", "1", "--output"]).arg(&program);
        let begin = Instant::now();
        run(&mut command)?;
        let rate = self.points as f64 / begin.elapsed().as_secs_f64();
        writeln!(text, "| `post`, dialect `linuxcnc`, one thread | {} | {rate:.0} |", self.points)?;
        Ok(text)
    }

    /// LinuxCNC's interpreter on the beginning of the program that `post` reads whole.
    fn reading(&self) -> Result<String, Box<dyn Error>> {
        let program = self.program()?;
        let whole = fs::read_to_string(&program)?;
        let lines = whole.lines().count() as u64;
        let beginning = self.at("beginning.ngc");
        let mut few: String = whole.split_inclusive('\n').take(RS274_LINES).collect();
        few.push_str("M2\n");
        fs::write(&beginning, few)?;
        let read = || run(linuxcnc(&["read"]).arg(&program));
        let verify = || run(linuxcnc(&["verify"]).arg(&program).arg("--against").arg(&self.cl));
        let diff = || run(linuxcnc(&["diff"]).args([&program, &program]));
        let mut rows = Vec::new();
        let rs274 = || {
            let mut command = Command::new("rs274");
            run(command.args(["-g", "-n", "0"]).arg(&beginning).current_dir(&self.folder))
        };
        if rs274().is_ok() {
            let lines = lines.min(RS274_LINES as u64);
            rows.push(TimedRow::new("LinuxCNC, `rs274 -g`", lines, rs274));
        }
        rows.push(TimedRow::new("`post read`", lines, read));
        rows.push(TimedRow::new("`post verify`", lines, verify));
        rows.push(TimedRow::new("`post diff` with itself, two programs", 2 * lines, diff));
        timed("Reading a program in axis positions (ratios by the line)", "lines/s", rows)
    }

    /// TOPPRA's figures beside those of `post-feed`, which a bench of that crate tells.
    fn planning(&self) -> Result<String, Box<dyn Error>> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let python = root.join("target/peers/bin/python");
        if !python.exists() {
            return Ok("TOPPRA is not installed: nothing to compare with.\n".to_owned());
        }
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let solvers = Command::new(cargo)
            .args(["bench", "--quiet", "-p", "post-feed", "--bench", "solvers"])
            .env("BENCH_MOST", PLANNED)
            .env("BENCH_CLARABEL", "0")
            .current_dir(root)
            .output()?;
        let own = self.at("solvers.txt");
        fs::write(&own, solvers.stdout)?;
        let compared = Command::new(python)
            .arg(root.join("core/feed/benches/toppra_compared.py"))
            .arg(own)
            .env("TOPPRA_MOST", PLANNED)
            .output()?;
        let table = String::from_utf8(compared.stdout)?;
        Ok(format!(
            "Planning, one core, on the same random paths and limits:\n\n```text\n{table}```\n"
        ))
    }
}

/// The command of this build.
fn command() -> &'static str {
    env!("CARGO_BIN_EXE_post")
}

/// The command with a machine.
fn post(machine: &str, tcp: &str) -> Command {
    let mut command = Command::new(command());
    command.args(["--machine", machine, "--tool-length", "100"]);
    command.args(["--set", &format!("control.tcp={tcp}")]);
    command
}

/// A verb with the machine whose programs LinuxCNC reads.
fn linuxcnc(verb: &[&str]) -> Command {
    let mut command = Command::new(command());
    command.args(verb).args(["--machine", "ac-trunnion", "--tool-length", "100"]);
    command.args(["--set", "control.tcp=post", "--set", "control.dialect=linuxcnc"]);
    command
}

/// Runs a command that must not fail; what it prints is thrown away.
fn run(command: &mut Command) -> Result<(), Box<dyn Error>> {
    let code = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status()?;
    if code.success() { Ok(()) } else { Err(format!("{command:?}: {code}").into()) }
}

/// Something that is timed, and how many of something it does.
struct TimedRow<'a> {
    name: String,
    count: u64,
    run: Box<dyn Fn() -> Result<(), Box<dyn Error>> + 'a>,
    /// Seconds by round.
    seconds: Vec<f64>,
}

impl<'a> TimedRow<'a> {
    fn new(name: &str, count: u64, run: impl Fn() -> Result<(), Box<dyn Error>> + 'a) -> Self {
        Self { name: name.to_owned(), count, run: Box::new(run), seconds: Vec::new() }
    }

    /// Seconds of each one, by round.
    fn each(&self) -> impl Iterator<Item = f64> {
        self.seconds.iter().map(|seconds| seconds / self.count as f64)
    }
}

/// Runs the rows in turn, and tells how long each took, and how many times as long as the first in the same round.
fn timed(title: &str, rate: &str, mut rows: Vec<TimedRow<'_>>) -> Result<String, Box<dyn Error>> {
    for _ in 0..ROUNDS {
        for row in &mut rows {
            let begin = Instant::now();
            (row.run)()?;
            row.seconds.push(begin.elapsed().as_secs_f64());
        }
    }
    let first = rows.first().map(|row| row.name.clone()).unwrap_or_default();
    let mut text = format!(
        "{title}:\n\n| | s | {rate} | time by that of {first} | least to largest |\n|---|---|---|---|---|\n"
    );
    for row in &rows {
        let mut seconds = row.seconds.clone();
        let mut ratios: Vec<f64> =
            row.each().zip(rows[0].each()).map(|(own, first)| own / first).collect();
        let (seconds, ratio) = (median(&mut seconds), median(&mut ratios));
        writeln!(
            text,
            "| {} | {seconds:.4} | {:.0} | {ratio:.3} | {:.3} to {:.3} |",
            row.name,
            row.count as f64 / seconds,
            ratios[0],
            ratios[ratios.len() - 1],
        )?;
    }
    Ok(text)
}

/// Puts numbers in order: the middle one.
fn median(numbers: &mut [f64]) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn say(text: &str) {
    let _ = writeln!(std::io::stdout(), "{text}");
}
