//! Why a file cannot be read or written.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use post_machine::diagnostic::Diagnostic;

use super::file_id::folder;
use super::{PathArg, Role};

use crate::disk;

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
    /// A folder stands where a file is to be read.
    ReadFolder(PathBuf),
    /// It is not what it was when the run first opened it.
    Changed(PathBuf),
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
    /// A whole disk stands where a file would be written.
    WriteDisk(PathBuf),
    /// What goes to a pipe cannot wait until it is whole.
    NoWaiting {
        /// Where it would go.
        name: String,
        /// The folder of temporary files.
        folder: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// Owner, group or rights of the file that a text would replace cannot be kept.
    NotKept {
        /// What the text is.
        role: Role,
        /// The file as the user named it.
        name: String,
        /// What the system says.
        error: io::Error,
    },
    /// A text would take the place of a file that the run reads.
    OverRead {
        /// What the text is.
        role: Role,
        /// Where it would go, as the user named it.
        name: String,
        /// What that file is, with its name.
        read: String,
    },
    /// What is printed would be added to a file that the run reads.
    PrintedOverRead(String),
    /// A text would replace the file that the shell adds standard output to.
    OverAppended {
        /// What the text is.
        role: Role,
        /// Where it would go, as the user named it.
        name: String,
    },
    /// Two texts of the run would go to one place.
    OverWritten {
        /// What the text is.
        role: Role,
        /// Where it would go, as the user named it.
        name: String,
        /// What the other one is.
        other: Role,
        /// Where that goes, as the user named it.
        other_name: String,
    },
    /// Whoever reads from a pipe closed it before all was written.
    ReaderGone(String),
    /// A text is whole but cannot take its name.
    Named {
        /// The file as the user named it.
        name: String,
        /// What the system says.
        error: io::Error,
        /// Files that were replaced and could not be put back, and where the earlier ones are.
        stuck: Vec<(String, Option<PathBuf>)>,
    },
}

impl FileFault {
    /// What could not be read at `path`.
    pub fn read(path: &Path, error: io::Error) -> Self {
        Self::Read { name: path.display().to_string(), error }
    }

    /// What could not be written to `target`: most often its folder is missing.
    pub fn write(target: &PathArg, error: io::Error) -> Self {
        let (Some(path), Some(named)) = (target.absolute(), target.path()) else {
            return Self::write_named("standard output", error);
        };
        if disk::is_dir(folder(path)) {
            return Self::write_named(&named.display().to_string(), error);
        }
        Self::NoFolder { path: named.to_owned(), folder: folder(named).to_owned() }
    }

    /// What could not be written at the place called `name`, as the system says it.
    pub fn write_named(name: &str, error: io::Error) -> Self {
        Self::Write { name: name.to_owned(), error }
    }

    /// The stable name for programs to read.
    fn code(&self) -> &'static str {
        match self {
            Self::Read { .. } | Self::ReadFolder(_) | Self::Changed(_) => "input",
            _ => "output",
        }
    }

    /// A file cannot be read: it is the same next time, unless the user changes it.
    pub fn is_of_input(&self) -> bool {
        self.code() == "input"
    }

    /// What can be done about it.
    fn help(&self) -> Option<String> {
        match self {
            Self::OverRead { role, .. }
            | Self::OverAppended { role, .. }
            | Self::OverWritten { role, .. } => Some(role.remedy.to_owned()),
            Self::PrintedOverRead(_) => Some("let standard output go elsewhere".to_owned()),
            Self::NotKept { role, .. } => Some(format!("delete it first, or {}", role.remedy)),
            Self::NoWaiting { .. } => {
                Some("the environment variable TMPDIR names another folder".to_owned())
            }
            Self::Changed(_) => Some("run it again once the file is written".to_owned()),
            _ => None,
        }
    }
}

impl fmt::Display for FileFault {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Read { name, error }
            | Self::Write { name, error }
            | Self::NotKept { name, error, .. } => write!(formatter, "{name}: {error}"),
            Self::ReadFolder(path) => {
                write!(formatter, "{} is a folder, not a file to read", path.display())
            }
            Self::Changed(path) => {
                write!(formatter, "{} was changed while it was read", path.display())
            }
            Self::NoFolder { path, folder } => {
                write!(formatter, "{}: there is no folder {}", path.display(), folder.display())
            }
            Self::WriteFolder(path) => write!(formatter, "{} is a folder", path.display()),
            Self::WriteDisk(path) => write!(formatter, "{} is a whole disk", path.display()),
            Self::NoWaiting { name, folder, error } => write!(
                formatter,
                "{name} gets a text only once it is whole, and until then it cannot be kept in {}: {error}",
                folder.display()
            ),
            Self::OverRead { role, name, read } => {
                write!(formatter, "the {} would overwrite {read}", role.what)?;
                if read.ends_with(&format!(" {name}")) {
                    return Ok(());
                }
                write!(formatter, ", which {name} is")
            }
            Self::PrintedOverRead(read) => {
                write!(formatter, "standard output goes to {read}, which the run reads")
            }
            Self::OverAppended { role, name } => write!(
                formatter,
                "the {} would overwrite {name}, which standard output is added to",
                role.what
            ),
            Self::OverWritten { role, name, other, other_name } => {
                if name == "standard output" && name == other_name {
                    let (other, this) = (other.what, role.what);
                    return write!(formatter, "{other} and {this} cannot both go to {name}");
                }
                write!(
                    formatter,
                    "the {} would overwrite the {} {other_name}",
                    role.what, other.what
                )?;
                if name == other_name {
                    return Ok(());
                }
                write!(formatter, ", which {name} is")
            }
            Self::ReaderGone(name) => write!(
                formatter,
                "{name}: whoever reads it closed it before the end; the text did not arrive whole"
            ),
            Self::Named { name, error, stuck } => {
                write!(formatter, "{name}: {error}")?;
                for (name, old) in stuck {
                    write!(formatter, "; {name} is new and cannot be taken back")?;
                    if let Some(old) = old {
                        write!(formatter, ", the earlier one is {}", old.display())?;
                    }
                }
                Ok(())
            }
        }
    }
}

impl From<FileFault> for Diagnostic {
    fn from(fault: FileFault) -> Self {
        let finding = Self::error(fault.code(), fault.to_string());
        match fault.help() {
            Some(help) => finding.help(help),
            None => finding,
        }
    }
}
