//! Temporary files of runs that were killed (`kill -9`, a machine out of memory): whoever writes beside them next deletes
//! them, and second names of files that were not replaced after all. A run holds a lock on each of its own as long as it
//! lives, so that none is taken from under it.

use std::fs::File;
use std::io;
use std::path::Path;

use tempfile::NamedTempFile;

/// Begin and end of the names of temporary files.
pub const PREFIX: &str = ".post-";
pub const SUFFIX: &str = ".tmp";

/// End of the names that former files have beside those that replace them.
pub const FORMER: &str = ".old";

/// Deletes temporary files in `folder` that no run holds, and second names that no run holds of files that have another.
/// What cannot be deleted stays, and nobody is told: it is in nobody's way.
#[cfg(unix)]
pub fn delete(folder: &Path) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        // A pipe or a link of that name is none of ours, nor what is called in more letters than are drawn.
        let ours = |suffix: &str| {
            let middle = name.strip_prefix(PREFIX).and_then(|rest| rest.strip_suffix(suffix));
            middle.is_some_and(|drawn| drawn.len() == 6)
                && entry.file_type().is_ok_and(|kind| kind.is_file())
        };
        if ours(SUFFIX) {
            delete_unless_held(&entry.path(), false);
        } else if ours(FORMER) {
            delete_unless_held(&entry.path(), true);
        }
    }
}

/// Deletes a file that nobody holds; where it may be the `last` name of what stood somewhere before, only if it is not. One
/// that may not be read is another user's.
#[cfg(unix)]
fn delete_unless_held(path: &Path, last: bool) {
    use std::os::unix::fs::MetadataExt;

    // Held until it is gone: who replaces the file that it is another name of finds it held.
    let Ok(file) = File::open(path) else {
        return;
    };
    if file.try_lock().is_ok()
        && (!last || file.metadata().is_ok_and(|metadata| metadata.nlink() > 1))
    {
        let _ = std::fs::remove_file(path);
    }
}

/// Holds the file at `path` with whoever else holds it so, and its second name with it; none where that cannot be.
#[cfg(unix)]
pub fn held(path: &Path) -> Option<File> {
    // Opening a pipe would wait.
    let open = std::fs::metadata(path).is_ok_and(|metadata| metadata.is_file());
    let file = if open { File::open(path).ok()? } else { return None };
    file.try_lock_shared().is_ok().then_some(file)
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

/// Nobody takes a second name away there.
#[cfg(not(unix))]
pub fn held(_path: &Path) -> Option<File> {
    None
}

/// A file as it is made.
///
/// # Errors
/// It cannot be made.
#[cfg(not(unix))]
pub fn claimed(make: impl Fn() -> io::Result<NamedTempFile>) -> io::Result<NamedTempFile> {
    make()
}

#[cfg(all(test, unix))]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn second_names_go_where_nothing_is_lost_by_it() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let at = |name: &str| folder.join(name);
        for name in ["part.nc", "held.nc", ".post-lonely.old"] {
            fs::write(at(name), name).unwrap();
        }
        for (name, second) in [("part.nc", ".post-AbCd12.old"), ("held.nc", ".post-heldby.old")] {
            fs::hard_link(at(name), at(second)).unwrap();
        }
        fs::hard_link(at("part.nc"), at(".post-of the user.old")).unwrap();
        let run = held(&at("held.nc")).unwrap();
        let names = || {
            let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
            let names = entries.map(|entry| entry.file_name().into_string().unwrap());
            let mut names: Vec<String> = names.collect();
            names.sort();
            names
        };
        delete(folder);
        let mut still =
            [".post-heldby.old", ".post-lonely.old", ".post-of the user.old", "held.nc", "part.nc"];
        assert_eq!(names(), still);
        drop(run);
        delete(folder);
        still.rotate_left(1);
        assert_eq!(names(), still[..4]);
    }
}
