//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod cycles;
mod offsets;
mod planes;

#[path = "../../../src/interpret/assigned.rs"]
mod assigned;
#[path = "../../../src/interpret/astray.rs"]
mod astray;
#[path = "../../../src/interpret/calls.rs"]
mod calls;
#[path = "../../../src/interpret/expression/mod.rs"]
mod expression;
#[path = "../../../src/interpret/flow/mod.rs"]
mod flow;
#[path = "../../../src/convert/number.rs"]
mod number;
#[path = "../../../src/verify/octree.rs"]
mod octree;
#[path = "../../../src/interpret/spindle_request.rs"]
mod spindle_request;
#[path = "../../../src/interpret/variables.rs"]
mod variables;

use post_readback::interpret::Limits;
