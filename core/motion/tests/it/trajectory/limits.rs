//! No limit is passed, whatever comes.

use post_machine::description::Machine;
use post_motion::path::{Curve, Interpolation};
use post_motion::{CornerMode, MovePace, SetPoints, Task, WaitReason};
use post_testkit::{Rng, randomised};

use super::build::{Program, run, trunnion};
use super::jumps;

/// Limits drawn for linear and rotary axes, mm and degrees.
struct Drawn {
    /// Velocity, acceleration, jerk a second of linear axes, and of rotary ones.
    limits: [[f64; 3]; 2],
}

impl Drawn {
    fn new(rng: &mut Rng, jerk: bool) -> Self {
        let mut axis = |size: f64| {
            let velocity = size * rng.range(50.0, 500.0);
            let acceleration = size * rng.order(2.0, 4.0);
            let jerk = match jerk {
                true => acceleration * rng.range(10.0, 200.0),
                false => f64::INFINITY,
            };
            [velocity, acceleration, jerk]
        };
        Self { limits: [axis(1.0), axis(0.5)] }
    }

    fn machine(&self, motion: &str, faster: f64) -> Machine {
        let [linear, rotary] = self.limits.map(|[velocity, acceleration, jerk]| {
            let [velocity, acceleration, jerk] =
                [velocity * 60.0, acceleration, jerk].map(|value| value * faster);
            match jerk.is_finite() {
                true => format!(
                    "max_feed = {velocity:?}, max_accel = {acceleration:?}, max_jerk = {jerk:?}"
                ),
                false => format!("max_feed = {velocity:?}, max_accel = {acceleration:?}"),
            }
        });
        trunnion(&linear, &rotary, motion)
    }
}

/// Moves of all sizes, each with the corner that `corner` draws.
fn moves(
    rng: &mut Rng,
    machine: &Machine,
    count: usize,
    way: &Interpolation,
    mut corner: impl FnMut(&mut Rng) -> CornerMode,
) -> Program {
    let mut program = Program::new(machine, [10.0, 20.0, 30.0]);
    for _ in 0..count {
        let size = rng.order(-2.0, 1.5);
        let step = rng.point(size);
        let tip = program.here.pose.tip + step;
        let mut joints = program.here.joints;
        for (place, axis) in machine.axes.iter().enumerate() {
            if axis.joint.rotary && rng.pick(4) > 0 {
                joints[place] += (size * rng.range(-2.0, 2.0)).to_radians();
            }
        }
        let to = program.stance([tip.x, tip.y, tip.z], &joints);
        let pace = match rng.pick(6) {
            0 => MovePace::Rapid,
            _ => MovePace::Minutes(step.norm() / rng.order(2.0, 4.5)),
        };
        let corner = corner(rng);
        program.go(way.clone(), to, pace, corner);
        if rng.pick(8) == 0 {
            program.tasks.push(Task::Wait { line: 0, seconds: 0.0123, why: WaitReason::Dwell });
        }
    }
    program
}

/// The most that velocity, acceleration and jerk of the axes amount to, by finite differences, against their limits:
/// largest ratio of each.
fn ratios(points: &SetPoints, machine: &Machine) -> [f64; 3] {
    let mut most = [0.0f64; 3];
    let h = points.period;
    for (place, axis) in machine.axes.iter().enumerate() {
        let value = |point: usize| points.joints[point][place];
        for at in 3..points.len() {
            let [p0, p1, p2, p3] = [3, 2, 1, 0].map(|back| value(at - back));
            let found = [
                libm::fabs(p3 - p2) / h / (axis.max_feed / 60.0),
                libm::fabs(p3 - 2.0 * p2 + p1) / (h * h) / axis.max_accel,
                libm::fabs(p3 - 3.0 * p2 + 3.0 * p1 - p0) / (h * h * h) / axis.max_jerk,
            ];
            for (most, found) in most.iter_mut().zip(found) {
                *most = most.max(found);
            }
        }
    }
    most
}

/// A tenth of a percent: what the bounds along ways of the tip leave out, and rounding.
const SLACK: f64 = 1.001;

#[test]
fn moves_with_a_standstill_behind_each_keep_all_limits() {
    let (rounds, mut rng) = randomised(40u16, 21);
    for round in rounds {
        let drawn = Drawn::new(&mut rng, round % 2 == 0);
        let machine = drawn.machine("period = 0.0005", 1.0);
        let way = [Interpolation::Axes, Interpolation::Tip(Curve::Straight)][rng.pick(2)].clone();
        let program = moves(&mut rng, &machine, 30, &way, |_| CornerMode::Stop);
        let run = run(&machine, &program.tasks, &program.solver, 100);
        let ratios = ratios(&run.points, &machine);
        assert!(ratios.iter().all(|ratio| *ratio < SLACK), "{round} {way:?}: {ratios:?}");
        for time in &run.times {
            assert!(time.seconds >= time.asked * (1.0 - 1e-9), "{time:?}");
        }
    }
}

#[test]
fn a_path_that_is_kept_keeps_all_limits_but_for_its_jumps() {
    let (rounds, mut rng) = randomised(40u16, 22);
    for round in rounds {
        let drawn = Drawn::new(&mut rng, false);
        let machine = drawn.machine("period = 0.001", 1.0);
        let program = moves(&mut rng, &machine, 60, &Interpolation::Axes, |rng| {
            [CornerMode::Path, CornerMode::Stop][usize::from(rng.pick(5) == 0)]
        });
        let run = run(&machine, &program.tasks, &program.solver, 100);
        let own = jumps::ratios(&run.points, &machine);
        assert!(own.iter().all(|ratio| *ratio <= 1.0 + 1e-6), "{round}: {own:?}");
    }
}

#[test]
fn overlapping_and_rounded_moves_keep_velocities_and_accelerations() {
    let (rounds, mut rng) = randomised(60u16, 23);
    for round in rounds {
        let drawn = Drawn::new(&mut rng, false);
        let blend = ["overlap", "round"][usize::from(round % 2)];
        let machine = drawn.machine(&format!("period = 0.0005\nblend = \"{blend}\""), 1.0);
        let tolerance = [None, Some(0.01), Some(0.5)][rng.pick(3)];
        let program = moves(&mut rng, &machine, 60, &Interpolation::Axes, |_| CornerMode::Blend {
            tolerance,
        });
        let run = run(&machine, &program.tasks, &program.solver, 100);
        let [velocity, acceleration, _, jump] = jumps::ratios(&run.points, &machine);
        // Where a move that must end as it is programmed is overlapped, LinuxCNC's own motion passes limits so too. Without a
        // tolerance the next move is speeded up as hard as it may be, and may go at full feed before the one that it
        // overlaps has slowed down by much: an axis has the velocities of both.
        let most = match (blend, tolerance) {
            ("overlap", None) => [2.0, 1.5 * SLACK],
            ("overlap", Some(_)) => [1.05, 1.5 * SLACK],
            _ => [1.0 + 1e-6; 2],
        };
        assert!(jump <= 1.0 + 1e-9, "{round} {blend}: {jump}");
        assert!(velocity < most[0], "{round} {blend}: {velocity}");
        assert!(acceleration < most[1], "{round} {blend} {tolerance:?}: {acceleration}");
    }
}

#[test]
fn larger_limits_are_never_slower() {
    let (rounds, mut rng) = randomised(30u16, 24);
    for round in rounds {
        let drawn = Drawn::new(&mut rng, false);
        let motion = ["blend = \"overlap\"", "blend = \"round\""][usize::from(round % 2)];
        let machine = drawn.machine(motion, 1.0);
        let program = moves(&mut rng, &machine, 60, &Interpolation::Axes, |rng| {
            [CornerMode::Path, CornerMode::Stop, CornerMode::Blend { tolerance: None }][rng.pick(3)]
        });
        let mut last = f64::INFINITY;
        for faster in [1.0, 1.1, 1.7, 3.0] {
            let machine = drawn.machine(motion, faster);
            let run = run(&machine, &program.tasks, &program.solver, 1000);
            let seconds: f64 = run.times.iter().map(|time| time.seconds).sum();
            assert!(seconds <= last * (1.0 + 1e-9), "{round}: {seconds} s, not {last} s");
            last = seconds;
        }
    }
}

#[test]
fn it_does_not_matter_how_many_set_points_are_asked_for_at_once() {
    let (rounds, mut rng) = randomised(12u16, 25);
    for round in rounds {
        let drawn = Drawn::new(&mut rng, round % 2 == 0);
        let machine = drawn.machine("look_ahead = 7", 1.0);
        let way = [Interpolation::Axes, Interpolation::Tip(Curve::Straight)][rng.pick(2)].clone();
        let program = moves(&mut rng, &machine, 40, &way, |rng| {
            [CornerMode::Path, CornerMode::Stop, CornerMode::Blend { tolerance: None }][rng.pick(3)]
        });
        let [one, many] =
            [1, 1000].map(|chunk| run(&machine, &program.tasks, &program.solver, chunk));
        assert!(one.points.joints == many.points.joints, "{round}");
        assert!(one.points.at == many.points.at && one.times == many.times, "{round}");
        assert_eq!(one.times.len(), program.tasks.len());
        // Tasks follow one another without a gap, and the last set-point stands at the end.
        let mut time = 0.0;
        for (place, task) in one.times.iter().enumerate() {
            assert_eq!(task.task, place as u64);
            assert!(libm::fabs(task.begins - time) < 1e-9);
            time = task.begins + task.seconds;
        }
        let last = one.points.joints.last().expect("some");
        assert!(libm::fabs(last[2] - program.here.joints[2]) < 1e-9);
        assert!(libm::fabs(time - (one.points.len() - 1) as f64 * 0.001) <= 0.001);
    }
}
