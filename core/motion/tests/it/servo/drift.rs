//! Ten million set-points: nothing creeps.

use nalgebra::DVector;
use post_machine::servo::{Feedback, Servo, StateSpace};
use post_motion::servo::Follower;

use super::{
    direct_loops, feedrate_paper, gear_loops, of_loops, screw_loops, transfer, with_friction,
};

const COUNT: u64 = 10_000_000;

/// The velocity that the equations give at a set-point: of the position's row over the states.
fn velocity(space: &StateSpace, follower: &Follower, command: f64, rate: f64) -> f64 {
    let states = DVector::from_column_slice(&follower.states()[..space.order()]);
    let change = &space.a * states + &space.value * command + &space.rate * rate;
    (&space.position * change)[0]
}

/// To and fro at `speed`, turning each `half` set-points; at each turn position and velocity against `lag` behind, exactly.
fn to_and_fro(servo: &Servo, speed: f64, half: u64, lag: f64) -> (f64, f64) {
    let period = 1e-3;
    let space = StateSpace::of(servo);
    let mut follower = Follower::new(servo, period).unwrap();
    let length = half as f64 * period * speed;
    follower.settle(0.0);
    let mut worst = (0.0_f64, 0.0_f64);
    for turn in 0..COUNT / half {
        let up = turn % 2 == 0;
        let mut found = 0.0;
        follower.run(
            half as usize,
            |k| {
                let way = (k + 1) as f64 / half as f64 * length;
                if up { way } else { length - way }
            },
            |_, value| found = value,
        );
        let (end, rate) = if up { (length, speed) } else { (0.0, -speed) };
        worst.0 = worst.0.max((found - (end - lag * rate)).abs());
        let velocity = velocity(&space, &follower, end, rate);
        worst.1 = worst.1.max((velocity - rate).abs());
    }
    worst
}

/// A screw with all loops, 200 mm to and fro: at each turn it is v/Kv behind and as fast as commanded, since what swings
/// has died away to e^(-36) by then.
#[test]
fn loops_do_not_creep() {
    let servo = of_loops(screw_loops(Feedback::Scale, [0.0, 0.0]));
    let (position, velocity) = to_and_fro(&servo, 200.0, 1000, 1.0 / 50.0);
    assert!(position < 1e-10 && velocity < 1e-8, "{position} {velocity}");
}

/// The PID servo of the feedrate paper, whose slowest pole is at -6.1 1/s: turned each 8 s.
#[test]
fn the_feedrate_papers_servo_does_not_creep() {
    // Den - num of its transfer function is J s³ + B s²: it is not behind a ramp at all.
    let (position, velocity) = to_and_fro(&feedrate_paper(), 20.0, 8000, 0.0);
    assert!(position < 1e-10 && velocity < 1e-8, "{position} {velocity}");
}

/// A table that turns on and on: after ten million set-points it is 2.4 million degrees on and still v/Kv behind.
#[test]
fn an_endless_axis_does_not_creep() {
    let servo = of_loops(direct_loops([0.5, 0.0]));
    let space = StateSpace::of(&servo);
    let mut follower = Follower::new(&servo, 1e-3).unwrap();
    let speed = 4.2;
    let mut found = 0.0;
    let at = |k: u64| speed * k as f64 / 1000.0;
    for thousand in 0..COUNT / 1000 {
        let first = thousand * 1000 + 1;
        follower.run(1000, |k| at(first + k as u64), |_, value| found = value);
        if thousand < 3 {
            continue;
        }
        let commanded = at(first + 999);
        let behind = commanded - found;
        // Some tens of the last place of the command itself.
        let allowed = 1e-12 + commanded * 2e-14;
        assert!((behind - 0.5 * speed / 50.0).abs() < allowed, "{thousand}: {behind}");
        let velocity = velocity(&space, &follower, commanded, speed);
        assert!((velocity - speed).abs() < 1e3 * allowed, "{thousand}: {velocity}");
    }
}

/// How far an axis stays behind a ramp of 1 mm/s or rad/s while `force` holds its table back, by the equations of its
/// steady motion alone: `w = p·t + q` with `a·p = -value` and `a·q = p - rate - push·force`.
fn lag(space: &StateSpace, force: f64) -> f64 {
    let solve = |right: DVector<f64>| space.a.clone().full_piv_lu().solve(&right).unwrap();
    let steady = solve(-&space.value);
    let states = solve(steady - &space.rate - &space.push * force);
    -(&space.position * states)[0]
}

/// A transfer function of second order, 2ζ/ω behind a ramp.
#[test]
fn a_transfer_function_does_not_creep() {
    let servo = transfer(&[1600.0], &[1.0, 60.0, 1600.0]);
    let (position, velocity) = to_and_fro(&servo, 200.0, 1250, 60.0 / 1600.0);
    assert!(position < 1e-10 && velocity < 1e-8, "{position} {velocity}");
}

/// A worm gear, measured on the motor and on the table, its torque without delay and its damping held by no integral part.
#[test]
fn a_gear_does_not_creep() {
    for feedback in [Feedback::Motor, Feedback::Scale] {
        let servo = of_loops(gear_loops(feedback, [0.0, 0.0]));
        let lag = lag(&StateSpace::of(&servo), 0.0);
        assert!(lag > 1.0 / 35.0);
        let (position, velocity) = to_and_fro(&servo, 1.5, 2500, lag);
        assert!(position < 1e-12 && velocity < 1e-10, "{position} {velocity}");
    }
}

/// Play behind the loops: the table is half of it short of where it is without, on either side.
#[test]
fn play_behind_the_loops_does_not_creep() {
    let mut servo = transfer(&[1600.0], &[1.0, 60.0, 1600.0]);
    let (speed, play) = (200.0, 0.02);
    servo.backlash = play;
    assert!(!servo.play_inside());
    let behind = 60.0 / 1600.0 + 0.5 * play / speed;
    let (position, velocity) = to_and_fro(&servo, speed, 1250, behind);
    assert!(position < 1e-10 && velocity < 1e-8, "{position} {velocity}");
}

/// To and fro at `speed` and a period of 0.1 ms, the table held back by `force` at that speed; the worst distance at the
/// turns from `lag` behind.
fn stepped_to_and_fro(servo: &Servo, speed: f64, lag: f64) -> f64 {
    let (period, half) = (1e-4, 10_000);
    let mut follower = Follower::new(servo, period).unwrap();
    follower.settle(0.0);
    let length = f64::from(half) * period * speed;
    let mut worst = 0.0_f64;
    for turn in 0..COUNT / half as u64 {
        let up = turn % 2 == 0;
        let mut last = [0.0; 2];
        follower.run(
            half as usize,
            |k| {
                let way = (k + 1) as f64 / f64::from(half) * length;
                if up { way } else { length - way }
            },
            |_, value| last = [last[1], value],
        );
        let (end, rate) = if up { (length, speed) } else { (0.0, -speed) };
        worst = worst.max((last[1] - (end - lag * rate)).abs());
        // Its velocity, over the last period.
        worst = worst.max((last[1] - last[0] - rate * period).abs());
    }
    worst
}

/// Friction that is all there at this speed: as a constant force the equations take it exactly.
#[test]
fn an_axis_with_friction_does_not_creep() {
    let plain = of_loops(gear_loops(Feedback::Scale, [0.0, 0.0]));
    let (coulomb, speed) = (40.0, 1.5);
    let behind = lag(&StateSpace::of(&plain), coulomb / speed);
    assert!(behind > 1.0001 * lag(&StateSpace::of(&plain), 0.0));
    let worst = stepped_to_and_fro(&with_friction(plain, coulomb, 1e-3), speed, behind);
    assert!(worst < 1e-12, "{worst}");
}

/// Play inside the loops, whose integral part takes it out: v/Kv behind.
#[test]
fn play_inside_the_loops_does_not_creep() {
    let mut servo = of_loops(screw_loops(Feedback::Scale, [0.0, 0.0]));
    servo.backlash = 0.01;
    assert!(servo.play_inside());
    let worst = stepped_to_and_fro(&servo, 200.0, 1.0 / 50.0);
    assert!(worst < 1e-10, "{worst}");
}
