//! How fast the tool cuts, against how fast it is asked to.

use super::prediction::{Feeds, Times};

/// A feed counts as lower than programmed below this share of it.
const LOW: f64 = 0.95;

/// Adds up set-points in cuts.
#[derive(Clone, Debug)]
pub struct FeedTally {
    period: f64,
    found: Feeds,
}

impl FeedTally {
    /// Set-points come every `period` seconds.
    pub fn new(period: f64) -> Self {
        Self { period, found: Feeds::default() }
    }

    /// A set-point in a cut: feed of the tip since the one before, feed of the program, mm/min.
    pub fn take(&mut self, feed: f64, programmed: f64, line: u64) {
        let found = &mut self.found;
        found.way_mm += feed * self.period / 60.0;
        found.programmed_largest = found.programmed_largest.max(programmed);
        if feed > found.true_largest {
            found.true_largest = feed;
            found.largest_nc_line = line;
        }
        if feed < LOW * programmed {
            found.below_95_percent_s += self.period;
        }
    }

    /// All of it, in a program that takes so long.
    pub fn finish(self, times: &Times) -> Feeds {
        let mean = |seconds: f64| match seconds > 0.0 {
            true => 60.0 * self.found.way_mm / seconds,
            false => 0.0,
        };
        Feeds {
            programmed_mean: mean(times.cutting_at_feed_s),
            true_mean: mean(times.cutting_s),
            ..self.found
        }
    }
}
