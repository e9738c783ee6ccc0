//! What a point costs by the functions for one point and by those for a batch. `cargo bench --bench kernels`
//!
//! The points are those of the generated file.

#[path = "common/job.rs"]
#[expect(dead_code, reason = "the machines alone are asked for")]
mod job;

#[path = "generate.rs"]
#[expect(dead_code, reason = "its `main` is that of the example")]
mod generate;

use std::error::Error;
use std::hint::black_box;
use std::io::Write;
use std::time::Instant;

use nalgebra::Vector3;
use post_machine::axis_words::{AxisWords, WordValues};
use post_machine::kinematics::batch::{AxisBatch, LANES, Traces};
use post_machine::kinematics::{Joints, Pose, Trace};
use post_plugin::Format;

const POINTS: u64 = 1_000_000;
const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let poses: Vec<Pose> = (0..POINTS)
        .map(|index| {
            let [x, y, z, i, j, k] = generate::point(index);
            Pose { tip: Vector3::new(x, y, z), axis: Vector3::new(i, j, k), ..Pose::default() }
        })
        .collect();
    say("ns a point       place and trace: one  batch");
    for name in ["ac-trunnion", "head-head", "nutating-head"] {
        let machine = job::machine(name, &[])?;
        let solver = machine.solver(100.0).map_err(|lack| format!("{name}: {lack:?}"))?;
        let format = Format { words: vec![3; machine.axes.len()], ..Format::default() };
        let mut words = AxisWords::new(&machine, &format);
        words.set_zero(&solver).ok_or("no zero")?;
        let printed: Vec<Joints> = poses
            .iter()
            .filter_map(|pose| {
                let branches = solver.orient(pose, 1e-3).ok()?;
                let set = solver.angles(&branches, 0);
                let mut joints = set.joints;
                let mut values = WordValues::default();
                words.print_rotary(&mut joints, &mut values);
                Some(joints)
            })
            .collect();
        let mut traces: Vec<Trace> = printed
            .iter()
            .map(|joints| Trace {
                joints: *joints,
                turns: solver.chain().turns(joints),
                ..Trace::default()
            })
            .collect();
        let settled = nanoseconds(|| {
            for (trace, pose) in traces.iter_mut().zip(&poses) {
                let turns = trace.turns;
                black_box(solver.place(pose.tip, &mut trace.joints, &turns).is_ok());
                solver.chain().trace(trace);
            }
        });
        let tips: Vec<Vector3<f64>> = poses.iter().map(|pose| pose.tip).collect();
        let (mut at, mut forward) = (AxisBatch::default(), Traces::default());
        let mut lanes = [[0.0; LANES]; 3];
        let together = nanoseconds(|| {
            for tips in tips.chunks(LANES) {
                for (coordinate, lanes) in lanes.iter_mut().enumerate() {
                    for (lane, tip) in lanes.iter_mut().zip(tips) {
                        *lane = tip[coordinate];
                    }
                }
                black_box(solver.place_all(&lanes, tips.len(), &mut at));
                solver.chain().trace_all(&at, tips.len(), &mut forward);
                black_box(&forward);
            }
        });
        say(&format!("{name:<16} {settled:>20.1} {together:>6.1}"));
    }
    Ok(())
}

/// Of a point, median of a few runs.
fn nanoseconds(mut run: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..RUNS)
        .map(|_| {
            let start = Instant::now();
            run();
            start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[RUNS / 2] * 1e9 / POINTS as f64
}

fn say(line: &str) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
