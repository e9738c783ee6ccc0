//! Where moves meet: jumps of the velocity within their limit, everything else within its own.

use post_machine::description::Machine;
use post_motion::limits::AxisLimits;
use post_motion::path::Interpolation;
use post_motion::{CornerMode, MovePace, SetPoints, Task};
use post_testkit::{Rng, randomised};

use super::build::{Program, run, trunnion};

/// Limits of linear axes and of rotary ones, anything from tiny to huge.
fn machine(rng: &mut Rng, jerk: bool, motion: &str) -> Machine {
    let jump = [None, Some(rng.order(-2.0, 3.0))][rng.pick(2)];
    let mut axis = |size: f64| {
        let [feed, acceleration] = [rng.order(2.0, 4.6), rng.order(0.0, 5.0)];
        let mut keys =
            format!("max_feed = {:?}, max_accel = {:?}", size * feed, size * acceleration);
        if jerk {
            let jerk = size * acceleration * rng.order(-1.0, 3.0);
            keys += &format!(", max_jerk = {jerk:?}");
        }
        if let Some(jump) = jump {
            keys += &format!(", max_jump = {:?}", size * jump);
        }
        keys
    };
    let (linear, rotary) = (axis(1.0), axis(0.5));
    trunnion(&linear, &rotary, motion)
}

/// A path of kinks of all sizes, none among them.
fn kinked(
    rng: &mut Rng,
    machine: &Machine,
    count: usize,
    mut corner: impl FnMut(&mut Rng) -> CornerMode,
) -> Program {
    let mut program = Program::new(machine, [10.0, 20.0, 30.0]);
    let turning = machine.axes.iter().enumerate();
    let turning: Vec<usize> =
        turning.filter(|(_, axis)| axis.joint.rotary).map(|(place, _)| place).collect();
    let mut way = [rng.point(1.0), rng.point(0.02)];
    for _ in 0..count {
        let kink = [0.0, rng.order(-6.0, 0.0), 1.0][rng.pick(3)];
        way[0] = (way[0] + rng.point(1.0) * kink).normalize();
        way[1] += rng.point(0.02) * kink;
        let size = rng.order(-2.0, 1.0);
        let tip = program.here.pose.tip + way[0] * size;
        let mut joints = program.here.joints;
        for (place, turn) in turning.iter().zip(way[1].iter()) {
            joints[*place] += turn * size;
        }
        let to = program.stance([tip.x, tip.y, tip.z], &joints);
        let pace = match rng.pick(8) {
            0 => MovePace::Rapid,
            _ => MovePace::Minutes(size / rng.order(2.5, 4.5)),
        };
        let corner = corner(rng);
        program.go(Interpolation::Axes, to, pace, corner);
    }
    program
}

/// Velocity, acceleration and jerk of the axes by differences, what the jumps make of them left out, and the jumps: largest
/// ratio of each to its limit.
pub fn ratios(points: &SetPoints, machine: &Machine) -> [f64; 4] {
    let limits = AxisLimits::new(machine);
    let mut most = [0.0f64; 4];
    let h = points.period;
    // What rounding of the positions makes of a difference.
    let rounding = 4e-13;
    for place in 0..machine.axes.len() {
        for jump in &points.jumps {
            most[3] = most[3].max(libm::fabs(jump.change[place]) / limits.jump[place]);
        }
        // The way from one set-point on that comes of the jumps in three periods alone.
        let mut jumps = points.jumps.as_slice();
        for at in 1..points.len() {
            let raw = |back: usize| points.joints[at - back][place];
            let velocity = (libm::fabs(raw(0) - raw(1)) - rounding) / h;
            most[0] = most[0].max(velocity / limits.velocity[place]);
            if at < 3 {
                continue;
            }
            let first = points.time(at - 3);
            jumps = &jumps[jumps.partition_point(|jump| jump.time <= first)..];
            // Less what the velocities' jumps make of it, and the accelerations' too.
            let value = |back: usize, bends: f64| {
                let time = points.time(at - back);
                let since = jumps.iter().take_while(|jump| jump.time <= time);
                let way = since.map(|jump| {
                    let t = time - jump.time;
                    (jump.change[place] + 0.5 * bends * jump.bend[place] * t) * t
                });
                raw(back) - way.sum::<f64>()
            };
            let [p1, p2, p3] = [2, 1, 0].map(|back| value(back, 0.0));
            let acceleration = libm::fabs(p3 - 2.0 * p2 + p1) - 2.0 * rounding;
            most[1] = most[1].max(acceleration / (h * h) / limits.acceleration[place]);
            let [p0, p1, p2, p3] = [3, 2, 1, 0].map(|back| value(back, 1.0));
            let jerk = libm::fabs(p3 - 3.0 * p2 + 3.0 * p1 - p0) - 4.0 * rounding;
            most[2] = most[2].max(jerk / (h * h * h) / limits.jerk[place]);
        }
    }
    most
}

fn seconds(machine: &Machine, program: &Program) -> f64 {
    let run = run(machine, &program.tasks, &program.solver, 1000);
    run.times.iter().map(|time| time.seconds).sum()
}

fn blend(rng: &mut Rng) -> CornerMode {
    CornerMode::Blend { tolerance: [None, Some(rng.order(-4.0, 0.0))][rng.pick(2)] }
}

fn any_corner(rng: &mut Rng) -> CornerMode {
    match rng.pick(5) {
        0 => CornerMode::Stop,
        1 | 2 => CornerMode::Path,
        _ => blend(rng),
    }
}

#[test]
fn outside_of_jumps_every_limit_holds_and_no_jump_passes_its_own() {
    let (rounds, mut rng) = randomised(120u16, 51);
    for round in rounds {
        let machine = machine(&mut rng, round % 2 == 0, "period = 0.001");
        let program = kinked(&mut rng, &machine, 40, any_corner);
        let run = run(&machine, &program.tasks, &program.solver, 1000);
        let ratios = ratios(&run.points, &machine);
        let jumps = run.points.jumps.len();
        assert!(
            jumps > 0 && ratios.iter().all(|ratio| *ratio <= 1.0 + 1e-6),
            "{round}, {jumps} jumps: {ratios:?}"
        );
    }
}

#[test]
fn a_corner_is_rounded_and_not_jumped_at_where_that_costs_no_time() {
    let (rounds, mut rng) = randomised(60u16, 53);
    let machine = trunnion(
        "max_feed = 30000, max_accel = 4000, max_jerk = 50000",
        "max_feed = 9000, max_accel = 600, max_jerk = 20000",
        "",
    );
    for round in rounds {
        // Ways of 5 to 30 mm that turn by up to a degree: slow enough for a curve within the tolerance at full feed.
        let mut program = Program::new(&machine, [0.0; 3]);
        let mut way = rng.point(1.0).normalize();
        let corner = CornerMode::Blend { tolerance: Some(0.1) };
        for _ in 0..20 {
            way = (way + rng.point(0.01)).normalize();
            let tip = program.here.pose.tip + way * rng.range(5.0, 30.0);
            let to = program.stance([tip.x, tip.y, tip.z], &program.here.joints);
            let length = (tip - program.here.pose.tip).norm();
            program.go(Interpolation::Axes, to, MovePace::Minutes(length / 1000.0), corner);
        }
        let run = run(&machine, &program.tasks, &program.solver, 1000);
        assert!(run.points.jumps.is_empty(), "{round}");
        let ratios = ratios(&run.points, &machine);
        assert!(ratios.iter().all(|ratio| *ratio <= 1.0 + 1e-6), "{round}: {ratios:?}");
        // Nothing but the two ends costs time.
        let beyond = |time: &post_motion::trajectory::TaskTime| time.seconds - time.asked;
        for time in &run.times[1..19] {
            assert!(beyond(time) < 1e-6, "{round}: {time:?}");
        }
    }
}

/// How much longer the same moves take with each of three corners, from stop to blend, than with the one before.
fn slower(rng: &mut Rng, jerk: bool) -> [f64; 2] {
    let machine = machine(rng, jerk, "period = 0.001");
    let mut program = kinked(rng, &machine, 40, |_| CornerMode::Stop);
    let times = [CornerMode::Stop, CornerMode::Path, blend(rng)].map(|corner| {
        for task in &mut program.tasks {
            if let Task::Move(task) = task {
                task.corner = corner;
            }
        }
        seconds(&machine, &program)
    });
    [times[1] / times[0], times[2] / times[1]].map(|ratio| ratio - 1.0)
}

#[test]
fn to_keep_the_path_is_never_slower_than_to_stop_and_to_leave_it_no_slower_than_that() {
    let (rounds, mut rng) = randomised(60u16, 52);
    let mut worst = [[f64::NEG_INFINITY; 2]; 2];
    for round in rounds {
        let jerk = round % 2 == 0;
        let own = slower(&mut rng, jerk);
        for (worst, own) in worst[usize::from(jerk)].iter_mut().zip(own) {
            *worst = worst.max(own);
        }
    }
    println!("without jerk limits {:?}, with {:?}", worst[0], worst[1]);
    let [[path, blend], [jerky_path, jerky_blend]] = worst;
    assert!(path <= 1e-9, "{path}");
    // A curve leaves less of the accelerations along the way than a kink does, and a ramp may go over it. A quarter goes lost
    // at most: with three quarters of them everywhere a way takes √(4/3) times as long.
    assert!(blend <= 0.155, "{blend}");
    // With jerk limits a ramp over several blocks has the least acceleration and jerk of them all: nothing is proven. Of
    // 9,000 such programs none is slower by keeping the path; by leaving it one in a thousand is by a twelfth.
    assert!(jerky_path <= 1e-3, "{jerky_path}");
    assert!(jerky_blend <= 0.15, "{jerky_blend}");
}

/// Between corners that hardly any speed is left at, the way is not crept along at theirs.
#[test]
fn short_ways_between_slow_corners_are_no_slower_than_from_stop_to_stop() {
    let linear = "max_feed = 6000, max_accel = 1000, max_jerk = 10000, max_jump = 0.01";
    let machine = trunnion(linear, "max_feed = 7200, max_accel = 600", "");
    let mut program = Program::new(&machine, [0.0; 3]);
    for step in 0..20 {
        // Two moves straight on, then one corner.
        let way = [[0.5, 0.0], [0.0, 0.5]][step / 2 % 2];
        let tip = program.here.pose.tip;
        let to = program.stance([tip.x + way[0], tip.y + way[1], tip.z], &program.here.joints);
        program.go(Interpolation::Axes, to, MovePace::Minutes(1e-4), CornerMode::Stop);
    }
    let [stop, path] = [CornerMode::Stop, CornerMode::Path].map(|corner| {
        for task in &mut program.tasks {
            if let Task::Move(task) = task {
                task.corner = corner;
            }
        }
        seconds(&machine, &program)
    });
    assert!(path < stop, "{path} s, from stop to stop {stop} s");
}
