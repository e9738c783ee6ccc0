//! Tests of what the page is made of.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]
#![allow(dead_code, reason = "tests do not use all of a file")]

mod solid;
mod table;

// Files that nobody outside sees are compiled here once more, with the tests that stand in them.
#[path = "../../src/base64.rs"]
mod base64;
#[path = "../../src/integers.rs"]
mod integers;
#[path = "../../src/sha256.rs"]
mod sha256;
#[path = "../../src/squeeze.rs"]
mod squeeze;
#[path = "../../src/template.rs"]
mod template;
