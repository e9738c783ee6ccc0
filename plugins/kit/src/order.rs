//! The order in which a dialect is sent events: what the host promises, as a table to read and a watch that holds it.

use post_plugin::{Compensation, Event, Spindle};

/// When each kind of event comes, by its name. *Away* is from the start, a retract or a tool change to the first
/// position after it; *at the part* is from there to the next retract.
pub const ORDER: &[(&str, &str)] = &[
    ("Start", "first, once"),
    ("Comment", "anywhere"),
    ("Literal", "anywhere but in a cycle"),
    ("ToolChange", "away, spindle and coolant off; no plane, no cycle, no compensation"),
    ("Preselect", "anywhere but in a cycle"),
    ("Spindle", "anywhere but in a cycle"),
    ("Coolant", "anywhere but in a cycle"),
    ("Compensate", "anywhere but in a cycle"),
    ("Position", "away: ends it"),
    ("Retract", "at the part, or behind the start, a tool change or a `Word`; not in a cycle"),
    ("Rapid", "at the part, not in a cycle"),
    ("Linear", "at the part, not in a cycle"),
    ("Dwell", "anywhere but in a cycle"),
    ("Stop", "anywhere but in a cycle"),
    ("OptionalStop", "anywhere but in a cycle"),
    ("Park", "away, no plane"),
    ("End", "last, once: away, no plane"),
    ("Turn", "away, no plane"),
    ("Word", "anywhere but in a cycle"),
    ("Operation", "anywhere but in a cycle; none is open"),
    ("OperationEnd", "behind its `Operation`, not in a cycle"),
    ("Message", "anywhere but in a cycle"),
    ("Units", "away, no plane"),
    ("WorkOffset", "away, no plane"),
    ("Offsets", "anywhere but in a cycle"),
    ("SurfaceSpeed", "anywhere but in a cycle"),
    ("Tcp", "on: away; off: in front of a retract; no plane"),
    ("Plane", "away, no plane before it"),
    ("PlaneOff", "away, behind its `Plane`"),
    ("Smoothing", "away, no plane"),
    ("SmoothingOff", "away, no plane, behind a `Smoothing`"),
    ("Clamp", "anywhere but in a cycle"),
    ("Arc", "at the part, not in a cycle"),
    ("Spline", "at the part, not in a cycle"),
    ("Cycle", "at the part, no compensation"),
    ("CyclePoint", "in a cycle, at least one"),
    ("CycleOff", "in a cycle, behind its points"),
    ("Surface", "at the part, not in a cycle"),
    ("Compensate3d", "anywhere but in a cycle"),
    ("Subprogram", "away, no plane"),
    ("Probe", "at the part, not in a cycle"),
    ("Instead", "in front of the event that it stands for"),
    ("Cuts", "at the part, not in a cycle"),
    ("WordLetter", "at the part, not in a cycle"),
    ("Pose", "at the part, in front of a `Linear`"),
];

/// Follows a program, and says where it breaks the promised order.
#[derive(Clone, Debug, Default)]
pub struct EventOrder {
    started: bool,
    ended: bool,
    at_part: bool,
    /// A retract has been sent since the last motion, and no tool change or line of the machine's own after it.
    retracted: bool,
    turning: bool,
    flowing: bool,
    compensated: bool,
    plane: bool,
    /// Number of points of the cycle in force.
    cycle: Option<u32>,
    operation: bool,
    smoothing: bool,
    instead: bool,
}

impl EventOrder {
    /// The next event.
    ///
    /// # Errors
    /// What it may not come before or after, in a sentence.
    pub fn next(&mut self, event: &Event<'_>) -> Result<(), String> {
        self.check(event).map_err(|lack| format!("{} comes {lack}", event.name()))?;
        self.take(event);
        Ok(())
    }

    fn check(&self, event: &Event<'_>) -> Result<(), &'static str> {
        let unless = |fault: bool, lack: &'static str| if fault { Err(lack) } else { Ok(()) };
        let away = || unless(self.at_part, "at the part, before a retract");
        let no_plane = || unless(self.plane, "inside a tilted plane");
        match event {
            Event::Start => return unless(self.started, "a second time"),
            _ => unless(!self.started, "before the start")?,
        }
        unless(self.ended, "behind the end")?;
        let of_cycle = matches!(
            event,
            Event::Cycle { .. }
                | Event::CyclePoint { .. }
                | Event::CycleOff
                | Event::Comment { .. }
                | Event::Instead { .. }
        );
        unless(self.cycle.is_some() && !of_cycle, "while a cycle is in force")?;
        match event {
            Event::ToolChange { .. } => {
                away()?;
                no_plane()?;
                unless(self.turning, "while the spindle turns")?;
                unless(self.flowing, "while the coolant flows")?;
                unless(self.compensated, "under cutter compensation")
            }
            Event::Position { .. } => unless(self.at_part, "without a retract since the last move"),
            Event::Retract { .. } => unless(self.retracted, "twice without a move between"),
            Event::Rapid { .. }
            | Event::Linear { .. }
            | Event::Cuts { .. }
            | Event::Arc { .. }
            | Event::Spline { .. }
            | Event::Surface { .. }
            | Event::WordLetter { .. }
            | Event::Pose { .. }
            | Event::Probe { .. } => unless(!self.at_part, "before a first position"),
            Event::Park { .. }
            | Event::Turn { .. }
            | Event::Units(_)
            | Event::WorkOffset { .. }
            | Event::Subprogram { .. }
            | Event::End => {
                away()?;
                no_plane()
            }
            Event::Plane { .. } => {
                away()?;
                unless(self.plane, "inside another plane")
            }
            Event::PlaneOff => {
                away()?;
                unless(!self.plane, "without a plane")
            }
            Event::Cycle { .. } => {
                unless(!self.at_part, "before a first position")?;
                unless(self.cycle == Some(0), "behind a cycle without a point")?;
                unless(self.compensated, "under cutter compensation")
            }
            Event::CyclePoint { .. } => unless(self.cycle.is_none(), "without a cycle"),
            Event::CycleOff => {
                unless(self.cycle.is_none(), "without a cycle")?;
                unless(self.cycle == Some(0), "behind a cycle without a point")
            }
            Event::Operation { .. } => unless(self.operation, "inside another operation"),
            Event::OperationEnd => unless(!self.operation, "without an operation"),
            Event::Tcp { on } => {
                unless(*on && self.at_part, "at the part, before a retract")?;
                no_plane()
            }
            Event::Smoothing { .. } => {
                away()?;
                no_plane()
            }
            Event::SmoothingOff => {
                away()?;
                no_plane()?;
                unless(!self.smoothing, "without smoothing")
            }
            Event::Instead { .. } => unless(self.instead, "in front of another one"),
            _ => Ok(()),
        }
    }

    fn take(&mut self, event: &Event<'_>) {
        self.instead = matches!(event, Event::Instead { .. });
        match event {
            Event::Start => self.started = true,
            Event::End => self.ended = true,
            Event::Retract { .. } => (self.at_part, self.retracted) = (false, true),
            Event::ToolChange { .. } => (self.at_part, self.retracted) = (false, false),
            Event::Position { .. } => (self.at_part, self.retracted) = (true, false),
            // Another head may have moved the depth.
            Event::Word { .. } => self.retracted = false,
            Event::Spindle(spindle) => self.turning = matches!(spindle, Spindle::On { .. }),
            Event::SurfaceSpeed { .. } => self.turning = true,
            Event::Coolant(coolant) => self.flowing = *coolant != post_plugin::Coolant::Off,
            Event::Compensate(side) => self.compensated = *side != Compensation::Off,
            Event::Plane { .. } => self.plane = true,
            Event::PlaneOff => self.plane = false,
            Event::Cycle { .. } => self.cycle = Some(0),
            Event::CyclePoint { .. } => self.cycle = self.cycle.map(|points| points + 1),
            Event::CycleOff => self.cycle = None,
            Event::Operation { .. } => self.operation = true,
            Event::OperationEnd => self.operation = false,
            Event::Smoothing { .. } => self.smoothing = true,
            Event::SmoothingOff => self.smoothing = false,
            _ => {}
        }
    }
}
