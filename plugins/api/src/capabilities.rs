//! What a dialect writes beyond moves.

use std::ops::{BitOr, BitOrAssign};

use crate::{Cycle, Event};

/// What a dialect declares to write, as a set.
///
/// Without declaration it is sent straight moves and the events up to [`Event::Word`](crate::Event::Word); the host
/// turns what is not declared into those, or refuses it by name. Inverse time and the feed a revolution are declared
/// by [`Format`](crate::Format), tool centre point control by not refusing [`Setup::tcp`](crate::Setup::tcp).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Capabilities(u64);

/// A capability as the contract has it.
#[derive(Clone, Copy, Debug)]
pub struct CapabilitySpec {
    /// Name of the capability, in C behind `POST_WRITES_`.
    pub name: &'static str,
    /// The set with it alone.
    pub set: Capabilities,
    /// What the dialect writes.
    pub doc: &'static str,
}

macro_rules! capabilities {
    ($($(#[doc = $doc:literal])* $bit:literal $name:ident;)*) => {
        impl Capabilities {
            $(
                $(#[doc = $doc])*
                pub const $name: Capabilities = Capabilities(1 << $bit);
            )*
        }

        /// Every capability that this version knows.
        pub const CAPABILITIES: &[CapabilitySpec] = &[$(CapabilitySpec {
            name: stringify!($name),
            set: Capabilities::$name,
            doc: concat!($($doc),*),
        }),*];
    };
}

capabilities! {
    /// `Arc` in the plane of X and Y (G17).
    0 ARC_XY;
    /// `Arc` in the plane of Z and X (G18).
    1 ARC_ZX;
    /// `Arc` in the plane of Y and Z (G19).
    2 ARC_YZ;
    /// `Arc` about any direction.
    3 ARC_ANY;
    /// `Arc` that ends off the plane of its start, in the planes declared.
    4 HELIX;
    /// `Arc` also while tool centre point control is on.
    5 ARC_TCP;
    /// `Spline`.
    6 SPLINE;
    /// `Plane` and `PlaneOff`.
    7 PLANE;
    /// Cycles and arcs inside a `Plane`.
    8 CYCLE_IN_PLANE;
    /// Cycles along any tool axis, without a `Plane`.
    9 CYCLE_ANY_AXIS;
    /// `Cycle` of kind `Drill`.
    10 CYCLE_DRILL;
    /// `Cycle` of kind `Deep`.
    11 CYCLE_DEEP;
    /// `Cycle` of kind `BreakChip`.
    12 CYCLE_BREAK_CHIP;
    /// `Cycle` of kind `Tap`.
    13 CYCLE_TAP;
    /// `Cycle` of kind `TapLeft`.
    14 CYCLE_TAP_LEFT;
    /// `Cycle` of kind `Ream`.
    15 CYCLE_REAM;
    /// `Cycle` of kind `Bore`.
    16 CYCLE_BORE;
    /// `Cycle` of kind `BoreFine`.
    17 CYCLE_BORE_FINE;
    /// `Cycle` of kind `BoreBack`.
    18 CYCLE_BORE_BACK;
    /// `Smoothing` and `SmoothingOff`.
    19 SMOOTHING;
    /// `Tcp`.
    20 TCP_SWITCH;
    /// The tool vector of a move instead of its rotary words.
    21 TOOL_VECTOR;
    /// `Operation` and `OperationEnd`.
    22 OPERATION;
    /// `Message`.
    23 MESSAGE;
    /// `Units`.
    24 UNITS;
    /// `WorkOffset`.
    25 WORK_OFFSET;
    /// `Offsets`.
    26 OFFSETS;
    /// `SurfaceSpeed`.
    27 SURFACE_SPEED;
    /// `Clamp`.
    28 CLAMP;
    /// `Surface`.
    29 SURFACE;
    /// `Compensate3d`.
    30 COMPENSATE_3D;
    /// `Subprogram`.
    31 SUBPROGRAM;
    /// `Probe`.
    32 PROBE;
    /// `Compensate` also while tool centre point control is on: the control offsets by the whole radius in the plane
    /// of X and Y of the part.
    33 COMPENSATE_TCP;
    /// No registers: length and radius are those that the control's own table has for the tool in the spindle.
    34 TOOL_TABLE;
    /// Tool centre point control is switched on in a block that moves nothing, so that a first position can go in
    /// the plane and then in depth under it.
    35 TCP_STILL;
    /// `Instead`.
    36 INSTEAD;
    /// `Arc` by its radius.
    37 ARC_RADIUS;
    /// Cycles also while tool centre point control is on, the tool upright on the part's X and Y.
    38 CYCLE_TCP;
    /// The tool's length is put along the depth axis, whichever of X, Y and Z that is (G18, `TOOL CALL 1 Y`); else
    /// along Z.
    39 LENGTH_ALONG_DEPTH;
    /// No length is put on: it is in the work offset.
    40 LENGTH_IN_OFFSET;
    /// `Arc` that ends off the plane of its start is told by its turn, to 0.00001 degrees: it ends as far from the
    /// centre as it begins.
    41 HELIX_BY_TURN;
    /// A feed a minute without tool centre point control counts along all axes together, degrees as millimetres; else
    /// along the linear ones.
    42 FEED_ALL_AXES;
    /// No retract of the host's own: where the control's machine coordinates end is not where the axis is known to
    /// stand clear (its zero is the builder's, or lies on a switch), so that the machine file must say where to.
    43 RETRACT_SAID;
    /// Under tool centre point control rapids hold what the axes of the program can do, and a joint may pass its own
    /// largest feed.
    44 TCP_RAPIDS_PASS;
    /// Length and radius are those of an edge of the tool, which D names: D1 is the first.
    45 TOOL_EDGES;
    /// `Cuts`.
    46 CUTS;
    /// Cycles do not wait at the bottom, or in a unit that is not known: a hole where the tool waits is made of moves.
    47 CYCLE_NO_DWELL;
    /// `WordLetter`.
    48 WORD_LETTER;
    /// Words of rotary axes without ends as a place within one turn, whose sign is the way there.
    49 SIGN_IS_WAY;
    /// `Pose`: cuts that lead the tool of a robot straight.
    50 POSES;
    /// Where no linear axis moves, a feed a minute counts along the rotary axis that turns the most, in degrees; else along
    /// the root of the sum of their squares.
    51 FEED_LONGEST_TURN;
    /// `Park` does not come: the control has no words for positions in machine coordinates.
    52 NO_PARK;
    /// G0 goes at F, as G1 does: `rapid_feed` of the format says at which.
    53 RAPIDS_AT_FEED;
    /// A line is one command, which stands first, and its parameters: no word of motion holds on to the next line, and what
    /// stands in front of a command or behind it is not run as words of a block. The dialect names every word that its
    /// control reads: what others of its language have in common does not hold.
    54 COMMAND_A_LINE;
    /// A parameter of the control says what its numbers count in, and a decimal point does not override it.
    55 UNIT_SYSTEM;
    /// The tool's length goes along the axis across the plane in force, also where the plane changes behind the word that
    /// put it on: along Y behind G18.
    56 LENGTH_ACROSS_PLANE;
    /// Tolerances of its smoothing are in mm in inch programs too.
    57 SMOOTHING_IN_MM;
}

impl Capabilities {
    /// No capability.
    pub const NONE: Capabilities = Capabilities(0);

    /// Whether all of `others` are in the set.
    pub const fn has(self, others: Capabilities) -> bool {
        self.0 & others.0 == others.0
    }

    /// The set and `others`, in a constant; elsewhere `|` does the same.
    pub const fn and(self, others: Capabilities) -> Capabilities {
        Capabilities(self.0 | others.0)
    }

    /// The set in the contract. Bits that this version does not know stay.
    pub const fn bits(self) -> u64 {
        self.0
    }

    /// The set of these bits.
    pub const fn from_bits(bits: u64) -> Capabilities {
        Capabilities(bits)
    }
}

impl Cycle {
    /// What a dialect declares that has words for the cycle.
    pub const fn capability(self) -> Capabilities {
        match self {
            Cycle::Drill => Capabilities::CYCLE_DRILL,
            Cycle::Deep => Capabilities::CYCLE_DEEP,
            Cycle::BreakChip => Capabilities::CYCLE_BREAK_CHIP,
            Cycle::Tap => Capabilities::CYCLE_TAP,
            Cycle::TapLeft => Capabilities::CYCLE_TAP_LEFT,
            Cycle::Ream => Capabilities::CYCLE_REAM,
            Cycle::Bore => Capabilities::CYCLE_BORE,
            Cycle::BoreFine => Capabilities::CYCLE_BORE_FINE,
            Cycle::BoreBack => Capabilities::CYCLE_BORE_BACK,
        }
    }
}

impl Event<'_> {
    /// The event is sent to dialects that declare one of these alone; none of them: to every dialect.
    pub const fn sent_under(&self) -> Capabilities {
        const CYCLES: Capabilities = Capabilities::CYCLE_DRILL
            .and(Capabilities::CYCLE_DEEP)
            .and(Capabilities::CYCLE_BREAK_CHIP)
            .and(Capabilities::CYCLE_TAP)
            .and(Capabilities::CYCLE_TAP_LEFT)
            .and(Capabilities::CYCLE_REAM)
            .and(Capabilities::CYCLE_BORE)
            .and(Capabilities::CYCLE_BORE_FINE)
            .and(Capabilities::CYCLE_BORE_BACK);
        match self {
            Event::Operation { .. } | Event::OperationEnd => Capabilities::OPERATION,
            Event::Message { .. } => Capabilities::MESSAGE,
            Event::Units(_) => Capabilities::UNITS,
            Event::WorkOffset { .. } => Capabilities::WORK_OFFSET,
            Event::Offsets { .. } => Capabilities::OFFSETS,
            Event::SurfaceSpeed { .. } => Capabilities::SURFACE_SPEED,
            Event::Tcp { .. } => Capabilities::TCP_SWITCH,
            Event::Plane { .. } | Event::PlaneOff => Capabilities::PLANE,
            Event::Smoothing { .. } | Event::SmoothingOff => Capabilities::SMOOTHING,
            Event::Clamp { .. } => Capabilities::CLAMP,
            Event::Arc { .. } => Capabilities::ARC_XY
                .and(Capabilities::ARC_ZX)
                .and(Capabilities::ARC_YZ)
                .and(Capabilities::ARC_ANY),
            Event::Spline { .. } => Capabilities::SPLINE,
            Event::Cycle { .. } | Event::CyclePoint { .. } | Event::CycleOff => CYCLES,
            Event::Surface { .. } => Capabilities::SURFACE,
            Event::Compensate3d { .. } => Capabilities::COMPENSATE_3D,
            Event::Subprogram { .. } => Capabilities::SUBPROGRAM,
            Event::Probe { .. } => Capabilities::PROBE,
            Event::Instead { .. } => Capabilities::INSTEAD,
            Event::Cuts { .. } => Capabilities::CUTS,
            Event::WordLetter { .. } => Capabilities::WORD_LETTER,
            Event::Pose { .. } => Capabilities::POSES,
            _ => Capabilities::NONE,
        }
    }
}

impl BitOr for Capabilities {
    type Output = Capabilities;

    fn bitor(self, others: Capabilities) -> Capabilities {
        self.and(others)
    }
}

impl BitOrAssign for Capabilities {
    fn bitor_assign(&mut self, others: Capabilities) {
        *self = self.and(others);
    }
}
