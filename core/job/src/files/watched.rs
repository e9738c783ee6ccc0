//! A file that someone else reads.

use std::io::{self, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A file that someone else reads, and how far that has come.
pub struct Watched<R> {
    input: R,
    position: ReadPosition,
}

/// The byte of a file that is read next, kept up to date by whoever reads it.
#[derive(Clone, Debug, Default)]
pub struct ReadPosition(Arc<AtomicU64>);

impl ReadPosition {
    /// Bytes before it.
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

impl<R: Read + Seek> Watched<R> {
    /// From its beginning, whose length is told too.
    ///
    /// # Errors
    /// As those of `input`.
    pub fn new(mut input: R) -> io::Result<(Self, u64)> {
        let length = input.seek(SeekFrom::End(0))?;
        input.seek(SeekFrom::Start(0))?;
        Ok((Self { input, position: ReadPosition::default() }, length))
    }

    /// The byte that is read next.
    pub fn position(&self) -> ReadPosition {
        self.position.clone()
    }
}

impl<R: Read> Read for Watched<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(into)?;
        self.position.0.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }
}

impl<R: Seek> Seek for Watched<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let position = self.input.seek(to)?;
        self.position.0.store(position, Ordering::Relaxed);
        Ok(position)
    }
}
