//! What all tests share, and no crate under test stands behind:
//!
//! - [`Rng`], numbers that are the same everywhere; [`randomised`] says how many rounds a test takes and from which seed;
//! - [`repository`] and [`shared`]: where files are;
//! - [`run`]: a command, run to its end.
#![allow(
    missing_docs,
    clippy::should_implement_trait,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests alone use it"
)]

mod command;
mod data;
mod random;
mod text;

pub use command::{Run, assert_contains, names, run};
pub use data::{repository, shared};
pub use random::{Rng, all_drawn, at_least, drawn, randomised, rounds, seeded};
