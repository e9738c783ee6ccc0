//! Sums and extremes of a run, for the report.

use crate::report::Deviation;
use post_machine::kinematics::{Joints, MAX_AXES};

/// Sums and extremes for the report.
#[derive(Clone, Debug)]
pub struct Tally {
    /// Moves taken.
    pub moves: u64,
    /// Blocks with a motion.
    pub blocks: u64,
    /// Points put in.
    pub points_added: u64,
    /// CL points that no block ends on.
    pub points_dropped: u64,
    /// Cuts: tip (mm), tool axis (radians); rapids: tip (mm).
    pub deviations: [Deviation; 3],
    /// Least axis values.
    pub least: Joints,
    /// Largest axis values.
    pub most: Joints,
    /// Way of each axis over all blocks, mm or radians.
    pub travel: Joints,
    /// Times that another branch or another full turn was taken.
    pub branch_changes: u64,
    /// Times that the tool was drawn back in a cut to go on otherwise.
    pub rewinds: u64,
    /// Points at which a rotary axis was held or turned early close to a pole.
    pub eased: u64,
    /// Minutes of cuts.
    pub cutting: f64,
    /// Minutes of rapids and dwells.
    pub other: f64,
    /// Blocks slowed down by an axis.
    pub limited: u64,
    /// Lines of text.
    pub lines: u64,
}

pub(super) const TIP: usize = 0;
pub(super) const AXIS: usize = 1;
pub(super) const RAPID: usize = 2;

impl Tally {
    pub(super) fn new() -> Self {
        Self {
            moves: 0,
            blocks: 0,
            points_added: 0,
            points_dropped: 0,
            deviations: [Deviation::default(); 3],
            least: [f64::INFINITY; MAX_AXES],
            most: [f64::NEG_INFINITY; MAX_AXES],
            travel: [0.0; MAX_AXES],
            branch_changes: 0,
            rewinds: 0,
            eased: 0,
            cutting: 0.0,
            other: 0.0,
            limited: 0,
            lines: 0,
        }
    }

    /// Keeps the range of each axis.
    #[inline]
    pub(super) fn reach(&mut self, joints: &Joints, axes: usize) {
        for (index, value) in joints.iter().take(axes).enumerate() {
            self.least[index] = self.least[index].min(*value);
            self.most[index] = self.most[index].max(*value);
        }
    }

    /// Adds a block's way of each axis.
    #[inline]
    pub(super) fn go(&mut self, from: &Joints, to: &Joints) {
        for index in 0..MAX_AXES {
            self.travel[index] += (to[index] - from[index]).abs();
        }
    }
}
