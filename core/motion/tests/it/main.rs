//! How machines move, held against closed forms and brute force.
#![allow(clippy::unwrap_used, reason = "tests")]

mod contour;
//! How a machine moves along a path.
mod trajectory;
mod servo;
