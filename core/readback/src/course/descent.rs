//! The way down from a retract: a matter of the machine, and not of the part.

use post_machine::kinematics::Joints;

use crate::Motion;

/// What an axis moves by less is the rounding of words, mm or degrees.
const ROUNDED: f64 = 0.01;

/// A way of one linear axis alone, from about where the machine stood at `retracted` on: how long that way is depends on
/// where the axes of this machine end, and on which words its control takes the tool there by.
pub(crate) fn comes_down(motion: &Motion, retracted: &Joints) -> bool {
    let [from, to] = [&motion.from.joints, &motion.to.joints];
    let mut moved = (0..from.len()).filter(|joint| libm::fabs(to[*joint] - from[*joint]) > ROUNDED);
    let (Some(joint), None) = (moved.next(), moved.next()) else {
        return false;
    };
    let by = to[joint] - from[joint];
    let above = from[joint] - retracted[joint];
    !motion.state.solver.chain().joints()[joint].rotary
        && above * by >= 0.0
        && libm::fabs(above) <= libm::fabs(by) + ROUNDED
}
