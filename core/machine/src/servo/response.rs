//! What a servo makes of a sine.

use std::f64::consts::FRAC_1_SQRT_2;

use nalgebra::{Complex, DMatrix, DVector};

use super::{Servo, ServoModel, ServoPole, StateSpace};
use crate::description::Machine;

/// The frequency response of a servo, friction and play left out.
#[derive(Clone, Debug)]
pub struct FrequencyResponse {
    space: StateSpace,
    poles: Vec<ServoPole>,
    /// Frequency of the table on its transmission, rad/s; none where that is rigid, or no part of the model.
    swing: Option<f64>,
}

/// Frequencies that are looked at for one e-fold: what happens in between, a resonance narrower than that, is found where
/// a pole says so, since the poles' own frequencies are looked at too.
const PER_E_FOLD: f64 = 64.0;

/// Halvings of an interval of frequencies.
const HALVINGS: usize = 60;

impl FrequencyResponse {
    /// The response of `servo`.
    pub fn new(servo: &Servo) -> Self {
        let space = StateSpace::of(servo);
        // A servo whose poles cannot be found was refused when its machine was loaded.
        let poles = space.poles().unwrap_or_default();
        let swing = match &servo.model {
            ServoModel::Loops(loops) => loops.drive.mechanics().natural_frequency(),
            ServoModel::Transfer(_) | ServoModel::Pid(_) => None,
        };
        Self { space, poles, swing }
    }

    /// The responses of the axes of `machine`, by their places in the chain; none for an axis without a servo, which is
    /// where it is commanded.
    pub fn of_machine(machine: &Machine) -> Vec<Option<Self>> {
        let servos = machine.axes.iter().map(|axis| axis.servo.as_deref());
        servos.map(|servo| servo.map(Self::new)).collect()
    }

    /// The poles, 1/s, the slowest first.
    pub fn poles(&self) -> &[ServoPole] {
        &self.poles
    }

    /// `G(jω)`, position of the table over commanded position at `omega` rad/s.
    pub fn at(&self, omega: f64) -> Complex<f64> {
        let space = &self.space;
        let order = space.order();
        let s = Complex::new(0.0, omega);
        let matrix = DMatrix::from_fn(order, order, |row, column| {
            let own = if row == column { s } else { Complex::new(0.0, 0.0) };
            own - space.a[(row, column)]
        });
        let input = DVector::from_fn(order, |row, _| {
            s * s * space.jump[row] + s * space.rate[row] + space.value[row]
        });
        // A stable servo has no pole at jω.
        let states = matrix.lu().solve(&input).unwrap_or(input);
        let position = space.position.iter().zip(states.iter());
        let sum: Complex<f64> = position.map(|(row, state)| state * *row).sum();
        sum + space.through
    }

    /// `|G(jω)|` at `omega` rad/s.
    pub fn gain(&self, omega: f64) -> f64 {
        let value = self.at(omega);
        libm::hypot(value.re, value.im)
    }

    /// The angular frequency at which `|G|` falls below `1/√2` (-3 dB) for the first time, rad/s; infinite if it never
    /// does.
    pub fn bandwidth(&self) -> f64 {
        self.first_beyond(|gain| gain >= FRAC_1_SQRT_2)
    }

    /// The largest angular frequency up to which `|1 - |G(jω)||` stays within `share` all the way, rad/s (Chen, Ren, Sun
    /// 2016, eq. 9): around an arc of radius ρ at ω the contour error is `ρ·|1 - |G(jω)||`. Infinite if it always does.
    pub fn faithful_up_to(&self, share: f64) -> f64 {
        self.first_beyond(|gain| libm::fabs(1.0 - gain) <= share)
    }

    /// Up to where a formula of the steady state may go, rad/s (Chen, Ren, Sun 2016, eq. 11, where it is ωn): the frequency
    /// at which the table swings on its transmission, where the servo has one, and no more than the bandwidth.
    pub fn natural_frequency(&self) -> f64 {
        self.bandwidth().min(self.swing.unwrap_or(f64::INFINITY))
    }

    /// The least frequency beyond which `holds` of the gain is false.
    fn first_beyond(&self, holds: impl Fn(f64) -> bool) -> f64 {
        let sizes = self.poles.iter().map(ServoPole::size);
        let least = sizes.clone().fold(f64::INFINITY, f64::min);
        let most = sizes.fold(0.0, f64::max);
        if !(least > 0.0 && most.is_finite()) {
            return f64::INFINITY;
        }
        let (first, last) = (least * 1e-6, most * 1e6);
        let count = libm::ceil(libm::log(last / first) * PER_E_FOLD) as usize;
        let grid = |place: usize| first * libm::exp(place as f64 / PER_E_FOLD);
        let mut looked: Vec<f64> = (0..=count).map(grid).collect();
        for pole in &self.poles {
            // Around a resonance, as finely as it is narrow.
            let width = libm::fabs(pole.real);
            let around = (-8..=8).map(|part| pole.imaginary + width * f64::from(part) / 4.0);
            looked.extend(around.filter(|omega| *omega > first));
        }
        looked.sort_by(f64::total_cmp);
        let mut good = 0.0;
        for omega in looked {
            if holds(self.gain(omega)) {
                good = omega;
                continue;
            }
            let mut bad = omega;
            for _ in 0..HALVINGS {
                let middle = f64::midpoint(good, bad);
                if holds(self.gain(middle)) {
                    good = middle;
                } else {
                    bad = middle;
                }
            }
            return good;
        }
        f64::INFINITY
    }
}
