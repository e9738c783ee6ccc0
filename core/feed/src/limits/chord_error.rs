//! Chord error of the control's interpolator (feedrate paper, eqs. 14, 15).

use super::{Collocation, Limit, bound_feed};
use crate::samples::Samples;
use crate::table::Table;

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

    fn apply(&self, samples: &Samples, table: &mut Table<'_>) {
        bound_feed(samples, self.collocation, table, |curvature| self.feed(curvature));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chord_of_one_period_strays_by_the_tolerance() {
        let limit =
            ChordError { tolerance: 0.0005, period: 0.004, collocation: Collocation::Start };
        for radius in [0.001, 0.02, 8.0, 1e6] {
            let half: f64 = limit.feed(1.0 / radius) * limit.period / 2.0;
            let error = half * half / (radius + (radius * radius - half * half).max(0.0).sqrt());
            assert!((error - 0.0005).abs() < 1e-12, "{radius}: {error}");
        }
        // As the paper approximates it in eq. 24: 2 * sqrt(2 * ρ * δ) / T.
        assert!((limit.feed(1.0 / 8.0) - 44.72).abs() < 0.01);
        assert_eq!(limit.feed(0.0), f64::INFINITY);
    }
}
