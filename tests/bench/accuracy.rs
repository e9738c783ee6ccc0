//! What error control costs and saves: blocks in and out for every placement, and the time of it.
//! `cargo bench --bench accuracy`
//!
//! Each line is a whole job with its text thrown away. Of the file's cuts, `blocks in` are those that the CAM system
//! wrote, `blocks out` those of the program; times are medians of a few runs. The last table sets what the
//! certificate of a block costs against what its inverse solution costs, over the blocks of the same files in the same
//! run.

#[path = "common/job.rs"]
mod job;

use std::error::Error;
use std::hint::black_box;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use post_grammar::Units;
use post_host::{OpenedModel, Plugin};
use post_posting::accuracy::{Lineariser, MoveTolerances, NodeMove, NodeRun, PathNode, Placer};
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_posting::{Observer, PostingRequest};

const RUNS: usize = 3;

/// A file, the machine that it is posted on, and what that takes.
struct Case {
    name: &'static str,
    path: PathBuf,
    machine: &'static str,
    settings: &'static [&'static str],
    millimetres: bool,
    /// None: that of the machine file.
    tool_length: Option<f64>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cl");
    let cases = [
        Case {
            name: "creo5x",
            path: shared.join("creo5x_4r19415_finition.ncl"),
            machine: "ac-trunnion",
            settings: &["workpiece.mount=[-140,21,-40]"],
            millimetres: true,
            tool_length: Some(100.0),
        },
        Case {
            name: "ust_a2",
            path: shared.join("nx_HumMan_ust_a2.cls"),
            machine: "head-head-360",
            settings: &[],
            millimetres: false,
            tool_length: Some(100.0),
        },
        Case {
            name: "blade",
            path: Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples/disc-blade.cls"),
            machine: "disc-cutter",
            settings: &[],
            millimetres: false,
            tool_length: None,
        },
    ];
    let (there, missing): (Vec<&Case>, Vec<&Case>) =
        cases.iter().partition(|case| case.path.exists());
    for case in missing {
        say(&format!("skipped: {} is not there", case.path.display()));
    }
    for case in &there {
        placements(case)?;
    }
    say("\na block of the bisected program, on average, one core\n\
        file     machine          blocks  inverse ns  certificate ns  ratio");
    for case in &there {
        certification(case)?;
    }
    Ok(())
}

impl Case {
    fn job(&self) -> PostingRequest {
        PostingRequest {
            reading: ReadingOptions {
                units: self.millimetres.then_some(Units::Millimetre),
                // Not all of the files switch it on.
                spindle: DefaultSpindle::Still,
                ..ReadingOptions::default()
            },
            tool_length: self.tool_length,
            ..PostingRequest::default()
        }
    }
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn placements(case: &Case) -> Result<(), Box<dyn Error>> {
    say(&format!(
        "\n{} on {}\ntolerance placement  reduce  blocks in blocks out  to bisect  certified     ns a block in",
        case.name, case.machine
    ));
    for tolerance in ["0.001", "0.005", "0.020"] {
        let (mut bisected, mut into) = (0, 0);
        for placement in ["bisect", "even", "fewest"] {
            for reduce in [false, true] {
                let mut settings: Vec<String> =
                    case.settings.iter().map(|text| (*text).to_owned()).collect();
                settings.push(format!("accuracy.tolerance={tolerance}"));
                settings.push(format!("accuracy.placement={placement:?}"));
                settings.push(format!("accuracy.reduce={reduce}"));
                let mut times = Vec::new();
                let mut last = None;
                for _ in 0..RUNS {
                    let start = Instant::now();
                    last = Some(job::run(&case.path, case.machine, &settings, case.job()));
                    times.push(start.elapsed());
                }
                let report = match last {
                    Some(Ok(report)) => report,
                    Some(Err(fault)) => {
                        say(&format!("{tolerance:>9} {placement:<10} {reduce:<6}  {fault:.90}"));
                        continue;
                    }
                    None => continue,
                };
                if placement == "bisect" && !reduce {
                    bisected = report.blocks;
                    into = report.blocks - report.points_added;
                }
                say(&format!(
                    "{tolerance:>9} {placement:<10} {reduce:<6} {into:>10} {:>10} {:>10.3} {:>8.3} µm {:>12.0}",
                    report.blocks,
                    report.blocks as f64 / bisected as f64,
                    report.tip_deviation_mm.value * 1e3,
                    median(&mut times).as_secs_f64() * 1e9 / into as f64,
                ));
            }
        }
    }
    Ok(())
}

fn median(times: &mut [Duration]) -> Duration {
    times.sort();
    times[times.len() / 2]
}

/// Blocks of a program and the points that they go to, as the bisected moves of a file give them.
struct Blocks {
    nodes: Vec<[PathNode; 2]>,
    placer: Option<Placer>,
    linearise: Lineariser,
    model: OpenedModel,
}

/// More blocks than this say nothing new.
const MOST: usize = 40_000;

impl Observer for Blocks {
    fn cut(&mut self, _: u64, cut: &NodeMove<'_>) {
        if self.nodes.len() > MOST {
            return;
        }
        let run = NodeRun {
            placer: cut.placer,
            nodes: &[*cut.from, *cut.to],
            tolerances: cut.tolerances,
            control_keeps_tip: cut.control_keeps_tip,
            straight: cut.straight,
            balances: true,
        };
        if self.linearise.split(&run, &mut self.model).is_ok() {
            let mut from = *cut.from;
            for piece in self.linearise.pieces() {
                self.nodes.push([from, piece.to]);
                from = piece.to;
            }
        }
        self.placer.get_or_insert_with(|| cut.placer.clone());
    }
}

/// What the certificate of a block of the program costs, and the inverse solution of its end, on average.
fn certification(case: &Case) -> Result<(), Box<dyn Error>> {
    let settings: Vec<String> = case.settings.iter().map(|text| (*text).to_owned()).collect();
    let machine = job::machine(case.machine, &settings)?;
    let mut blocks = Blocks {
        nodes: Vec::new(),
        placer: None,
        linearise: Lineariser::new(&machine.accuracy, false),
        model: Plugin::linked(post_stock::plugin("sampled").ok_or("no such plugin")?)?
            .error_model(&[])?,
    };
    job::watched(&case.path, case.machine, &settings, case.job(), Some(&mut blocks))?;
    let Some(placer) = blocks.placer else {
        return Ok(());
    };
    let tolerances =
        MoveTolerances { tip: machine.accuracy.tolerance, axis: machine.accuracy.axis_tolerance };
    let nodes = &blocks.nodes;
    let block = |index: usize| NodeMove {
        placer: &placer,
        from: &nodes[index][0],
        to: &nodes[index][1],
        tolerances,
        control_keeps_tip: false,
        straight: None,
    };
    let (mut inverse, mut certificate) = (Vec::new(), Vec::new());
    for _ in 0..5 {
        inverse.push(each(nodes.len(), |index| {
            let [from, to] = &nodes[index];
            black_box(placer.place(to.target, 1.0, &from.trace.joints).is_ok());
        }));
        certificate.push(each(nodes.len(), |index| {
            black_box(black_box(block(index)).certify());
        }));
    }
    let [inverse, certificate] =
        [inverse, certificate].map(|mut times| median(&mut times).as_secs_f64() * 1e9);
    say(&format!(
        "{:<8} {:<14} {:>8} {inverse:>11.0} {certificate:>15.0} {:>6.2}",
        case.name,
        case.machine,
        nodes.len(),
        certificate / inverse
    ));
    Ok(())
}

/// Time of one of `count` calls.
fn each(count: usize, mut call: impl FnMut(usize)) -> Duration {
    let start = Instant::now();
    for index in 0..count {
        call(index);
    }
    start.elapsed() / count as u32
}
