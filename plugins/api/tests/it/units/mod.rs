//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod batch_bytes;
mod deviation;
mod raw_event;
mod raw_setup;
mod standstill;
mod text;

#[path = "../../../src/axis_names.rs"]
mod axis_names;
#[path = "../../../src/number.rs"]
mod number;
