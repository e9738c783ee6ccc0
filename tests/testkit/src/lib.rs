//! What the tests share, so that they judge by nothing of the crates under test:
//!
//! - [`Reference`], a forward product of isometries, and [`Random`] machines; [`randomised`] says how many rounds a
//!   test takes and from which seed;
//! - [`posted`]: whole runs of posting, with the recorder of events, the sink and the models that go with them;
//! - [`walk`]: a run's words held against the path of its CL file;
//! - [`frechet`]: how far a curve and a path are apart, both gone along in order;
//! - [`read_back`]: NC programs read back by a kinematics built from the machine's TOML;
//! - [`repository`] and [`shared`]: where files are.
#![allow(
    missing_docs,
    clippy::should_implement_trait,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests alone use it"
)]

mod data;
pub mod frechet;
mod geometry;
mod papers;
pub mod posted;
mod random;
pub mod read_back;
mod reference;
pub mod walk;

pub use data::{repository, shared};
pub use geometry::{angle, between, distance, slerp, turned};
pub use papers::blade;
pub use random::{Kind, Random, Rng, SIZE, across, randomised, rounds, seed, seeded};
pub use reference::{Reference, nearest};
