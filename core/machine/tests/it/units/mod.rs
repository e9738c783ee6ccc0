//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod nearest;
mod short;
mod smoothing;
mod template;

#[path = "../../../src/kinematics/chain.rs"]
mod chain;
#[path = "../../../src/kinematics/errors.rs"]
mod errors;
#[path = "../../../src/kinematics/travel.rs"]
mod travel;
