//! What a CL file means: moves and curves of the tip and the tool axis in mm in the part frame, and the commands
//! between them.

use nalgebra::Vector3;
use post_machine::description::{Retract, Rewind, Smoothing};
use post_machine::wait_rule::WaitLine;
use post_motion::path::BSpline;
use post_plugin::{Compensation, Coolant, Spindle, SpindleSense};

use super::{DrillCycle, PathArc};

/// One step of the program, with every modal word settled. Curves and cycles keep their shape: whether they are
/// written as such or as moves is for dialect and machine to say.
#[derive(Clone, Debug, PartialEq)]
pub enum ProgramStep {
    /// Along a straight line.
    Move(StraightMove),
    /// Along an arc or a helix.
    Arc(Box<ArcStep>),
    /// Along a spline.
    Spline(Box<SplineStep>),
    /// A cycle at one point.
    Cycle(Box<CycleStep>),
    /// The cycle in force ends (`CYCLE/OFF`).
    EndCycle,
    /// The points that follow lie in a plane that the CL file names, until it names another or none.
    Plane(Option<Box<PlaneStep>>),
    /// Not a motion.
    Command(Command),
}

/// What the CL file asks of the control between the motions.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// The tool stands here, and has not moved (`FROM`).
    From {
        /// Tip, mm, part frame.
        tip: Vector3<f64>,
        /// Tool axis, unit vector, part frame.
        axis: Vector3<f64>,
    },
    /// Tool change.
    Tool(ToolChange),
    /// An index axis of the part is at an angle (`ROTABL`).
    Index {
        /// `A`, `B` or `C`.
        axis: char,
        /// Angle from the part's own frame, radians.
        angle: f64,
    },
    /// Another head (`HEAD`).
    Head(String),
    /// The next tool is made ready.
    Preselect(u32),
    /// Spindle.
    Spindle(Spindle),
    /// The spindle turns at a constant cutting speed.
    SurfaceSpeed {
        /// Cutting speed, m/min.
        speed: f64,
        /// Revolutions a minute that it must not exceed, if the CL file says so.
        most: Option<f64>,
        /// Sense of rotation.
        sense: SpindleSense,
    },
    /// Coolant.
    Coolant(Coolant),
    /// Cutter radius compensation.
    Compensate(Compensation),
    /// An operation of the CAM system begins, by this name.
    Operation(String),
    /// The operation ends.
    OperationEnd,
    /// A remark for the operator.
    Comment(String),
    /// A text for the control's screen.
    Message(String),
    /// The work offset of this number holds from here on, the tool retracted: from 1.
    WorkOffset(u32),
    /// A subprogram of the control runs, by its number. Where the tool stands after it is not known.
    Subprogram(u32),
    /// The tool comes near anew, and the control may leave the path by other tolerances from there on; none: as it does
    /// by default.
    Smoothing(Option<Smoothing>),
    /// A line of the program, letter for letter.
    Literal(String),
    /// Wait, s.
    Dwell(f64),
    /// The program waits for those of other channels at a mark.
    Sync(SyncWait),
    /// Stop.
    Stop,
    /// Optional stop.
    OptionalStop,
    /// The tool is retracted and the axes are parked.
    Home,
    /// The tool is retracted, spindle and coolant rest, and it comes near anew.
    Retract {
        /// They stay at rest until they are switched on; else they are as before once it comes near.
        forgets: bool,
    },
    /// The tool is retracted, and comes near anew.
    Leave,
}

impl Command {
    /// The tool leaves the part: what comes after begins anew.
    pub(crate) fn leaves(&self) -> bool {
        matches!(
            self,
            Self::Tool(_)
                | Self::Home
                | Self::Retract { .. }
                | Self::Leave
                | Self::From { .. }
                | Self::Index { .. }
                | Self::Head(_)
                | Self::WorkOffset(_)
                | Self::Subprogram(_)
                | Self::Smoothing(_)
        )
    }
}

/// A wait for other channels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyncWait {
    /// The mark of the CL file.
    pub mark: u32,
    /// The line of the program, and the channels that wait.
    pub line: WaitLine,
}

/// A move along a straight line of the part frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightMove {
    /// Where the tip goes, mm, part frame.
    pub tip: Vector3<f64>,
    /// The tool axis there, unit vector from the tip to the holder, part frame.
    pub axis: Vector3<f64>,
    /// Where the leading edge of a knife or disc is headed there, unit vector, part frame; it may lean: its part across
    /// the tool axis is meant. Zero if the file does not say.
    pub edge: Vector3<f64>,
    /// How fast.
    pub pace: MoveFeed,
    /// How far this line strays from the curve that the CL file asks for (arcs, splines), mm, proven.
    pub chord: f64,
}

/// An arc, a helix, or a spiral between two radii.
#[derive(Clone, Debug, PartialEq)]
pub struct ArcStep {
    /// Shape of the arc in the part frame.
    pub arc: PathArc,
    /// The move to its end, whose pace is that of the whole arc.
    pub end: StraightMove,
    /// The tool axis at its start, part frame; it turns evenly to that of the end.
    pub start_axis: Vector3<f64>,
}

/// A spline that begins where the tool stands.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineStep {
    /// Shape of the spline in the part frame.
    pub spline: BSpline,
    /// The move to its end.
    pub end: StraightMove,
}

/// A cycle at one point: what is done there, along the tool axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleStep {
    /// The cycle in force.
    pub cycle: DrillCycle,
    /// The point that its heights count from, and its feed.
    pub point: StraightMove,
}

/// A plane that stays for an operation, the tool standing upright on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneStep {
    /// X, Y and Z axes of the plane as unit vectors of the part frame.
    pub axes: [Vector3<f64>; 3],
}

impl StraightMove {
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
        Some(Self { tip: self.tip + self.axis * distance, ..*self })
    }
}

/// How fast a move is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MoveFeed {
    /// Rapid traverse.
    Rapid,
    /// Feed of the tip against the part, mm/min.
    PerMinute(f64),
    /// The move takes 1/F minutes.
    InverseTime(f64),
    /// Feed of the tip in a revolution of the part, mm: how long it takes follows where the blocks are.
    PerRevolution(f64),
}

impl MoveFeed {
    /// A feed in mm/min; none is rapid.
    pub(crate) fn feed_or_rapid(feed: Option<f64>) -> Self {
        feed.map_or(Self::Rapid, Self::PerMinute)
    }
}

/// A tool change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ToolChange {
    /// Tool number.
    pub number: u32,
    /// Register of its length compensation.
    pub register: u32,
    /// Length from the gauge point to the tip, mm, if the CL file gives it.
    pub length: Option<f64>,
    /// Diameter of its cutter, mm, if the CL file describes it before it loads the tool.
    pub diameter: Option<f64>,
    /// Corner radius of the cutter, mm, likewise.
    pub corner_radius: Option<f64>,
    /// Name of the tool, empty if not known.
    pub name: String,
}
