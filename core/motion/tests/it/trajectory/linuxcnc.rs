//! A program run by LinuxCNC 2.9, 1 ms a row: an XYZAC trunnion with limits on the programmed coordinates, trapezoidal,
//! G64 without a tolerance.

use std::process::Command;

use post_motion::path::{Curve, Interpolation};
use post_motion::{CornerMode, MovePace, Task, WaitReason};
use post_testkit::shared;

use super::build::{Program, run, trunnion};

/// Columns of the data: joints X Y Z A C, pose x y z a c, the tip's speed.
fn rows() -> Option<Vec<Vec<f64>>> {
    let path = shared("data/motion/linuxcnc_t1_xyzac_1ms.txt.gz")?;
    let unpacked = Command::new("gzip").arg("-dc").arg(path).output();
    let Ok(unpacked) = unpacked else {
        eprintln!("skipped: gzip is missing");
        return None;
    };
    let text = String::from_utf8(unpacked.stdout).expect("text");
    let numbers = |line: &str| -> Vec<f64> {
        line.split_whitespace().map(|field| field.parse().expect("a number")).collect()
    };
    Some(text.lines().map(numbers).collect())
}

/// The data's tool length, which its z contains, mm.
const TOOL: f64 = 50.0;

#[test]
fn overlapping_moves_go_as_those_of_linuxcnc() {
    let Some(rows) = rows() else { return };
    let machine = trunnion(
        "max_feed = 30000, max_accel = 2000",
        "max_feed = 7200, max_accel = 600",
        "limits = \"programmed\"\nblend = \"overlap\"",
    );
    // X Y Z A C of t1.ngc; Z0 of the joints is -50 of the tip.
    let mut program = Program::new(&machine, [0.0, 0.0, -TOOL]);
    let blend = CornerMode::Blend { tolerance: None };
    let place = |name: &str| machine.axes.iter().position(|axis| axis.name == name);
    let (a, c) = (place("A").expect("A"), place("C").expect("C"));
    let go = |program: &mut Program, words: [f64; 5], feed: Option<f64>| {
        let [x, y, z, first, second] = words;
        let mut joints = program.here.joints;
        joints[a] = first.to_radians();
        joints[c] = second.to_radians();
        let to = program.stance([x, y, z], &joints);
        let length = (to.pose.tip - program.here.pose.tip).norm();
        let (pace, corner) = match feed {
            None => (MovePace::Rapid, CornerMode::Stop),
            Some(feed) => (MovePace::Minutes(length / feed), blend),
        };
        program.go(Interpolation::Tip(Curve::Straight), to, pace, corner);
    };
    go(&mut program, [0.0, 0.0, 60.0, 0.0, 0.0], None);
    go(&mut program, [10.0, 20.0, 30.0, 0.0, 0.0], Some(3000.0));
    go(&mut program, [30.0, -10.0, 25.0, -20.0, 40.0], Some(3000.0));
    go(&mut program, [35.0, -15.0, 22.0, -30.0, 55.0], Some(3000.0));
    program.tasks.push(Task::Wait { line: 7, seconds: 0.2, why: WaitReason::Dwell });
    go(&mut program, [0.0, 0.0, 60.0, 0.0, 0.0], Some(3000.0));
    let ours = run(&machine, &program.tasks, &program.solver, 1000);
    let moves = |row: usize| rows[row][5..10] != rows[row - 1][5..10];
    let begins = (1..rows.len()).find(|row| moves(*row)).expect("moves") - 1;
    let ends = (1..rows.len()).rev().find(|row| moves(*row)).expect("moves");
    let cycle = (ends - begins) as f64 * 0.001;
    let own = (ours.points.len() - 1) as f64 * ours.points.period;
    println!("cycle time {own} s, LinuxCNC {cycle} s");
    assert!(libm::fabs(own - cycle) < 0.002 * cycle);
    // LinuxCNC begins every block, and ends the dwell, at a period: up to the dwell, and behind it, the best delay is looked
    // for, and a period's way is allowed besides.
    let dwell = &ours.times[4];
    let [stands, goes] = [dwell.begins, dwell.begins + dwell.seconds].map(|time| time * 1000.0);
    let stance = |place: usize| {
        let (pose, joints) = (&ours.points.poses[place], &ours.points.joints[place]);
        let [a, c] = [a, c].map(|place| joints[place].to_degrees());
        [pose.tip.x, pose.tip.y, pose.tip.z + TOOL, a, c]
    };
    let apart = |one: &[f64], other: &[f64]| {
        let squares = one.iter().zip(other).map(|(one, other)| (one - other) * (one - other));
        squares.sum::<f64>().sqrt()
    };
    for range in [(1.0, stands), (goes, own * 1000.0 - 2.0)] {
        let range = range.0.ceil() as usize..=range.1.floor() as usize;
        let off = |delay: usize| {
            let most = range.clone().map(|place| {
                let row = &rows[begins + place + delay][5..10];
                let way = apart(&stance(place - 1), &stance(place + 1)) / 2.0;
                (apart(&stance(place), row) - way).max(0.0)
            });
            most.fold(0.0, f64::max)
        };
        let best = (0..10)
            .map(|delay| (delay, off(delay)))
            .min_by(|one, other| one.1.total_cmp(&other.1))
            .expect("ten");
        println!("{} mm and degrees off, {} ms later", best.1, best.0);
        assert!(best.1 < 0.001);
    }
}
