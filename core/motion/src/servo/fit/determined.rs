//! How well a log determines what was fitted to it.

use nalgebra::DVector;

use super::search::{FitSearch, SearchState};
use super::{FittedNumber, LARGEST_DEVIATION, ServoFit, UndeterminedDirection};

/// A singular value that is smaller than this share of the largest is the error of the differences.
const SMALLEST: f64 = 1e-9;
/// The standard deviation along a combination that the log says nothing of.
const ENDLESS: f64 = 1e9;
/// A share in a combination that is not told.
const SMALL_SHARE: f64 = 0.1;

impl FitSearch<'_> {
    /// What has been found, with errors of the log of the standard deviation `spread` that hang together so
    /// much, whose squares were `before`.
    pub(super) fn told(
        &self,
        found: &SearchState,
        [spread, together]: [f64; 2],
        before: f64,
    ) -> ServoFit {
        let count = self.names.len();
        let samples = (self.log.measured.len() - self.log.lead) as f64;
        let derivatives = found.triangle.view((0, 0), (count, count)).into_owned();
        let decomposed = derivatives.svd(false, true);
        let largest = decomposed.singular_values.amax();
        let along: Vec<f64> = decomposed
            .singular_values
            .iter()
            .map(|value| if *value > SMALLEST * largest { spread / value } else { ENDLESS })
            .collect();
        let directions: Vec<DVector<f64>> = decomposed
            .v_t
            .iter()
            .flat_map(|rows| rows.row_iter().map(|row| row.transpose()))
            .collect();
        // A number whose share in an endless combination is mere rounding is not endless.
        let covariance = |one: usize, other: usize| -> f64 {
            let parts = directions.iter().zip(&along);
            parts
                .filter(|(direction, _)| libm::fabs(direction[one] * direction[other]) > SMALLEST)
                .map(|(direction, along)| direction[one] * direction[other] * along * along)
                .sum()
        };
        let fitted = (0..count)
            .map(|index| {
                let deviation = told_deviation(libm::sqrt(covariance(index, index)));
                let correlation = |other: usize| {
                    let both = covariance(index, index) * covariance(other, other);
                    let value = covariance(index, other) / libm::sqrt(both);
                    if value.is_finite() { value } else { 0.0 }
                };
                let others = (0..count).filter(|other| *other != index);
                let correlated = others
                    .map(|other| (self.names[other], correlation(other)))
                    .max_by(|one, other| libm::fabs(one.1).total_cmp(&libm::fabs(other.1)));
                let value = self.value(&found.place, index);
                FittedNumber {
                    table: self.tables[index],
                    name: self.names[index],
                    before: self.value(&self.start, index),
                    value,
                    deviation: if self.by_factor[index] { deviation * value } else { deviation },
                    determined: deviation <= LARGEST_DEVIATION,
                    correlated,
                }
            })
            .collect();
        let undetermined = directions
            .iter()
            .zip(&along)
            .filter(|(_, along)| **along > LARGEST_DEVIATION)
            .map(|(direction, along)| self.direction(direction, *along))
            .collect();
        ServoFit {
            servo: self.servo_at(&found.place),
            fitted,
            undetermined,
            before: libm::sqrt(before / samples),
            after: found.triangle.column(count).norm() / libm::sqrt(samples),
            hanging_together: together,
            converged: found.converged,
        }
    }

    fn direction(&self, direction: &DVector<f64>, along: f64) -> UndeterminedDirection {
        // The largest share is 1.
        let largest = direction.iter().copied().fold(0.0, |largest: f64, share| {
            if libm::fabs(share) > libm::fabs(largest) { share } else { largest }
        });
        let shares = self.names.iter().zip(direction.iter());
        let shares = shares.map(|(name, share)| (*name, share / largest));
        UndeterminedDirection {
            shares: shares.filter(|(_, share)| libm::fabs(*share) > SMALL_SHARE).collect(),
            deviation: told_deviation(along * libm::fabs(largest)),
        }
    }
}

/// The deviation as it is reported: infinite where the log says nothing.
fn told_deviation(deviation: f64) -> f64 {
    if deviation < ENDLESS * SMALL_SHARE * SMALL_SHARE { deviation } else { f64::INFINITY }
}
