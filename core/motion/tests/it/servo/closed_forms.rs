//! Steps and ramps whose answers are known in closed form.

use libm::{cos, exp, sin, sqrt};
use post_machine::servo::{Drive, Feedback, Loops, ServoModel};
use post_motion::servo::Follower;

use super::{all_loops, apart, followed, of_loops, screw_loops, servo, transfer};

/// From 0 at a speed of 40 mm/s, standing again from 0.25 s on.
fn ramp_and_stand(period: f64) -> Vec<f64> {
    let count = (0.5 / period).round() as usize;
    (0..=count).map(|k| (40.0 * period * k as f64).min(10.0)).collect()
}

/// That of a servo whose answer to a ramp of 1 mm/s is `ramp`.
fn expected(period: f64, count: usize, ramp: impl Fn(f64) -> f64) -> Vec<f64> {
    let begun = |time: f64| if time > 0.0 { ramp(time) } else { 0.0 };
    (0..count)
        .map(|k| {
            let time = k as f64 * period;
            40.0 * (begun(time) - begun(time - 0.25))
        })
        .collect()
}

/// `1 - G` over s², inverted, is how far a second-order servo is behind a ramp of 1.
fn second_order(frequency: f64, damping: f64) -> impl Fn(f64) -> f64 {
    move |time| {
        let fade = exp(-damping * frequency * time);
        let free = frequency * sqrt(1.0 - damping * damping);
        let (sine, cosine) = (sin(free * time), cos(free * time));
        let lag = 2.0 * damping / frequency;
        time - lag + fade * (lag * cosine + (2.0 * damping * damping - 1.0) / free * sine)
    }
}

#[test]
fn a_first_order_servo_answers_as_its_closed_form() {
    for period in [0.015625, 0.001953125] {
        let command = ramp_and_stand(period);
        let servo = transfer(&[50.0], &[1.0, 50.0]);
        let ramp = |time: f64| time - (1.0 - exp(-50.0 * time)) / 50.0;
        let found = followed(&servo, period, &command);
        let expected = expected(period, command.len(), ramp);
        assert!(apart(&found, &expected) < 1e-13, "{period}");
        // It is behind, so the test tells a servo from none.
        assert!(apart(&found, &command) > 0.7);
    }
}

#[test]
fn a_second_order_servo_answers_as_its_closed_form() {
    for (frequency, damping) in [(300.0, 0.05), (60.0, 0.7), (2000.0, 0.3)] {
        let squared = frequency * frequency;
        let servo = transfer(&[squared], &[1.0, 2.0 * damping * frequency, squared]);
        for period in [0.015625, 0.001953125] {
            let command = ramp_and_stand(period);
            let found = followed(&servo, period, &command);
            let expected = expected(period, command.len(), second_order(frequency, damping));
            assert!(apart(&found, &expected) < 1e-12, "{frequency} {period}");
        }
    }
}

/// A rigid direct drive without damping and integral part is of second order: `ω² = Kv·G/m`, `2ζω = G/m`.
#[test]
fn rigid_loops_reduce_to_second_order() {
    let (kv, gain, mass) = (60.0, 1500.0, 8.0);
    let loops = Loops {
        feedback: Feedback::Motor,
        kv,
        velocity_feed_forward: 0.0,
        acceleration_feed_forward: 0.0,
        velocity_gain: gain,
        velocity_time: None,
        current: None,
        motor_inertia: 5.0,
        motor_damping: 0.0,
        drive: Drive::Direct { load: 3.0, load_damping: 0.0 },
    };
    let servo = servo(false, ServoModel::Loops(Box::new(loops)));
    let frequency = sqrt(kv * gain / mass);
    let damping = gain / mass / (2.0 * frequency);
    assert!(damping < 1.0);
    let period = 0.001953125;
    let command = ramp_and_stand(period);
    let found = followed(&servo, period, &command);
    let expected = expected(period, command.len(), second_order(frequency, damping));
    assert!(apart(&found, &expected) < 1e-12);
}

/// With an integral part in the velocity loop the position loop is of type 1: it is v/Kv behind a ramp, and with the full
/// velocity fed forward not at all. Play and elastic parts change nothing of that where the table is measured.
#[test]
fn behind_a_ramp_by_v_over_kv() {
    for loops in all_loops() {
        if loops.velocity_time.is_none() {
            continue;
        }
        let ahead = loops.velocity_feed_forward;
        let (kv, feedback) = (loops.kv, loops.feedback);
        let mechanics = loops.drive.mechanics();
        let servo = of_loops(loops);
        let (speed, period) = (servo.unit() * 70.0, 0.001);
        let command: Vec<f64> = (0..2500).map(|k| speed * period * f64::from(k)).collect();
        let found = followed(&servo, period, &command);
        let mut behind = (1.0 - ahead) * speed / kv;
        if let (Feedback::Motor, Some(stiffness)) = (feedback, mechanics.stiffness) {
            // The table's damping stretches the transmission, which the motor does not see.
            behind += mechanics.damping * speed / stiffness;
        }
        let last = command.len() - 1;
        let error = command[last] - found[last];
        assert!((error - behind).abs() < 1e-11, "{error} {behind}");
    }
}

/// The same command, sampled four times as often where it is straight in between, leads to the same states.
#[test]
fn the_period_changes_nothing() {
    let mut command = vec![120.0];
    let mut seed = 1_u64;
    for k in 0..400 {
        // Any numbers will do: a linear congruence, with a rest now and then.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let step = (seed >> 40) as f64 / (1 << 24) as f64 - 0.5;
        command.push(command[k] + if k % 50 < 10 { 0.0 } else { step });
    }
    let mut servos: Vec<_> = all_loops().into_iter().map(of_loops).collect();
    servos.push(super::feedrate_paper());
    servos.push(transfer(&[3.0, 200.0], &[1e-4, 0.5, 20.0, 200.0]));
    servos.push(transfer(&[0.4, 50.0], &[1.0, 50.0]));
    for servo in servos {
        let mut coarse = Follower::new(&servo, 1e-3).unwrap();
        let mut fine = Follower::new(&servo, 0.25e-3).unwrap();
        coarse.settle(command[0]);
        fine.settle(command[0]);
        let mut last = command[0];
        for value in &command {
            let one = coarse.next(*value);
            let mut other = 0.0;
            for quarter in 1..=4 {
                other = fine.next(last + (value - last) * f64::from(quarter) / 4.0);
            }
            last = *value;
            assert!((one - other).abs() < 1e-12 * 120.0, "{one} {other}");
            for (one, other) in coarse.states().iter().zip(fine.states()) {
                let size = coarse.states().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                assert!((one - other).abs() < 1e-12 * size, "{one} {other} {size}");
            }
        }
    }
}

/// With the velocity and the acceleration fed forward, less is left of an error than without.
#[test]
fn acceleration_feed_forward_helps() {
    let period = 1e-3;
    // A way of 100 mm in 0.4 s with a continuous acceleration.
    let command: Vec<f64> = (0..=600)
        .map(|k| {
            let share = (f64::from(k) * period / 0.4).min(1.0);
            100.0 * share * share * share * (10.0 - 15.0 * share + 6.0 * share * share)
        })
        .collect();
    let error = |feed_forward| {
        let servo = of_loops(screw_loops(Feedback::Scale, feed_forward));
        apart(&followed(&servo, period, &command), &command)
    };
    let (none, velocity, both) = (error([0.0, 0.0]), error([1.0, 0.0]), error([1.0, 1.0]));
    assert!(
        none > 5.0 && velocity < 0.1 * none && both < 0.5 * velocity,
        "{none} {velocity} {both}"
    );
}
