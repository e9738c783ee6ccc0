//! A file that someone else reads.

use std::cell::Cell;
use std::io::{self, Read, Seek, SeekFrom};
use std::rc::Rc;

/// A file that someone else reads, and how far that has come.
pub struct Watched<R> {
    input: R,
    position: Rc<Cell<u64>>,
}

impl<R: Read + Seek> Watched<R> {
    /// From its beginning, whose length is told too.
    ///
    /// # Errors
    /// As those of `input`.
    pub fn new(mut input: R) -> io::Result<(Self, u64)> {
        let length = input.seek(SeekFrom::End(0))?;
        input.seek(SeekFrom::Start(0))?;
        let position = Rc::default();
        Ok((Self { input, position }, length))
    }

    /// The byte that is read next, kept up to date.
    pub fn position(&self) -> Rc<Cell<u64>> {
        Rc::clone(&self.position)
    }
}

impl<R: Read> Read for Watched<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(into)?;
        self.position.set(self.position.get() + count as u64);
        Ok(count)
    }
}

impl<R: Seek> Seek for Watched<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let position = self.input.seek(to)?;
        self.position.set(position);
        Ok(position)
    }
}
