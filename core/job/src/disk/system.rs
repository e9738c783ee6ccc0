//! The disk of the system.

use std::io;
use std::path::Path;

pub use std::env::temp_dir;
pub use std::fs::{
    File, Metadata, OpenOptions, TryLockError, canonicalize, create_dir_all, metadata, read,
    read_dir, read_link, read_to_string, remove_file, symlink_metadata,
};

/// A regular file is there.
pub fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// A folder is there.
pub fn is_dir(path: &Path) -> bool {
    path.is_dir()
}

/// Something is there.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// A file without a name, gone once nobody has it open.
///
/// # Errors
/// There is no place for it.
pub fn unnamed() -> io::Result<File> {
    tempfile::tempfile()
}
