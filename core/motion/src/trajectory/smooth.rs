//! Look-ahead with jerk limits.

use super::look_ahead::{LookAhead, Part};

/// What a plan works with.
#[derive(Debug, Default)]
pub(super) struct Work {}

impl Work {
    pub fn forget(&mut self) {}

    pub fn settle(&mut self, ahead: &mut LookAhead, done: usize, take: &mut dyn FnMut(Part)) {
        let _ = (ahead, done, take);
    }
}
