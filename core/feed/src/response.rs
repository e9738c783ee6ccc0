//! How a drive answers a sine: gain and phase by frequency.

/// A drive's steady answer to a sine of one.
pub trait Response {
    /// At `frequency` rad/s.
    fn at(&self, frequency: f64) -> Answer;
}

/// A complex number: the answer's size and phase against what was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// In phase with what was asked.
    pub real: f64,
    /// A quarter turn ahead of it.
    pub imaginary: f64,
}

impl Answer {
    /// `|G|`.
    #[must_use]
    pub fn gain(self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }

    /// By how much it is ahead of another, rad, in half a turn to either side.
    #[must_use]
    pub fn phase_from(self, other: Self) -> f64 {
        let real = self.real * other.real + self.imaginary * other.imaginary;
        let imaginary = self.imaginary * other.real - self.real * other.imaginary;
        libm::atan2(imaginary, real)
    }
}

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
            denominator: vec![
                integral,
                proportional,
                self.damping + derivative,
                self.inertia,
            ],
        }
    }
}

impl Response for Transfer {
    fn at(&self, frequency: f64) -> Answer {
        let [a, b] = polynomial(&self.numerator, frequency);
        let [c, d] = polynomial(&self.denominator, frequency);
        let square = c * c + d * d;
        Answer {
            real: (a * c + b * d) / square,
            imaginary: (b * c - a * d) / square,
        }
    }
}

/// A polynomial at `j * frequency`, real and imaginary part.
fn polynomial(coefficients: &[f64], frequency: f64) -> [f64; 2] {
    let step = |[real, imaginary]: [f64; 2], coefficient: &f64| {
        [coefficient - imaginary * frequency, real * frequency]
    };
    coefficients.iter().rev().fold([0.0, 0.0], step)
}
