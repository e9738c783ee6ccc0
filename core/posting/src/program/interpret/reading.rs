//! How a file is to be read: what the user says of it, and what the machine file does.

use post_grammar::Units;
use post_machine::description::{Insert, ToolLength};

use crate::program::Unknown;

/// How a file is to be read.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The file's name in messages.
    pub file: String,
    /// Units of the numbers, whatever the file says.
    pub units: Option<Units>,
    /// The tool that a file without `LOADTL` works with.
    pub tool: Option<u32>,
    /// Take points and axes into the frame of `MSYS`.
    pub apply_msys: bool,
    /// What to do with unknown words.
    pub unknown: Unknown,
    /// What becomes of `INSERT`.
    pub insert: Insert,
    /// Which tool length counts.
    pub tool_length: ToolLength,
    /// How far chords may stray from arcs and splines, mm.
    pub chord_tolerance: f64,
}
