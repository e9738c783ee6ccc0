//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod channel;
mod chord_error;
mod feed_limit;
mod feed_spline;
mod forms;
mod jerk_law;
mod quintic;

#[path = "../../../src/interior/band.rs"]
mod band;
#[path = "../../../src/fit/basis.rs"]
mod basis;
#[path = "../../../src/fit/hull.rs"]
mod hull;
#[path = "../../../src/fit/knots.rs"]
mod knots;
#[path = "../../../src/reach/step.rs"]
mod step;
