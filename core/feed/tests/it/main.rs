//! The crate as its callers see it.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]
#![allow(clippy::print_stdout, reason = "helpers of tests tell what was measured")]

mod agreement;
mod closed_forms;
mod contour_axes;
mod corners;
mod fit;
mod five_axes;
mod infeasible;
mod jerk_streaming;
mod paper;
mod properties;
mod streaming;
mod support;
mod units;
// The evaluation of B-splines, which no limit and no solver needs.
#[path = "../../../motion/src/path/spline.rs"]
#[allow(dead_code, reason = "tests do not use all of a file")]
mod spline;

// As the files in `units` name it.
use post_feed::problem;
