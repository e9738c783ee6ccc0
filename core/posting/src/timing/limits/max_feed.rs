//! `max_feed`: no axis goes faster than its largest feed.

use post_machine::description::Machine;
use post_machine::kinematics::batch::{Column, Lanes};
use post_machine::kinematics::{Joints, MAX_AXES};

use super::BlockTimeLimit;
use crate::blocks::MotionBlock;

/// Name of the limit.
pub(in crate::timing) const NAME: &str = "max_feed";

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
        NAME
    }

    fn least_minutes(&self, from: &Joints, block: &MotionBlock) -> f64 {
        // Between the words too, where the control keeps the tip.
        least_minutes(&self.slowness, block.follow.minutes, from, &block.joints)
    }
}

/// [`least_minutes`] of `count` blocks; `least` holds the times that each must take anyway.
pub(in crate::timing) fn least_minutes_all(
    slowness: &Joints,
    joints: &[Column; MAX_AXES],
    count: usize,
    least: &mut Lanes,
) {
    for (column, slowness) in joints.iter().zip(slowness) {
        // A place without an axis, or one as fast as may be, asks for no time.
        if *slowness == 0.0 {
            continue;
        }
        let pairs = column[..count].iter().zip(&column[1..=count]);
        for (least, (from, to)) in least.iter_mut().zip(pairs) {
            let minutes = (to - from).abs() * slowness;
            *least = if minutes > *least { minutes } else { *least };
        }
    }
}

/// The least time of a block from one place to another, at least `follow` minutes.
#[inline]
pub(in crate::timing) fn least_minutes(
    slowness: &Joints,
    follow: f64,
    from: &Joints,
    to: &Joints,
) -> f64 {
    let mut least = follow;
    for index in 0..MAX_AXES {
        let minutes = (to[index] - from[index]).abs() * slowness[index];
        if minutes > least {
            least = minutes;
        }
    }
    least
}
