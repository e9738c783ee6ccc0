//! How machines move, held against closed forms and brute force.
#![allow(clippy::unwrap_used, reason = "tests")]

mod arc_spline;
mod contour;
mod contour_limit;
mod servo;
mod trajectory;
mod units;

// As the files in `units` name it.
use post_motion::{ProgramPlace, VelocityJump, limits};
