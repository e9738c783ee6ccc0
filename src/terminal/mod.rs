//! What the user sees: results on standard output; questions, progress and messages on standard error.

mod findings;
mod progress;

use std::borrow::Cow;
use std::io::{self, Write as _};

use post_grammar::text::escaped;

pub use findings::findings;
pub use progress::Progress;

use crate::failure::Failure;

/// Lines of text in which names and texts from files, plugins and the command line cannot switch the terminal: what it
/// would obey is written as an escape.
fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, &['\n', '\t'])
}

/// Prints a result to standard output; a reader that has seen enough closes the pipe.
pub fn print(text: &str) {
    let _ = io::stdout().lock().write_all(printable(text).as_bytes());
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
        other => findings(&other.findings()),
    }
}
