//! The CL file: a file, a pipe, or standard input.

use std::io::{self, Read};
use std::sync::Arc;

use post_machine::diagnostic::{FurtherFile, SourceFiles};

use super::file_id::FileId;
use super::seen_files::SeenFiles;
use super::{FileFault, PathArg};
use crate::disk;
use crate::session::Session;

/// A CL file that is read, and what is known of it.
pub struct ClInput {
    /// As the user named it.
    pub name: String,
    /// What it holds.
    pub bytes: Box<dyn Read + Send>,
    /// How long it is, bytes, if it is a file.
    pub length: Option<u64>,
    /// Files that are read behind it, as one text.
    pub further: Arc<[FurtherFile]>,
}

impl ClInput {
    /// The files that it is the text of.
    pub fn files(&self) -> SourceFiles {
        SourceFiles::new(&self.name, Arc::clone(&self.further))
    }

    /// Opens a CL file. Nothing is written to it from here on.
    pub fn open(session: &Session, source: &PathArg) -> Result<Self, FileFault> {
        Self::open_again(session, source, &SeenFiles::default())
    }

    /// The same of one that a job may have `seen` before.
    ///
    /// # Errors
    /// It cannot be opened, or is not what it was.
    pub fn open_again(
        session: &Session,
        source: &PathArg,
        seen: &SeenFiles,
    ) -> Result<Self, FileFault> {
        let (Some(path), Some(named)) = (source.absolute(), source.path()) else {
            if let Some(id) = FileId::of_standard_input() {
                session.read_files().note_id(id, "the CL file on standard input".to_owned());
            }
            return Ok(Self {
                name: "standard input".to_owned(),
                bytes: Box::new(io::stdin()),
                length: None,
                further: Arc::default(),
            });
        };
        let fault = |error| FileFault::read(named, error);
        let file = disk::open(path).map_err(fault)?;
        let metadata = file.metadata().map_err(fault)?;
        if metadata.is_dir() {
            return Err(FileFault::ReadFolder(named.to_owned()));
        }
        if metadata.is_file() {
            seen.opened(named, path, &metadata)?;
        }
        let name = named.display().to_string();
        // A terminal is read from and written to.
        if metadata.is_file()
            && let Ok(id) = FileId::of(path)
        {
            session.read_files().note_id(id, format!("the CL file {name}"));
        }
        Ok(Self {
            name,
            bytes: Box::new(session.stoppable(file)),
            length: metadata.is_file().then_some(metadata.len()),
            further: Arc::default(),
        })
    }
}
