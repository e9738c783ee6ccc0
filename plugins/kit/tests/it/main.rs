//! Tests of the kit: what it finds in plugins, and that it finds nothing where nothing is.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

mod boastful;
mod conformance;
mod sloppy;
mod units;
