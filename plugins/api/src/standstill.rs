//! What a stop of the program has switched off, until the tool needs it again.

use crate::Event;

/// Spindle and coolant that a stop has switched off: on again before the next cut, and not in between. An operator
/// stands at an open door, and a tool change after the stop would switch both off once more.
#[derive(Clone, Copy, Debug, Default)]
pub struct Standstill {
    /// The last motion was a cut: the tool may stand in the part.
    cut: bool,
    /// Whether the stop did so.
    in_part: bool,
    spindle: bool,
    coolant: bool,
}

impl Standstill {
    /// The program stops, and the control switches off what is named.
    pub fn stop(&mut self, spindle: bool, coolant: bool) {
        self.spindle |= spindle;
        self.coolant |= coolant;
        self.in_part = self.cut;
    }

    /// Whether the spindle, and the coolant, must be on again ahead of `event`. To be asked of every event, in order.
    #[inline]
    pub fn before(&mut self, event: &Event<'_>) -> [bool; 2] {
        let due = match event {
            Event::Linear { .. } | Event::Cuts { .. } | Event::Arc { .. } | Event::Spline { .. } => {
                self.cut = true;
                true
            }
            Event::Cycle { .. }
            | Event::CyclePoint { .. }
            | Event::Probe { .. }
            | Event::Position { .. }
            // It is not known what they do.
            | Event::Literal { .. }
            | Event::Subprogram { .. } => {
                self.cut = false;
                true
            }
            // A spindle that stands tears on the way out of the part.
            Event::Rapid { .. } | Event::Retract { .. } => {
                self.cut = false;
                std::mem::take(&mut self.in_part)
            }
            Event::Spindle(_) | Event::SurfaceSpeed { .. } => {
                self.spindle = false;
                false
            }
            Event::Coolant(_) => {
                self.coolant = false;
                false
            }
            Event::ToolChange { .. } => {
                (self.spindle, self.coolant) = (false, false);
                false
            }
            _ => false,
        };
        match due && (self.spindle || self.coolant) {
            true => [&mut self.spindle, &mut self.coolant].map(std::mem::take),
            false => [false; 2],
        }
    }
}
