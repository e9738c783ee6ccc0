//! CL files that a run opens more than once: each time they are what they were.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

use super::FileFault;

use crate::disk::{self, Metadata};

/// What of a file is another where another one has its name, or it was written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct FileStamp {
    /// Device and number on it; not known on every system.
    node: Option<(u64, u64)>,
    /// How long it is, bytes.
    length: u64,
    /// When it was written to last.
    modified: Option<SystemTime>,
}

/// A file as it was when it was first opened.
struct SeenFile {
    named: PathBuf,
    path: PathBuf,
    stamp: FileStamp,
}

/// The files of a job.
#[derive(Default)]
pub struct SeenFiles(Mutex<Vec<SeenFile>>);

impl FileStamp {
    fn of(metadata: &Metadata) -> Self {
        Self { node: node(metadata), length: metadata.len(), modified: metadata.modified().ok() }
    }
}

#[cfg(unix)]
fn node(metadata: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn node(_: &Metadata) -> Option<(u64, u64)> {
    None
}

impl SeenFiles {
    /// Takes the file that was opened at `path`, which the user has `named` so.
    ///
    /// # Errors
    /// It is not what it was when it was opened before.
    pub fn opened(&self, named: &Path, path: &Path, metadata: &Metadata) -> Result<(), FileFault> {
        let stamp = FileStamp::of(metadata);
        let mut seen = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match seen.iter().find(|file| file.path == path) {
            Some(file) if file.stamp == stamp => {}
            Some(_) => return Err(FileFault::Changed(named.to_owned())),
            None => seen.push(SeenFile { named: named.to_owned(), path: path.to_owned(), stamp }),
        }
        Ok(())
    }

    /// All was read: none of the files was written to since it was first opened. One that has lost its name to another was
    /// read whole.
    ///
    /// # Errors
    /// One was written to.
    pub fn refuse_written(&self) -> Result<(), FileFault> {
        let seen = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        for SeenFile { named, path, stamp } in seen.iter() {
            let now = disk::metadata(path).map(|metadata| FileStamp::of(&metadata));
            if now.is_ok_and(|now| now.node == stamp.node && now != *stamp) {
                return Err(FileFault::Changed(named.clone()));
            }
        }
        Ok(())
    }
}
