//! What error control costs and saves: blocks in and out for every placement, and the time of it.
//! `cargo bench --bench accuracy`
//!
//! Each line is a whole job with its text thrown away. Of the file's cuts, `blocks in` are those that the CAM system
//! wrote, `blocks out` those of the program; times are medians of a few runs. The last table sets what the
//! certificate of a block costs against what its inverse solution costs, over the same points in the same run.

#[path = "common/job.rs"]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

use std::error::Error;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use nalgebra::Vector3;
use post_core::Job;
use post_core::accuracy::{Move, Node, Placer, Tolerances};
use post_core::kinematics::Pose;
use post_core::program::Reading;
use post_grammar::{Reader, Statement, Units};
use post_plugin::Format;

const RUNS: usize = 3;

/// A file, the machine that it is posted on, and what that takes.
struct Case {
    name: &'static str,
    path: PathBuf,
    machine: &'static str,
    settings: &'static [&'static str],
    millimetres: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let shared = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/cl");
    let folder = tempfile::tempdir()?;
    let wave = folder.path().join("wave.cls");
    let mut file = BufWriter::new(File::create(&wave)?);
    generate::write_file(&mut file, 100_000)?;
    file.flush()?;
    drop(file);
    let cases = [
        Case {
            name: "creo5x",
            path: shared.join("creo5x_4r19415_finition.ncl"),
            machine: "ac-trunnion",
            settings: &["workpiece.mount=[-140,21,-40]"],
            millimetres: true,
        },
        Case {
            name: "ust_a2",
            path: shared.join("nx_HumMan_ust_a2.cls"),
            machine: "head-head-360",
            settings: &[],
            millimetres: false,
        },
        Case {
            name: "blade",
            path: Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/samples/disc-blade.cls"),
            machine: "disc-cutter",
            settings: &[],
            millimetres: false,
        },
    ];
    for case in &cases {
        if !case.path.exists() {
            say(&format!("skipped: {} is not there", case.path.display()));
            continue;
        }
        placements(case)?;
    }
    certification(&wave)
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
                let mut settings: Vec<String> = case
                    .settings
                    .iter()
                    .map(|text| (*text).to_owned())
                    .collect();
                settings.push(format!("accuracy.tolerance={tolerance}"));
                settings.push(format!("accuracy.placement={placement:?}"));
                settings.push(format!("accuracy.reduce={reduce}"));
                let mut times = Vec::new();
                let mut last = None;
                for _ in 0..RUNS {
                    let start = Instant::now();
                    let job = Job {
                        reading: Reading {
                            units: case.millimetres.then_some(Units::Millimetre),
                            ..Reading::default()
                        },
                        ..Job::default()
                    };
                    last = Some(job::run(&case.path, case.machine, &settings, job));
                    times.push(start.elapsed());
                }
                let report = match last {
                    Some(Ok(report)) => report,
                    Some(Err(fault)) => {
                        say(&format!(
                            "{tolerance:>9} {placement:<10} {reduce:<6}  {fault:.90}"
                        ));
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

/// What the certificate of a block costs beside the inverse solution of its end, over the same points.
fn certification(path: &Path) -> Result<(), Box<dyn Error>> {
    let poses = poses(path)?;
    say(
        "\nmachine          inverse ns  certificate ns  ratio  tight ns   (a block, on average, one core)",
    );
    for name in ["ac-trunnion", "head-head", "nutating-head"] {
        let machine = job::machine(name, &["control.tcp=\"post\"".to_owned()])?;
        let format = Format {
            words: vec![4; machine.axes.len()],
            feed: 3,
            inverse_time: Some(4),
            feed_per_revolution: 4,
            extension: String::new(),
        };
        let start = machine.solution.start;
        let placer = Placer::for_machine(&machine, &format, 100.0, &start)
            .map_err(|finding| finding.message)?;
        let tolerances = Tolerances {
            tip: machine.accuracy.tolerance,
            axis: machine.accuracy.axis_tolerance,
        };
        let mut last = start;
        let mut nodes: Vec<Node> = Vec::with_capacity(poses.len());
        for pose in &poses {
            if let Ok(node) = placer.place(*pose, 1.0, &last) {
                last = node.trace.joints;
                nodes.push(node);
            }
        }
        let block = |pair: &[Node]| -> (f64, f64) {
            let piece = Move {
                placer: &placer,
                from: &pair[0],
                to: &pair[1],
                tolerances,
                control_keeps_tip: false,
            };
            let bound = black_box(piece).certify();
            (bound.tip, bound.axis)
        };
        let (mut inverse, mut certificate, mut tight) = (Vec::new(), Vec::new(), Vec::new());
        for _ in 0..5 {
            inverse.push(each(nodes.len(), |index| {
                let from = &nodes[index.saturating_sub(1)].trace.joints;
                black_box(placer.place(nodes[index].target, 1.0, from).is_ok());
            }));
            certificate.push(each(nodes.len() - 1, |index| {
                black_box(block(&nodes[index..index + 2]));
            }));
            tight.push(each(nodes.len() - 1, |index| {
                let piece = Move {
                    placer: &placer,
                    from: &nodes[index],
                    to: &nodes[index + 1],
                    tolerances,
                    control_keeps_tip: false,
                };
                black_box(black_box(piece).measured());
            }));
        }
        let [inverse, certificate, tight] =
            [inverse, certificate, tight].map(|mut times| median(&mut times).as_secs_f64() * 1e9);
        say(&format!(
            "{name:<16} {inverse:>10.0} {certificate:>15.0} {:>6.2} {tight:>9.0}",
            certificate / inverse
        ));
    }
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

/// The five-axis points of a file.
fn poses(path: &Path) -> Result<Vec<Pose>, Box<dyn Error>> {
    let mut reader = Reader::new(File::open(path)?);
    let mut poses = Vec::new();
    while let Some(record) = reader.next_record()? {
        if let Statement::Goto {
            point,
            axis: Some(axis),
        } = record.statement
        {
            poses.push(Pose {
                tip: Vector3::from(point),
                axis: Vector3::from(axis).normalize(),
                ..Pose::default()
            });
        }
    }
    Ok(poses)
}
