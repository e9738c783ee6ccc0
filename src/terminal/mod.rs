//! What the user sees: results on standard output; questions, progress and messages on standard error.

mod findings;
mod progress;
mod quantity;

use std::io::{self, Write as _};

pub use findings::findings;
pub use progress::Progress;
pub use quantity::{clock, number};

use crate::failure::Failure;

/// Prints a result to standard output; a reader that has seen enough closes the pipe.
pub fn print(text: &str) {
    let _ = io::stdout().lock().write_all(text.as_bytes());
}

/// Prints what is no result to standard error, such as questions; a closed one leaves nobody to tell.
pub fn tell(text: &str) {
    let mut stderr = io::stderr().lock();
    let _ = stderr.write_all(text.as_bytes());
    let _ = stderr.flush();
}

/// Says why a verb failed.
pub fn explain(failure: Failure) {
    match failure {
        Failure::Usage(error) => {
            let _ = error.print();
        }
        other => findings(&other.findings()),
    }
}
