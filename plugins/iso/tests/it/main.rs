//! Tests of the engine that the G-code dialects share.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

mod events;
mod tables;

// Files that nobody outside sees, compiled here once more with the tests that stand in them, and what they name.
#[allow(dead_code, reason = "tests do not use all of a file")]
#[path = "../../src/block_style.rs"]
mod block_style;
#[allow(dead_code, reason = "tests do not use all of a file")]
#[path = "../../src/lines.rs"]
mod lines;
mod table {
    pub use post_iso::Table;
}
