//! Temporary files of runs that were killed (`kill -9`, a machine out of memory): whoever writes beside them next deletes
//! them. A run holds a lock on each of its own as long as it lives, so that none is taken from under it.

use std::io;
use std::path::Path;

use tempfile::NamedTempFile;

/// Deletes temporary files in `folder` that no run holds. What cannot be deleted stays, and nobody is told: it is in
/// nobody's way.
#[cfg(unix)]
pub fn delete(folder: &Path) {
    use super::temporary::{PREFIX, SUFFIX};

    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let middle = name.strip_prefix(PREFIX).and_then(|rest| rest.strip_suffix(SUFFIX));
        // A pipe or a link of that name is none of ours, nor what is called in more letters than are drawn.
        let ours = middle.is_some_and(|drawn| drawn.len() == 6)
            && entry.file_type().is_ok_and(|kind| kind.is_file());
        if ours && lets_go(&entry.path()) {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Nobody holds the file. One that may not be read is another user's.
#[cfg(unix)]
fn lets_go(path: &Path) -> bool {
    std::fs::File::open(path).is_ok_and(|file| file.try_lock().is_ok())
}

/// A file that this run holds. Another run may have found it in the moment before, and taken it for abandoned: then there
/// is another one.
///
/// # Errors
/// It cannot be made.
#[cfg(unix)]
pub fn claimed(make: impl Fn() -> io::Result<NamedTempFile>) -> io::Result<NamedTempFile> {
    use std::fs::TryLockError;
    use std::os::unix::fs::MetadataExt;

    for _ in 0..16 {
        let file = make()?;
        match file.as_file().try_lock() {
            Err(TryLockError::WouldBlock) => continue,
            // A disk that knows no locks lets nobody have one either.
            Err(TryLockError::Error(_)) => return Ok(file),
            Ok(()) => {}
        }
        if file.as_file().metadata()?.nlink() > 0 {
            return Ok(file);
        }
    }
    make()
}

/// Locks of other systems keep a file from being read, by its own run too: what is left there is for the user to delete.
#[cfg(not(unix))]
pub fn delete(_folder: &Path) {}

/// A file as it is made.
///
/// # Errors
/// It cannot be made.
#[cfg(not(unix))]
pub fn claimed(make: impl Fn() -> io::Result<NamedTempFile>) -> io::Result<NamedTempFile> {
    make()
}
