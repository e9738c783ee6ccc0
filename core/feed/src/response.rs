//! How a drive answers a sine: gain and phase by frequency.

/// A drive's steady answer to a sine of one.
pub trait DriveResponse {
    /// Answer at `frequency` rad/s.
    fn at(&self, frequency: f64) -> ComplexGain;
}

/// What tells the answer at a frequency in rad/s is a drive: so a servo of another crate serves without knowing this one.
impl<F: Fn(f64) -> ComplexGain> DriveResponse for F {
    fn at(&self, frequency: f64) -> ComplexGain {
        self(frequency)
    }
}

/// A complex number: the answer's size and phase against what was asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexGain {
    /// Part in phase with what was asked.
    pub real: f64,
    /// A quarter turn ahead of it.
    pub imaginary: f64,
}

impl ComplexGain {
    /// Answer of a drive that is where it is commanded.
    pub const EXACT: Self = Self { real: 1.0, imaginary: 0.0 };

    /// `|G|`.
    #[must_use]
    pub fn gain(self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }

    /// Angle by which it is ahead of another, rad, in half a turn to either side.
    #[must_use]
    pub fn phase_from(self, other: Self) -> f64 {
        let real = self.real * other.real + self.imaginary * other.imaginary;
        let imaginary = self.imaginary * other.real - self.real * other.imaginary;
        libm::atan2(imaginary, real)
    }
}
