//! Codes of the letter G.

use std::fmt;

/// A G code, whose number may have a tenth: `G54`, `G43.4`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct GCode {
    tenths: u16,
}

impl GCode {
    /// The code of a whole number: `G54`.
    pub const fn whole(number: u16) -> Self {
        Self::with_tenth(number, 0)
    }

    /// The code of a number with a tenth: `G43.4` of 43 and 4.
    pub const fn with_tenth(number: u16, tenth: u16) -> Self {
        Self { tenths: 10 * number + tenth }
    }

    /// The code nearest to a number; none below zero and from 6553.5 on.
    pub fn nearest(number: f64) -> Option<Self> {
        let tenths = libm::rint(number * 10.0);
        (0.0..65_535.0).contains(&tenths).then_some(Self { tenths: tenths as u16 })
    }

    /// The code of a number as a block states it; none if it is finer than a tenth.
    #[inline]
    pub fn of(number: f64) -> Option<Self> {
        let exact = |code: &Self| libm::fabs(number * 10.0 - f64::from(code.tenths)) <= 1e-6;
        Self::nearest(number).filter(exact)
    }

    /// The whole number, and the tenth: 43 and 4 of `G43.4`.
    pub const fn parts(self) -> (u16, u16) {
        (self.tenths / 10, self.tenths % 10)
    }

    /// Place in a table of all codes.
    #[inline]
    pub fn index(self) -> usize {
        usize::from(self.tenths)
    }
}

impl fmt::Display for GCode {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.parts() {
            (number, 0) => write!(to, "G{number}"),
            (number, tenth) => write!(to, "G{number}.{tenth}"),
        }
    }
}
