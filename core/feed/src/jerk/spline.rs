//! The quadratic spline of one stretch: which coefficients it has, and what each interval is in them.

use super::forms::LinearForm;
use super::{IntervalLaw, Law};
use crate::infeasible::Infeasible;

/// `q` and the middle Bernstein coefficient of the first interval: value and slope that a stretch begins with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StartState {
    pub(super) q: f64,
    pub(super) middle: f64,
}

impl StartState {
    /// State with this speed and no acceleration along the path.
    pub(super) fn even(q: f64) -> Self {
        Self { q, middle: q }
    }

    pub(super) fn is_rest(self) -> bool {
        self.q == 0.0
    }
}

/// The spline's coefficients: one an interval, and one fixed before and after them. Where the path has a corner the
/// coefficients of both intervals beside it are the same unknown: there is no acceleration along the path there.
pub(super) struct Spline {
    /// Lengths of the intervals, as far as the spline is concerned; those before and after have none.
    pub(super) widths: Vec<f64>,
    /// Whether the stretch begins and ends at rest.
    pub(super) rest: [bool; 2],
    /// The fixed coefficients at both ends.
    fixed: [[f64; 2]; 2],
    /// The unknown that each coefficient is.
    pub(super) unknowns: Vec<usize>,
}

impl Spline {
    /// Makes the spline over these intervals; `corners` has a value for each sample.
    pub(super) fn new(
        steps: &[f64],
        corners: &[bool],
        start: StartState,
        end: f64,
    ) -> Result<Self, Infeasible> {
        let last = steps.len();
        if last < 4 {
            return Err(Infeasible::TooShort { sample: 0 });
        }
        let rest = [start.is_rest(), end == 0.0];
        // There a speed at the corner would have to be that at rest.
        for (rest, sample) in [(rest[0], 1), (rest[1], last - 1)] {
            if rest && corners[sample] {
                return Err(Infeasible::TooShort { sample: sample - 1 });
            }
        }
        let mut widths = vec![0.0];
        widths.extend_from_slice(steps);
        widths.push(0.0);
        for (at, rest) in [(1, rest[0]), (last, rest[1])] {
            if rest {
                // Joins `share^(4/3)` with value and slope.
                widths[at] *= 1.5;
            }
        }
        let mut unknowns = vec![0];
        let mut unknown = 0;
        for coefficient in 1..last + 2 {
            let merged = (2..=last).contains(&coefficient) && corners[coefficient - 1];
            unknown += usize::from(!merged);
            unknowns.push(unknown);
        }
        Ok(Self { widths, rest, fixed: [[start.q, start.middle], [end, end]], unknowns })
    }

    pub(super) fn intervals(&self) -> usize {
        self.widths.len() - 2
    }

    /// Number of unknowns.
    pub(super) fn count(&self) -> usize {
        self.unknowns.last().map_or(0, |last| last + 1)
    }

    /// Whether an interval is part of the spline, or leaves rest or goes to it.
    pub(super) fn is_spline(&self, interval: usize) -> bool {
        let first = interval == 0 && self.rest[0];
        let last = interval + 1 == self.intervals() && self.rest[1];
        !first && !last
    }

    /// The Bernstein coefficients of an interval in the three coefficients that begin with the one of its number.
    pub(super) fn bernstein(&self, interval: usize) -> [LinearForm; 3] {
        let [before, here, next] = [0, 1, 2].map(|k| self.widths[interval + k]);
        [
            [here / (before + here), before / (before + here), 0.0],
            [0.0, 1.0, 0.0],
            [0.0, next / (here + next), here / (here + next)],
        ]
    }

    /// The value that a coefficient has in any case, if it is one of those at the ends.
    pub(super) fn fixed(&self, coefficient: usize) -> Option<f64> {
        let last = self.intervals();
        match coefficient {
            0 | 1 => Some(self.fixed[0][coefficient]),
            _ if coefficient >= last => Some(self.fixed[1][coefficient - last]),
            _ => None,
        }
    }

    /// The first of the three neighbouring unknowns among which those of an interval are.
    pub(super) fn first(&self, interval: usize) -> usize {
        self.unknowns[interval].min(self.count() - 3)
    }

    /// A form in the three coefficients of an interval, as one in three unknowns from [`Spline::first`] on.
    pub(super) fn in_unknowns(&self, interval: usize, form: LinearForm) -> LinearForm {
        let first = self.first(interval);
        let mut all = [0.0; 3];
        for (k, value) in form.into_iter().enumerate() {
            all[self.unknowns[interval + k] - first] += value;
        }
        all
    }

    /// The integral of each unknown's basis functions, times `1 / sqrt(scale)`, the largest being 1.
    pub(super) fn weights(&self, scale: &[f64]) -> Vec<f64> {
        let count = self.widths.len();
        let mut weights = vec![0.0; self.count()];
        for (at, &unknown) in self.unknowns.iter().enumerate() {
            let around = at.saturating_sub(1)..(at + 2).min(count);
            weights[unknown] +=
                self.widths[around].iter().sum::<f64>() / 3.0 / scale[unknown].sqrt();
        }
        let most = weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        weights.iter_mut().for_each(|weight| *weight /= most);
        weights
    }

    /// Value of a form of an interval.
    pub(super) fn value(&self, interval: usize, form: LinearForm, unknowns: &[f64]) -> f64 {
        let place = &self.unknowns[interval..interval + 3];
        form.iter().zip(place).map(|(a, &at)| a * unknowns[at]).sum()
    }

    /// The feed over `steps`.
    pub(super) fn law(&self, steps: &[f64], unknowns: &[f64]) -> Law {
        let last = self.intervals() - 1;
        let piece = |interval: usize| {
            let bernstein = self.bernstein(interval);
            let value = |form: LinearForm| self.value(interval, form, unknowns);
            if self.is_spline(interval) {
                IntervalLaw::Quadratic(bernstein.map(value))
            } else if interval == 0 {
                IntervalLaw::Leave(value(bernstein[2]))
            } else {
                IntervalLaw::Arrive(value(bernstein[0]))
            }
        };
        Law { steps: steps.to_vec(), pieces: (0..=last).map(piece).collect() }
    }
}
