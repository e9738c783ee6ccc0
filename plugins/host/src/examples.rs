//! The smallest plugins that are of use, as the guide shows them: `post plugin new` writes them out to start from.

/// In Rust, on the contract alone; it exports `tiny`.
pub const TINY: &str = include_str!("../examples/post_tiny.rs");

/// In Rust, a table of the G-code family; it exports `gcode`.
pub const GCODE: &str = include_str!("../examples/post_gcode.rs");

/// In C; it exports `minimal`.
pub const MINIMAL_C: &str = include_str!("../tests/c/minimal.c");

/// An error model in C; it exports `bow`.
pub const BOW_C: &str = include_str!("../tests/c/bow.c");
