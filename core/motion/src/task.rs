//! What a control carries out, in order.

use std::sync::Arc;

use post_machine::kinematics::Solver;

use crate::path::{Interpolation, Stance};

/// One thing after the other.
#[derive(Clone, Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "most are moves, and they lie in a queue that is filled again and again"
)]
pub enum Task {
    /// The machine moves.
    Move(Move),
    /// The machine waits where it stands.
    Wait {
        /// Line of the program.
        line: u64,
        /// How long, s.
        seconds: f64,
        /// What for.
        why: WaitReason,
    },
}

/// What the machine waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitReason {
    /// A dwell of the program.
    Dwell,
    /// A tool change.
    ToolChange,
    /// The spindle.
    Spindle,
    /// Programs of other channels: how long is not known here.
    Channels,
    /// A word that is carried out at rest: coolant, a stop, another head.
    Word,
}

/// A way from one stance to another.
#[derive(Clone, Debug)]
pub struct Move {
    /// Line of the program.
    pub line: u64,
    /// How the control goes.
    pub way: Interpolation,
    /// Start of the move: where the last one has ended.
    pub from: Stance,
    /// End of the move.
    pub to: Stance,
    /// The chain that it is meant for, with the tool in use.
    pub solver: Arc<Solver>,
    /// The control keeps the tip (G43.4, TRAORI, M128): what is programmed are the coordinates of the tip, else those
    /// of the axes.
    pub keeps_tip: bool,
    /// How fast it is asked for.
    pub pace: MovePace,
    /// How the control passes from it into the next one.
    pub corner: CornerMode,
}

/// How fast a move is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MovePace {
    /// Rapid traverse: as fast as the axes go.
    Rapid,
    /// Time that the move takes at the programmed feed, no limit of the machine regarded, minutes.
    Minutes(f64),
}

/// How a control passes from one move into the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CornerMode {
    /// The machine stands still at the end (G9, G61.1 of LinuxCNC, G60).
    Stop,
    /// The machine keeps the path, and stands still where the direction changes (G61).
    Path,
    /// The machine may leave the path (G64, CYCLE832, CYCL DEF 32).
    Blend {
        /// Largest distance from the path, mm; none: as far as the control's own rule leads.
        tolerance: Option<f64>,
    },
    /// The machine may leave the path so near to the corner (G641 ADIS).
    Within {
        /// Largest distance from the corner along the path, mm.
        distance: f64,
    },
}
