//! Instructions of the command a point, a block and a start, which do not drift as times do.
//! `cargo bench --bench ledger` writes them into `tests/bench/ledger.txt` and prints what has changed.
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
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

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
    Predict,
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
    /// A program is made for it first.
    fn reads_program(self) -> bool {
        matches!(self, Self::Read | Self::Verify | Self::Predict | Self::PredictAgainst)
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
const VMC: &[&str] = &["-m", "vmc"];

const CASES: [Case; 16] = [
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
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).status().is_err() {
        say("skipped: valgrind is not installed, and no instructions are counted");
        return Ok(());
    }
    let ledger = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bench/ledger.txt");
    let before = fs::read_to_string(&ledger).unwrap_or_default();
    let folder = tempfile::tempdir()?;
    let mut after = String::new();
    for case in CASES {
        let (count, unit) = case.count(folder.path())?;
        writeln!(after, "{:<36} {count:>9} {unit}", case.name)?;
        let known = before.lines().find_map(|line| {
            line.strip_prefix(case.name)?.split_whitespace().next()?.parse::<u64>().ok()
        });
        let change = known.map_or_else(
            || "new".to_owned(),
            |known| {
                let share = 100.0 * (count as f64 / known as f64 - 1.0);
                format!("{known:>9} before, {share:+.1} %")
            },
        );
        say(&format!("{:<36} {count:>9} {unit:<11} {change}", case.name));
    }
    fs::write(ledger, after)?;
    Ok(())
}

impl Case {
    /// Instructions, and of what.
    fn count(self, folder: &Path) -> Result<(u64, &'static str), Box<dyn Error>> {
        let (points, unit) = match self.job {
            Job::Start | Job::Version => {
                return Ok((self.instructions(folder, 2)?, "a start"));
            }
            Job::Post => (POINTS, "a point"),
            Job::Read | Job::Verify => (POINTS, "a block"),
            Job::Predict | Job::PredictAgainst => (FEW_POINTS, "a block"),
            Job::Plan => (FEW_POINTS, "a point"),
        };
        let [fewer, more] = [points, 2 * points].map(|points| self.instructions(folder, points));
        Ok(((more? - fewer?) / points, unit))
    }

    /// All instructions of the job on a file of so many points.
    fn instructions(self, folder: &Path, points: u64) -> Result<u64, Box<dyn Error>> {
        let cl = folder.join(format!("{:?}-{points}.cls", self.form));
        if !cl.exists() {
            self.form.write(&cl, points)?;
        }
        let program = folder.join("program.nc");
        let post = env!("CARGO_BIN_EXE_post");
        if self.job.reads_program() {
            let mut posting = Command::new(post);
            self.posting(&mut posting, &cl, &program);
            succeed(&mut posting)?;
        }
        let mut counted = Command::new("valgrind");
        counted.args(["--tool=callgrind", "--callgrind-out-file=/dev/null", post]);
        match self.job {
            Job::Post | Job::Start => self.posting(&mut counted, &cl, &program),
            Job::Plan => {
                self.posting(&mut counted, &cl, &program);
                counted.arg("--plan");
            }
            Job::Read => {
                counted.arg("read").arg(&program).args(self.flags);
            }
            Job::Verify => {
                counted.arg("verify").arg(&program).arg("--against").arg(&cl).args(self.flags);
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
        if self.job.reads_program() {
            counted.args(["--tool-length", "100"]);
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
