//! What a control remembers from block to block.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES, Solver, Turns};
use post_machine::program_text::DeclaredLines;
use post_machine::wait_rule::WaitLines;
use post_machine::word_map::WordMap;

use super::ReadReport;
use super::along::AlongStand;
use super::cycles::CycleState;
use super::frame::{CoordinateFrame, FrameStack};
use super::splines::OpenSpline;
use super::tools::ToolState;
use super::variables::Variables;
use crate::lexicon::Lexicon;
use crate::{BlockEffect, MachineState, Offsets, Stance};

/// A control at work: all that holds from block to block.
///
/// A block of words goes through `block::run`, a conversational one through `conversational::run`. Both settle what is
/// modal here and then ask for motions: `Control::go` in words, or `Control::straight` along the coordinates of the
/// program. What happens is pushed to `done` in order.
#[derive(Debug)]
pub(super) struct ControlState {
    /// The file, as messages call it.
    pub file: String,
    /// Which word switches what.
    pub lexicon: Lexicon,
    /// The lines that the machine file has of its own.
    pub declared: DeclaredLines,
    /// The lines at which it waits for other channels; none where the machine has none.
    pub waits: Option<WaitLines>,
    /// What stands in the control's tables.
    pub offsets: Offsets,
    /// The machine with the head that it has now.
    pub machine: Arc<Machine>,
    /// Heads of the machine.
    pub heads: Vec<MountedHead>,
    /// The head, by its place among them, that a remark asks the operator to swap in at the next stop.
    pub head_by_hand: Option<usize>,
    /// Which word is which axis.
    pub axes: AxisLetters,
    /// What is modal in its programs.
    pub modal: ModalState,
    /// What the words count from, inside the work offset. After a change: `ControlState::frames_changed`.
    pub frames: FrameStack,
    /// Number of the work offset in force, by place in `offsets.work`; none: the machine file's.
    pub work: Option<usize>,
    /// Whether it was reported that work offsets of which nothing is known are taken for one.
    pub offsets_told: bool,
    /// Tools and lengths.
    pub tools: ToolState,
    /// Variables of the program.
    pub variables: Variables,
    /// The cycle that is in force, if there is one.
    pub cycles: CycleState,
    /// The axes that are clamped.
    pub clamps: super::clamps::ClampState,
    /// What its words are in polar interpolation of the control; none where the machine has none.
    pub face_words: Option<super::face::FaceWords>,
    /// The polar interpolation in force.
    pub face: Option<Box<super::face::FaceReading>>,
    /// The same of cylinder interpolation.
    pub wrap_words: Option<super::wrap::WrapWords>,
    /// Which word is which axis outside of the cylinder interpolation that is in force.
    pub wrap_outside: Option<Box<AxisLetters>>,
    /// The spline whose control points are told, if one is.
    pub spline: Option<Box<OpenSpline>>,
    /// The variable of joint positions that a robot's program has filled last.
    pub joint_variable: super::statements::JointVariable,
    /// Tool and frame that a robot's straight moves go by.
    pub robot_frames: super::robot_frames::RobotFrames,
    /// Lengths of tools act by the plane, and those of a turning tool in X and Z under G18 alone.
    pub lengths_by_plane: bool,
    /// Velocity of the tip where a robot's control leads it straight, m/s.
    pub path_velocity: Option<f64>,
    /// What conversational path functions remember.
    pub path: super::conversational::PathMemory,
    /// What its motions share; handed on when something of it changes. After a change: `ControlState::state_changed`.
    pub state: MachineState,
    /// `state` as it was handed on last; none if it has changed since.
    pub(super) shared: Option<Arc<MachineState>>,
    /// Bits of the places of axes of which the program has said where they go.
    pub said: u32,
    /// The same before the block that is run.
    pub led: u32,
    /// Something was fed.
    pub fed: bool,
    /// A tool was changed, or led to the part.
    pub begun: bool,
    /// Where the machine stands.
    pub at: Stance,
    /// Sines and cosines of its joints.
    pub turns: Turns,
    /// The program has come to its end.
    pub ended: bool,
    /// The motion is asked for in positions of the machine.
    pub in_machine: bool,
    /// The motions of this block end with the axes at rest: G9.
    pub exact_stop: bool,
    /// Motions are part of a cycle's hole.
    pub hole: bool,
    /// Axis values that the words of the axes count from: mm and radians, by place in the chain.
    pub zero: Joints,
    /// Axis values at the origin of the work offset, the tip of the tool there: mm and radians, by place in the chain.
    pub origin: Joints,
    /// The frame of the words in the part frame, where they are the tip.
    pub to_part: CoordinateFrame,
    /// The frame of the words in that of the work offset.
    pub to_work: CoordinateFrame,
    /// Line of the block that is run.
    pub line: u64,
    /// Number of the block.
    pub number: Option<u64>,
    /// What was found.
    pub report: ReadReport,
    /// What was done since it was taken last.
    pub done: Vec<BlockEffect>,
    /// The word that goes with the way of the tip.
    pub(super) along: AlongStand,
    /// Solvers by length, so that none is made twice.
    pub(super) solvers: Vec<(f64, Arc<Solver>)>,
}

/// A head that a word swaps in.
#[derive(Clone, Debug)]
pub(super) struct MountedHead {
    /// Name of the head.
    pub name: String,
    /// The line of the program that swaps it in.
    pub word: Option<String>,
    /// The machine with it.
    pub machine: Arc<Machine>,
}

/// Which word is which axis.
#[derive(Clone, Debug)]
pub(super) struct AxisLetters {
    /// Place in the chain of the axis of each letter; [`AxisLetters::NONE`] if there is none.
    pub letters: [u8; 26],
    /// Places of the axes whose names are longer than a letter.
    pub names: Vec<(String, usize)>,
    /// Places in the chain of X, Y and Z.
    pub cartesian: [Option<usize>; 3],
    /// Bits of the letters of axes.
    pub mask: u32,
    /// Bits of the places of rotary axes.
    pub rotary: u32,
    /// Axis values in one unit of the word of each axis, by its place: half of a diameter.
    pub scale: [f64; MAX_AXES],
    /// What words that hold several axes make of them.
    pub coupled: Option<Arc<WordMap>>,
}

impl AxisLetters {
    /// No axis has this letter.
    pub const NONE: u8 = u8::MAX;
}

/// What is modal in a program, lengths in mm.
#[derive(Clone, Debug)]
pub(super) struct ModalState {
    /// What axis words alone mean.
    pub motion: MotionMode,
    /// The plane of arcs and cycles.
    pub plane: ArcPlane,
    /// Words are ways: G91.
    pub incremental: bool,
    /// Centres of arcs are positions: G90.1.
    pub centres_absolute: bool,
    /// mm in one unit of a word.
    pub unit: f64,
    /// What a Siemens was told of smoothing.
    pub smoothing: super::corners::NamedSmoothing,
    /// The spindle that S and M3 speak to, by Siemens' SETMS.
    pub master_spindle: u32,
    /// The spindle that turned last.
    pub spindle_used: Option<u32>,
    /// How F counts.
    pub feed_mode: FeedMeaning,
    /// F: mm/min, 1/min (or 1/s as the machine file has it) or mm a revolution; of rotary axes alone deg/min or a
    /// revolution, unless `unit` was an inch: then so many times 25.4. None where the program has stated none.
    pub feed: Option<f64>,
    /// S, revolutions a minute.
    pub speed: f64,
    /// The speed is that of the cut, m/min: G96.
    pub surface_speed: bool,
    /// The speed is that at which a cutting speed ended in this block.
    pub kept_speed: bool,
    /// The spindle turns no faster than this, revolutions a minute: LIMS.
    pub most_speed: Option<f64>,
    /// Where a cycle returns to.
    pub return_to: ReturnTo,
    /// The level that a cycle returns to under M53: Z of G71.
    pub return_level: Option<f64>,
    /// Rotary axes go the shorter way (M126) or as written (M127); none: as the machine file says of each axis.
    pub shortest: Option<bool>,
    /// How the tool axis goes between two vectors.
    pub orientation: OrientationMode,
    /// I J K of a straight move are the tool axis: G43.5.
    pub vectors: bool,
    /// Tool centre point control came with a word of length compensation, and ends with it.
    pub tcp_by_length: bool,
    /// A length register by a name: `HL=1`.
    pub named_register: Option<u32>,
    /// The taps of this cycle are rigid: M29.
    pub rigid_taps: bool,
    /// Positions are machine coordinates until a word ends that: `#MCS ON`.
    pub machine: bool,
    /// Bits of the modes that the program has neither set nor relied on ([`super::ModalGroup`]).
    pub unset: u16,
    /// Ways of X are radii while its positions are diameters: DIAM90.
    pub ways_are_radii: bool,
    /// A rigid tap was made and no word has turned the spindle since: it stands when the cycle is over.
    pub tapped: bool,
    /// A transformation has begun or ended, which may have ended the work offset, and no word has named it since.
    pub frame_dropped: bool,
}

/// Where a cycle returns to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ReturnTo {
    /// The level where it began: G98.
    #[default]
    Start,
    /// The level where the feed begins: G99, M54.
    Clearance,
    /// A level that the program names: M53.
    Level,
}

/// What axis words alone mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum MotionMode {
    /// Nothing was said yet.
    #[default]
    None,
    /// G0.
    Rapid,
    /// G1.
    Linear,
    /// G2.
    Clockwise,
    /// G3.
    CounterClockwise,
    /// G6.2, G5.2.
    Spline,
}

/// The plane of arcs and cycles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ArcPlane {
    /// G17.
    #[default]
    Xy,
    /// G18.
    Zx,
    /// G19.
    Yz,
}

impl ArcPlane {
    /// The plane's two coordinates in right-handed order, and the third.
    pub const fn coordinates(self) -> [usize; 3] {
        match self {
            Self::Xy => [0, 1, 2],
            Self::Zx => [2, 0, 1],
            Self::Yz => [1, 2, 0],
        }
    }

    /// The plane's normal, in the coordinates of the words.
    pub fn normal(self) -> Vector3<f64> {
        let mut normal = Vector3::zeros();
        normal[self.coordinates()[2]] = 1.0;
        normal
    }
}

/// How F counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum FeedMeaning {
    /// G94.
    #[default]
    PerMinute,
    /// G93.
    Inverse,
    /// G95.
    PerRevolution,
}

/// How the tool axis goes between two vectors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum OrientationMode {
    /// The way the control is set up: words of rotary axes linearly, vectors on the great circle.
    #[default]
    Usual,
    /// The rotary axes linearly, vectors too: ORIAXES.
    Axes,
    /// The great circle, for rotary words too: ORIVECT.
    Circle,
}
