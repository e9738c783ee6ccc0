//! A bar on a terminal, nothing in a pipe.

use std::cell::Cell;
use std::io::{self, IsTerminal, Read, Seek, SeekFrom};
use std::rc::Rc;

use super::gathering::is_gathering;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressFinish, ProgressStyle};

/// Records, blocks or batches between two looks at the clock.
const EVERY: u64 = 4096;

/// How far reading has come.
pub struct Progress {
    bar: ProgressBar,
    records: u64,
}

impl Progress {
    /// A bar over `bytes` of input; of unknown length, a running count.
    pub fn new(bytes: Option<u64>) -> Self {
        let bar = match bytes {
            Some(bytes) => ProgressBar::new(bytes),
            None => ProgressBar::no_length(),
        };
        // What cannot be read ends it too.
        let bar = bar.with_finish(ProgressFinish::AndClear);
        if is_gathering() || !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        let style = "{bar:40} {percent}% of {total_bytes}, {eta} left";
        if let (Some(_), Ok(style)) = (bytes, ProgressStyle::with_template(style)) {
            bar.set_style(style);
        }
        Self { bar, records: 0 }
    }

    /// One more record; `position` bytes of the input are read.
    #[inline]
    pub fn record(&mut self, position: impl FnOnce() -> u64) {
        self.records += 1;
        if self.records.is_multiple_of(EVERY) {
            self.bar.set_position(position());
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// How many of so many jobs are done.
pub struct JobsProgress {
    bar: ProgressBar,
}

impl JobsProgress {
    /// A bar over so many jobs.
    pub fn new(jobs: u64) -> Self {
        let bar = ProgressBar::new(jobs).with_finish(ProgressFinish::AndClear);
        if !std::io::stderr().is_terminal() {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) =
            ProgressStyle::with_template("{bar:40} {pos} of {len} jobs, {eta} left{msg}")
        {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// So many are done, so many of them refused.
    pub fn at(&self, done: u64, refused: u64) {
        self.bar.set_position(done);
        if refused > 0 {
            self.bar.set_message(format!(", {refused} refused"));
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

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
