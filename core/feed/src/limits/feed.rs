//! The programmed feed, and what the machine allows of it (feedrate paper, eq. 17).

use super::{Collocation, Limit, bound_feed};
use crate::problem::Table;
use crate::samples::Samples;

/// The feed of the tip against the part stays below `most`.
#[derive(Clone, Copy, Debug)]
pub struct Feed {
    /// mm/s.
    pub most: f64,
    /// At samples, or between them too.
    pub collocation: Collocation,
}

impl Limit for Feed {
    fn name(&self) -> &str {
        "feed"
    }

    fn apply(&self, samples: &Samples, table: &mut Table<'_>) {
        bound_feed(samples, self.collocation, table, |_| self.most);
    }
}
