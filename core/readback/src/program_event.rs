//! What a program or a CL file asks for besides motion, in the same words for both, so that they can be compared.

use nalgebra::Vector3;
use post_grammar::SyncMark;
use post_machine::description::surface_rpm_on_way;

/// What a block asks for that is no motion: tool, spindle, coolant, wait, stop, remark, offset.
#[derive(Clone, Debug, PartialEq)]
pub enum ProgramEvent {
    /// This tool is in the spindle now.
    ToolChange {
        /// Its number; none where only a name is given.
        number: Option<u32>,
        /// Its name.
        name: Option<String>,
    },
    /// This tool is made ready.
    Preselect(u32),
    /// The spindle from here on.
    Spindle(SpindleState),
    /// Coolants from here on.
    Coolant(Coolants),
    /// The program waits, seconds; for so many revolutions where `revolutions` is set.
    Dwell {
        /// How long.
        time: f64,
        /// In turns of the spindle.
        revolutions: bool,
    },
    /// The program waits for those of other channels, at this mark of the CL file: the channels are those
    /// that the line of the program names.
    Sync(SyncMark),
    /// `M0`.
    Stop,
    /// `M1`.
    OptionalStop,
    /// An operation of this name begins.
    Operation(String),
    /// A remark.
    Remark(String),
    /// A message to the operator.
    Message(String),
    /// Radius compensation: -1 left, 1 right, 0 off; and its register.
    Compensation {
        /// The side.
        side: i8,
        /// The register.
        register: Option<u32>,
    },
    /// Work offset of this name: `G54`, `G54.1 P3`; of a CL file its number as text.
    WorkOffset(String),
    /// The head of this name is swapped in.
    Head(String),
    /// A subprogram of the control runs, by its number: where the tool stands behind it nobody knows.
    Subprogram(u32),
    /// A cycle was called whose motions follow, up to the next `CycleEnd`.
    Cycle(CycleCall),
    /// Its motions are done.
    CycleEnd,
    /// A word of the control that moves nothing and that we do not know what it does; once a word.
    Unknown(String),
    /// The program ends.
    End,
}

/// The spindle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SpindleState {
    /// It stands.
    #[default]
    Off,
    /// It turns clockwise, seen from the spindle to the part, revolutions a minute.
    Clockwise(f64),
    /// Counter-clockwise.
    CounterClockwise(f64),
    /// It stands at an angle.
    Oriented,
    /// It turns the part at a cutting speed that the control keeps.
    Surface {
        /// m/min.
        speed: f64,
        /// Revolutions a minute that it does not exceed, if that is said.
        most: Option<f64>,
        /// Its sense.
        clockwise: bool,
    },
}

impl SpindleState {
    /// Its speed, revolutions a minute, where it turns at a constant one.
    pub fn rpm(self) -> Option<f64> {
        match self {
            Self::Clockwise(rpm) | Self::CounterClockwise(rpm) => Some(rpm),
            _ => None,
        }
    }

    /// Revolutions a minute by which a way between two tips (mm, part frame) takes as long as at its cutting speed, and the
    /// most of them; none where it keeps none. The part turns about its Z.
    pub fn surface_rpm(self, [from, to]: [Vector3<f64>; 2]) -> Option<[f64; 2]> {
        let Self::Surface { speed, most, .. } = self else {
            return None;
        };
        Some(surface_rpm_on_way(speed, [from.xy(), to.xy()], most.unwrap_or(f64::INFINITY)))
    }
}

/// Which coolants flow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coolants {
    /// Flood: M8.
    pub flood: bool,
    /// Mist: M7.
    pub mist: bool,
    /// Through the tool, air, or any other.
    pub other: bool,
}

/// A cycle at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CycleCall {
    /// What it does.
    pub kind: CycleKind,
    /// The bottom of the hole below the clearance level, mm, along the tool axis.
    pub depth: f64,
    /// The clearance level above the surface, where known, mm.
    pub clearance: f64,
    /// Peck, mm; zero for none.
    pub peck: f64,
    /// The pecks behind the first, mm; zero where they are as that or grow less.
    pub later_peck: f64,
    /// Dwell at the bottom, seconds.
    pub dwell: f64,
    /// Feed, mm/min; of a thread mm a revolution where `per_revolution` is set.
    pub feed: f64,
    /// The feed is a revolution.
    pub per_revolution: bool,
}

/// What a cycle does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "their names say it")]
pub enum CycleKind {
    #[default]
    Drill,
    Deep,
    BreakChip,
    Tap,
    TapLeft,
    Ream,
    Bore,
    BoreFine,
    BoreBack,
}
