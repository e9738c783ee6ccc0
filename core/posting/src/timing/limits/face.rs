//! The turning axis while the control interpolates in polar coordinates: the nearer to its line, the slower the tool.

use post_machine::face_mode::FaceMode;
use post_machine::kinematics::Joints;

use super::BlockTimeLimit;
use crate::blocks::MotionBlock;

/// Largest feed of the axis that turns the part.
#[derive(Debug)]
pub(super) struct TurningFeed {
    mode: FaceMode,
}

impl TurningFeed {
    pub(super) fn new(mode: &FaceMode) -> Self {
        Self { mode: mode.clone() }
    }
}

impl BlockTimeLimit for TurningFeed {
    fn name(&self, _: &MotionBlock) -> &'static str {
        "max_feed"
    }

    /// Those of both real axes on the face.
    fn least_minutes(&self, from: &Joints, block: &MotionBlock) -> f64 {
        let [from, to] = [from, &block.joints].map(|joints| self.mode.place(joints));
        self.mode.least_minutes(from, to)
    }
}
