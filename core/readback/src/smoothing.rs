//! How far the words of a program let the control leave the path.

use post_machine::description::Machine;
use post_motion::CornerMode;

use crate::{Corners, MachineState};

/// Rounding of what is compared, mm and radians.
const SAME: [f64; 2] = [1e-3, 1e-6];

/// How far the control may leave what is programmed, by what the program says; zero where it says nothing of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Leeway {
    /// From the path, mm.
    pub path: f64,
    /// From the tool axis there, radians.
    pub turn: f64,
    /// From the path by as much as parameters of the control say, which no program names: `G5.1 Q1`.
    pub own: bool,
}

impl MachineState {
    /// How far the control may leave what is programmed.
    pub fn leeway(&self) -> Leeway {
        let said = match self.corners {
            Corners::Said(CornerMode::Blend { tolerance }) => tolerance,
            _ => None,
        };
        Leeway {
            path: self.smoothing.or(said).unwrap_or(0.0),
            turn: self.smoothing_turn,
            own: self.corners == Corners::Own,
        }
    }
}

impl Leeway {
    /// What is to be told of it, where the program keeps within `tolerance` mm and `axis_tolerance` radians and the machine
    /// file smooths by more or less; nothing where that is enough.
    pub fn beyond(self, machine: &Machine, tolerance: f64, axis_tolerance: f64) -> Option<String> {
        let smoothing = machine.smoothing.largest();
        let most = smoothing.map_or(0.0, |smoothing| smoothing.tolerance).max(tolerance);
        // How far its own rule goes, the machine file says by the tolerances that it has words for.
        let unknown = self.own && smoothing.is_none();
        let path = (self.path > most + SAME[0] || unknown).then(|| {
            let far = match self.path {
                _ if unknown => "by as much as its parameters say".to_owned(),
                path if path.is_finite() => format!("by {path} mm"),
                _ => "by any distance".to_owned(),
            };
            format!("the control may leave the path {far}, and the tolerance is {most} mm")
        });
        let named = smoothing.and_then(|smoothing| smoothing.axis_tolerance).unwrap_or(0.0);
        let most = named.to_radians().max(axis_tolerance);
        let turns = machine.axes.iter().any(|axis| axis.joint.rotary);
        let turn = (turns && self.turn > most + SAME[1]).then(|| {
            let [far, most] = [self.turn, most].map(|angle| degrees(angle.to_degrees()));
            format!(
                "the control may turn the tool axis off by {far}°, and the tolerance is {most}°"
            )
        });
        path.into_iter().chain(turn).reduce(|path, turn| format!("{path}; {turn}"))
    }
}

/// An angle as it was written: without what turning it into radians and back has left.
fn degrees(angle: f64) -> f64 {
    libm::rint(angle * 1e6) / 1e6
}
