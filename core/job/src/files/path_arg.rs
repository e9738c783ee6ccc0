//! A path on the command line, where `-` is standard input or output.

use std::path::{self, Path, PathBuf};

/// Where a text comes from, or where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathArg {
    /// `-`: standard input or standard output.
    Standard,
    /// A file, a pipe or a device.
    Path {
        /// As the user named it.
        named: PathBuf,
        /// Where that was when the command line was read: a plugin may change the folder that the command works in.
        absolute: PathBuf,
    },
}

impl PathArg {
    /// The path as the user named it, for messages; none for `-`.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Standard => None,
            Self::Path { named, .. } => Some(named),
        }
    }

    /// The path that is opened, whatever folder the command works in by now; none for `-`.
    pub fn absolute(&self) -> Option<&Path> {
        match self {
            Self::Standard => None,
            Self::Path { absolute, .. } => Some(absolute),
        }
    }

    /// The file's name without folder and ending, unless it is `-`.
    pub fn stem(&self) -> Option<String> {
        let stem = self.path()?.file_stem()?;
        Some(stem.to_string_lossy().into_owned())
    }

    /// The same path, changed by `change`; `-` stays what it is.
    pub fn map(&self, change: impl Fn(&Path) -> PathBuf) -> Self {
        match self {
            Self::Standard => Self::Standard,
            Self::Path { named, absolute } => {
                Self::Path { named: change(named), absolute: change(absolute) }
            }
        }
    }
}

impl From<PathBuf> for PathArg {
    fn from(named: PathBuf) -> Self {
        if named == Path::new("-") {
            return Self::Standard;
        }
        // It fails where the folder was deleted under the command: opening the path then says so.
        let absolute = path::absolute(&named).unwrap_or_else(|_| named.clone());
        Self::Path { named, absolute }
    }
}
