//! What a machine file says of planned feeds: `[plan]`.

use super::bounds::Bounds;
use super::build::Builder;
use super::motion::{self, MotionRules};
use super::quantity::KeyedNumber;
use super::table::{Spanned, keys, words};

/// Errors and smoothing.
const DISTANCE: Bounds = Bounds {
    table: "[plan] ",
    farthest: 10.0,
    says: " mm; it must be above zero, and 10 mm at most",
    help: "leave it out where there is no limit",
    ..Bounds::above_zero("machine-plan")
};

const WAIT: Bounds = Bounds { table: "[plan] ", ..motion::WAIT };

keys! {
    /// What a planned feed (`post --plan`) keeps, beside the limits of the axes and of the tip. What is posted without a plan
    /// does not depend on it.
    PlanFile {
        /// Largest contour error that the servos make of the path, mm; not limited if not said. The axes need servos for it.
        contour_error: Option<KeyedNumber> = DISTANCE,
        /// By how much the way of one interpolation period may stray from the path, mm; not limited if not said.
        chord_error: Option<KeyedNumber> = DISTANCE,
        /// A block is cut where its feed changes if that saves at least this time, s; a fifth of shortest_block if not said.
        least_saving: Option<KeyedNumber> = WAIT,
        /// No block is cut into pieces that take less than this, s; if not said two periods of [motion], and its block_time
        /// at least.
        shortest_block: Option<KeyedNumber> = WAIT,
        /// By how much the curve that is planned along may leave the path of the blocks, mm; half the tolerance of
        /// [accuracy] if not said.
        smoothing: Option<KeyedNumber> = DISTANCE,
        /// Which solver plans; reach if not said.
        solver: Option<Spanned<PlanSolver>>,
    }
}

words! {
    /// What plans feeds.
    PlanSolver = Reach {
        /// Reachability analysis: velocity, acceleration and errors, in linear time.
        Reach "reach",
        /// Jerk is kept too; a hundred times slower.
        Jerk "jerk",
    }
}

/// What a planned feed keeps beside the limits of axes and tip (Chen, Ren and Sun 2016).
#[derive(Clone, Debug, PartialEq)]
pub struct PlanRules {
    /// Largest contour error that the servos make of the path, mm; none: not limited.
    pub contour_error: Option<f64>,
    /// Distance by which the way of one interpolation period may stray from the path, mm; none: not limited.
    pub chord_error: Option<f64>,
    /// A block is cut where its feed changes if that saves at least this time, s.
    pub least_saving: f64,
    /// No block is cut into pieces that take less than this, s.
    pub shortest_block: f64,
    /// Distance by which the curve that is planned along may leave the path of the blocks, mm.
    pub smoothing: f64,
    /// Which solver plans.
    pub solver: PlanSolver,
}

/// The shortest block where the file does not say, periods of the control.
const PERIODS: f64 = 2.0;

/// What a cut saves where the file does not say, in shortest blocks.
const SAVING: f64 = 0.2;

/// The share of the tolerance that smoothing may take where the file does not say.
const SMOOTHING: f64 = 0.5;

impl Builder<'_> {
    /// `tolerance` is that of `[accuracy]`, mm.
    pub(super) fn plan(
        &mut self,
        file: &PlanFile,
        motion: &MotionRules,
        tolerance: f64,
    ) -> PlanRules {
        let contour_error = self.checked(&file.contour_error);
        let chord_error = self.checked(&file.chord_error);
        let smoothing = self.checked(&file.smoothing);
        let shortest_block = match self.checked(&file.shortest_block) {
            Some(said) => said.max(motion.block_time),
            None => motion.block_time.max(PERIODS * motion.period),
        };
        PlanRules {
            contour_error,
            chord_error,
            least_saving: self.checked(&file.least_saving).unwrap_or(SAVING * shortest_block),
            shortest_block,
            smoothing: smoothing.unwrap_or(SMOOTHING * tolerance),
            solver: file.solver.as_ref().map(|solver| *solver.get_ref()).unwrap_or_default(),
        }
    }
}
