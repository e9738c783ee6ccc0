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

// As the files in `units` name them.
use post_feed::{curve, problem};
