//! What the user sees: results on standard output; questions, progress and messages on standard error.

mod codes;
mod findings;
mod gathering;
mod progress;
mod quantity;
mod table;

use std::borrow::Cow;
use std::io::{self, Write as _};
use std::sync::{Mutex, PoisonError};

use post_grammar::text::escaped;

pub use codes::{CODES, Code, CodeGroup};
pub use findings::findings;
pub use gathering::{gathered, is_gathering};
pub use progress::{JobsProgress, Progress, Watched};
pub use quantity::{at_most, clock, number};
pub use table::table;

use crate::failure::Failure;
use crate::files::{FileFault, outcome, standard};

/// Lines of text in which names and texts from files, plugins and the command line cannot switch the terminal: what it
/// would obey is written as an escape.
fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, &['\n', '\t'])
}

/// Why a result could not be printed: the first fault of the run.
static UNPRINTED: Mutex<Option<io::Error>> = Mutex::new(None);

/// Prints a result to standard output. A reader that has seen enough closes the pipe; any other fault is told by
/// [`all_printed`] at the end.
pub fn print(text: &str) {
    // Whoever writes a file has been refused before that.
    if standard::is_read().is_some() {
        return;
    }
    let printed = standard::open().and_then(|mut out| {
        out.write_all(printable(text).as_bytes())?;
        out.flush()
    });
    match printed {
        Ok(()) => outcome::printed(),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {}
        Err(error) => {
            // The error is whole whatever a thread died of.
            let mut unprinted = UNPRINTED.lock().unwrap_or_else(PoisonError::into_inner);
            unprinted.get_or_insert(error);
        }
    }
}

/// All results were printed.
pub fn all_printed() -> Result<(), Failure> {
    if let Some(read) = standard::is_read() {
        return Err(FileFault::PrintedOverRead(read).into());
    }
    let mut unprinted = UNPRINTED.lock().unwrap_or_else(PoisonError::into_inner);
    match unprinted.take() {
        Some(error) => Err(FileFault::write_named("standard output", error).into()),
        None => Ok(()),
    }
}

/// Prints what is no result to standard error, such as questions; a closed one leaves nobody to tell.
pub fn tell(text: &str) {
    let mut stderr = io::stderr().lock();
    let _ = stderr.write_all(printable(text).as_bytes());
    let _ = stderr.flush();
}

/// Says why a verb failed.
pub fn explain(failure: Failure) {
    match failure {
        Failure::Usage(error) => {
            let plain = error.render().to_string();
            match printable(&plain) {
                // Colours are the terminal's own here.
                Cow::Borrowed(_) => {
                    let _ = error.print();
                }
                Cow::Owned(legible) => tell(&legible),
            }
        }
        Failure::Different => {}
        other => findings(&other.findings()),
    }
}
