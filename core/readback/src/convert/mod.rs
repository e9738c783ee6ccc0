//! What a program did, as a CL file.
//!
//! [`ClWriter`] takes the items of a course one by one and writes the records that ask for them: a CL file that reads back
//! as the same course. Programs move to another machine so: their path is written down, and posted there.

mod number;
mod records;
mod text;
mod writer;

pub use writer::{ClWriter, MountedTool};
