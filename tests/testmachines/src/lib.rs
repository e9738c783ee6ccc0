//! Machines and paths that tests judge kinematics by:
//!
//! - [`Reference`], a forward product of isometries, and [`Random`] machines;
//! - [`frechet`]: how far a curve and a path are apart, both gone along in order;
//! - angles, great circles and distances; what the papers print.
#![allow(
    missing_docs,
    clippy::should_implement_trait,
    clippy::unwrap_used,
    reason = "tests alone use it"
)]

pub mod frechet;
mod geometry;
mod papers;
mod random;
mod reference;

pub use geometry::{angle, between, distance, slerp, turned, within};
pub use papers::blade;
pub use random::{Kind, Random, SIZE, across};
pub use reference::{Reference, nearest};
