//! Velocity of each axis (feedrate paper, eq. 22).

use super::{Collocation, Limit, first_derivative};
use crate::samples::Samples;
use crate::table::LimitTable;

/// `|Q'| * ds/dt <= v` of each axis, so `q <= (v / |Q'|)^2`.
#[derive(Clone, Debug)]
pub struct AxisVelocity {
    /// Largest velocity of each axis, in its unit per second.
    pub limits: Vec<f64>,
    /// Where the limit is kept: at samples, or between them too.
    pub collocation: Collocation,
}

impl Limit for AxisVelocity {
    fn name(&self) -> &'static str {
        "axis velocity"
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        for (index, (axis, &limit)) in samples.axes.iter().zip(&self.limits).enumerate() {
            let name = Some(index as u16);
            let bound = |first: f64| (limit / first) * (limit / first);
            if self.collocation != Collocation::Throughout {
                for (sample, &first) in axis.first.iter().enumerate() {
                    table.lower(sample, bound(first), name);
                }
                continue;
            }
            for interval in 0..samples.intervals() {
                let first = [axis.first[interval], axis.first[interval + 1]];
                let second = [axis.second[interval], axis.second[interval + 1]];
                let hull = first_derivative(first, second, samples.step(interval));
                let largest = hull.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                table.lower(interval, bound(largest), name);
                table.lower(interval + 1, bound(largest), name);
            }
        }
    }
}
