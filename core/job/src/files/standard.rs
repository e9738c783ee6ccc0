//! Standard output: for results alone, once a library may print.

use std::fs::File;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;

use super::file_id::FileId;
use crate::session::Session;

/// Standard output as it was, once what libraries print is kept out of it.
static RESULTS: OnceLock<Option<File>> = OnceLock::new();

/// From here on standard output is for results alone; what a library prints goes to standard error.
pub fn keep_apart() {
    RESULTS.get_or_init(post_host::keep_results_apart);
}

fn kept() -> Option<&'static File> {
    RESULTS.get().and_then(Option::as_ref)
}

/// Opens it without a buffer, in which a text would seem to have got through.
#[cfg(unix)]
pub fn open() -> io::Result<Box<dyn Write + Send>> {
    use std::os::fd::AsFd;
    let own = match kept() {
        Some(file) => file.try_clone()?,
        None => File::from(io::stdout().as_fd().try_clone_to_owned()?),
    };
    Ok(Box::new(own))
}

/// Where it stands on a disk in memory, to be fetched from there.
pub const OUTPUT: &str = "/dev/stdout";

/// Where standard error stands there.
pub const ERRORS: &str = "/dev/stderr";

/// Opens it.
#[cfg(target_family = "wasm")]
pub fn open() -> io::Result<Box<dyn Write + Send>> {
    let file = crate::disk::OpenOptions::new().create(true).append(true).open(OUTPUT)?;
    Ok(Box::new(file))
}

/// Opens standard error.
#[cfg(target_family = "wasm")]
pub fn errors() -> Box<dyn Write> {
    match crate::disk::OpenOptions::new().create(true).append(true).open(ERRORS) {
        Ok(file) => Box::new(file),
        Err(_) => Box::new(io::sink()),
    }
}

/// Opens standard error.
#[cfg(not(target_family = "wasm"))]
pub fn errors() -> Box<dyn Write> {
    Box::new(io::stderr().lock())
}

/// Opens it.
#[cfg(not(any(unix, target_family = "wasm")))]
pub fn open() -> io::Result<Box<dyn Write + Send>> {
    match kept() {
        Some(file) => Ok(Box::new(file.try_clone()?)),
        None => Ok(Box::new(io::stdout())),
    }
}

/// Which file it is; none where the system does not say.
pub fn id() -> Option<FileId> {
    match kept() {
        Some(file) => FileId::of_stream(file),
        None => FileId::of_stream(io::stdout()),
    }
}

/// What it is of what the run reads, which would be spoilt by what is printed: `the CL file part.cls`.
pub fn is_read(session: &Session) -> Option<String> {
    id().and_then(|id| session.read_files().what(&id))
}

/// Somebody reads it on a screen.
pub fn is_terminal() -> bool {
    kept().map_or_else(|| io::stdout().is_terminal(), File::is_terminal)
}

/// The path is another name of it. Once it is kept apart, the system takes such a name for what libraries print to.
pub fn is_named(path: &Path) -> bool {
    ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"].iter().any(|name| path == Path::new(name))
}
