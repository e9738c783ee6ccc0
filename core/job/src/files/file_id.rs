//! Which file a path leads to: two names of one file are equal.

use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};

use super::disk;

/// How the system tells files apart: device and number on it.
#[cfg(unix)]
type Node = (u64, u64);

/// How the system tells files apart: the path without links, in small letters, as names there often are the same in both.
#[cfg(not(unix))]
type Node = String;

/// A file, or the place where one would be made. Links, hard links and several ways to a folder lead to the same one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FileId {
    /// A file that is there.
    There(Node),
    /// There is none yet: its folder, and its name in it.
    Missing(Node, OsString),
}

impl FileId {
    /// The file that a path leads to, or the place where it would be made.
    pub fn of(path: &Path) -> io::Result<Self> {
        match node(path) {
            Ok(node) => Ok(Self::There(node)),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let path = followed(path)?;
                let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
                Ok(Self::Missing(node(folder(&path))?, name.to_owned()))
            }
            Err(error) => Err(error),
        }
    }

    /// What an open stream is.
    #[cfg(unix)]
    pub fn of_stream(stream: impl std::os::fd::AsFd) -> Option<Self> {
        of_stream(stream, false)
    }

    /// The file that standard input is; none for a pipe or a terminal.
    #[cfg(unix)]
    pub fn of_standard_input() -> Option<Self> {
        of_stream(io::stdin(), true)
    }

    /// What an open stream is: not known on this system.
    #[cfg(not(unix))]
    pub fn of_stream<S>(_: S) -> Option<Self> {
        None
    }

    /// What standard input is: not known on this system.
    #[cfg(not(unix))]
    pub fn of_standard_input() -> Option<Self> {
        None
    }
}

#[cfg(unix)]
fn of_stream(stream: impl std::os::fd::AsFd, files_alone: bool) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt;
    let file = std::fs::File::from(stream.as_fd().try_clone_to_owned().ok()?);
    let metadata = file.metadata().ok()?;
    let id = FileId::There((metadata.dev(), metadata.ino()));
    (metadata.is_file() || !files_alone).then_some(id)
}

#[cfg(unix)]
fn node(path: &Path) -> io::Result<Node> {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata(path).map(|metadata| (metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
fn node(path: &Path) -> io::Result<Node> {
    Ok(disk::canonicalize(path)?.to_string_lossy().to_lowercase())
}

/// More links than this behind one another lead nowhere, as on most systems.
const MOST_LINKS: usize = 40;

/// Where a path leads: links are followed, to a file that is not there yet, too.
///
/// # Errors
/// Its folder is missing or cannot be read, or links lead in a circle.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match disk::symlink_metadata(&path) {
            Ok(metadata) if metadata.is_symlink() => {
                path = folder(&path).join(disk::read_link(&path)?);
            }
            Ok(_) => return disk::canonicalize(&path),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
                return Ok(disk::canonicalize(folder(&path))?.join(name));
            }
            Err(error) => return Err(error),
        }
    }
    // The system says it in its own words.
    disk::canonicalize(&path)
}

/// The folder that a path lies in.
pub fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}
