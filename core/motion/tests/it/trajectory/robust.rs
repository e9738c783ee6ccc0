//! Programs of no sense: everything is carried out, nothing jumps.

use std::ops::Range;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::Joints;
use post_motion::path::{Curve, Interpolation, on_arc};
use post_motion::{CornerMode, MovePace, Task, WaitReason};
use post_testkit::{Rng, randomised};

use super::build::{Program, run, trunnion};

/// A limit, or none.
fn limit(rng: &mut Rng, name: &str, from: f64, to: f64) -> String {
    match rng.pick(3) {
        0 => String::new(),
        _ => format!("{name} = {:?},", rng.order(from, to)),
    }
}

fn step(rng: &mut Rng, program: &mut Program, count: usize) {
    let here = program.here;
    let size = [0.0, 1e-9, 1e-3, 0.1, 10.0, 200.0][rng.pick(6)];
    let tip = here.pose.tip + rng.point(1.0) * size;
    let mut joints: Joints = here.joints;
    for value in &mut joints[..2] {
        *value += [0.0, rng.range(-0.3, 0.3) * size.min(1.0)][rng.pick(2)];
    }
    // The pole, where vectors say nothing of C, is another matter.
    joints[1] = joints[1].clamp(0.3, 1.2);
    let pace = match rng.pick(5) {
        0 => MovePace::Rapid,
        1 => MovePace::Minutes(0.0),
        _ => MovePace::Minutes(rng.order(-8.0, -3.0)),
    };
    let corner = match rng.pick(4) {
        0 => CornerMode::Stop,
        1 => CornerMode::Path,
        2 => CornerMode::Blend { tolerance: None },
        _ => CornerMode::Blend { tolerance: Some(rng.order(-4.0, 1.0)) },
    };
    let way = match rng.pick(6) {
        0 => Interpolation::Axes,
        1 => Interpolation::TipAndAxis,
        2 => {
            let centre = here.pose.tip + Vector3::new(rng.range(1.0, 20.0), 0.0, 0.0);
            let normal = Vector3::z();
            let sweep = rng.range(-7.0, 7.0);
            let arm = here.pose.tip - centre;
            let turned = nalgebra::Rotation3::new(normal * sweep) * arm;
            let end = centre + turned;
            assert!((on_arc([here.pose.tip, end], centre, normal, sweep, 1.0) - end).norm() < 1e-9);
            let to = program.stance([end.x, end.y, end.z], &joints);
            let way = Interpolation::Tip(Curve::Arc { centre, normal, sweep });
            return program.go(way, to, pace, corner);
        }
        _ => Interpolation::Tip(Curve::Straight),
    };
    let to = program.stance([tip.x, tip.y, tip.z], &joints);
    program.go(way, to, pace, corner);
    if rng.pick(10) == 0 || count == 0 {
        program.tasks.push(Task::Wait {
            line: 0,
            seconds: [0.0, 1e-7, 0.02][rng.pick(3)],
            why: WaitReason::Dwell,
        });
    }
}

#[test]
fn whatever_is_asked_for_nothing_jumps_and_all_of_it_is_done() {
    let (rounds, rng) = randomised(60u16, 41);
    carried_out(rounds, rng);
}

/// In the ninth a task is over before the middle of the time in which the one before overlaps it: it takes no time, not less.
#[test]
fn a_task_that_is_over_within_an_overlap_takes_no_time() {
    let numbers = 640_415_199_u64.wrapping_mul(0xD1B5_4A32_D192_ED03);
    carried_out(0..9, Rng::new(numbers.wrapping_add(41)));
}

fn carried_out(rounds: Range<u16>, mut rng: Rng) {
    for round in rounds {
        let mut axis = || {
            let speed = format!("max_feed = {:?},", 60.0 * rng.order(1.0, 3.0));
            let others = [
                limit(&mut rng, "max_accel", -1.0, 5.0),
                limit(&mut rng, "max_jerk", -1.0, 7.0),
                limit(&mut rng, "max_jump", -3.0, 4.0),
            ];
            format!("{speed} {}", others.concat())
        };
        let [linear, rotary] = [axis(), axis()];
        let motion = format!(
            "period = 0.002\nblend = {:?}\nlimits = {:?}\nlook_ahead = {}\nblock_time = {:?}\n{}\n{}\n{}",
            ["overlap", "round"][rng.pick(2)],
            ["axes", "programmed"][rng.pick(2)],
            [1, 2, 5, 40][rng.pick(4)],
            [0.0, 0.004][rng.pick(2)],
            limit(&mut rng, "tip_accel", -1.0, 4.0).trim_end_matches(','),
            limit(&mut rng, "tip_jerk", -1.0, 6.0).trim_end_matches(','),
            limit(&mut rng, "tip_jump", -3.0, 4.0).trim_end_matches(','),
        );
        let machine = trunnion(&linear, &rotary, &motion);
        let mut program = Program::new(&machine, [100.0, 0.0, 0.0]);
        let mut joints = Joints::default();
        joints[1] = 0.6;
        program.here = program.stance([100.0, 0.0, 0.0], &joints);
        if rng.pick(3) == 0 {
            program.tasks.push(Task::Wait { line: 0, seconds: 0.01, why: WaitReason::Spindle });
        }
        for count in 0..30 {
            step(&mut rng, &mut program, count);
            if rng.pick(15) == 0 {
                // Another tool of the same chain.
                program.solver = Arc::new(program.solver.as_ref().clone());
            }
        }
        let [run, one] =
            [1000, 1].map(|chunk| run(&machine, &program.tasks, &program.solver, chunk));
        assert_eq!(run.times, one.times);
        assert!(run.points.joints == one.points.joints, "{round}");
        assert_eq!(run.times.len(), program.tasks.len(), "{round}\n{motion}");
        let mut time = 0.0;
        for (place, task) in run.times.iter().enumerate() {
            assert_eq!(task.task, place as u64);
            assert!(libm::fabs(task.begins - time) < 1e-9, "{round} {task:?} {time}");
            let sane = task.seconds >= -1e-12 && task.seconds.is_finite();
            assert!(sane, "{round} {task:?}\n{motion}");
            time = task.begins + task.seconds;
        }
        let programmed =
            machine.motion.limits == post_machine::description::LimitsActOn::Programmed;
        for (place, pair) in run.points.joints.windows(2).enumerate() {
            for (axis, (from, to)) in pair[0].iter().zip(&pair[1]).enumerate() {
                assert!(to.is_finite(), "{round} {place}");
                let Some(limits) = machine.axes.get(axis) else {
                    continue;
                };
                if programmed && !limits.joint.rotary {
                    continue;
                }
                let most = limits.max_feed / 60.0;
                let speed = libm::fabs(to - from) / 0.002;
                assert!(
                    speed <= most * 1.01 + 1e-6,
                    "{round} at {place}, axis {axis}: {speed}, limit {most}\n{motion}\n{:?}",
                    run.points.at[place]
                );
            }
        }
        let last = run.points.joints.last().expect("some");
        for (own, due) in last.iter().zip(&program.here.joints) {
            assert!(libm::fabs(own - due) < 1e-6, "{round}: {last:?} {:?}", program.here.joints);
        }
    }
}
