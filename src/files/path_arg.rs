//! A path on the command line, where `-` is standard input or output.

use std::path::{Path, PathBuf};

use clap::builder::{PathBufValueParser, TypedValueParser};

/// Where a text comes from, or where it goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PathArg {
    /// `-`: standard input or standard output.
    Standard,
    /// A file, a pipe or a device.
    Path(PathBuf),
}

impl PathArg {
    /// Reads one on the command line.
    pub fn parser() -> impl TypedValueParser<Value = Self> {
        PathBufValueParser::new().map(Self::from)
    }

    /// It is `-`.
    pub fn is_standard(&self) -> bool {
        *self == Self::Standard
    }

    /// The path, unless it is `-`.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Standard => None,
            Self::Path(path) => Some(path),
        }
    }

    /// The file's name without folder and ending, unless it is `-`.
    pub fn stem(&self) -> Option<String> {
        let stem = self.path()?.file_stem()?;
        Some(stem.to_string_lossy().into_owned())
    }
}

impl From<PathBuf> for PathArg {
    fn from(path: PathBuf) -> Self {
        if path == Path::new("-") {
            Self::Standard
        } else {
            Self::Path(path)
        }
    }
}
