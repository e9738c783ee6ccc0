//! Files: read, and written whole or not at all.

pub mod atomic_file;
pub mod cl_input;
pub mod svg;
