//! What the user sees: results on standard output; questions, progress and messages on standard error.

mod findings;
mod progress;

use std::fs::File;
use std::io::{self, Write};
use std::sync::OnceLock;

pub use findings::findings;
pub use progress::Progress;

use crate::failure::Failure;

/// Standard output, once what libraries print is kept out of it.
static RESULTS: OnceLock<Option<File>> = OnceLock::new();

/// From here on standard output is for results alone; what a library prints goes to standard error.
pub fn keep_results_apart() {
    RESULTS.get_or_init(post_host::keep_results_apart);
}

/// Where results go: standard output.
pub fn results() -> Box<dyn Write> {
    match RESULTS.get() {
        Some(Some(file)) => Box::new(file),
        _ => Box::new(io::stdout().lock()),
    }
}

/// Prints a result to standard output; a reader that has seen enough closes the pipe.
pub fn print(text: &str) {
    let _ = results().write_all(text.as_bytes());
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
