//! Chord error of the control's interpolator (feedrate paper, eqs. 14, 15).

use super::{Collocation, Limit, bound_feed};
use crate::samples::Samples;
use crate::table::LimitTable;

/// The way of one interpolation period `T` is a chord of the path; on an arc of radius `ρ` it strays from the path by
/// at most `δ` if the feed is at most `2 * sqrt(ρ² - (ρ - δ)²) / T`.
#[derive(Clone, Copy, Debug)]
pub struct ChordError {
    /// `δ`, mm.
    pub tolerance: f64,
    /// `T`, s.
    pub period: f64,
    /// Where the limit is kept: at samples, or between them too.
    pub collocation: Collocation,
}

impl ChordError {
    /// The fastest feed on a path of this curvature, mm/s.
    #[must_use]
    pub fn feed(&self, curvature: f64) -> f64 {
        let radius = 1.0 / curvature;
        // A chord is no longer than the arc's diameter.
        let depth = self.tolerance.min(radius);
        // The form of the square that loses no digits where the radius is large.
        2.0 * (depth * (2.0 * radius - depth)).sqrt() / self.period
    }
}

impl Limit for ChordError {
    fn name(&self) -> &'static str {
        "chord error"
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        bound_feed(samples, self.collocation, table, |curvature| self.feed(curvature));
    }
}
