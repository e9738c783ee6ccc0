//! How far the words of a program let the control leave the path.

use post_machine::description::Machine;
use post_motion::CornerMode;

use crate::{Corners, MachineState};

/// Rounding of what is compared, mm.
const SAME: f64 = 1e-3;

impl MachineState {
    /// How far the control may leave the path by what the program says, mm; zero where it says nothing of it.
    pub fn off_path(&self) -> f64 {
        let said = match self.corners {
            Corners::Said(CornerMode::Blend { tolerance }) => tolerance,
            _ => None,
        };
        self.smoothing.or(said).unwrap_or(0.0)
    }
}

/// What is to be told of a control that may leave the path by `off_path` mm, where the program keeps within `tolerance` mm and
/// the machine file smooths by more or less; none where that is enough.
pub fn smooths_beyond(off_path: f64, machine: &Machine, tolerance: f64) -> Option<String> {
    let most = machine.smoothing.largest().unwrap_or(0.0).max(tolerance);
    let far = match off_path {
        off_path if off_path <= most + SAME => return None,
        off_path if off_path.is_finite() => format!("by {off_path} mm"),
        _ => "by any distance".to_owned(),
    };
    Some(format!("the control may leave the path {far}, and the tolerance is {most} mm"))
}
