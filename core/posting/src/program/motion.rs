//! What a CL file means: moves of the tip and the tool axis in mm in the part frame, and the steps between them.

use nalgebra::Vector3;
use post_plugin::{Compensation, Coolant, Spindle};

use post_machine::description::{Retract, Rewind};

/// One step of the program, with every modal word settled.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// The tool moves.
    Move(Motion),
    /// The tool stands here, and has not moved (`FROM`).
    From {
        /// Tip, mm, part frame.
        tip: Vector3<f64>,
        /// Tool axis, unit vector, part frame.
        axis: Vector3<f64>,
    },
    /// Tool change.
    Tool(Tool),
    /// An index axis of the part is at an angle (`ROTABL`).
    Index {
        /// `A`, `B` or `C`.
        axis: char,
        /// Radians, from the part's own frame.
        angle: f64,
    },
    /// Another head (`HEAD`).
    Head(String),
    /// The next tool is made ready.
    Preselect(u32),
    /// Spindle.
    Spindle(Spindle),
    /// Coolant.
    Coolant(Coolant),
    /// Cutter radius compensation.
    Compensate(Compensation),
    /// A remark for the operator.
    Comment(String),
    /// A line of the program, letter for letter.
    Literal(String),
    /// Wait, s.
    Dwell(f64),
    /// Stop.
    Stop,
    /// Optional stop.
    OptionalStop,
    /// To the machine's reference.
    Home,
}

impl Step {
    /// The tool leaves the part: what comes behind begins anew.
    pub(crate) fn leaves(&self) -> bool {
        matches!(
            self,
            Self::Tool(_) | Self::Home | Self::From { .. } | Self::Index { .. } | Self::Head(_)
        )
    }
}

/// A move along a straight line of the part frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Where the tip goes, mm, part frame.
    pub tip: Vector3<f64>,
    /// The tool axis there, unit vector from the tip to the holder, part frame.
    pub axis: Vector3<f64>,
    /// Leading edge of a knife or disc there, unit vector across the tool axis, part frame; zero if the file
    /// does not say.
    pub edge: Vector3<f64>,
    /// How fast.
    pub pace: Pace,
    /// How far this line strays from the curve that the CL file asks for (arcs, splines), mm, proven.
    pub chord: f64,
}

impl Motion {
    /// The motion to where the tool is drawn back to from here; none if its axis does not lead there. The point of
    /// the motion stands `along` mm above the tip.
    pub(crate) fn drawn_back(&self, rewind: &Rewind, along: f64) -> Option<Self> {
        let distance = match rewind.retract {
            Retract::Distance(distance) => distance,
            Retract::Plane(height) => {
                // Nearly level, the tool would travel for ever.
                let rise = self.axis.z;
                if rise < 0.1 {
                    return None;
                }
                (height - self.tip.z) / rise + along
            }
        };
        // A plane below the tip leads into the part.
        if distance <= 0.0 {
            return None;
        }
        Some(Self {
            tip: self.tip + self.axis * distance,
            ..*self
        })
    }
}

/// How fast a move is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pace {
    /// Rapid traverse.
    Rapid,
    /// Feed of the tip against the part, mm/min.
    PerMinute(f64),
    /// The move takes 1/F minutes.
    InverseTime(f64),
}

impl Pace {
    /// A feed in mm/min; none is rapid.
    pub(crate) fn feed_or_rapid(feed: Option<f64>) -> Self {
        feed.map_or(Self::Rapid, Self::PerMinute)
    }
}

/// A tool change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tool {
    /// Tool number.
    pub number: u32,
    /// Register of its length compensation.
    pub register: u32,
    /// Length from the gauge point to the tip, mm, if the CL file gives it.
    pub length: Option<f64>,
    /// Its name, empty if not known.
    pub name: String,
}
