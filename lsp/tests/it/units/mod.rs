//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

#[path = "../../../src/machine/cursor.rs"]
mod cursor;
#[path = "../../../src/positions.rs"]
mod positions;
#[path = "../../../src/machine/tree.rs"]
mod tree;
#[path = "../../../src/uri.rs"]
mod uri;
