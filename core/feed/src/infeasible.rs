//! Why there is no plan: which limit, and where.

use std::fmt;

use crate::table::LimitSource;

/// Why no feed keeps every limit. Samples are counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Infeasible {
    /// Fewer than two samples, arrays whose lengths do not fit, or ends that are negative or not finite.
    Shape,
    /// The parameter does not grow from this sample to the next.
    Standstill {
        /// The first of the two.
        sample: usize,
    },
    /// No limit bounds the speed at this sample.
    Unbounded {
        /// Where.
        sample: usize,
    },
    /// A limit came out negative or not finite.
    NotANumber {
        /// Sample, or the first of the two that it lies between.
        sample: usize,
        /// Which limit.
        source: LimitSource,
    },
    /// The speed is above a bound further on, even by the hardest braking from the given start.
    TooFastStart {
        /// Where the bound is first broken.
        sample: usize,
        /// The bound.
        source: LimitSource,
        /// `q` there by the hardest braking.
        needed: f64,
        /// Largest `q` there.
        allowed: f64,
        /// The row that keeps it from braking harder, if any does.
        braking: Option<LimitSource>,
    },
    /// The given end speed cannot be reached: to have it at the end the speed would have to be above a bound before.
    OutOfReach {
        /// The last sample, counted from the end, where the bound is broken.
        sample: usize,
        /// The bound.
        source: LimitSource,
        /// `q` there by the hardest acceleration from there on.
        needed: f64,
        /// Largest `q` there.
        allowed: f64,
        /// The row that keeps it from accelerating harder, if any does.
        accelerating: Option<LimitSource>,
    },
    /// A plan with jerk limits needs four intervals between two stops; sample the path finer there.
    TooShort {
        /// The stop before.
        sample: usize,
    },
    /// The interior-point method ended without a plan on the stretch that begins here. Its limits may be so far apart
    /// that numbers run out of digits.
    NoProgress {
        /// Where the stretch begins.
        sample: usize,
    },
    /// The limits of one interval contradict each other for every speed that can be reached there.
    Contradiction {
        /// The interval begins here.
        sample: usize,
        /// One of the limits.
        source: LimitSource,
    },
}

impl Infeasible {
    /// The sample where it shows, if it is one.
    #[must_use]
    pub fn sample(mut self) -> Option<usize> {
        self.sample_mut().copied()
    }

    /// Shifts the fault of a part of a path that begins with sample `first` of the whole.
    pub(crate) fn shifted(mut self, first: usize) -> Self {
        if let Some(sample) = self.sample_mut() {
            *sample += first;
        }
        self
    }

    fn sample_mut(&mut self) -> Option<&mut usize> {
        match self {
            Self::Shape => None,
            Self::Standstill { sample }
            | Self::Unbounded { sample }
            | Self::TooShort { sample }
            | Self::NoProgress { sample }
            | Self::NotANumber { sample, .. }
            | Self::TooFastStart { sample, .. }
            | Self::OutOfReach { sample, .. }
            | Self::Contradiction { sample, .. } => Some(sample),
        }
    }

    /// The limit that it breaks, if it is one.
    #[must_use]
    pub fn source(&self) -> Option<LimitSource> {
        match *self {
            Self::Shape
            | Self::Standstill { .. }
            | Self::Unbounded { .. }
            | Self::TooShort { .. }
            | Self::NoProgress { .. } => None,
            Self::NotANumber { source, .. }
            | Self::TooFastStart { source, .. }
            | Self::OutOfReach { source, .. }
            | Self::Contradiction { source, .. } => Some(source),
        }
    }
}

impl fmt::Display for Infeasible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape => f.write_str(
                "there is no path to plan: fewer than two samples, or ends that are no speeds",
            ),
            Self::Standstill { sample } => {
                write!(f, "the path parameter does not grow behind sample {sample}")
            }
            Self::Unbounded { sample } => write!(f, "no limit bounds the speed at sample {sample}"),
            Self::TooShort { sample } => write!(
                f,
                "behind sample {sample} there are fewer than four intervals to the next stop"
            ),
            Self::NoProgress { sample } => {
                write!(f, "behind sample {sample} no plan with jerk limits was found")
            }
            Self::NotANumber { sample, .. } => {
                write!(f, "a limit at sample {sample} is not finite, or negative")
            }
            Self::TooFastStart { sample, .. } => {
                write!(f, "the start is too fast for the limit at sample {sample}")
            }
            Self::OutOfReach { sample, .. } => {
                write!(f, "the end is too fast for the limit at sample {sample}")
            }
            Self::Contradiction { sample, .. } => {
                write!(f, "the limits behind sample {sample} contradict each other")
            }
        }
    }
}

impl std::error::Error for Infeasible {}
