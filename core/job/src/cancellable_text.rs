//! A text in memory that is read until that is given up.

use std::io::{self, Cursor, Read, Seek, SeekFrom};

/// A text that cannot be read any more once its work is given up.
pub struct CancellableText<'t> {
    text: Cursor<&'t [u8]>,
    is_given_up: Box<dyn Fn() -> bool + Send + 't>,
}

impl<'t> CancellableText<'t> {
    /// From its beginning.
    pub fn new(text: &'t [u8], is_given_up: impl Fn() -> bool + Send + 't) -> Self {
        Self { text: Cursor::new(text), is_given_up: Box::new(is_given_up) }
    }
}

impl Read for CancellableText<'_> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if (self.is_given_up)() {
            return Err(io::Error::other("given up"));
        }
        self.text.read(into)
    }
}

impl Seek for CancellableText<'_> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.text.seek(to)
    }
}
