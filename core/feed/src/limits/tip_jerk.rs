//! Jerk of the tip.

use super::channel::tip_channels;
use super::{Channel, Limit, Order};
use crate::samples::Samples;
use crate::table::LimitTable;

/// `|P' * s⃛ + 3 * P'' * ṡ * s̈ + P''' * ṡ³| <= j`, a ball.
///
/// `crate::jerk` keeps a polyhedron inside it: at most 1.9 % are lost on a path in a plane parallel to XY, 5.4 % on
/// others. A solver without jerk does not know it.
#[derive(Clone, Copy, Debug)]
pub struct TipJerk {
    /// Largest jerk of the tip, mm/s³.
    pub limit: f64,
}

impl Limit for TipJerk {
    fn name(&self) -> &'static str {
        "tip jerk"
    }

    /// Nothing, for the reason that [`super::AxisJerk`] has nothing.
    fn apply(&self, _: &Samples, _: &mut LimitTable<'_>) {}

    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        tip_channels(samples, interval, Order::Jerk, self.limit, sink);
    }
}
