//! There is no terminal: bars that nobody sees.

use post_job::session::Bar;

/// None is shown.
pub fn bytes(_: Option<u64>) -> BytesProgress {
    BytesProgress
}

/// How many bytes are read.
pub struct BytesProgress;

impl Bar for BytesProgress {
    fn set(&self, _: u64) {}
}

/// How many of so many jobs are done.
pub struct JobsProgress;

impl JobsProgress {
    /// None is shown.
    pub fn new(_: u64) -> Self {
        Self
    }

    /// So many are done, so many of them refused.
    pub fn at(&self, _: u64, _: u64) {}

    /// There is nothing to take away.
    pub fn finish(&self) {}
}
