//! The way down from a retract: a matter of the machine, and not of the part.

use post_machine::kinematics::Joints;

use crate::{Curve, Interpolation, Motion};

/// What an axis moves by less is the rounding of words, mm or degrees.
const ROUNDED: f64 = 0.01;

/// A tip that goes along the tool is off its line by no more than words round, mm, and by this share of the way.
const ASIDE: f64 = 0.005;
const LEAN: f64 = 1e-4;

/// Where a way down leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Descent {
    /// The first position.
    ToPoint,
    /// Aside of the tool's own line, perhaps to where it goes in along it.
    ToLine,
}

/// A way of one linear axis alone or along the tool, from about where the machine stood at `retracted` on, or `on_line`: from
/// where another such way led to the tool's own line. How long it is depends on where the axes of this machine end, and on
/// which words its control takes the tool there by.
pub(crate) fn descends(motion: &Motion, retracted: &Joints, on_line: bool) -> Option<Descent> {
    let [from, to] = [&motion.from.joints, &motion.to.joints];
    let joints = motion.state.solver.chain().joints();
    let moves = |joint: &usize| libm::fabs(to[*joint] - from[*joint]) > ROUNDED;
    let from_retract = |joint: usize| {
        let by = to[joint] - from[joint];
        let above = from[joint] - retracted[joint];
        above * by >= 0.0 && libm::fabs(above) <= libm::fabs(by) + ROUNDED
    };
    let (mut count, mut slides, mut retracts) = (0, true, false);
    for joint in (0..joints.len()).filter(moves) {
        count += 1;
        slides &= !joints[joint].rotary;
        retracts |= from_retract(joint);
    }
    let along = goes_in(motion);
    let descends = slides && (retracts && (along || count == 1) || on_line && along);
    let to_point = along || motion.way != Interpolation::Tip(Curve::Straight);
    descends.then_some(match to_point {
        true => Descent::ToPoint,
        false => Descent::ToLine,
    })
}

/// The tip goes along the tool, away from its holder.
fn goes_in(motion: &Motion) -> bool {
    let way = motion.to.pose.tip - motion.from.pose.tip;
    let axis = motion.to.pose.axis;
    way.dot(&axis) < 0.0 && way.cross(&axis).norm() <= ASIDE + LEAN * way.norm()
}
