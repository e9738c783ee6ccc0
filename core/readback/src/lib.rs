//! What an NC program makes the machine do, and whether that is what the CL file asked for.
//!
//! | part | takes | hands on |
//! |---|---|---|
//! | [`lexicon`] | a dialect's words and meanings | which word switches what |
//! | [`interpret`] | blocks of `post_grammar::nc` | [`BlockEffect`]: every motion of the machine, and what is told between them |
//! | [`course`] | a CL file, or what a program did | [`course::CourseItem`]: the path of the tool against the part, piece by piece |
//! | [`verify`] | a program and a course | deviations, block by block |
//! | [`diff`] | two programs | what they do differently |
//! | [`tasks`] | what a program did | what its control carries out, for `post_motion` |
//! | [`convert`] | what a program did | the CL file that asks for it |
//!
//! This crate never stands on `post-posting`, and shares no code with the emitters: a check must not share the mistake
//! of what it checks. The chain and its kinematics come from `post-machine`, where LinuxCNC's own kinematics and random
//! chains prove them. There is no input or output here, no unsafe code and no dialect's name, and memory does not grow
//! with the program.

pub mod convert;
mod corners;
pub mod course;
pub mod diff;
mod fed_rapids;
mod g_code;
pub mod interpret;
pub mod lexicon;
mod motion;
mod offsets;
mod program_event;
mod run;
mod smoothing;
pub mod tasks;
pub mod verify;

pub use corners::Corners;
pub use fed_rapids::{FedRapids, turns_the_spindle};
pub use motion::{Motion, MotionKind};
pub use offsets::{Offsets, Reference, WorkOffset};
pub use post_motion::path::{BSpline, Curve, Interpolation, Stance};
pub use program_event::{Coolants, CycleCall, CycleKind, ProgramEvent, SpindleState};
pub use run::{BlockRunner, MOST_FAULTS, ProgramRun};
pub use smoothing::Leeway;

use std::sync::Arc;

use post_machine::face_mode::FaceMode;
use post_machine::kinematics::Solver;
use post_machine::tilted_plane::TiltedPlane;
use post_machine::wrap_mode::WrapMode;

/// What tests of single files reach; no part of the face.
#[doc(hidden)]
pub mod internals {
    pub use crate::interpret::planes::turns_of;
}

/// What a block of a program did, in the order in which it did it.
#[derive(Clone, Debug)]
#[allow(
    clippy::large_enum_variant,
    reason = "most are motions, and they lie in a buffer that is filled again and again"
)]
pub enum BlockEffect {
    /// The machine moved.
    Motion(Motion),
    /// A tool change, a spindle command, a wait or another event.
    Event {
        /// Line of the program.
        line: u64,
        /// The event.
        event: ProgramEvent,
    },
    /// From here on this holds.
    State(Arc<MachineState>),
}

/// What holds while the machine moves: it changes seldom, and motions share it.
#[derive(Clone, Debug)]
pub struct MachineState {
    /// The machine with the tool that the program's length compensation speaks of: `chain().forward` leads from axis
    /// values to the tip and tool axis in the part frame.
    pub solver: Arc<Solver>,
    /// Length that is compensated, mm; zero where compensation is off.
    pub length: f64,
    /// Tool in the spindle.
    pub tool: Option<u32>,
    /// Length register in force.
    pub length_register: Option<u32>,
    /// The length in force is that of the tool in the spindle, which no register and no number names.
    pub length_of_spindle: bool,
    /// Radius register in force.
    pub radius_register: Option<u32>,
    /// Side of the contour: -1 left (G41), 1 right (G42), 0 off.
    pub compensation: i8,
    /// The control keeps the tip.
    pub tcp: bool,
    /// The tilted plane in force.
    pub plane: Option<TiltedPlane>,
    /// The polar interpolation in force: the tip goes straight, and the axes in polar coordinates.
    pub face: Option<Arc<FaceMode>>,
    /// The cylinder interpolation in force.
    pub wrap: Option<Arc<WrapMode>>,
    /// Name of the work offset in force: `G54`.
    pub work_offset: Option<String>,
    /// Nobody says where that one lies: it is taken to be where the machine file has the part.
    pub offset_assumed: bool,
    /// The spindle.
    pub spindle: SpindleState,
    /// Coolants that flow.
    pub coolants: Coolants,
    /// What a stop may have switched off since the program switched it on.
    pub standstill: Standstill,
    /// The operation, as a remark or a word of the program names it.
    pub operation: Option<String>,
    /// The control may leave the path by this much, mm; none: it keeps it, or nothing is said.
    pub smoothing: Option<f64>,
    /// The control may turn the tool axis off by this much beside that, radians; zero: nothing is said.
    pub smoothing_turn: f64,
    /// How the control passes from one motion to the next.
    pub corners: Corners,
}

/// Lines of the stops (M0, M1) that switch something off where the control stops it there, until the program switches it
/// on again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Standstill {
    /// The spindle turned as the program stopped.
    pub spindle: Option<u64>,
    /// A coolant flowed.
    pub coolant: Option<u64>,
    /// A tool was changed, whether the spindle turned or not: most controls stop it for that.
    pub change: Option<u64>,
    /// A tool was changed while a coolant flowed, on a control whose manual does not say that it flows on.
    pub dry_change: Option<u64>,
}
