//! Standard output is for results: what a library prints (`printf`) must not get in between, nor behind the last line
//! of a program when the C library empties its buffers.

#![allow(unsafe_code)]

use std::fs::File;

/// Standard output as it was, for results alone. From here on what is printed without it goes to standard error. None
/// where that cannot be: then results go where all goes.
#[cfg(unix)]
pub fn keep_results_apart() -> Option<File> {
    use std::io::Write as _;
    use std::os::fd::AsFd as _;

    let mut stdout = std::io::stdout().lock();
    stdout.flush().ok()?;
    let own = stdout.as_fd().try_clone_to_owned().ok()?;
    // SAFETY: numbers of standard error and output; the latter is replaced as a whole.
    let done = unsafe { libc::dup2(libc::STDERR_FILENO, libc::STDOUT_FILENO) };
    (done >= 0).then(|| own.into())
}

/// Elsewhere they stay together.
#[cfg(not(unix))]
pub fn keep_results_apart() -> Option<File> {
    None
}
