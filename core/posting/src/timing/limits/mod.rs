//! What keeps a block from being faster: each limit a file of its own, and a line in [`of`].

mod face;
pub(super) mod max_feed;
mod planned;

use post_machine::description::Machine;
use post_machine::kinematics::Joints;

use crate::blocks::MotionBlock;

/// A limit of the machine.
pub trait BlockTimeLimit: std::fmt::Debug {
    /// Name of the limit for a block that it limits, as the machine file has it.
    fn name(&self, block: &MotionBlock) -> &'static str;

    /// An axis cannot do more; else it is a wish that the least feed that is printed may pass.
    fn must_hold(&self) -> bool {
        true
    }

    /// The least time of a block that begins with the axes at `from` (mm, radians), minutes.
    fn least_minutes(&self, from: &Joints, block: &MotionBlock) -> f64;
}

/// The limits that hold on a machine.
pub fn of(machine: &Machine) -> Vec<Box<dyn BlockTimeLimit>> {
    let mut limits: Vec<Box<dyn BlockTimeLimit>> =
        vec![Box::new(max_feed::MaxFeed::new(machine)), Box::new(planned::PlannedFeed)];
    if let Some(mode) = &machine.face {
        limits.push(Box::new(face::TurningFeed::new(mode)));
    }
    limits
}
