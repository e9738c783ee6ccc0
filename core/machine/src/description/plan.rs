//! What a machine file says of planned feeds: `[plan]`.

use super::build::Builder;
use super::motion::MotionRules;
use super::plan_file::{PlanFile, PlanSolver};
use super::quantity::Quantity;
use crate::diagnostic::Short;

/// What a planned feed keeps beside the limits of axes and tip (Chen, Ren and Sun 2016).
#[derive(Clone, Debug, PartialEq)]
pub struct PlanRules {
    /// Largest contour error that the servos make of the path, mm; none: not limited.
    pub contour_error: Option<f64>,
    /// By how much the way of one interpolation period may stray from the path, mm; none: not limited.
    pub chord_error: Option<f64>,
    /// A block is cut where its feed changes if that saves at least this time, s.
    pub least_saving: f64,
    /// No block is cut into pieces that take less than this, s.
    pub shortest_block: f64,
    /// By how much the curve that is planned along may leave the path of the blocks, mm.
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

/// No error or smoothing is larger, mm.
const LONGEST: f64 = 10.0;

impl Builder<'_> {
    /// `tolerance` is that of `[accuracy]`, mm.
    pub(super) fn plan(
        &mut self,
        file: &PlanFile,
        motion: &MotionRules,
        tolerance: f64,
    ) -> PlanRules {
        let mut positive = |name: &str, said: &Option<Quantity>| {
            said.as_ref().and_then(|said| self.plan_length(name, said))
        };
        let contour_error = positive("contour_error", &file.contour_error);
        let chord_error = positive("chord_error", &file.chord_error);
        let smoothing = positive("smoothing", &file.smoothing);
        let usual = motion.block_time.max(PERIODS * motion.period);
        let shortest = &file.shortest_block;
        let shortest = shortest.as_ref().map_or(usual, |said| {
            self.seconds_of("plan", "shortest_block", said).max(motion.block_time)
        });
        let saving = file.least_saving.as_ref();
        let saving =
            saving.map_or(SAVING * shortest, |said| self.seconds_of("plan", "least_saving", said));
        PlanRules {
            contour_error,
            chord_error,
            least_saving: saving,
            shortest_block: shortest,
            smoothing: smoothing.unwrap_or(SMOOTHING * tolerance),
            solver: file
                .solver
                .as_ref()
                .map_or_else(PlanSolver::default, |solver| *solver.get_ref()),
        }
    }

    fn plan_length(&mut self, name: &str, said: &Quantity) -> Option<f64> {
        let value = self.number(said);
        if value > 0.0 && value <= LONGEST {
            return Some(value);
        }
        // What is no number was told already.
        if value.is_nan() {
            return None;
        }
        self.fault(
            "machine-plan",
            said.span(),
            format!(
                "[plan] {name} is {} mm; it must be above zero, and {LONGEST} mm at most",
                Short(value)
            ),
            "leave it out where there is no limit",
        );
        None
    }
}
