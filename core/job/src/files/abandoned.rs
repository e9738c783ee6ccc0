//! Temporary files of runs that were killed (`kill -9`, a machine out of memory): whoever writes beside them next deletes
//! them, and second names of files that were not replaced after all. What was replaced while its run did not come to its
//! end goes once another run has replaced the same file and come to its end. A run holds a lock on each of its own as
//! long as it lives, so that none is taken from under it.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Begin and end of the names of temporary files.
pub const PREFIX: &str = ".post-";
pub const SUFFIX: &str = ".tmp";

/// End of the names that former files have beside those that replace them.
pub const FORMER: &str = ".old";

/// How many letters of a temporary file's name are drawn.
#[cfg(unix)]
const DRAWN: usize = 6;

/// End of the names that what stood at `target` has beside it: which file it was stands in it, as a file that nothing
/// else leads to is else nobody's.
pub fn former_suffix(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default().as_encoded_bytes();
    let hash = blake3::hash(name).to_hex();
    format!("-{}{FORMER}", &hash[..16])
}

/// Deletes temporary files in `folder` that no run holds, and second names that no run holds of files that have another.
/// What cannot be deleted stays, and nobody is told: it is in nobody's way. The second names that stay.
#[cfg(unix)]
pub fn delete(folder: &Path) -> Vec<PathBuf> {
    let mut formers = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else {
        return formers;
    };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let Some(rest) = name.strip_prefix(PREFIX) else {
            continue;
        };
        // A pipe or a link of that name is none of ours, nor what is called in more letters than are drawn.
        if !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let drawn = |suffix| rest.strip_suffix(suffix).is_some_and(|drawn| drawn.len() == DRAWN);
        let of_target = |drawn: &str| drawn.as_bytes().get(DRAWN) == Some(&b'-');
        if drawn(SUFFIX) {
            delete_unless_held(&entry.path(), false);
        } else if drawn(FORMER) || rest.strip_suffix(FORMER).is_some_and(of_target) {
            delete_unless_held(&entry.path(), true);
            formers.push(entry.path());
        }
    }
    formers
}

/// Deletes those of `formers` that stood at `target` and that no run holds: another file stands there, of a run that has
/// come to its end.
#[cfg(unix)]
pub fn delete_former(formers: &[PathBuf], target: &Path) {
    let suffix = former_suffix(target);
    let of_target = |path: &&PathBuf| path.to_string_lossy().ends_with(&suffix);
    for path in formers.iter().filter(of_target) {
        delete_unless_held(path, false);
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
pub fn delete(_folder: &Path) -> Vec<PathBuf> {
    Vec::new()
}

/// Nothing is known of second names there.
#[cfg(not(unix))]
pub fn delete_former(_formers: &[PathBuf], _target: &Path) {}

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

    #[test]
    fn what_was_replaced_goes_once_the_same_file_is_replaced_again() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let second = |target: &str| at(&format!(".post-AbCd12{}", former_suffix(&at(target))));
        for target in ["part.nc", "other.nc", "held.nc"] {
            fs::write(second(target), target).unwrap();
        }
        let formers = delete(folder.path());
        assert_eq!(formers.len(), 3);
        let run = held(&second("held.nc")).unwrap();
        for target in ["part.nc", "held.nc"] {
            delete_former(&formers, &at(target));
        }
        let there = ["part.nc", "other.nc", "held.nc"].map(|target| second(target).exists());
        assert_eq!(there, [false, true, true]);
        drop(run);
    }
}
