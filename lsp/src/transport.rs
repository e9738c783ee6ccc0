//! Messages over standard input and output.
//!
//! Standard output is opened as results are: what a library of a plugin prints is kept out of it.

use std::io::{self, BufRead, Read, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};

use lsp_server::{Connection, Message, Notification};

use post_job::files::standard;

/// Longest message, bytes: the largest CL files that an editor opens, and their letters written as escapes.
const MOST_BYTES: usize = 1 << 30;

/// Longest line of a header, bytes.
const MOST_HEADER: u64 = 4096;

/// The two threads that read and write.
pub struct Transport {
    fault: Arc<Mutex<Option<io::Error>>>,
    writer: JoinHandle<io::Result<()>>,
}

/// Opens the connection with the editor.
///
/// # Errors
/// Standard output cannot be opened.
pub fn open() -> io::Result<(Connection, Transport)> {
    standard::keep_apart();
    let mut output = standard::open()?;
    let (ours, theirs) = Connection::memory();
    let fault = Arc::new(Mutex::new(None));
    let kept = Arc::clone(&fault);
    let Connection { sender, receiver } = theirs;
    thread::spawn(move || {
        let mut input = io::stdin().lock();
        loop {
            match read(&mut input) {
                Ok(Some(message)) => {
                    let last = is_exit(&message);
                    if sender.send(message).is_err() || last {
                        break;
                    }
                }
                Ok(None) => break,
                Err(error) => {
                    // It is kept before the connection is closed, so that whoever sees that finds it.
                    *kept.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                    break;
                }
            }
        }
    });
    let writer = thread::spawn(move || {
        for message in &receiver {
            let mut bytes = Vec::new();
            message.write(&mut bytes)?;
            output.write_all(&bytes)?;
            output.flush()?;
        }
        Ok(())
    });
    Ok((ours, Transport { fault, writer }))
}

impl Transport {
    /// Waits until all is written, once the connection is dropped.
    ///
    /// # Errors
    /// Reading or writing failed.
    pub fn end(self) -> io::Result<()> {
        let read = self.fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(error) = read {
            return Err(error);
        }
        match self.writer.join() {
            // An editor that closes its end hears nothing more.
            Ok(Err(error)) if error.kind() != io::ErrorKind::BrokenPipe => Err(error),
            _ => Ok(()),
        }
    }
}

fn is_exit(message: &Message) -> bool {
    matches!(message, Message::Notification(Notification { method, .. }) if method == "exit")
}

/// The next message; none at the end.
fn read(input: &mut impl BufRead) -> io::Result<Option<Message>> {
    let wrong = |why: &str| io::Error::new(io::ErrorKind::InvalidData, why.to_owned());
    let mut length = None;
    loop {
        let mut line = Vec::new();
        let count = input.by_ref().take(MOST_HEADER).read_until(b'\n', &mut line)?;
        if count == 0 {
            return Ok(None);
        }
        let line = line.trim_ascii();
        if line.is_empty() {
            break;
        }
        let line = String::from_utf8_lossy(line);
        let Some((name, value)) = line.split_once(": ") else {
            return Err(wrong("a header without a value"));
        };
        if name.eq_ignore_ascii_case("Content-Length") {
            length = value.trim().parse::<usize>().ok();
        }
    }
    let length = length.ok_or_else(|| wrong("a message without Content-Length"))?;
    if length > MOST_BYTES {
        return Err(wrong("a message that is too long"));
    }
    let mut bytes = Vec::new();
    // Memory is taken as it comes: a length alone asks for none.
    let read = input.take(length as u64).read_to_end(&mut bytes)?;
    if read < length {
        return Err(wrong("a message that breaks off"));
    }
    let message = serde_json::from_slice(&bytes).map_err(|error| wrong(&error.to_string()))?;
    Ok(Some(message))
}
