//! Tests of reading back on hand-made programs and courses.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod course;
mod interpret;
mod point_by_point;
mod robust;
mod runs;
mod tasks;
mod units;
mod verify;

// As files that are compiled by themselves call them.
use post_readback::{CycleCall, CycleKind};
