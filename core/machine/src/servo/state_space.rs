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

/// Makes the equations of [`Loops`], a row for the derivative of each state.
///
/// Everything on the motor's shaft is seen at the axis: a torque T is the force T/ρ there, an inertia J the mass J/ρ².
struct LoopEquations<'a> {
    loops: &'a Loops,
    mechanics: Mechanics,
    places: StateIndices,
    /// One unit of the axis in m or radians.
    length: f64,
    rows: Vec<(usize, Signal)>,
}

/// How forces enter the states of a servo.
struct ForceColumns {
    /// Friction on the table.
    push: DVector<f64>,
    /// The transmission, between motor and table.
    transmission: DVector<f64>,
}

/// `length` is one unit of the axis in m or radians.
fn of_loops(loops: &Loops, length: f64) -> StateSpace {
    let mechanics = loops.drive.mechanics();
    let places = StateIndices::of(loops, &mechanics);
    let mut equations = LoopEquations { loops, mechanics, places, length, rows: Vec::new() };
    let wanted = equations.velocity_loop();
    let force = equations.current_loop(wanted);
    let forces = equations.motion(&force);
    equations.state_space(forces)
}

impl LoopEquations<'_> {
    fn state(&self, place: usize) -> Signal {
        Signal::state(self.places.order, place)
    }

    /// The derivative of the commanded position so many times, m or radians.
    fn command(&self, times: usize) -> Signal {
        Signal::command(self.places.order, times).times(self.length)
    }

    /// Position and velocity of the motor.
    fn motor(&self) -> [Signal; 2] {
        [self.state(self.places.motor), self.state(self.places.motor + 1)]
    }

    /// Position and velocity of the table.
    fn table(&self) -> [Signal; 2] {
        [self.state(self.places.table), self.state(self.places.table + 1)]
    }

    /// The position that the loop is closed over.
    fn measured(&self) -> Signal {
        match self.loops.feedback {
            Feedback::Scale => self.state(self.places.table),
            Feedback::Motor => self.state(self.places.motor),
        }
    }

    fn motor_mass(&self) -> f64 {
        let travel = self.mechanics.travel;
        self.loops.motor_inertia / (travel * travel)
    }

    /// The loops of position and velocity: the force that they ask for.
    fn velocity_loop(&mut self) -> Signal {
        let loops = self.loops;
        let travel = self.mechanics.travel;
        let velocity_gain = loops.velocity_gain / (travel * travel);
        let [_, motor_velocity] = self.motor();
        let velocity_error = self
            .command(0)
            .plus(-1.0, &self.measured())
            .times(loops.kv)
            .plus(loops.velocity_feed_forward, &self.command(1))
            .plus(-1.0, &motor_velocity);
        let mass = self.motor_mass() + self.mechanics.mass;
        let mut wanted = velocity_error
            .times(velocity_gain)
            .plus(loops.acceleration_feed_forward * mass, &self.command(2));
        if let (Some(place), Some(time)) = (self.places.velocity_integral, loops.velocity_time) {
            wanted = wanted.plus(velocity_gain / time, &self.state(place));
            self.rows.push((place, velocity_error));
        }
        wanted
    }

    /// The current loop, if there is one: the force that the motor makes where `wanted` is asked for.
    fn current_loop(&mut self, wanted: Signal) -> Signal {
        let (Some(current), Some(place)) = (&self.loops.current, self.places.current) else {
            return wanted;
        };
        let travel = self.mechanics.travel;
        let [_, motor_velocity] = self.motor();
        let newtons_per_ampere = current.torque_constant / travel;
        let error = wanted.times(1.0 / newtons_per_ampere).plus(-1.0, &self.state(place));
        let mut voltage = error
            .times(current.gain)
            .plus(-current.resistance, &self.state(place))
            .plus(-current.back_emf / travel, &motor_velocity);
        if let (Some(integral), Some(time)) = (self.places.current_integral, current.time) {
            voltage = voltage.plus(current.gain / time, &self.state(integral));
            self.rows.push((integral, error));
        }
        self.rows.push((place, voltage.times(1e3 / current.inductance)));
        self.state(place).times(newtons_per_ampere)
    }

    /// How motor and table go under the motor's force.
    fn motion(&mut self, force: &Signal) -> ForceColumns {
        let Mechanics { travel, mass, damping, .. } = self.mechanics;
        let (motor, order) = (self.places.motor, self.places.order);
        let motor_mass = self.motor_mass();
        let motor_damping =
            (self.loops.motor_damping + self.mechanics.shaft_damping) / (travel * travel);
        let [_, motor_velocity] = self.motor();
        let [_, table_velocity] = self.table();
        let shaft = force.clone().plus(-motor_damping, &motor_velocity);
        self.rows.push((motor, motor_velocity.clone()));
        let mut forces =
            ForceColumns { push: DVector::zeros(order), transmission: DVector::zeros(order) };
        if let Some(stiffness) = self.mechanics.stiffness {
            let table = self.places.table;
            let spring = self
                .stretch()
                .times(stiffness)
                .plus(self.mechanics.stiffness_damping, &motor_velocity)
                .plus(-self.mechanics.stiffness_damping, &table_velocity);
            self.rows.push((motor + 1, shaft.plus(-1.0, &spring).times(1.0 / motor_mass)));
            self.rows.push((table, table_velocity.clone()));
            let driven = spring.plus(-damping, &table_velocity);
            self.rows.push((table + 1, driven.times(1.0 / mass)));
            forces.push[table + 1] = -1.0 / mass;
            forces.transmission[motor + 1] = -1.0 / motor_mass;
            forces.transmission[table + 1] = 1.0 / mass;
        } else {
            let mass = motor_mass + mass;
            let driven = shaft.plus(-damping, &motor_velocity);
            self.rows.push((motor + 1, driven.times(1.0 / mass)));
            forces.push[motor + 1] = -1.0 / mass;
        }
        forces
    }

    /// How far the transmission is stretched: motor minus table.
    fn stretch(&self) -> Signal {
        let ([motor, _], [table, _]) = (self.motor(), self.table());
        motor.plus(-1.0, &table)
    }

    /// The rows, as matrices.
    fn state_space(mut self, forces: ForceColumns) -> StateSpace {
        let order = self.places.order;
        let mut a = DMatrix::zeros(order, order);
        let mut inputs = [0, 1, 2].map(|_| DVector::zeros(order));
        for (place, signal) in std::mem::take(&mut self.rows) {
            a.row_mut(place).copy_from(&signal.states);
            for (input, factor) in inputs.iter_mut().zip(signal.command) {
                input[place] = factor;
            }
        }
        let ForceColumns { push, transmission } = forces;
        let [_, motor_velocity] = self.motor();
        let [table, table_velocity] = self.table();
        let damping = self.mechanics.stiffness_damping;
        let released = self.mechanics.stiffness.map(|stiffness| {
            let stretch = self.stretch().states;
            let handed = stretch.clone() * stiffness
                + (&motor_velocity.states - &table_velocity.states) * damping;
            Released {
                a: &a - &transmission * handed,
                force: transmission,
                stretch,
                stiffness,
                damping,
            }
        });
        let [value, rate, jump] = inputs;
        let axis_units = 1.0 / self.length;
        StateSpace {
            a,
            value,
            rate,
            jump,
            push,
            position: &table.states * axis_units,
            measured: &self.measured().states * axis_units,
            velocity: table_velocity.states,
            through: 0.0,
            released,
        }
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
