//! Whole-job speed as a ratio to a floor measured in the same run. `cargo bench`
//!
//! The floor reads the same file, parses the six numbers of every line, and formats and writes five: what
//! any program that turns such a file into another must do, by the fastest scalar means known to us. The job
//! is reading, kinematics, certificate, feed and dialect (through the plugin boundary) on one core.
//! Runs alternate, and medians are compared, so that the machine's drift hits both alike.

#[path = "common/job.rs"]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

use std::error::Error;
use std::fs::{self, File};
use std::io::{BufWriter, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use post_posting::Job;

/// Points of the file; more by the first argument behind `--`.
const POINTS: u64 = 1_000_000;
const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let points = std::env::args()
        .skip(1)
        .find_map(|argument| argument.parse().ok())
        .unwrap_or(POINTS);
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("wave.cls");
    let mut file = BufWriter::new(File::create(&path)?);
    generate::write_file(&mut file, points)?;
    file.flush()?;
    drop(file);
    say(&format!(
        "{points} five-axis points, {} MB, median of {RUNS} runs, one core",
        fs::metadata(&path)?.len() / 1_000_000
    ));
    let machines = ["ac-trunnion", "head-head", "nutating-head"];
    let mut floors = Vec::new();
    let mut jobs = vec![Vec::new(); machines.len()];
    for _ in 0..RUNS {
        floors.push(timed(|| floor(&path))?);
        for (machine, times) in machines.iter().zip(&mut jobs) {
            let settings = [
                "control.tcp=\"post\"".to_owned(),
                "control.dialect=\"fanuc\"".to_owned(),
            ];
            times.push(timed(|| {
                job::run(
                    &path,
                    machine,
                    &settings,
                    Job {
                        tool_length: Some(100.0),
                        ..Job::default()
                    },
                )
                .map(drop)
            })?);
        }
    }
    let floor = median(&mut floors);
    tell("floor", floor, floor, points);
    for (machine, times) in machines.iter().zip(&mut jobs) {
        tell(machine, median(times), floor, points);
    }
    Ok(())
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn tell(name: &str, time: Duration, floor: Duration, points: u64) {
    let seconds = time.as_secs_f64();
    say(&format!(
        "{name:<16} {:>7.1} ns a point {:>10.0} blocks/s {:>6.2} times the floor",
        seconds / points as f64 * 1e9,
        points as f64 / seconds,
        seconds / floor.as_secs_f64()
    ));
}

fn timed(mut run: impl FnMut() -> Result<(), Box<dyn Error>>) -> Result<Duration, Box<dyn Error>> {
    let start = Instant::now();
    run()?;
    Ok(start.elapsed())
}

fn median(times: &mut [Duration]) -> Duration {
    times.sort();
    times[times.len() / 2]
}

/// Read, parse six numbers a line, format and write five.
fn floor(path: &Path) -> Result<(), Box<dyn Error>> {
    let mut input = File::open(path)?;
    let mut output = File::create("/dev/null")?;
    let mut buffer = vec![0; 1 << 20];
    let mut kept = 0;
    let mut out = Vec::with_capacity(1 << 21);
    loop {
        let read = input.read(&mut buffer[kept..])?;
        if read == 0 {
            return Ok(());
        }
        let filled = kept + read;
        let mut start = 0;
        while let Some(length) = memchr::memchr(b'\n', &buffer[start..filled]) {
            let line = &buffer[start..start + length];
            start += length + 1;
            if let Some(numbers) = line.strip_prefix(b"GOTO/") {
                let mut at = 0;
                let mut values = [0.0; 6];
                for value in &mut values {
                    *value = parse(numbers, &mut at);
                }
                for (letter, value, decimals) in [
                    (b'X', values[0], 4),
                    (b'Y', values[1], 4),
                    (b'Z', values[2], 4),
                    (b'A', values[3], 3),
                    (b'C', values[4], 3),
                ] {
                    out.push(letter);
                    format(&mut out, value, decimals);
                    out.push(b' ');
                }
                out.push(b'\n');
            }
        }
        buffer.copy_within(start..filled, 0);
        kept = filled - start;
        output.write_all(&out)?;
        out.clear();
    }
}

const POWERS: [f64; 10] = [1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9];

/// The number at `at`, and the comma behind it.
fn parse(text: &[u8], at: &mut usize) -> f64 {
    let mut mantissa: u64 = 0;
    let mut decimals = 0;
    let mut point = false;
    let minus = text.get(*at) == Some(&b'-');
    *at += usize::from(minus);
    while let Some(&byte) = text.get(*at) {
        *at += 1;
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa * 10 + u64::from(digit);
            decimals += usize::from(point);
        } else if byte == b'.' {
            point = true;
        } else {
            break;
        }
    }
    let value = mantissa as f64 / POWERS[decimals];
    if minus { -value } else { value }
}

const PAIRS: &[u8; 200] = b"0001020304050607080910111213141516171819\
2021222324252627282930313233343536373839\
4041424344454647484950515253545556575859\
6061626364656667686970717273747576777879\
8081828384858687888990919293949596979899";

fn format(out: &mut Vec<u8>, value: f64, decimals: usize) {
    let mut count = (value.abs() * POWERS[decimals] + 0.5) as u64;
    let mut text = [b'0'; 20];
    let mut at = text.len();
    while count >= 100 || text.len() - at < decimals {
        let pair = (count % 100) as usize * 2;
        count /= 100;
        at -= 2;
        text[at..at + 2].copy_from_slice(&PAIRS[pair..pair + 2]);
    }
    while count > 0 || text.len() - at <= decimals {
        at -= 1;
        text[at] = b'0' + (count % 10) as u8;
        count /= 10;
    }
    if value < 0.0 {
        out.push(b'-');
    }
    let point = text.len() - decimals;
    out.extend_from_slice(&text[at..point]);
    out.push(b'.');
    out.extend_from_slice(&text[point..]);
}
