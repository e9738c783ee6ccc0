//! The differential equations of the prediction paper, integrated step by step (Runge, Kutta), friction and play included.

use post_machine::servo::{Feedback, Friction, Loops, ServoModel};
use post_motion::servo::Follower;

use super::{Servo, all_loops, apart, of_loops, screw_loops, with_friction};

/// Motor angle and speed, table position and velocity, integral of the speed error, current, integral of its error.
type State = [f64; 7];

/// What is commanded at an instant: position, velocity and acceleration, m or radians.
type Command = [f64; 3];

/// Eq. 8 as it stands, in angles and torques of the motor; nothing is eliminated. A rigid transmission is one state less:
/// the table's are those of the motor.
fn derivative(
    loops: &Loops,
    friction: Friction,
    play: f64,
    state: &State,
    command: Command,
) -> State {
    let drive = loops.drive.mechanics();
    let travel = drive.travel;
    let [angle, speed, x, v, integral, current, current_integral] = *state;
    let (x, v) = match drive.stiffness {
        Some(_) => (x, v),
        None => (angle * travel, speed * travel),
    };
    let measured = match loops.feedback {
        Feedback::Scale => x,
        Feedback::Motor => angle * travel,
    };
    let wanted =
        (loops.kv * (command[0] - measured) + loops.velocity_feed_forward * command[1]) / travel;
    let error = wanted - speed;
    let inertia = loops.motor_inertia + drive.mass * travel * travel;
    let torque = loops.velocity_gain
        * (error + loops.velocity_time.map_or(0.0, |time| integral / time))
        + loops.acceleration_feed_forward * inertia * command[2] / travel;
    let (motor_torque, current_rate, current_error) = match loops.current {
        None => (torque, 0.0, 0.0),
        Some(winding) => {
            let error = torque / winding.torque_constant - current;
            let voltage =
                winding.gain * (error + winding.time.map_or(0.0, |time| current_integral / time));
            let rate = (voltage - winding.resistance * current - winding.back_emf * speed)
                / (winding.inductance * 1e-3);
            (winding.torque_constant * current, rate, error)
        }
    };
    let dry = friction.coulomb * (v / friction.width).clamp(-1.0, 1.0);
    let loss = (loops.motor_damping + drive.shaft_damping) * speed;
    match drive.stiffness {
        Some(stiffness) => {
            let stretch = angle * travel - x;
            let force = if stretch.abs() < play / 2.0 {
                0.0
            } else {
                stiffness * (stretch - (play / 2.0).copysign(stretch))
                    + drive.stiffness_damping * (speed * travel - v)
            };
            [
                speed,
                (motor_torque - loss - travel * force) / loops.motor_inertia,
                v,
                (force - drive.damping * v - dry) / drive.mass,
                error,
                current_rate,
                current_error,
            ]
        }
        None => {
            let load = travel * (drive.damping * v + dry);
            let rate = (motor_torque - loss - load) / inertia;
            [speed, rate, v, travel * rate, error, current_rate, current_error]
        }
    }
}

/// The table's position at the end of each period, m or radians, from rest at the first command.
fn integrated(
    servo: &Servo,
    period: f64,
    steps: usize,
    count: usize,
    command: impl Fn(usize, f64) -> Command,
) -> Vec<f64> {
    let ServoModel::Loops(loops) = &servo.model else { panic!("loops") };
    let friction = servo.friction.unwrap_or(Friction { coulomb: 0.0, width: 1.0 });
    let metres = if servo.rotary { 1.0 } else { 1e-3 };
    let friction = Friction { width: friction.width * metres * servo.unit(), ..friction };
    let play = servo.backlash * servo.unit() * metres;
    let travel = loops.drive.mechanics().travel;
    let start = command(0, 0.0)[0];
    let mut state = [start / travel, 0.0, start, 0.0, 0.0, 0.0, 0.0];
    let moved = |state: &State, rate: &State, by: f64| -> State {
        std::array::from_fn(|place| state[place] + by * rate[place])
    };
    let mut found = vec![start];
    let step = period / steps as f64;
    for k in 0..count {
        for part in 0..steps {
            let at = |share: f64| command(k, (part as f64 + share) / steps as f64);
            let rate =
                |state: &State, share: f64| derivative(loops, friction, play, state, at(share));
            let first = rate(&state, 0.0);
            let second = rate(&moved(&state, &first, step / 2.0), 0.5);
            let third = rate(&moved(&state, &second, step / 2.0), 0.5);
            let fourth = rate(&moved(&state, &third, step), 1.0);
            let mean = std::array::from_fn(|place| {
                (first[place] + 2.0 * second[place] + 2.0 * third[place] + fourth[place]) / 6.0
            });
            state = moved(&state, &mean, step);
        }
        let rigid = loops.drive.mechanics().stiffness.is_none();
        found.push(if rigid { state[0] * travel } else { state[2] });
    }
    found
}

/// m or radians of one unit of the axis.
fn metres(servo: &Servo) -> f64 {
    if servo.rotary { 1.0 } else { 1e-3 }
}

/// Set-points in axis units: to and fro with stops, up to 20 units a second.
fn set_points(period: f64, count: usize) -> Vec<f64> {
    let mut command = vec![10.0];
    for k in 0..count {
        let speed = [0.0, 20.0, 20.0, -13.0, 0.0, -20.0, 5.0, 5.0][k / 40 % 8];
        command.push(command[k] + speed * period);
    }
    command
}

/// Straight between set-points, as the discretised model has it: no approximation is left on either side but that of the
/// integration. The acceleration is not fed forward here, since it is none but at the kinks.
#[test]
fn loops_are_the_papers_differential_equations() {
    let period = 2e-3;
    let command = set_points(period, 400);
    for loops in all_loops() {
        if loops.acceleration_feed_forward != 0.0 {
            continue;
        }
        let servo = of_loops(loops);
        let scale = metres(&servo);
        let straight = |k: usize, share: f64| {
            let change = command[k + 1] - command[k];
            [(command[k] + change * share) * scale, change / period * scale, 0.0]
        };
        let expected = integrated(&servo, period, 100, 400, straight);
        let mut follower = Follower::new(&servo, period).unwrap();
        follower.settle(command[0]);
        let found: Vec<f64> = command.iter().map(|value| follower.next(*value) * scale).collect();
        assert!(apart(&found, &expected) < 1e-8 * scale, "{}", apart(&found, &expected));
        assert!(apart(&found, &expected) > 0.0);
    }
}

/// A smooth way of 30 units in 0.3 s: position, velocity and acceleration over time.
fn smooth(time: f64) -> Command {
    let all = 0.3;
    let s = (time / all).min(1.0);
    [
        30.0 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s),
        30.0 * 30.0 * s * s * (1.0 - s) * (1.0 - s) / all,
        30.0 * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (all * all),
    ]
}

/// With the acceleration fed forward, for a smooth command: the pieces between set-points are straight, so what is left
/// falls with the square of the period.
#[test]
fn a_smooth_command_is_met_with_the_square_of_the_period() {
    for loops in all_loops() {
        if loops.acceleration_feed_forward == 0.0 {
            continue;
        }
        let servo = of_loops(loops);
        let scale = metres(&servo);
        let error = |period: f64, count: usize| {
            let command = |k: usize, share: f64| {
                smooth((k as f64 + share) * period).map(|value| value * scale)
            };
            let steps = (period / 2e-5).round() as usize;
            let expected = integrated(&servo, period, steps, count, command);
            let mut follower = Follower::new(&servo, period).unwrap();
            let found: Vec<f64> =
                (0..=count).map(|k| follower.next(smooth(k as f64 * period)[0]) * scale).collect();
            apart(&found, &expected) / scale
        };
        let (coarse, fine) = (error(1e-3, 400), error(0.25e-3, 1600));
        assert!(coarse < 2e-4, "{coarse}");
        assert!(fine < coarse / 12.0 && fine > coarse / 20.0, "{coarse} {fine}");
    }
}

fn sine(time: f64) -> Command {
    let omega = 8.0;
    let (sine, cosine) = (libm::sin(omega * time), libm::cos(omega * time));
    [5.0 * (1.0 - cosine), 5.0 * omega * sine, 5.0 * omega * omega * cosine]
}

/// Set-points on a sine, straight in between, for both; the largest distance, in units of the axis.
fn against_integration(servo: &Servo, steps: usize) -> f64 {
    let (period, count) = (1e-3, 800);
    let scale = metres(servo);
    let at = |k: usize| sine(k as f64 * period)[0];
    let command = |k: usize, share: f64| {
        let change = at(k + 1) - at(k);
        [(at(k) + change * share) * scale, change / period * scale, 0.0]
    };
    let expected = integrated(servo, period, steps, count, command);
    let mut follower = Follower::new(servo, period).unwrap();
    let found: Vec<f64> = (0..=count).map(|k| follower.next(at(k)) * scale).collect();
    apart(&found, &expected) / scale
}

/// Reversals with friction: 300 N below 1 mm/s in proportion to speed.
#[test]
fn friction_is_that_of_the_differential_equations() {
    for feedback in [Feedback::Scale, Feedback::Motor] {
        let bare = of_loops(screw_loops(feedback, [1.0, 0.0]));
        let servo = with_friction(bare.clone(), 300.0, 1.0);
        let error = against_integration(&servo, 200);
        assert!(error < 1e-4, "{error} mm");
        // Friction changes the way by more than ten times that.
        let command: Vec<f64> = (0..800).map(|k| sine(f64::from(k) * 1e-3)[0]).collect();
        let change = apart(
            &super::followed(&bare, 1e-3, &command),
            &super::followed(&servo, 1e-3, &command),
        );
        assert!(change > 10.0 * error, "{change} {error}");
    }
}

/// A dead zone of 20 µm in the transmission.
#[test]
fn play_is_that_of_the_differential_equations() {
    for feedback in [Feedback::Scale, Feedback::Motor] {
        let bare = of_loops(screw_loops(feedback, [1.0, 0.0]));
        let servo = Servo { backlash: 0.02, ..with_friction(bare.clone(), 100.0, 1.0) };
        let error = against_integration(&servo, 400);
        assert!(error < 1e-3, "{error} mm");
        let without = Servo { backlash: 0.0, ..servo.clone() };
        let command: Vec<f64> = (0..800).map(|k| sine(f64::from(k) * 1e-3)[0]).collect();
        let change = apart(
            &super::followed(&without, 1e-3, &command),
            &super::followed(&servo, 1e-3, &command),
        );
        assert!(change > 5.0 * error, "{change} {error}");
    }
}

/// Less force than friction can hold moves nothing, for however long; more does.
#[test]
fn the_table_sticks_until_friction_is_passed() {
    let mut loops = screw_loops(Feedback::Motor, [0.0, 0.0]);
    // Without an integral part the force stays where the error puts it: Kv·G/ρ²·error.
    loops.velocity_time = None;
    loops.current = None;
    let travel = loops.drive.mechanics().travel;
    let newtons = |mm: f64| loops.kv * loops.velocity_gain / (travel * travel) * mm * 1e-3;
    let servo = with_friction(of_loops(loops.clone()), 400.0, 0.0);
    for (mm, moves) in [(0.0, false), (350.0 / newtons(1.0), false), (450.0 / newtons(1.0), true)] {
        let mut follower = Follower::new(&servo, 1e-3).unwrap();
        let mut found = 0.0;
        for _ in 0..3000 {
            found = follower.next(mm);
        }
        if moves {
            // The rest is what friction holds: 400 N.
            let rest = mm - found;
            assert!(found > 1e-3 * mm && rest > 0.0, "{found}");
        } else {
            // Within a step it gives by less than a nanometre.
            assert!(found.abs() < 1e-6, "{mm}: {found}");
        }
    }
}

/// Behind rigid loops the table lags by half the play, either way.
#[test]
fn play_behind_the_loops_is_half_on_either_side() {
    let servo = Servo { backlash: 0.01, ..super::transfer(&[1000.0], &[1.0, 1000.0]) };
    let mut follower = Follower::new(&servo, 1e-3).unwrap();
    let mut last = 0.0;
    for (to, expected) in [(5.0, 4.995), (4.995, 4.995), (0.0, 0.005), (0.004, 0.005)] {
        for _ in 0..200 {
            last = follower.next(to);
        }
        assert!((last - expected).abs() < 1e-12, "{to}: {last}");
    }
}
