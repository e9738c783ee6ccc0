//! The limits of a feed, one file each. What a limit bounds, and from which formula, is said there.
//!
//! A limit is asked for a batch of samples at a time. It lowers the upper bounds of `q`, the squared speed of the path
//! parameter, and adds rows between neighbours; the solver with jerk limits asks for [`Channel`]s too. Adding a limit
//! is adding a file here: it implements [`Limit`], and nothing else knows of it.

mod axis_acceleration;
mod axis_jerk;
mod axis_velocity;
mod block_time;
pub(crate) mod channel;
mod chord_error;
mod contour_error;
mod feed;
mod tip_acceleration;
mod tip_jerk;

pub use axis_acceleration::AxisAcceleration;
pub use axis_jerk::AxisJerk;
pub use axis_velocity::AxisVelocity;
pub use block_time::BlockTime;
pub use channel::{Channel, Order};
pub use chord_error::ChordError;
pub use contour_error::{ContourError, deviation};
pub use feed::TipFeed;
pub use tip_acceleration::TipAcceleration;
pub use tip_jerk::TipJerk;

use crate::samples::{Samples, is_still, norm};
use crate::table::LimitTable;

/// Something that a feed must keep.
pub trait Limit {
    /// What it limits, in the words of a report: `axis acceleration`.
    fn name(&self) -> &'static str;

    /// The rows that it has in each interval: for each the axis that it is of. Their number must not depend on the
    /// batch.
    fn rows(&self, samples: &Samples) -> Vec<Option<u16>> {
        let _ = samples;
        Vec::new()
    }

    /// Lowers upper bounds and sets the rows of every interval.
    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>);

    /// Hands on what it limits in one interval, for the solver with jerk limits. A limit that has bounds alone, or one
    /// that [`Limit::apply`] says all of, hands on nothing.
    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        let _ = (samples, interval, sink);
    }
}

/// Where along an interval a limit is kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Collocation {
    /// Each sample with the acceleration of the interval after it: the feedrate paper (eqs. 22, 23), and what
    /// reachability analysis calls collocation. At the end of an interval a limit may be exceeded by a term of first
    /// order in the step.
    Start,
    /// Both ends of each interval: what reachability analysis calls interpolation. Between samples a limit may be
    /// exceeded by a term of second order in the step.
    Ends,
    /// Every point between samples: where an axis follows a cubic between them (its first and second derivatives at
    /// both ends are those of one cubic), its velocity and acceleration keep the limit everywhere, proven by the
    /// convex hull of Bernstein coefficients. On other paths what is left is of the size of the fourth derivative.
    /// Curvature is taken to be largest at a sample.
    #[default]
    Throughout,
}

impl Collocation {
    /// Rows that each acceleration needs.
    #[must_use]
    pub fn rows(self) -> usize {
        match self {
            Self::Start => 1,
            Self::Ends => 2,
            Self::Throughout => 3,
        }
    }
}

/// Bernstein coefficients of a first derivative between two samples, where the second is linear between them: its
/// value here, the middle coefficient, its value at the next sample. Where the function is no cubic the middle one is
/// the mean of what the two ends say.
pub(crate) fn first_derivative(first: [f64; 2], second: [f64; 2], step: f64) -> [f64; 3] {
    let middle = 0.5 * (first[0] + first[1]) + 0.25 * step * (second[0] - second[1]);
    [first[0], middle, first[1]]
}

/// Where a bound of the tip's feed holds: a sample, or an interval with both its ends.
pub(crate) struct SampleRange {
    pub(crate) samples: std::ops::RangeInclusive<usize>,
    /// The largest `|P'|`, mm per unit of the parameter.
    pub(crate) stretch: f64,
    /// The largest curvature, 1/mm.
    pub(crate) curvature: f64,
}

impl SampleRange {
    /// All of a batch: its samples, or its intervals if a limit is kept between samples too.
    fn all(samples: &Samples, collocation: Collocation) -> impl Iterator<Item = Self> + '_ {
        let throughout = collocation == Collocation::Throughout;
        let count = if throughout { samples.intervals() } else { samples.len() };
        (0..count).map(move |first| {
            if throughout {
                Self::between(samples, first)
            } else {
                Self {
                    samples: first..=first,
                    stretch: samples.stretch(first),
                    curvature: samples.curvature[first],
                }
            }
        })
    }

    fn between(samples: &Samples, interval: usize) -> Self {
        let step = samples.step(interval);
        let [first, second, _] = &samples.tip;
        let middle = |axis: usize| {
            let pair = |all: &[[f64; 3]]| [all[interval][axis], all[interval + 1][axis]];
            first_derivative(pair(first), pair(second), step)[1]
        };
        let middle = norm([middle(0), middle(1), middle(2)]);
        let ends = samples.stretch(interval).max(samples.stretch(interval + 1));
        Self {
            samples: interval..=interval + 1,
            stretch: ends.max(middle),
            curvature: samples.curvature[interval].max(samples.curvature[interval + 1]),
        }
    }

    /// Whether the tip stands still there, so that there is no feed to bound: at a cusp, or where rotary axes alone
    /// turn.
    pub(crate) fn is_still(&self) -> bool {
        is_still(self.stretch)
    }

    /// Bounds the speed of the parameter there.
    pub(crate) fn bound(&self, table: &mut LimitTable<'_>, speed: f64) {
        // A speed below 0 is invalid, and must not become valid by being squared.
        let bound = if speed >= 0.0 { speed * speed } else { f64::NAN };
        for sample in self.samples.clone() {
            table.lower(sample, bound, None);
        }
    }
}

/// Bounds `q` so that the feed of the tip stays below what `most` says of a curvature in 1/mm, mm/s; nothing where the
/// tip stands still.
pub(crate) fn bound_feed(
    samples: &Samples,
    collocation: Collocation,
    table: &mut LimitTable<'_>,
    most: impl Fn(f64) -> f64,
) {
    for place in SampleRange::all(samples, collocation).filter(|place| !place.is_still()) {
        place.bound(table, most(place.curvature) / place.stretch);
    }
}

/// The least of what each sample of a place has of its block; infinite where there are no blocks. Between two samples a
/// block may end and the next begin, so both count.
pub(crate) fn least_of_blocks(each: &[f64], place: &SampleRange) -> f64 {
    let here = each.get(place.samples.clone()).unwrap_or_default();
    // What is not a number must not get lost in a comparison.
    let least = |least: f64, &value: &f64| {
        if value < least || value.is_nan() { value } else { least }
    };
    here.iter().fold(f64::INFINITY, least)
}
