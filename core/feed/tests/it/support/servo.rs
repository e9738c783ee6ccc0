//! The servo of the feedrate paper.

use post_feed::response::{ComplexGain, DriveResponse};

/// A quotient of polynomials in `s`.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// From the constant term up.
    pub numerator: Vec<f64>,
    /// From the constant term up.
    pub denominator: Vec<f64>,
}

/// Gains of a PID position loop around a drive, in the units of the feedrate paper's Table 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid {
    /// Proportional, V/mm.
    pub proportional: f64,
    /// Integral, V/(mm s).
    pub integral: f64,
    /// Derivative, V/(mm/s).
    pub derivative: f64,
    /// Current amplifier times torque constant times screw lead, V to mm.
    pub drive: f64,
    /// Moment of inertia, kg m².
    pub inertia: f64,
    /// Viscous damping, kg m²/s.
    pub damping: f64,
}

impl Pid {
    /// `K (kd s² + kp s + ki) / (J s³ + (B + K kd) s² + K kp s + K ki)`: the feedrate paper's eq. 2, in which `s` is
    /// missing behind `kp`.
    #[must_use]
    pub fn transfer(&self) -> Transfer {
        let [integral, proportional, derivative] =
            [self.integral, self.proportional, self.derivative].map(|gain| self.drive * gain);
        Transfer {
            numerator: vec![integral, proportional, derivative],
            denominator: vec![integral, proportional, self.damping + derivative, self.inertia],
        }
    }
}

impl DriveResponse for Transfer {
    fn at(&self, frequency: f64) -> ComplexGain {
        let [a, b] = polynomial(&self.numerator, frequency);
        let [c, d] = polynomial(&self.denominator, frequency);
        let square = c * c + d * d;
        ComplexGain { real: (a * c + b * d) / square, imaginary: (b * c - a * d) / square }
    }
}

/// A polynomial at `j * frequency`, real and imaginary part.
fn polynomial(coefficients: &[f64], frequency: f64) -> [f64; 2] {
    let step = |[real, imaginary]: [f64; 2], coefficient: &f64| {
        [coefficient - imaginary * frequency, real * frequency]
    };
    coefficients.iter().rev().fold([0.0, 0.0], step)
}
