//! Servos, against closed forms, complex algebra and integrations that take no line from them.

mod closed_forms;
mod drift;
mod fit;
mod frequency;
mod integration;
mod machine;

use post_machine::servo::{
    Current, Drive, Feedback, Friction, Loops, Pid, Servo, ServoModel, Transfer,
};
use post_motion::servo::Follower;

fn servo(rotary: bool, model: ServoModel) -> Servo {
    Servo { place: None, rotary, model, friction: None, backlash: 0.0 }
}

fn transfer(numerator: &[f64], denominator: &[f64]) -> Servo {
    let transfer = Transfer { numerator: numerator.to_vec(), denominator: denominator.to_vec() };
    servo(false, ServoModel::Transfer(transfer))
}

/// The X axis of the feedrate paper (Chen, Ren, Sun 2016), Table 1.
fn feedrate_paper() -> Servo {
    let pid = Pid {
        kp: 10.0,
        ki: 50.0,
        kd: 0.3,
        gain: 6.5723 * 0.4769 * 1.5915,
        inertia: 7.0028e-3,
        damping: 0.023569,
    };
    servo(false, ServoModel::Pid(pid))
}

/// A linear axis with a lead screw: every part of the model is there.
fn screw_loops(feedback: Feedback, feed_forward: [f64; 2]) -> Loops {
    Loops {
        feedback,
        kv: 50.0,
        velocity_feed_forward: feed_forward[0],
        acceleration_feed_forward: feed_forward[1],
        velocity_gain: 2.5,
        velocity_time: Some(0.02),
        current: Some(Current {
            gain: 20.0,
            time: Some(0.005),
            resistance: 0.6,
            inductance: 5.0,
            torque_constant: 1.2,
            back_emf: 0.8,
        }),
        motor_inertia: 0.008,
        motor_damping: 0.003,
        drive: Drive::Screw {
            lead: 16.0,
            screw_damping: 0.01,
            axial_stiffness: Some(180.0),
            torsional_stiffness: Some(8000.0),
            axial_damping: 8000.0,
            table_mass: 450.0,
            table_damping: 3000.0,
        },
    }
}

/// A rotary axis with a worm, torque without delay.
fn gear_loops(feedback: Feedback, feed_forward: [f64; 2]) -> Loops {
    Loops {
        feedback,
        kv: 35.0,
        velocity_feed_forward: feed_forward[0],
        acceleration_feed_forward: feed_forward[1],
        velocity_gain: 2.5,
        velocity_time: None,
        current: None,
        motor_inertia: 0.006,
        motor_damping: 0.003,
        drive: Drive::Gear {
            ratio: 90.0,
            gear_stiffness: Some(1.5e6),
            gear_damping: 1500.0,
            table_inertia: 12.0,
            table_damping: 20.0,
        },
    }
}

/// A rotary axis on a torque motor.
fn direct_loops(feed_forward: [f64; 2]) -> Loops {
    Loops {
        feedback: Feedback::Scale,
        kv: 50.0,
        velocity_feed_forward: feed_forward[0],
        acceleration_feed_forward: feed_forward[1],
        velocity_gain: 400.0,
        velocity_time: Some(0.02),
        current: Some(Current {
            gain: 25.0,
            time: None,
            resistance: 1.5,
            inductance: 12.0,
            torque_constant: 15.0,
            back_emf: 10.0,
        }),
        motor_inertia: 0.9,
        motor_damping: 0.5,
        drive: Drive::Direct { load: 1.5, load_damping: 1.0 },
    }
}

fn of_loops(loops: Loops) -> Servo {
    let rotary = !matches!(loops.drive, Drive::Screw { .. });
    servo(rotary, ServoModel::Loops(Box::new(loops)))
}

/// All sets of loops, with a feedback and without and with feed-forward.
fn all_loops() -> Vec<Loops> {
    let mut all = Vec::new();
    for feed_forward in [[0.0, 0.0], [1.0, 0.0], [0.95, 0.8], [1.0, 1.0]] {
        for feedback in [Feedback::Scale, Feedback::Motor] {
            all.push(screw_loops(feedback, feed_forward));
            all.push(gear_loops(feedback, feed_forward));
        }
        all.push(direct_loops(feed_forward));
    }
    all
}

fn with_friction(mut servo: Servo, coulomb: f64, width: f64) -> Servo {
    servo.friction = Some(Friction { coulomb, width });
    servo
}

/// Where the axis is at each set-point of `command`, which begins at rest where it first stands.
fn followed(servo: &Servo, period: f64, command: &[f64]) -> Vec<f64> {
    let mut follower = Follower::new(servo, period).unwrap();
    follower.settle(command[0]);
    command.iter().map(|value| follower.next(*value)).collect()
}

/// The largest distance of two courses.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one.iter().zip(other);
    pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}
