//! Files: CL files read, texts written whole or not at all.

mod atomic_file;
mod cl_input;
mod file_fault;
mod path_arg;
pub mod svg;
mod temporary;

use std::path::Path;

pub use atomic_file::{AtomicFile, NullSink};
pub use cl_input::ClInput;
pub use file_fault::FileFault;
pub use path_arg::PathArg;
pub use temporary::{delete_on_signals, delete_temporary_files};

/// Writes a text whole, or not at all.
pub fn write(target: &PathArg, text: &[u8]) -> Result<(), FileFault> {
    let mut file = AtomicFile::create(target)?;
    file.write_bytes(text)?;
    file.finish()
}

/// A value as JSON, for programs to read.
pub fn json(value: &impl serde::Serialize) -> String {
    let mut text = serde_json::to_string_pretty(value).unwrap_or_default();
    text.push('\n');
    text
}

/// Writing to `target` would replace the file `other`.
pub fn would_replace(target: &PathArg, other: &Path) -> bool {
    atomic_file::Target::of(target).is(other)
}
