//! Whole-job speed as a ratio to two floors measured in the same run. `cargo bench --bench throughput`
//!
//! The floors read the same file, parse the six numbers of every line, and format and write five: what any program that
//! turns such a file into another must do, by plain loops and by the fastest scalar means known to us
//! (`common/floor.rs`). The job is reading, kinematics, certificate, feed and dialect (through the plugin boundary) on
//! one core, its text thrown away; the command as a process stands beside floors in `peers.rs`. Runs alternate, and
//! medians are compared, so that the machine's drift hits all alike. Instructions do not drift: `ledger.rs`.

#[path = "common/floor.rs"]
mod floor;

#[path = "common/job.rs"]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use post_posting::PostingRequest;

/// Points of the file; more by the first argument behind `--`.
const POINTS: u64 = 1_000_000;
const RUNS: usize = 7;

/// Machine, and what keeps the tip.
const CASES: [(&str, &str); 4] = [
    ("ac-trunnion", "post"),
    ("ac-trunnion", "control"),
    ("head-head", "post"),
    ("head-head", "control"),
];

/// Text thrown away.
const NOWHERE: &str = "/dev/null";

fn main() -> Result<(), Box<dyn Error>> {
    let points =
        std::env::args().skip(1).find_map(|argument| argument.parse().ok()).unwrap_or(POINTS);
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("wave.cls");
    let mut file = BufWriter::new(File::create(&path)?);
    generate::write_file(&mut file, points)?;
    file.flush()?;
    drop(file);
    agree(&path, folder.path())?;
    say(&format!(
        "{points} five-axis points, {} MB, median of {RUNS} runs, one core",
        fs::metadata(&path)?.len() / 1_000_000
    ));
    let mut jobs = Table::new("job, its text thrown away", points);
    for _ in 0..RUNS {
        let nowhere = Path::new(NOWHERE);
        jobs.time("floor, plain", || floor::plain(&path, nowhere))?;
        jobs.time("floor, masked", || floor::masked(&path, nowhere))?;
        for (machine, tcp) in CASES {
            jobs.time(&format!("{machine}, {tcp}"), || job(&path, machine, tcp))?;
        }
    }
    jobs.tell();
    Ok(())
}

/// Both floors do the same work.
fn agree(path: &Path, folder: &Path) -> Result<(), Box<dyn Error>> {
    let [plain, masked] = ["plain", "masked"].map(|name| folder.join(name));
    floor::plain(path, &plain)?;
    floor::masked(path, &masked)?;
    if fs::read(plain)? == fs::read(masked)? {
        Ok(())
    } else {
        Err("the floors write different files".into())
    }
}

fn job(path: &Path, machine: &str, tcp: &str) -> Result<(), Box<dyn Error>> {
    let settings = [format!("control.tcp={tcp:?}"), "control.dialect=\"fanuc\"".to_owned()];
    let job = PostingRequest { tool_length: Some(100.0), ..PostingRequest::default() };
    job::run(path, machine, &settings, job).map(drop)
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// Times of things that are compared, the two floors first.
struct Table {
    title: &'static str,
    points: u64,
    rows: Vec<(String, Vec<Duration>)>,
}

impl Table {
    fn new(title: &'static str, points: u64) -> Self {
        Self { title, points, rows: Vec::new() }
    }

    /// Runs something once.
    fn time(
        &mut self,
        name: &str,
        run: impl FnOnce() -> Result<(), Box<dyn Error>>,
    ) -> Result<(), Box<dyn Error>> {
        let start = Instant::now();
        run()?;
        let time = start.elapsed();
        match self.rows.iter_mut().find(|(known, _)| known == name) {
            Some((_, times)) => times.push(time),
            None => self.rows.push((name.to_owned(), vec![time])),
        }
        Ok(())
    }

    fn tell(&mut self) {
        let medians: Vec<f64> =
            self.rows.iter_mut().map(|(_, times)| median(times).as_secs_f64()).collect();
        say(&format!("\n{:<32} ns a point   blocks/s  times plain  times masked", self.title));
        for ((name, _), seconds) in self.rows.iter().zip(&medians) {
            say(&format!(
                "{name:<32} {:>10.1} {:>10.0} {:>12.2} {:>13.2}",
                seconds / self.points as f64 * 1e9,
                self.points as f64 / seconds,
                seconds / medians[0],
                seconds / medians[1],
            ));
        }
    }
}

fn median(times: &mut [Duration]) -> Duration {
    times.sort();
    times[times.len() / 2]
}
