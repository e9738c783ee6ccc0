//! The CL file: a file, a pipe, or standard input.

use std::fs::File;
use std::io::{self, Read};

use super::{FileFault, PathArg};

/// A CL file that is read, and what is known of it.
pub struct ClInput {
    /// As the user named it.
    pub name: String,
    /// What it holds.
    pub bytes: Box<dyn Read>,
    /// How long it is, bytes, if it is a file.
    pub length: Option<u64>,
}

impl ClInput {
    /// Opens a CL file.
    pub fn open(source: &PathArg) -> Result<Self, FileFault> {
        let Some(path) = source.path() else {
            return Ok(Self {
                name: "standard input".to_owned(),
                bytes: Box::new(io::stdin().lock()),
                length: None,
            });
        };
        let fault = |error| FileFault::read(path, error);
        let file = File::open(path).map_err(fault)?;
        let metadata = file.metadata().map_err(fault)?;
        if metadata.is_dir() {
            return Err(FileFault::ReadFolder(path.to_owned()));
        }
        Ok(Self {
            name: path.display().to_string(),
            bytes: Box::new(file),
            length: metadata.is_file().then_some(metadata.len()),
        })
    }
}
