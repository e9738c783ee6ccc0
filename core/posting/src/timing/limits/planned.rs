//! The planned feed, which keeps limits of its own.

use post_machine::kinematics::Joints;

use super::Limit;
use crate::blocks::Block;

/// What the planning stage left a block.
#[derive(Debug)]
pub(super) struct PlannedFeed;

impl Limit for PlannedFeed {
    fn name(&self, block: &Block) -> &'static str {
        block.planned.limit.unwrap_or("plan")
    }

    fn must_hold(&self) -> bool {
        false
    }

    fn least_minutes(&self, _: &Joints, block: &Block) -> f64 {
        block.planned.minutes
    }
}
