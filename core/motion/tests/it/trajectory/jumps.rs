//! Where moves meet: jumps of the velocity within their limit, everything else within its own.

use post_machine::description::Machine;
use post_motion::limits::AxisLimits;
use post_motion::path::Way;
use post_motion::{Corner, Pace, SetPoints};
use post_testkit::{Rng, randomised};

use super::build::{Program, run, trunnion};

/// Limits of linear axes and of rotary ones, anything from tiny to huge.
fn machine(rng: &mut Rng, jerk: bool, motion: &str) -> Machine {
    let jump = [None, Some(rng.order(-2.0, 3.0))][rng.pick(2)];
    let mut axis = |size: f64| {
        let [feed, acceleration] = [rng.order(2.0, 4.6), rng.order(0.0, 5.0)];
        let mut keys = format!(
            "max_feed = {:?}, max_accel = {:?}",
            size * feed,
            size * acceleration
        );
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
    mut corner: impl FnMut(&mut Rng) -> Corner,
) -> Program {
    let mut program = Program::new(machine, [10.0, 20.0, 30.0]);
    let turning = machine.axes.iter().enumerate();
    let turning: Vec<usize> = turning
        .filter(|(_, axis)| axis.joint.rotary)
        .map(|(place, _)| place)
        .collect();
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
            0 => Pace::Rapid,
            _ => Pace::Minutes(size / rng.order(2.5, 4.5)),
        };
        let corner = corner(rng);
        program.go(Way::Axes, to, pace, corner);
    }
    program
}

/// Velocity, acceleration and jerk of the axes by differences, what the jumps make of them left out, and the jumps: largest
/// ratio of each to its limit.
fn ratios(points: &SetPoints, machine: &Machine) -> [f64; 4] {
    let limits = AxisLimits::new(machine);
    let mut most = [0.0f64; 4];
    let h = points.period;
    // What rounding of the positions makes of a difference.
    let rounding = 2e-13;
    for place in 0..machine.axes.len() {
        let mut value: Vec<f64> = points.joints.iter().map(|joints| joints[place]).collect();
        let [mut velocity, mut jumped, mut next] = [0.0; 3];
        let mut jumps = points.jumps.iter().peekable();
        for (point, value) in value.iter_mut().enumerate() {
            let time = points.time(point);
            // Way that comes of the jumps alone.
            jumped += next;
            next = velocity * h;
            while let Some(jump) = jumps.next_if(|jump| jump.time <= time) {
                let change = jump.change[place];
                jumped += change * (time - jump.time);
                velocity += change;
                next += change * h;
                most[3] = most[3].max(libm::fabs(change) / limits.jump[place]);
            }
            if point > 0 {
                *value -= jumped;
            }
        }
        let raw = |point: usize| points.joints[point][place];
        for at in 3..points.len() {
            let [p0, p1, p2, p3] = [3, 2, 1, 0].map(|back| value[at - back]);
            let found = [
                (libm::fabs(raw(at) - raw(at - 1)) - rounding) / h / limits.velocity[place],
                (libm::fabs(p3 - 2.0 * p2 + p1) - 2.0 * rounding) / (h * h)
                    / limits.acceleration[place],
                (libm::fabs(p3 - 3.0 * p2 + 3.0 * p1 - p0) - 4.0 * rounding) / (h * h * h)
                    / limits.jerk[place],
            ];
            for (most, found) in most.iter_mut().zip(found) {
                *most = most.max(found);
            }
        }
    }
    most
}

fn seconds(machine: &Machine, program: &Program) -> f64 {
    let run = run(machine, &program.tasks, &program.solver, 1000);
    run.times.iter().map(|time| time.seconds).sum()
}

fn blend(rng: &mut Rng) -> Corner {
    Corner::Blend {
        tolerance: [None, Some(rng.order(-4.0, 0.0))][rng.pick(2)],
    }
}

fn any_corner(rng: &mut Rng) -> Corner {
    match rng.pick(5) {
        0 => Corner::Stop,
        1 | 2 => Corner::Path,
        _ => blend(rng),
    }
}

#[test]
fn outside_of_jumps_every_limit_holds_and_no_jump_passes_its_own() {
    let (rounds, mut rng) = randomised(120u16, 51);
    for round in rounds {
        let jerk = round % 2 == 0;
        let machine = machine(&mut rng, jerk, "period = 0.001\nblend = \"round\"");
        let program = kinked(&mut rng, &machine, 40, any_corner);
        let run = run(&machine, &program.tasks, &program.solver, 1000);
        let ratios = ratios(&run.points, &machine);
        println!("{round}: {ratios:?}, {} jumps", run.points.jumps.len());
        let most = [1.0 + 1e-6; 4];
        assert!(
            ratios.iter().zip(most).all(|(ratio, most)| *ratio <= most),
            "{round}: {ratios:?}"
        );
    }
}

#[test]
fn to_leave_the_path_is_never_slower_than_to_keep_it_and_that_never_than_to_stop() {
    let (rounds, mut rng) = randomised(60u16, 52);
    for round in rounds {
        let jerk = round % 2 == 0;
        let machine = machine(&mut rng, jerk, "period = 0.001\nblend = \"round\"");
        let program = kinked(&mut rng, &machine, 40, |_| Corner::Stop);
        let mut last = f64::INFINITY;
        let mut all = Vec::new();
        for corner in [Corner::Stop, Corner::Path, blend(&mut rng)] {
            let mut program = Program {
                solver: program.solver.clone(),
                here: program.here,
                tasks: program.tasks.clone(),
            };
            for task in &mut program.tasks {
                if let post_motion::Task::Move(task) = task {
                    task.corner = corner;
                }
            }
            let own = seconds(&machine, &program);
            all.push(own / last.min(1e9));
            last = own;
        }
        println!("{round}: {all:?}");
        assert!(all[1..].iter().all(|ratio| *ratio <= 1.0 + 1e-9), "{round} {all:?}");
    }
}
