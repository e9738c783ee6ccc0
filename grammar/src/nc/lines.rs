//! Lines of a file, and going back to one of them.

use std::io::{self, ErrorKind, Read, Seek, SeekFrom};

use memchr::memchr2;

use super::reader::LONGEST;
use crate::layout::WINDOW;

/// Bytes asked of the input at a time: small enough that a loop over the edge of the buffer stays cheap.
const CHUNK: usize = 64 * 1024;

/// UTF-8 for U+FEFF, which some editors put before a text.
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// Bytes that stay in the buffer after the place of reading, for short loops.
const KEPT: usize = 16 * 1024;

/// How much of a line that is too long is shown.
const SHOWN: usize = 400;

/// A place in a program between two lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct NcMark {
    /// Bytes from where the reader began.
    offset: u64,
    line: u64,
}

impl NcMark {
    /// The beginning of the program.
    pub(super) const START: Self = Self { offset: 0, line: 1 };

    /// The line that begins here, counted from 1.
    pub fn line(&self) -> u64 {
        self.line
    }

    /// Bytes of the program in front of it.
    pub fn offset(&self) -> u64 {
        self.offset
    }
}

/// Lines of `input`.
#[derive(Debug)]
pub(super) struct ProgramLines<R> {
    input: R,
    buffer: Vec<u8>,
    /// What is read and not yet consumed: `buffer[start..end]`. What stands in front is still there.
    start: usize,
    end: usize,
    /// Offset of `buffer[0]`, from `origin`.
    base: u64,
    /// Where the input stood at first.
    origin: Option<u64>,
    ended: bool,
    /// Number of the line that begins at `start`.
    line: u64,
}

/// A line; offsets from the place of reading.
#[derive(Debug)]
pub(super) struct PhysicalBlockLine {
    /// Where its text ends.
    end: usize,
    /// Where the next line begins.
    next: usize,
    /// Whether the line is too long: `end` is that of its beginning, and `next` says nothing.
    pub(super) overlong: bool,
}

impl<R: Read + Seek> ProgramLines<R> {
    pub(super) fn new(input: R) -> Self {
        Self {
            input,
            buffer: vec![0; CHUNK + WINDOW],
            start: 0,
            end: 0,
            base: 0,
            origin: None,
            ended: false,
            line: 1,
        }
    }

    /// Number of the line that comes next.
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    pub(super) fn mark(&self) -> NcMark {
        NcMark { offset: self.base + self.start as u64, line: self.line }
    }

    pub(super) fn go_to(&mut self, mark: NcMark) -> io::Result<()> {
        let within = mark.offset.checked_sub(self.base).and_then(|at| usize::try_from(at).ok());
        match within {
            Some(at) if at <= self.end => self.start = at,
            _ => {
                let origin = self.origin.unwrap_or_default();
                self.input.seek(SeekFrom::Start(origin + mark.offset))?;
                self.base = mark.offset;
                (self.start, self.end, self.ended) = (0, 0, false);
            }
        }
        self.line = mark.line;
        Ok(())
    }

    pub(super) fn skip_byte_order_mark(&mut self) -> io::Result<()> {
        while self.pending().len() < BYTE_ORDER_MARK.len() && !self.ended {
            self.fill()?;
        }
        if self.pending().starts_with(BYTE_ORDER_MARK) {
            self.start += BYTE_ORDER_MARK.len();
        }
        Ok(())
    }

    /// What is read and not yet consumed.
    pub(super) fn pending(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }

    /// The input has no more than what is pending.
    pub(super) fn ended(&self) -> bool {
        self.ended
    }

    /// The text of a line; of one that is too long, its beginning.
    pub(super) fn text(&self, line: &PhysicalBlockLine) -> &[u8] {
        &self.pending()[..line.end]
    }

    /// Reads on if no whole line is pending; false if one is, if it is too long, or if nothing more comes.
    pub(super) fn read_on(&mut self) -> io::Result<bool> {
        let pending = self.pending();
        if self.ended || pending.len() > LONGEST || memchr2(b'\n', b'\r', pending).is_some() {
            return Ok(false);
        }
        self.fill()?;
        Ok(true)
    }

    /// The text of the line of this number, which is that at `mark` or one after it, if the buffer still holds it.
    pub(super) fn kept(&self, mark: NcMark, line: u64) -> Option<&[u8]> {
        let at = usize::try_from(mark.offset.checked_sub(self.base)?).ok()?;
        let mut rest = self.buffer[..self.end].get(at..)?;
        let text = |rest: &[u8]| memchr2(b'\n', b'\r', rest).unwrap_or(rest.len());
        for _ in 0..line.checked_sub(mark.line)? {
            let end = text(rest);
            rest = rest.get(end + line_end(&rest[end..], true)?..)?;
        }
        Some(&rest[..text(rest)])
    }

    /// Goes past a line.
    pub(super) fn consume(&mut self, line: &PhysicalBlockLine) -> io::Result<()> {
        if line.overlong {
            return self.pass_overlong();
        }
        self.pass(line.next);
        Ok(())
    }

    /// Goes `bytes` on, which are one line.
    pub(super) fn pass(&mut self, bytes: usize) {
        self.pass_lines(bytes, 1);
    }

    /// Goes `bytes` on, which are so many lines.
    pub(super) fn pass_lines(&mut self, bytes: usize, lines: u64) {
        self.start += bytes;
        self.line += lines;
    }

    /// Goes `bytes` back, which are so many lines that were passed since more was read.
    pub(super) fn step_back(&mut self, bytes: usize, lines: u64) {
        self.start -= bytes;
        self.line -= lines;
    }

    /// All that is held, and room behind it.
    pub(super) fn buffer(&self) -> &[u8] {
        &self.buffer
    }

    /// Where in the buffer begins what is read and not yet consumed, and where it ends.
    pub(super) fn at_hand(&self) -> [usize; 2] {
        [self.start, self.end]
    }

    /// The next line, which stays in place; none at the end of the file.
    pub(super) fn physical(&mut self) -> io::Result<Option<PhysicalBlockLine>> {
        let mut searched = 0;
        loop {
            let pending = self.pending();
            let end = match memchr2(b'\n', b'\r', &pending[searched..]) {
                Some(at) => searched + at,
                None => pending.len(),
            };
            if end > LONGEST {
                return Ok(Some(PhysicalBlockLine { end: SHOWN, next: end, overlong: true }));
            }
            let next = line_end(&pending[end..], self.ended);
            match next {
                Some(length) if end + length > 0 => {
                    return Ok(Some(PhysicalBlockLine {
                        end,
                        next: end + length,
                        overlong: false,
                    }));
                }
                Some(_) => return Ok(None),
                None => searched = end,
            }
            self.fill()?;
        }
    }

    /// Goes past a line that does not fit into the buffer.
    fn pass_overlong(&mut self) -> io::Result<()> {
        loop {
            let pending = self.pending();
            let end = memchr2(b'\n', b'\r', pending).unwrap_or(pending.len());
            if let Some(length) = line_end(&pending[end..], self.ended) {
                self.pass(end + length);
                return Ok(());
            }
            self.start += end;
            self.fill()?;
        }
    }

    /// Reads more after what is pending, and lets go what was consumed long ago.
    fn fill(&mut self) -> io::Result<()> {
        if self.origin.is_none() {
            self.origin = Some(self.input.stream_position()?);
        }
        let passed = self.start.saturating_sub(KEPT);
        if passed > 0 {
            self.buffer.copy_within(passed..self.end, 0);
            self.start -= passed;
            self.end -= passed;
            self.base += passed as u64;
        }
        loop {
            match self.input.read(&mut self.buffer[self.end..CHUNK]) {
                Ok(0) => self.ended = true,
                Ok(count) => self.end += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            }
            return Ok(());
        }
    }
}

/// How long the line end is that `rest` begins with: zero at the end of the file; none if more must be read.
pub(super) fn line_end(rest: &[u8], ended: bool) -> Option<usize> {
    match rest {
        [b'\r', b'\n', ..] => Some(2),
        [b'\r'] if !ended => None,
        [_, ..] => Some(1),
        [] if ended => Some(0),
        [] => None,
    }
}
