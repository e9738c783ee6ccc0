//! Instructions of the command a point, a block and a start, which do not drift as times do.
//! `cargo build --release && cargo run --example ledger` writes them into `tests/bench/ledger.txt` and prints what has
//! changed; `-- --print` writes nothing, and the command may be named after that.
//!
//! Those of a point are the difference between two files, over their points, as callgrind counts them; without valgrind
//! nothing is counted, and that is said. The committed ledger is one of the same build on Linux, x86-64: another
//! compiler counts differently, so that a change is something to look into, and no failure.

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

use std::error::Error;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Points of the smaller file; the larger has twice as many.
const POINTS: u64 = 20_000;

/// Points of the smaller file where each costs much more than one of a posted program.
const FEW_POINTS: u64 = 2_000;

/// How the points are written.
#[derive(Clone, Copy, Debug)]
enum Form {
    /// As NX writes five axes: six numbers in a line.
    Nx,
    /// As Creo does: ten decimals, the tool axis in a second line.
    Creo,
    /// Three numbers, without a tool axis.
    Point,
}

/// What the command does.
#[derive(Clone, Copy, Debug)]
enum Job {
    Post,
    Read,
    Verify,
    /// A program against itself.
    Diff,
    Predict,
    /// Posting, with a page beside the program.
    Report,
    /// Eight dry runs at most, for the mount.
    Place,
    /// The tool is held against the CL file too.
    PredictAgainst,
    /// Posting with planned feeds, predictions of its rounds included.
    Plan,
    /// Posting of two points, as a whole.
    Start,
    /// Nothing but its version, as a whole.
    Version,
}

impl Job {
    /// A program is posted first, and read.
    fn reads(self) -> bool {
        matches!(
            self,
            Self::Read | Self::Verify | Self::Diff | Self::Predict | Self::PredictAgainst
        )
    }
}

#[derive(Clone, Copy, Debug)]
struct Case {
    name: &'static str,
    job: Job,
    form: Form,
    /// Machine, and the rest of the flags that the job and its program are made with.
    flags: &'static [&'static str],
}

const AC_POST: &[&str] = &["-m", "ac-trunnion", "--set", "control.tcp=post"];
const AC_CONTROL: &[&str] = &["-m", "ac-trunnion", "--set", "control.tcp=control"];
const HEAD_POST: &[&str] = &["-m", "head-head", "--set", "control.tcp=post"];
const HEAD_CONTROL: &[&str] = &["-m", "head-head", "--set", "control.tcp=control"];
const DMU: &[&str] = &["-m", "dmu50"];
const AC_ARCS: &[&str] =
    &["-m", "ac-trunnion", "--set", "control.tcp=post", "--set", "control.arcs.fit=true"];
/// Its rapids are searched for from many places.
const ARM: &[&str] =
    &["-m", concat!(env!("CARGO_MANIFEST_DIR"), "/tests/chains/six-axis-arm.toml")];
const VMC: &[&str] = &["-m", "vmc"];

const CASES: &[Case] = &[
    Case { name: "post ac-trunnion, tcp = post", job: Job::Post, form: Form::Nx, flags: AC_POST },
    Case {
        name: "post ac-trunnion, tcp = control",
        job: Job::Post,
        form: Form::Nx,
        flags: AC_CONTROL,
    },
    Case { name: "post head-head, tcp = post", job: Job::Post, form: Form::Nx, flags: HEAD_POST },
    Case {
        name: "post head-head, tcp = control",
        job: Job::Post,
        form: Form::Nx,
        flags: HEAD_CONTROL,
    },
    Case { name: "post dmu50", job: Job::Post, form: Form::Nx, flags: DMU },
    Case {
        name: "post ac-trunnion, form of Creo",
        job: Job::Post,
        form: Form::Creo,
        flags: AC_POST,
    },
    Case { name: "post vmc, three axes", job: Job::Post, form: Form::Point, flags: VMC },
    Case { name: "post ac-trunnion, arcs fitted", job: Job::Post, form: Form::Nx, flags: AC_ARCS },
    Case { name: "post ac-trunnion, report", job: Job::Report, form: Form::Nx, flags: AC_POST },
    Case { name: "place ac-trunnion, eight runs", job: Job::Place, form: Form::Nx, flags: AC_POST },
    Case { name: "read ac-trunnion, tcp = post", job: Job::Read, form: Form::Nx, flags: AC_POST },
    Case {
        name: "verify ac-trunnion, tcp = post",
        job: Job::Verify,
        form: Form::Nx,
        flags: AC_POST,
    },
    Case {
        name: "verify ac-trunnion, tcp = control",
        job: Job::Verify,
        form: Form::Nx,
        flags: AC_CONTROL,
    },
    Case { name: "diff ac-trunnion, tcp = post", job: Job::Diff, form: Form::Nx, flags: AC_POST },
    Case {
        name: "diff ac-trunnion, tcp = control",
        job: Job::Diff,
        form: Form::Nx,
        flags: AC_CONTROL,
    },
    Case {
        name: "predict ac-trunnion, tcp = post",
        job: Job::Predict,
        form: Form::Nx,
        flags: AC_POST,
    },
    Case {
        name: "predict ac-trunnion, tcp = control",
        job: Job::Predict,
        form: Form::Nx,
        flags: AC_CONTROL,
    },
    Case { name: "start of a job, six-axis arm", job: Job::Start, form: Form::Nx, flags: ARM },
    Case {
        name: "predict against the CL file",
        job: Job::PredictAgainst,
        form: Form::Nx,
        flags: AC_POST,
    },
    Case {
        name: "post --plan ac-trunnion, tcp = post",
        job: Job::Plan,
        form: Form::Nx,
        flags: AC_POST,
    },
    Case { name: "start of a job", job: Job::Start, form: Form::Nx, flags: AC_POST },
    Case { name: "start, --version", job: Job::Version, form: Form::Nx, flags: &[] },
];

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut arguments = std::env::args_os().skip(1).peekable();
    let keeps = arguments.next_if(|word| word == "--print").is_none();
    let command = arguments.next().map_or_else(|| root.join("target/release/post"), PathBuf::from);
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).status().is_err() {
        say("skipped: valgrind is not installed, and no instructions are counted");
        return Ok(());
    }
    let ledger = root.join("tests/bench/ledger.txt");
    let before = fs::read_to_string(&ledger).unwrap_or_default();
    let mut after = String::new();
    for (case, Count { instructions: count, unit }) in CASES.iter().zip(counts(&command)?) {
        let name = case.name;
        writeln!(after, "{name:<36} {count:>9} {unit}")?;
        let known = before.lines().find_map(|line| {
            line.strip_prefix(name)?.split_whitespace().next()?.parse::<u64>().ok()
        });
        let change = known.map_or_else(
            || "new".to_owned(),
            |known| {
                let share = 100.0 * (count as f64 / known as f64 - 1.0);
                format!("{known:>9} before, {share:+.1} %")
            },
        );
        say(&format!("{name:<36} {count:>9} {unit:<11} {change}"));
    }
    if keeps {
        fs::write(ledger, after)?;
    }
    Ok(())
}

/// What was counted.
#[derive(Clone, Copy, Debug)]
struct Count {
    instructions: u64,
    /// What they are spent on, as "a point".
    unit: &'static str,
}

/// Counts each case, as many side by side as there are processors, which changes no count.
fn counts(post: &Path) -> Result<Vec<Count>, Box<dyn Error>> {
    let next = AtomicUsize::new(0);
    let counts = Mutex::new(vec![None; CASES.len()]);
    let work = || -> Result<(), String> {
        while let number = next.fetch_add(1, Ordering::Relaxed)
            && let Some(case) = CASES.get(number)
        {
            let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
            let count = case.count(post, folder.path());
            let count = count.map_err(|error| format!("{}: {error}", case.name))?;
            counts.lock().map_err(|error| error.to_string())?[number] = Some(count);
        }
        Ok(())
    };
    let workers = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    std::thread::scope(|scope| -> Result<(), Box<dyn Error>> {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            worker.join().map_err(|_| "a thread of the ledger has failed")??;
        }
        Ok(())
    })?;
    Ok(counts.into_inner()?.into_iter().flatten().collect())
}

impl Case {
    /// Instructions, and of what.
    fn count(self, post: &Path, folder: &Path) -> Result<Count, Box<dyn Error>> {
        let (points, unit) = match self.job {
            Job::Start | Job::Version => {
                let instructions = self.instructions(post, folder, 2)?;
                return Ok(Count { instructions, unit: "a start" });
            }
            Job::Post | Job::Report | Job::Place => (POINTS, "a point"),
            Job::Read | Job::Verify => (POINTS, "a block"),
            Job::Diff => (POINTS, "a pair"),
            Job::Predict | Job::PredictAgainst => (FEW_POINTS, "a block"),
            Job::Plan => (FEW_POINTS, "a point"),
        };
        let [fewer, more] =
            [points, 2 * points].map(|points| self.instructions(post, folder, points));
        Ok(Count { instructions: (more? - fewer?) / points, unit })
    }

    /// All instructions of the job on a file of so many points.
    fn instructions(self, post: &Path, folder: &Path, points: u64) -> Result<u64, Box<dyn Error>> {
        let cl = folder.join(format!("{:?}-{points}.cls", self.form));
        if !cl.exists() {
            self.form.write(&cl, points)?;
        }
        let program = folder.join("program.nc");
        if self.job.reads() {
            let mut posting = Command::new(post);
            self.posting(&mut posting, &cl, &program);
            succeed(&mut posting)?;
        }
        let mut counted = Command::new("valgrind");
        counted.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(post);
        match self.job {
            Job::Post | Job::Start => self.posting(&mut counted, &cl, &program),
            Job::Report => {
                self.posting(&mut counted, &cl, &program);
                counted.arg("--report").arg(folder.join("report.html"));
            }
            Job::Plan => {
                self.posting(&mut counted, &cl, &program);
                counted.arg("--plan");
            }
            Job::Place => {
                counted.arg("place").arg(&cl).args(self.flags).args(["--runs", "8"]);
            }
            Job::Read => {
                counted.arg("read").arg(&program).args(self.flags);
            }
            Job::Verify => {
                counted.arg("verify").arg(&program).arg("--against").arg(&cl).args(self.flags);
            }
            Job::Diff => {
                counted.arg("diff").args([&program, &program]).args(self.flags);
            }
            Job::Predict => {
                counted.arg("predict").arg(&program).args(self.flags);
            }
            Job::PredictAgainst => {
                counted.arg("predict").arg(&program).arg("--against").arg(&cl).args(self.flags);
            }
            Job::Version => {
                counted.arg("--version");
            }
        }
        if self.job.reads() || matches!(self.job, Job::Place) {
            counted.args(["--tool-length", "100"]);
        }
        if !matches!(self.job, Job::Read | Job::Diff | Job::Version) {
            // What threads spend on one another is not the same every time.
            counted.args(["--jobs", "1"]);
        }
        let told = succeed(&mut counted)?;
        let collected = told.lines().find_map(|line| line.split_once("Collected :"));
        let count = collected.and_then(|(_, count)| count.trim().parse().ok());
        count.ok_or_else(|| format!("callgrind tells no count: {told}").into())
    }

    /// Arguments that make the program of a CL file.
    fn posting(self, command: &mut Command, cl: &PathBuf, program: &PathBuf) {
        command.arg(cl).args(self.flags).args(["--tool-length", "100", "--quiet"]);
        command.arg("--output").arg(program);
    }
}

/// Runs a command that must not fail; what it tells on standard error.
fn succeed(command: &mut Command) -> Result<String, Box<dyn Error>> {
    let run = command.stdout(Stdio::null()).output()?;
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    if run.status.success() { Ok(told) } else { Err(format!("{command:?}: {told}").into()) }
}

impl Form {
    /// Writes a finishing pass of so many points.
    fn write(self, path: &Path, points: u64) -> Result<(), Box<dyn Error>> {
        let mut file = BufWriter::new(File::create(path)?);
        let words = match self {
            Self::Nx => {
                generate::write_file(&mut file, points)?;
                return Ok(file.flush()?);
            }
            Self::Creo => [
                "PARTNO / WAVE",
                "UNITS / MM",
                "LOADTL / 1",
                "SPINDL / RPM, 12000.000000,  CLW",
                "FEDRAT / 3000.000000,  MMPM",
            ],
            Self::Point => [
                "TOOL PATH/WAVE,TOOL,BALL_10",
                "UNITS/MM",
                "LOAD/TOOL,1",
                "SPINDL/12000,RPM,CLW",
                "FEDRAT/MMPM,3000.0000",
            ],
        };
        for word in words {
            writeln!(file, "{word}")?;
        }
        for index in 0..points {
            let [x, y, z, i, j, k] = generate::point(index);
            match self {
                Self::Creo => writeln!(
                    file,
                    "GOTO / {x:.10}, {y:.10}, {z:.10},  $\n{i:.10}, {j:.10}, {k:.10}"
                )?,
                _ => writeln!(file, "GOTO/{x:.4},{y:.4},{z:.4}")?,
            }
        }
        writeln!(file, "{}", if matches!(self, Self::Creo) { "FINI" } else { "END-OF-PATH" })?;
        Ok(file.flush()?)
    }
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
