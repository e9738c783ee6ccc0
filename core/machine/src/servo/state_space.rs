//! The linear equations of a servo.

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{DMatrix, DVector, RowDVector};

use super::{Feedback, Loops, Mechanics, Pid, Servo, ServoModel, Transfer};

/// A servo as a system of linear differential equations: `r` is the commanded position in axis units (mm or radians), `f`
/// the friction against the motion of the table (N or N·m):
///
/// ```text
/// w' = a·w + value·r + rate·r' + jump·r'' + push·f
/// ```
///
/// The states are scaled by powers of two, so that the matrix is as even as its equations allow.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpace {
    /// The equations' matrix, 1/s.
    pub a: DMatrix<f64>,
    /// How the commanded position enters.
    pub value: DVector<f64>,
    /// How its velocity enters.
    pub rate: DVector<f64>,
    /// How its acceleration enters: a kink of `r` by `v` is a jump of the states by `jump·v`.
    pub jump: DVector<f64>,
    /// How friction on the table enters; zero where the table is no part of the model.
    pub push: DVector<f64>,
    /// Row that gives the position of the table, in axis units; [`StateSpace::through`]·r is added to it.
    pub position: RowDVector<f64>,
    /// Row that gives the position that the position loop measures, in axis units, likewise.
    pub measured: RowDVector<f64>,
    /// Row that gives the velocity of the table, m/s or rad/s; zero where the table is no part of the model.
    pub velocity: RowDVector<f64>,
    /// What of `r` is in the position at once.
    pub through: f64,
    /// The same without the force of the transmission; none where that is rigid or no part of the model.
    pub released: Option<Released>,
}

/// A servo whose transmission hands no force on, since its flanks do not touch.
#[derive(Clone, Debug, PartialEq)]
pub struct Released {
    /// [`StateSpace::a`] without stiffness and damping of the transmission.
    pub a: DMatrix<f64>,
    /// How a force from the motor on the table enters, N or N·m.
    pub force: DVector<f64>,
    /// Row that gives how far the transmission is stretched, motor minus table, m or radians.
    pub stretch: RowDVector<f64>,
    /// Stiffness of the transmission, N/m or N·m/rad.
    pub stiffness: f64,
    /// Damping beside it, N·s/m or N·m·s/rad.
    pub damping: f64,
}

/// Squares of larger numbers, added up, may not be finite.
const LARGEST: f64 = 1e150;

/// A quantity as a linear function of the states, and of `r`, `r'` and `r''`.
#[derive(Clone, Debug)]
struct Signal {
    states: RowDVector<f64>,
    command: [f64; 3],
}

impl Signal {
    fn zero(order: usize) -> Self {
        Self { states: RowDVector::zeros(order), command: [0.0; 3] }
    }

    fn state(order: usize, place: usize) -> Self {
        let mut signal = Self::zero(order);
        signal.states[place] = 1.0;
        signal
    }

    /// The derivative of `r` so many times.
    fn command(order: usize, times: usize) -> Self {
        let mut signal = Self::zero(order);
        signal.command[times] = 1.0;
        signal
    }

    fn plus(mut self, factor: f64, other: &Self) -> Self {
        self.states += &other.states * factor;
        for (own, other) in self.command.iter_mut().zip(other.command) {
            *own += factor * other;
        }
        self
    }

    fn times(&self, factor: f64) -> Self {
        Self::zero(self.states.len()).plus(factor, self)
    }
}

impl StateSpace {
    /// The equations of a servo.
    pub fn of(servo: &Servo) -> Self {
        let mut space = match &servo.model {
            ServoModel::Loops(loops) => of_loops(loops, servo.length()),
            ServoModel::Transfer(transfer) => of_transfer(transfer),
            ServoModel::Pid(pid) => of_transfer(&pid.transfer()),
        };
        space.balance();
        space
    }

    /// Number of states.
    pub fn order(&self) -> usize {
        self.a.nrows()
    }

    /// The states at rest, where the commanded position is 1; none where a pole lies at zero.
    pub fn rest(&self) -> Option<DVector<f64>> {
        let decomposed = self.a.clone().full_piv_lu();
        decomposed.is_invertible().then(|| decomposed.solve(&-&self.value)).flatten()
    }

    /// Position of the table over the commanded position once everything has come to rest; none where a pole lies at zero.
    pub fn static_gain(&self) -> Option<f64> {
        Some((&self.position * self.rest()?)[0] + self.through)
    }

    /// Rows and columns of the matrix become as equal in size as powers of two make them. What has no finite size, or a
    /// square that has none, stays: balancing it would not end.
    fn balance(&mut self) {
        if !self.a.iter().all(|part| libm::fabs(*part) < LARGEST) {
            return;
        }
        let mut balanced = self.a.clone();
        let scale = balance_parlett_reinsch(&mut balanced);
        self.a = balanced;
        for column in [&mut self.value, &mut self.rate, &mut self.jump, &mut self.push] {
            column.component_div_assign(&scale);
        }
        let row_scale = scale.transpose();
        for row in [&mut self.position, &mut self.measured, &mut self.velocity] {
            row.component_mul_assign(&row_scale);
        }
        if let Some(released) = &mut self.released {
            let order = scale.len();
            released.a = DMatrix::from_fn(order, order, |row, column| {
                released.a[(row, column)] * scale[column] / scale[row]
            });
            released.force.component_div_assign(&scale);
            released.stretch.component_mul_assign(&row_scale);
        }
    }
}

/// Places of the states of [`Loops`].
struct StateIndices {
    order: usize,
    /// Position and velocity of the motor, seen at the axis.
    motor: usize,
    /// States of the table; of a rigid drive those of the motor.
    table: usize,
    velocity_integral: Option<usize>,
    current: Option<usize>,
    current_integral: Option<usize>,
}

impl StateIndices {
    fn of(loops: &Loops, mechanics: &Mechanics) -> Self {
        let mut order = 2;
        let mut next = |wanted: bool, count: usize| {
            let place = order;
            order += if wanted { count } else { 0 };
            wanted.then_some(place)
        };
        let table = next(mechanics.stiffness.is_some(), 2).unwrap_or(0);
        let velocity_integral = next(loops.velocity_time.is_some(), 1);
        let current = next(loops.current.is_some(), 1);
        let integral = loops.current.is_some_and(|current| current.time.is_some());
        let current_integral = next(integral, 1);
        Self { order, motor: 0, table, velocity_integral, current, current_integral }
    }
}

/// Everything on the motor's shaft is seen at the axis: a torque T is the force T/ρ there, an inertia J the mass J/ρ².
/// `length` is one unit of the axis in m or radians.
fn of_loops(loops: &Loops, length: f64) -> StateSpace {
    let mechanics = loops.drive.mechanics();
    let places = StateIndices::of(loops, &mechanics);
    let order = places.order;
    let travel = mechanics.travel;
    let state = |place: usize| Signal::state(order, place);
    let command = |times: usize| Signal::command(order, times).times(length);
    let motor_mass = loops.motor_inertia / (travel * travel);
    let motor_damping = (loops.motor_damping + mechanics.shaft_damping) / (travel * travel);
    let velocity_gain = loops.velocity_gain / (travel * travel);
    let [motor, motor_velocity] = [state(places.motor), state(places.motor + 1)];
    let [table, table_velocity] = [state(places.table), state(places.table + 1)];
    let measured = match loops.feedback {
        Feedback::Scale => &table,
        Feedback::Motor => &motor,
    };

    let mut rows: Vec<(usize, Signal)> = Vec::new();
    let velocity_error = command(0)
        .plus(-1.0, measured)
        .times(loops.kv)
        .plus(loops.velocity_feed_forward, &command(1))
        .plus(-1.0, &motor_velocity);
    let mut wanted = velocity_error
        .times(velocity_gain)
        .plus(loops.acceleration_feed_forward * (motor_mass + mechanics.mass), &command(2));
    if let (Some(place), Some(time)) = (places.velocity_integral, loops.velocity_time) {
        wanted = wanted.plus(velocity_gain / time, &state(place));
        rows.push((place, velocity_error));
    }
    let force = match (&loops.current, places.current) {
        (Some(current), Some(place)) => {
            let newtons_per_ampere = current.torque_constant / travel;
            let error = wanted.times(1.0 / newtons_per_ampere).plus(-1.0, &state(place));
            let mut voltage = error
                .times(current.gain)
                .plus(-current.resistance, &state(place))
                .plus(-current.back_emf / travel, &motor_velocity);
            if let (Some(integral), Some(time)) = (places.current_integral, current.time) {
                voltage = voltage.plus(current.gain / time, &state(integral));
                rows.push((integral, error));
            }
            rows.push((place, voltage.times(1e3 / current.inductance)));
            state(place).times(newtons_per_ampere)
        }
        _ => wanted,
    };

    let shaft = force.plus(-motor_damping, &motor_velocity);
    rows.push((places.motor, motor_velocity.clone()));
    let stretch = motor.clone().plus(-1.0, &table);
    let mut push = DVector::zeros(order);
    let mut inner = DVector::zeros(order);
    if let Some(stiffness) = mechanics.stiffness {
        let spring = stretch
            .times(stiffness)
            .plus(mechanics.stiffness_damping, &motor_velocity)
            .plus(-mechanics.stiffness_damping, &table_velocity);
        let mass = mechanics.mass;
        rows.push((places.motor + 1, shaft.plus(-1.0, &spring).times(1.0 / motor_mass)));
        rows.push((places.table, table_velocity.clone()));
        let driven = spring.plus(-mechanics.damping, &table_velocity);
        rows.push((places.table + 1, driven.times(1.0 / mass)));
        push[places.table + 1] = -1.0 / mass;
        inner[places.motor + 1] = -1.0 / motor_mass;
        inner[places.table + 1] = 1.0 / mass;
    } else {
        let mass = motor_mass + mechanics.mass;
        let driven = shaft.plus(-mechanics.damping, &motor_velocity);
        rows.push((places.motor + 1, driven.times(1.0 / mass)));
        push[places.motor + 1] = -1.0 / mass;
    }

    let mut a = DMatrix::zeros(order, order);
    let mut inputs = [0, 1, 2].map(|_| DVector::zeros(order));
    for (place, signal) in rows {
        a.row_mut(place).copy_from(&signal.states);
        for (input, factor) in inputs.iter_mut().zip(signal.command) {
            input[place] = factor;
        }
    }
    let released = mechanics.stiffness.map(|stiffness| {
        let handed = stretch.states.clone() * stiffness
            + (&motor_velocity.states - &table_velocity.states) * mechanics.stiffness_damping;
        Released {
            a: &a - &inner * handed,
            force: inner,
            stretch: stretch.states,
            stiffness,
            damping: mechanics.stiffness_damping,
        }
    });
    let [value, rate, jump] = inputs;
    let axis_units = 1.0 / length;
    StateSpace {
        a,
        value,
        rate,
        jump,
        push,
        position: &table.states * axis_units,
        measured: &measured.states * axis_units,
        velocity: table_velocity.states,
        through: 0.0,
        released,
    }
}

/// The companion form in a time that makes the outer coefficients of the denominator equal in size.
fn of_transfer(transfer: &Transfer) -> StateSpace {
    let leading = |coefficients: &[f64]| {
        let zeros = coefficients.iter().take_while(|part| **part == 0.0).count();
        coefficients[zeros..].to_vec()
    };
    let denominator = leading(&transfer.denominator);
    let numerator = leading(&transfer.numerator);
    let order = denominator.len() - 1;
    let first = denominator[0];
    // Coefficient of s^power of the monic polynomial.
    let of = |coefficients: &[f64], power: usize| {
        let place = coefficients.len().checked_sub(power + 1);
        place.map_or(0.0, |place| coefficients[place] / first)
    };
    let size = libm::fabs(of(&denominator, 0));
    let rate = if size > 0.0 { libm::pow(size, 1.0 / order as f64) } else { 1.0 };
    let scaled = |coefficients: &[f64], power: usize| {
        of(coefficients, power) * libm::pow(rate, power as f64 - order as f64)
    };
    let through = of(&numerator, order);
    let mut a = DMatrix::zeros(order, order);
    let mut value = DVector::zeros(order);
    let mut position = RowDVector::zeros(order);
    for power in 0..order {
        if power + 1 < order {
            a[(power, power + 1)] = rate;
        }
        a[(order - 1, power)] -= rate * scaled(&denominator, power);
        position[power] = scaled(&numerator, power) - through * scaled(&denominator, power);
    }
    value[order - 1] = rate;
    let zero = DVector::zeros(order);
    StateSpace {
        a,
        value,
        rate: zero.clone(),
        jump: zero.clone(),
        push: zero.clone(),
        measured: position.clone(),
        position,
        velocity: zero.transpose(),
        through,
        released: None,
    }
}

impl Pid {
    /// The transfer function, eq. 2 of the feedrate paper (whose Table 2 calls the inertia A3 where A4 is meant).
    pub fn transfer(&self) -> Transfer {
        let gain = self.gain;
        let mut numerator = vec![gain * self.kd, gain * self.kp];
        let mut denominator = vec![self.inertia, self.damping + gain * self.kd, gain * self.kp];
        // Without integral part both have s as a factor.
        if self.ki > 0.0 {
            numerator.push(gain * self.ki);
            denominator.push(gain * self.ki);
        }
        Transfer { numerator, denominator }
    }
}
