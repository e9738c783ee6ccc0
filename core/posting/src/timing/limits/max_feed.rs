//! `max_feed`: no axis goes faster than its largest feed.

use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES};

use super::BlockTimeLimit;
use crate::blocks::MotionBlock;

/// Largest feeds of the axes.
#[derive(Debug)]
pub(super) struct MaxFeed {
    /// Minutes that each axis needs for one mm or radian at its largest feed; none for places without an axis.
    slowness: Joints,
}

impl MaxFeed {
    pub(super) fn new(machine: &Machine) -> Self {
        Self { slowness: machine.slowness() }
    }
}

impl BlockTimeLimit for MaxFeed {
    fn name(&self, _: &MotionBlock) -> &'static str {
        "max_feed"
    }

    fn least_minutes(&self, from: &Joints, block: &MotionBlock) -> f64 {
        let to = &block.joints;
        // Between the words too, where the control keeps the tip.
        let mut least = block.follow.minutes;
        for index in 0..MAX_AXES {
            let minutes = (to[index] - from[index]).abs() * self.slowness[index];
            if minutes > least {
                least = minutes;
            }
        }
        least
    }
}
