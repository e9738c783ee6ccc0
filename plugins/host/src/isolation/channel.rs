//! The connection of two processes: messages of a length, one at a time.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::os::fd::{AsFd as _, BorrowedFd};
use std::os::unix::net::UnixStream;

use super::wire::Wire;

/// Bytes of the longest message: a batch's text and where its events end, and more than that.
const MOST: u64 = 64 << 20;

/// Bytes that are asked of the system at once.
const PIECE: usize = 1 << 16;

/// One end.
#[derive(Debug)]
pub(crate) struct Channel {
    stream: UnixStream,
    sent: Vec<u8>,
    received: Vec<u8>,
}

impl Channel {
    pub(crate) fn new(stream: UnixStream) -> Self {
        Self { stream, sent: Vec::new(), received: vec![0; PIECE] }
    }

    /// Sends what `fill` appends.
    pub(crate) fn send(&mut self, fill: impl FnOnce(&mut Vec<u8>)) -> io::Result<()> {
        self.sent.clear();
        0_u64.put(&mut self.sent);
        fill(&mut self.sent);
        let length = self.sent.len() as u64 - 8;
        self.sent[..8].copy_from_slice(&length.to_ne_bytes());
        self.stream.write_all(&self.sent)
    }

    /// The next message. `wait` comes ahead of each look for more of it, and may give it up.
    pub(crate) fn receive(
        &mut self,
        mut wait: impl FnMut(BorrowedFd<'_>) -> io::Result<()>,
    ) -> io::Result<&[u8]> {
        let mut filled = 0;
        loop {
            wait(self.stream.as_fd())?;
            match self.stream.read(&mut self.received[filled..]) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => filled += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {}
                Err(error) => return Err(error),
            }
            if let Some((length, _)) = self.received[..filled].split_first_chunk() {
                let length = u64::from_ne_bytes(*length);
                if length > MOST {
                    return Err(ErrorKind::InvalidData.into());
                }
                let whole = 8 + length as usize;
                if filled == whole {
                    return Ok(&self.received[8..whole]);
                }
                if filled > whole {
                    return Err(ErrorKind::InvalidData.into());
                }
                if self.received.len() < whole {
                    self.received.resize(whole, 0);
                }
            }
        }
    }
}
