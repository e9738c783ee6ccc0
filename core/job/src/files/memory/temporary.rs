//! Texts in the making on a disk in memory: nobody sees one that has no name yet, and nothing is left behind.

use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crate::disk::{self, File};

/// A text in the making.
pub struct Temporary(File);

impl Temporary {
    /// A new one, whatever the folder.
    ///
    /// # Errors
    /// None here.
    pub fn private(_: &Path) -> io::Result<Self> {
        disk::unnamed().map(Self)
    }

    /// The same: there are no rights.
    ///
    /// # Errors
    /// None here.
    pub fn shared(folder: &Path) -> io::Result<Self> {
        Self::private(folder)
    }

    /// The open file.
    ///
    /// # Errors
    /// None here.
    pub fn as_file(&self) -> io::Result<&File> {
        Ok(&self.0)
    }

    /// The file opened once more, from its start and with a place of its own in it.
    ///
    /// # Errors
    /// None here.
    pub fn reopen(&self) -> io::Result<File> {
        Ok(self.0.reopen())
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Read for Temporary {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.0.read(bytes)
    }
}

impl Seek for Temporary {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.seek(to)
    }
}

/// There are none that would outlast the run.
pub fn delete_temporary_files() {}

/// There are no signals.
pub fn delete_on_signals() {}
