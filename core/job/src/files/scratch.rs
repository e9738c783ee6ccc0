//! A text that is read again at once and then thrown away.

use std::io::{self, BufWriter, Write};

use post_posting::TextSink;

use super::FileFault;
use super::temporary::Temporary;

use crate::disk;

/// A text in the folder of temporary files.
pub struct Scratch {
    name: &'static str,
    text: BufWriter<Temporary>,
}

impl Scratch {
    /// An empty one; messages call it `name`.
    ///
    /// # Errors
    /// There is no place for it.
    pub fn new(name: &'static str) -> Result<Self, FileFault> {
        let text = Temporary::private(&disk::temp_dir()).map_err(|error| fault(name, error))?;
        Ok(Self { name, text: BufWriter::new(text) })
    }

    /// All that was written, to be read from its start.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn reread(self) -> Result<Temporary, FileFault> {
        let name = self.name;
        let text = self.text.into_inner();
        text.map_err(|error| fault(name, error.into_error()))
    }
}

impl TextSink for Scratch {
    fn write(&mut self, text: &[u8]) -> Result<(), String> {
        let written = self.text.write_all(text);
        written.map_err(|error| fault(self.name, error).to_string())
    }
}

impl Write for Scratch {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.text.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.text.flush()
    }
}

fn fault(name: &str, error: io::Error) -> FileFault {
    FileFault::NoWaiting {
        name: name.to_owned(),
        folder: disk::temp_dir(),
        error: error.kind().into(),
    }
}
