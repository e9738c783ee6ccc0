//! Single files of the crate, each by itself. Those that nobody outside sees are compiled here once more, with the tests
//! that stand in them.
#![allow(dead_code, reason = "tests do not use all of a file")]

mod ahead;
mod findings;
mod inserted;
mod placed_batch;
mod window;

#[path = "../../../src/program/arc.rs"]
mod arc;
#[path = "../../../src/program/cycle.rs"]
mod cycle;
#[path = "../../../src/configuration/cycle_time.rs"]
mod cycle_time;
#[path = "../../../src/blocks/free_way.rs"]
mod free_way;
#[path = "../../../src/plan/graded.rs"]
mod graded;
#[path = "../../../src/program/limits.rs"]
mod limits;
#[path = "../../../src/plan/pieces.rs"]
mod pieces;
#[path = "../../../src/source_buffer.rs"]
mod source_buffer;
#[path = "../../../src/program/spline.rs"]
mod spline;
#[path = "../../../src/configuration/taut.rs"]
mod taut;
#[path = "../../../src/tightening.rs"]
mod tightening;
#[path = "../../../src/blocks/tool_alignment.rs"]
mod tool_alignment;
