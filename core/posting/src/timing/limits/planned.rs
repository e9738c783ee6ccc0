//! The planned feed, which keeps limits of its own.

use post_machine::kinematics::Joints;

use super::BlockTimeLimit;
use crate::blocks::MotionBlock;

/// What the planning stage left a block.
#[derive(Debug)]
pub(super) struct PlannedFeed;

impl BlockTimeLimit for PlannedFeed {
    fn name(&self, block: &MotionBlock) -> &'static str {
        block.planned.limit.unwrap_or("plan")
    }

    fn must_hold(&self) -> bool {
        false
    }

    fn least_minutes(&self, _: &Joints, block: &MotionBlock) -> f64 {
        block.planned.minutes
    }
}
