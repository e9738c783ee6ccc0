//! The contract between `post` and its plugins.
//!
//! An author implements [`Dialect`] or [`ErrorModel`] and writes one export line; everything else here
//! is what those traits speak of. Nothing in this crate depends on another crate.

mod axis_names;
mod batch;
mod block;
mod capabilities;
mod command;
mod deviation;
mod dialect;
mod drilling;
mod event;
#[doc(hidden)]
pub mod export;
mod field;
mod flat;
mod model;
mod number;
mod plane;
pub mod raw;
mod setup;
mod text;
mod vocabulary;

pub use axis_names::AxisNames;
pub use batch::Batch;
pub use block::{Axes, Block, Group, Modal, NumberStyle};
pub use capabilities::{CAPABILITIES, Capabilities, CapabilitySpec};
pub use command::{CODES, Compensation, Coolant, Cycle, Feed, Spindle, SpindleSense};
pub use deviation::{ask, length};
pub use dialect::{Dialect, DialectSession, Format, WriteFault};
pub use drilling::Drilling;
pub use event::{EVENTS, Event, EventSpec, FieldSpec};
pub use export::{Linked, LinkedDialect};
pub use field::{Codes, List, Promise, Shape, ToolPose};
pub use model::{Curve, Deviation, ErrorModel, ModelSession, Tolerance};
pub use number::{fixed, quantise};
pub use plane::PlaneAngles;
pub use setup::{
    Accuracy, Ahead, AxisWord, Kinematics, OptionKind, OptionSpec, Setup, Tool, Units, Value,
};
pub use text::{ascii, remark, wrapped};
pub use vocabulary::{Meaning, VocabularyWord};
