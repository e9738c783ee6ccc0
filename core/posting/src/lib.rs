//! A CL file becomes a program, in stages.
//!
//! A record takes one way through, never back, and enters no stage twice. Each stage takes a batch and hands on a
//! batch; commands travel in the same stream as the points, in order.
//!
//! | stage | takes | hands on |
//! |---|---|---|
//! | [`program`] | records | [`program::ProgramStep`]: what is meant, mm, part frame |
//! | `expand` | steps | straight moves; those of a curve or a hole that may stay one as one element |
//! | `configuration` | moves | points with the axis values chosen for them, over whole passes |
//! | `blocks` | points | [`MotionBlock`]: as printed, more or fewer of them, each certified |
//! | `timing` | blocks | the same with time, feed and what limits it |
//! | `emit` | blocks | the dialect's events, whose text goes to an [`TextSink`] |
//!
//! [`Post`] joins them. [`accuracy`] is the mathematics of error control that `configuration` and `blocks` stand on.
//! What never happens here: input or output, unsafe code, a dialect's name, a CL keyword after `program`, memory
//! that grows with the file.

pub mod accuracy;
mod blocks;
mod configuration;
pub mod curve;
mod emit;
pub mod expand;
pub mod faces;
mod findings;
mod job_facts;
mod mount_bounds;
mod observer;
mod operation_work;
mod part_anywhere;
pub mod plan;
mod post;
pub mod preview;
pub mod program;
mod refusal;
pub mod report;
mod run_stages;
mod shift;
mod source_buffer;
mod stream;
mod tightening;
mod timing;
mod window;

pub use blocks::{
    BlockDuration, BlockKind, BlockNote, BlockReason, MotionBlock, NominalTime, PlannedTime,
};
pub use configuration::{BodyClearance, ClearTool, Contact, TrialWay, TrialWayKind, whole_pass};
pub use emit::{STACK, SpareWork};
pub use findings::MOST_FAULTS;
pub use job_facts::{JobFacts, ProgramPreview};
pub use mount_bounds::MountBounds;
pub use observer::{Observer, TextSink};
pub use operation_work::{OperationList, OperationWork};
pub use post::{Post, PostingRequest};
pub use shift::{PathPoint, PathShift};
pub use stream::{HoleMoves, StreamItem, StreamPoint};
pub use tightening::{TightPlace, Tightening};
pub use timing::limits;

/// What tests look into; no part of the crate's face.
#[doc(hidden)]
pub mod internals {
    pub use crate::accuracy::PlacedBatch;
    pub use crate::findings::without_numbers;
    pub use crate::program::interpret::words::InsertContent;
    pub use crate::window::LineWindow;
}
