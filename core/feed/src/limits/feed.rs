//! The programmed feed, and what the machine allows of it (feedrate paper, eq. 17).

use super::{Collocation, Limit, SampleRange, least_of_blocks};
use crate::samples::Samples;
use crate::table::LimitTable;

/// The feed of the tip against the part stays below `most`, and below the feed of its block, [`Samples::feeds`].
///
/// Where the tip stands still because rotary axes alone turn there is no feed per length of the tip's path: there the
/// feed counts by the parameter, `ds/dt <= feed`.
#[derive(Clone, Copy, Debug)]
pub struct TipFeed {
    /// Largest feed, mm/s; infinite where the feeds of the blocks alone count.
    pub most: f64,
    /// Where the limit is kept: only between samples too does a block that ends between two of them bound both.
    pub collocation: Collocation,
}

impl Limit for TipFeed {
    fn name(&self) -> &'static str {
        "feed"
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        for place in SampleRange::all(samples, self.collocation) {
            let stretch = if place.is_still() { 1.0 } else { place.stretch };
            place.bound(table, self.most / stretch);
            place.bound(table, least_of_blocks(&samples.feeds, &place) / stretch);
        }
    }
}
