//! Jerk of each axis.

use super::channel::axis_channels;
use super::{Channel, Limit, Order};
use crate::samples::Samples;
use crate::table::LimitTable;

/// `|Q' * s⃛ + 3 * Q'' * ṡ * s̈ + Q''' * ṡ³| <= j` of each axis.
///
/// It ties three neighbours and is not convex: `crate::jerk` keeps it; the solvers without jerk do not know it.
#[derive(Clone, Debug)]
pub struct AxisJerk {
    /// Largest jerk of each axis, in its unit per second cubed.
    pub limits: Vec<f64>,
}

impl Limit for AxisJerk {
    fn name(&self) -> &'static str {
        "axis jerk"
    }

    /// Nothing: `(j / |Q'''|)^(2/3)` bounds only a plan that goes on evenly; one that slows down may pass a sample
    /// faster.
    fn apply(&self, _: &Samples, _: &mut LimitTable<'_>) {}

    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        axis_channels(samples, interval, Order::Jerk, &self.limits, sink);
    }
}
