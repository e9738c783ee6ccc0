//! What a library prints: the host tells it, line by line and under the library's name, so that nobody takes it for a
//! message of the command.

use std::io::{self, ErrorKind, PipeReader, PipeWriter, Read as _, Write as _};
use std::os::fd::{AsFd as _, BorrowedFd};

use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};

use crate::shown::sentence;

/// Bytes that are told of one process. What follows is read and forgotten: no call waits for it.
const MOST: usize = 1 << 16;

/// Bytes of a line; a longer one is told in pieces.
const LONGEST: usize = 1000;

/// Bytes that are read at a time, and how often in a row: a library may print faster than anybody reads.
const PIECE: usize = 1 << 12;
const PIECES: usize = 32;

/// The host's end.
#[derive(Debug)]
pub(crate) struct Printed {
    plugin: String,
    /// None once nobody can print any more.
    pipe: Option<PipeReader>,
    /// The beginning of a line.
    line: Vec<u8>,
    /// Bytes that are still told.
    left: usize,
}

impl Printed {
    /// Of the process of `plugin`, which prints into the other end.
    pub(crate) fn new(plugin: &str) -> io::Result<(Self, PipeWriter)> {
        let (reader, writer) = io::pipe()?;
        fcntl_setfl(&reader, fcntl_getfl(&reader)? | OFlags::NONBLOCK)?;
        let plugin = sentence(plugin);
        Ok((Self { plugin, pipe: Some(reader), line: Vec::new(), left: MOST }, writer))
    }

    /// Where something to read is waited for.
    pub(crate) fn waits_at(&self) -> Option<BorrowedFd<'_>> {
        self.pipe.as_ref().map(|pipe| pipe.as_fd())
    }

    /// Tells what was printed by now.
    pub(crate) fn tell(&mut self) {
        let mut piece = [0; PIECE];
        for _ in 0..PIECES {
            let Some(pipe) = &mut self.pipe else { return };
            match pipe.read(&mut piece) {
                Ok(count) if count > 0 => self.take(&piece[..count]),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                _ => self.pipe = None,
            }
        }
    }

    /// Tells the rest: nobody is waited for that prints still.
    pub(crate) fn end(&mut self) {
        self.tell();
        self.pipe = None;
        self.tell_line();
    }

    fn take(&mut self, piece: &[u8]) {
        let told = piece.len().min(self.left);
        if told == 0 {
            return;
        }
        self.left -= told;
        for byte in &piece[..told] {
            if *byte == b'\n' {
                self.tell_line();
                continue;
            }
            if is_full(self.line.len(), *byte) {
                self.tell_line();
            }
            self.line.push(*byte);
        }
        if self.left == 0 {
            self.tell_line();
            self.say(&format!("(no more is shown than {} KiB)", MOST >> 10));
        }
    }

    /// Tells the line that was begun.
    pub(crate) fn tell_line(&mut self) {
        let line = std::mem::take(&mut self.line);
        let shown = sentence(&String::from_utf8_lossy(&line));
        if !shown.is_empty() {
            self.say(&shown);
        }
        self.line = line;
        self.line.clear();
    }

    fn say(&self, line: &str) {
        // Nobody is left to tell that it failed.
        let _ = writeln!(io::stderr(), "plugin `{}` prints: {line}", self.plugin);
    }
}

/// A line of so many bytes is told before `next` is taken: a letter of several bytes stays whole.
fn is_full(bytes: usize, next: u8) -> bool {
    let begins_letter = next & 0xc0 != 0x80;
    bytes >= LONGEST + 3 || bytes >= LONGEST && begins_letter
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_line_is_cut_between_letters() {
        for letter in ["x", "ä", "€", "🔧"] {
            let (mut length, mut cut) = (0, 0);
            for byte in letter.repeat(2000).bytes() {
                if is_full(length, byte) {
                    assert_eq!(length % letter.len(), 0, "{letter} {length}");
                    (length, cut) = (0, cut + 1);
                }
                length += 1;
            }
            assert!(cut > 0);
        }
        // What is no letter at all ends all the same.
        assert!(is_full(LONGEST + 3, 0x80));
    }
}
