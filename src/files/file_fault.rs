//! Why a file cannot be read or written.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use post_machine::diagnostic::Diagnostic;

use super::PathArg;

/// Why a file cannot be read or written.
#[derive(Debug)]
pub enum FileFault {
    /// It cannot be opened or read to its end.
    Read {
        /// The file as the user named it.
        name: String,
        /// What the system says.
        error: io::Error,
    },
    /// A folder stands where a CL file is wanted.
    ReadFolder(PathBuf),
    /// It cannot be made, written or replaced.
    Write {
        /// The file as the user named it.
        name: String,
        /// What the system says.
        error: io::Error,
    },
    /// The folder that it would be written into is not there.
    NoFolder {
        /// The file.
        path: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// A folder stands where a file would be written.
    WriteFolder(PathBuf),
}

impl FileFault {
    /// What could not be read at `path`.
    pub fn read(path: &Path, error: io::Error) -> Self {
        Self::Read {
            name: path.display().to_string(),
            error,
        }
    }

    /// What could not be written to `target`: most often its folder is missing.
    pub fn write(target: &PathArg, error: io::Error) -> Self {
        let Some(path) = target.path() else {
            return Self::Write {
                name: "standard output".to_owned(),
                error,
            };
        };
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        match folder {
            Some(folder) if !folder.is_dir() => Self::NoFolder {
                path: path.to_owned(),
                folder: folder.to_owned(),
            },
            _ => Self::write_at(path, error),
        }
    }

    /// What could not be written at `path`, as the system says it.
    pub fn write_at(path: &Path, error: io::Error) -> Self {
        Self::Write {
            name: path.display().to_string(),
            error,
        }
    }

    /// The stable name for programs to read.
    fn code(&self) -> &'static str {
        match self {
            Self::Read { .. } | Self::ReadFolder(_) => "input",
            Self::Write { .. } | Self::NoFolder { .. } | Self::WriteFolder(_) => "output",
        }
    }
}

impl fmt::Display for FileFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { name, error } | Self::Write { name, error } => {
                write!(formatter, "{name}: {error}")
            }
            Self::ReadFolder(path) => {
                write!(formatter, "{} is a folder, not a CL file", path.display())
            }
            Self::NoFolder { path, folder } => write!(
                formatter,
                "{}: there is no folder {}",
                path.display(),
                folder.display()
            ),
            Self::WriteFolder(path) => write!(formatter, "{} is a folder", path.display()),
        }
    }
}

impl From<FileFault> for Diagnostic {
    fn from(fault: FileFault) -> Self {
        Self::error(fault.code(), fault.to_string())
    }
}
