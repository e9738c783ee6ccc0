//! What a block takes at most without a plan: from rest to rest, each axis by its own limits.

use post_machine::kinematics::Joints;

use super::limits::PlanAxes;

/// A plan may keep errors that moving from rest to rest does not: only one that takes this many times longer is discarded.
const FAR_SLOWER: f64 = 1e4;

/// The limits of the axes, by place in the chain.
#[derive(Clone, Debug)]
pub(super) struct RestToRest {
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
    jerk: Vec<f64>,
}

impl RestToRest {
    pub(super) fn new(axes: &PlanAxes) -> Self {
        let [velocity, acceleration, jerk] = axes.of_joints();
        Self { velocity, acceleration, jerk }
    }

    /// Is a plan of `planned` s for a block of `asked` s slower than any control would be without one? It would at worst
    /// stand still at both ends.
    pub(super) fn is_passed(&self, planned: f64, asked: f64, from: &Joints, to: &Joints) -> bool {
        let axes = self.velocity.iter().zip(&self.acceleration).zip(&self.jerk);
        let ways = axes.zip(from.iter().zip(to));
        let slowest = ways
            .map(|(((velocity, acceleration), jerk), (from, to))| {
                let way = libm::fabs(to - from);
                way / velocity
                    + 2.0 * libm::sqrt(way / acceleration)
                    + libm::cbrt(32.0 * way / jerk)
            })
            .fold(0.0, f64::max);
        let least = FAR_SLOWER * (slowest + asked);
        planned.is_nan() || planned > least
    }
}
