//! Temporary files that a signal finds and takes away: whoever presses Ctrl-C leaves no half of a program behind.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Paths of the temporary files that exist. A file is made, renamed and deleted with this locked, so that a signal finds
/// every one, and never one that has its name already.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn live() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // A set of paths is whole whatever a thread died of.
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file. Dropped, it is deleted.
pub struct Temporary {
    /// None once it has its name.
    file: Option<NamedTempFile>,
}

impl Temporary {
    /// A new one in a folder.
    pub fn new_in(folder: &Path) -> io::Result<Self> {
        let mut live = live();
        let file = NamedTempFile::new_in(folder)?;
        live.insert(file.path().to_owned());
        Ok(Self { file: Some(file) })
    }

    /// The open file.
    pub fn as_file(&self) -> io::Result<&File> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        Ok(file.as_file())
    }

    /// Gives it its name, in the place of whatever has it.
    pub fn persist(mut self, target: &Path) -> io::Result<()> {
        let Some(file) = self.file.take() else {
            return Err(io::ErrorKind::NotFound.into());
        };
        let mut live = live();
        let path = file.path().to_owned();
        // The error holds the file, which is deleted with it.
        let named = file.persist(target).map(drop).map_err(|fault| fault.error);
        live.remove(&path);
        // The name of the temporary file would only puzzle.
        named.map_err(|error| error.kind().into())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let mut live = live();
            live.remove(file.path());
            drop(file);
        }
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.as_file()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.as_file()?.flush()
    }
}

impl Read for Temporary {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.as_file()?.read(bytes)
    }
}

impl Seek for Temporary {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.as_file()?.seek(to)
    }
}

/// Deletes the temporary files. No file is made or named any more: the command is about to end.
pub fn delete_temporary_files() {
    let live = live();
    for path in live.iter() {
        // Nobody is left to tell of a folder that was taken away.
        let _ = std::fs::remove_file(path);
    }
    std::mem::forget(live);
}

/// From here on SIGINT, SIGTERM and SIGHUP delete the temporary files before they end the command, with the exit code of shells:
/// 128 and the signal's number.
#[cfg(unix)]
pub fn delete_on_signals() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    // Without a thread for it a signal ends the command as ever.
    let Ok(mut signals) = Signals::new([SIGHUP, SIGINT, SIGTERM]) else {
        return;
    };
    let waiting = move || {
        if let Some(signal) = signals.forever().next() {
            delete_temporary_files();
            post_host::leave_at_once(128 + signal as u8);
        }
    };
    let _ = std::thread::Builder::new()
        .name("signals".to_owned())
        .spawn(waiting);
}

/// Other systems end the command without asking; what it leaves lies in the folder of the target.
#[cfg(not(unix))]
pub fn delete_on_signals() {}
