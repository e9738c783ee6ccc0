//! What is told of NC programs.
//!
//! | file | does |
//! |---|---|
//! | `program` | the program read back on the chosen machine: what holds at each line |
//! | `lint` | what is wrong with it on the chosen machine |
//! | `hover` | what is said of a line |
//! | `map` | the CL line that a line came from, as `post verify --map` tells it |

pub mod hover;
mod lint;
pub mod map;
mod program;

pub use lint::looked_over;
pub use program::{InterpretedProgram, control, read};

/// Endings of NC programs.
pub const ENDINGS: &[&str] = &[
    "nc", "h", "mpf", "spf", "ngc", "gcode", "tap", "eia", "min", "iso", "cnc", "ptp", "pim", "fnc",
];
