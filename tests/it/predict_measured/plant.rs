//! The servos of the machine file as differential equations, solved by Runge and Kutta's fourth order in steps of a tenth of
//! a millisecond: no line of it is shared with the state spaces and matrix exponentials of the code under test.

use std::f64::consts::TAU;

use super::course::Course;

/// Step, s.
const STEP: f64 = 1e-4;

/// Before the program and behind it the axes stand, s.
pub const REST: f64 = 0.5;

/// What is the machine's, and not the file's.
#[derive(Clone, Copy)]
pub struct Truth {
    pub kv: f64,
    pub feed_forward: f64,
    pub table_mass: f64,
    /// Coulomb friction of X's table, N; below 1 mm/s it grows in proportion to speed.
    pub friction: f64,
}

/// As the machine file has it.
pub const AS_FILED: Truth = Truth { kv: 40.0, feed_forward: 0.5, table_mass: 300.0, friction: 0.0 };

/// States of a servo; not all need so many.
type State = [f64; 5];

/// The axes, from [`REST`] before the program on, every [`STEP`].
pub struct Run {
    pub commanded: Vec<[f64; 4]>,
    pub actual: Vec<[f64; 4]>,
}

impl Run {
    pub fn of(course: &Course, truth: Truth) -> Self {
        let count = ((course.seconds + 2.0 * REST) / STEP) as usize;
        let time = |place: f64| place * STEP - REST;
        let first = course.at(time(0.0));
        let mut states: [State; 4] = std::array::from_fn(|axis| rest(axis, first[axis]));
        let mut run =
            Self { commanded: Vec::with_capacity(count), actual: Vec::with_capacity(count) };
        for place in 0..count {
            let at = |share: f64| course.at(time(place as f64 + share));
            let three = [at(0.0), at(0.5), at(1.0)];
            run.commanded.push(three[0]);
            run.actual.push(std::array::from_fn(|axis| position(axis, &states[axis])));
            for (axis, state) in states.iter_mut().enumerate() {
                step(axis, &truth, state, three.map(|row| row[axis]));
            }
        }
        run
    }

    /// Both at a time of the program, straight between the steps.
    pub fn at(&self, time: f64) -> [[f64; 4]; 2] {
        let place = ((time + REST) / STEP).clamp(0.0, (self.actual.len() - 2) as f64);
        let from = place as usize;
        let share = place - from as f64;
        [&self.commanded, &self.actual].map(|rows| {
            std::array::from_fn(|axis| {
                rows[from][axis] * (1.0 - share) + rows[from + 1][axis] * share
            })
        })
    }
}

fn step(axis: usize, truth: &Truth, state: &mut State, [first, middle, last]: [f64; 3]) {
    // Velocities of the parabola through the three commands.
    let rates = [
        (4.0 * middle - 3.0 * first - last) / STEP,
        (last - first) / STEP,
        (3.0 * last - 4.0 * middle + first) / STEP,
    ];
    let moved = |by: &State, share: f64| -> State {
        std::array::from_fn(|part| state[part] + share * STEP * by[part])
    };
    let one = slope(axis, truth, state, first, rates[0]);
    let two = slope(axis, truth, &moved(&one, 0.5), middle, rates[1]);
    let three = slope(axis, truth, &moved(&two, 0.5), middle, rates[1]);
    let four = slope(axis, truth, &moved(&three, 1.0), last, rates[2]);
    *state = std::array::from_fn(|part| {
        state[part] + STEP / 6.0 * (one[part] + 2.0 * (two[part] + three[part]) + four[part])
    });
}

const SCREW: f64 = 0.010 / TAU;

/// The derivatives of the states at a commanded position and velocity.
fn slope(axis: usize, truth: &Truth, state: &State, command: f64, rate: f64) -> State {
    match axis {
        // X: position and velocity loop, a screw between motor and table; SI.
        0 => {
            let [angle, speed, table, velocity, integral] = *state;
            let wanted = truth.kv * (command * 1e-3 - table) + truth.feed_forward * rate * 1e-3;
            let error = wanted / SCREW - speed;
            let torque = 2.0 * (error + integral / 0.02);
            let force = 150e6 * (SCREW * angle - table) + 6000.0 * (SCREW * speed - velocity);
            let rubs = truth.friction * (velocity / 1e-3).clamp(-1.0, 1.0);
            [
                speed,
                (torque - SCREW * force) / 0.006,
                velocity,
                (force - 2000.0 * velocity - rubs) / truth.table_mass,
                error,
            ]
        }
        // Y: a PID controller over an inertia; mm.
        1 => {
            let [place, speed, integral, ..] = *state;
            let error = command - place;
            let drive = 30.0 * error + 120.0 * integral + 0.9 * (rate - speed);
            let acceleration = (1.6 * drive - 0.02 * speed) / 0.007;
            [speed, acceleration, error, 0.0, 0.0]
        }
        // Z: a swing; mm.
        2 => {
            let [place, speed, ..] = *state;
            [speed, 900.0 * (command - place) - 42.0 * speed, 0.0, 0.0, 0.0]
        }
        // C: position and velocity loop of a torque motor; radians.
        _ => {
            let [angle, speed, integral, ..] = *state;
            let error = 30.0 * (command.to_radians() - angle) - speed;
            let torque = 300.0 * (error + integral / 0.03);
            [speed, (torque - speed) / (0.9 + 1.5), error, 0.0, 0.0]
        }
    }
}

fn rest(axis: usize, command: f64) -> State {
    match axis {
        0 => [command * 1e-3 / SCREW, 0.0, command * 1e-3, 0.0, 0.0],
        3 => [command.to_radians(), 0.0, 0.0, 0.0, 0.0],
        _ => [command, 0.0, 0.0, 0.0, 0.0],
    }
}

fn position(axis: usize, state: &State) -> f64 {
    match axis {
        0 => state[2] * 1e3,
        3 => state[0].to_degrees(),
        _ => state[0],
    }
}
