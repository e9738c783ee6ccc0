//! Block processing time of the control.

use super::{Collocation, Limit, SampleRange, least_of_blocks};
use crate::samples::Samples;
use crate::table::LimitTable;

/// A control that needs `seconds` to prepare a block must not finish one sooner: the speed on a block of length `l`
/// stays below `l / seconds`, everywhere on the block. Lengths are [`Samples::blocks`].
#[derive(Clone, Copy, Debug)]
pub struct BlockTime {
    /// Least time of a block, s.
    pub seconds: f64,
    /// Where the limit is kept: only between samples too does a block that ends between two of them bound both.
    pub collocation: Collocation,
}

impl Limit for BlockTime {
    fn name(&self) -> &'static str {
        "block time"
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        for place in SampleRange::all(samples, self.collocation) {
            let length = least_of_blocks(&samples.blocks, &place);
            place.bound(table, length / self.seconds);
        }
    }
}
