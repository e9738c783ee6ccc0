//! Block processing time of the control.

use super::{Collocation, Limit};
use crate::problem::Table;
use crate::samples::Samples;

/// A control that needs `seconds` to prepare a block must not finish one sooner: the speed on a block of length `l`
/// stays below `l / seconds`, everywhere on the block. Lengths are [`Samples::blocks`].
#[derive(Clone, Copy, Debug)]
pub struct BlockTime {
    /// Least time of a block, s.
    pub seconds: f64,
    /// At samples, or between them too: only then a block that ends between two samples bounds both.
    pub collocation: Collocation,
}

impl Limit for BlockTime {
    fn name(&self) -> &str {
        "block time"
    }

    fn apply(&self, samples: &Samples, table: &mut Table<'_>) {
        for (sample, length) in samples.blocks.iter().enumerate() {
            let speed = length / self.seconds;
            table.lower(sample, speed * speed, None);
            if self.collocation == Collocation::Throughout && sample + 1 < samples.len() {
                table.lower(sample + 1, speed * speed, None);
            }
        }
    }
}
