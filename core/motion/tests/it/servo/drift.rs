//! Ten million set-points: nothing creeps.

use nalgebra::DVector;
use post_machine::servo::{Feedback, Servo, StateSpace};
use post_motion::servo::Follower;

use super::{direct_loops, feedrate_paper, of_loops, screw_loops};

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
        assert!(
            (behind - 0.5 * speed / 50.0).abs() < allowed,
            "{thousand}: {behind}"
        );
        let velocity = velocity(&space, &follower, commanded, speed);
        assert!(
            (velocity - speed).abs() < 1e3 * allowed,
            "{thousand}: {velocity}"
        );
    }
}
