//! The poles of a servo.

use std::fmt;

use nalgebra::linalg::Schur;

use super::StateSpace;
use crate::diagnostic::Short;

/// A pole, 1/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoPole {
    /// Real part: what is left of an error falls like `exp(real·t)`.
    pub real: f64,
    /// Imaginary part: it swings at so many radians a second.
    pub imaginary: f64,
}

impl ServoPole {
    /// Distance from zero, 1/s.
    pub fn size(&self) -> f64 {
        libm::hypot(self.real, self.imaginary)
    }
}

impl fmt::Display for ServoPole {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Short(self.real))?;
        if self.imaginary == 0.0 {
            return Ok(());
        }
        let sign = if self.imaginary < 0.0 { '-' } else { '+' };
        write!(f, " {sign} {}j", Short(libm::fabs(self.imaginary)))
    }
}

/// Steps of the QR iteration a pole: far more than any matrix of a servo takes.
const MOST_STEPS: usize = 1_000;

/// A real part that is smaller than this share of the largest pole is zero but for rounding.
const AT_ZERO: f64 = 1e-12;

impl StateSpace {
    /// The poles, the slowest first: eigenvalues of the matrix. None where they are
    /// too large to be numbers, or the search for them does not end.
    pub fn poles(&self) -> Option<Vec<ServoPole>> {
        if !self.a.iter().all(|part| part.is_finite()) {
            return None;
        }
        let steps = MOST_STEPS * self.order();
        let schur = Schur::try_new(self.a.clone(), f64::EPSILON, steps)?;
        let mut poles: Vec<ServoPole> = schur
            .complex_eigenvalues()
            .iter()
            .map(|value| ServoPole { real: value.re, imaginary: value.im })
            .collect();
        poles.sort_by(|one, other| {
            (other.real.total_cmp(&one.real)).then(other.imaginary.total_cmp(&one.imaginary))
        });
        Some(poles)
    }
}

/// Every motion of its own dies away.
pub fn stable(poles: &[ServoPole]) -> bool {
    let largest = poles.iter().map(ServoPole::size).fold(0.0, f64::max);
    poles.iter().all(|pole| pole.real < -AT_ZERO * largest)
}
