//! Temporary files that a signal finds and takes away: whoever presses Ctrl-C leaves no half of a program behind.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
#[cfg(unix)]
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, NamedTempFile};

use super::abandoned::{self, PREFIX, SUFFIX};
use super::file_id::folder as folder_of;

/// Paths of the temporary files that exist. A file is made, renamed and deleted with this locked, so that a signal finds
/// every one, and never one that has its name already.
static LIVE: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// How many files this run has given their names; counted with the paths locked.
static NAMED: AtomicUsize = AtomicUsize::new(0);

/// Folders in which this run has deleted what killed runs left, once, however many files it makes there; what was replaced
/// in each while its run did not come to its end.
static TIDIED: Mutex<BTreeMap<PathBuf, Vec<PathBuf>>> = Mutex::new(BTreeMap::new());

/// The paths, locked: a signal waits until it is let go.
pub type LivePaths = MutexGuard<'static, BTreeSet<PathBuf>>;

/// Keeps signals waiting.
pub fn live() -> LivePaths {
    // A set of paths is whole whatever a thread died of.
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX);
    builder
}

fn tidied() -> MutexGuard<'static, BTreeMap<PathBuf, Vec<PathBuf>>> {
    TIDIED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What stood at `target` before runs that were killed is the user's no longer: this run has come to its end.
pub fn forget_former(target: &Path) {
    if let Some(formers) = tidied().get(folder_of(target)) {
        abandoned::delete_former(formers, target);
    }
}

/// A temporary file. Dropped, it is deleted.
pub struct Temporary {
    /// None once it has its name.
    file: Option<NamedTempFile>,
}

impl Temporary {
    /// A new one in a folder, for its owner alone to read.
    pub fn private(folder: &Path) -> io::Result<Self> {
        Self::new(&builder(), folder)
    }

    /// A new one in a folder, with the rights that the system gives to new files there.
    pub fn shared(folder: &Path) -> io::Result<Self> {
        let mut builder = builder();
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // The system takes away what the umask says.
            builder.permissions(std::fs::Permissions::from_mode(0o666));
        }
        Self::new(&builder, folder)
    }

    fn new(builder: &Builder<'_, '_>, folder: &Path) -> io::Result<Self> {
        let mut live = live();
        tidied().entry(folder.to_owned()).or_insert_with(|| abandoned::delete(folder));
        let file = abandoned::claimed(|| builder.tempfile_in(folder))?;
        live.insert(file.path().to_owned());
        #[cfg(unix)]
        post_host::delete_on_crash(file.path());
        Ok(Self { file: Some(file) })
    }

    /// The open file.
    pub fn as_file(&self) -> io::Result<&File> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        Ok(file.as_file())
    }

    /// The file opened once more, from its start and with a place of its own in it.
    pub fn reopen(&self) -> io::Result<File> {
        let file = self.file.as_ref().ok_or(io::ErrorKind::NotFound)?;
        file.reopen()
    }

    /// Gives it its name, in the place of whatever has it. The guard keeps signals waiting.
    pub fn persist(&mut self, live: &mut LivePaths, target: &Path) -> io::Result<()> {
        let file = self.file.take().ok_or(io::ErrorKind::NotFound)?;
        live.remove(file.path());
        #[cfg(unix)]
        post_host::keep_on_crash(file.path());
        // The error holds the file, which is deleted with it; its name would only puzzle.
        let named = file.persist(target).map(drop);
        NAMED.fetch_add(named.is_ok().into(), Ordering::Relaxed);
        named.map_err(|fault| match fault.error.raw_os_error() {
            Some(code) => io::Error::from_raw_os_error(code),
            None => fault.error.kind().into(),
        })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let mut live = live();
            live.remove(file.path());
            #[cfg(unix)]
            post_host::keep_on_crash(file.path());
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

/// From here on a signal that asks the command to end (SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGALRM, SIGUSR1, SIGUSR2,
/// SIGXCPU) has the temporary files deleted first, and it is said whether files were written; the exit code is that of
/// shells: 128 and the signal's number. A file that outgrows the limit of the shell is a fault of writing and no signal.
#[cfg(unix)]
pub fn delete_on_signals() {
    use signal_hook::consts::{
        SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ,
    };
    use signal_hook::flag;
    use signal_hook::iterator::Signals;

    // With a handler, whatever it does, writing fails with an error instead.
    let _ = flag::register(SIGXFSZ, Arc::default());
    // A command that shall outlast its terminal (`nohup`) stays deaf to what it was told to ignore.
    let ignored = ignored();
    let ending = [SIGALRM, SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGUSR1, SIGUSR2, SIGXCPU];
    let heard = ending.iter().filter(|signal| ignored >> (**signal - 1) & 1 == 0);
    // Without a thread for it a signal ends the command as ever.
    let Ok(mut signals) = Signals::new(heard) else {
        return;
    };
    let waiting = move || {
        if let Some(signal) = signals.forever().next() {
            delete_temporary_files();
            let told = match NAMED.load(Ordering::Relaxed) {
                0 => "no file was written".to_owned(),
                1 => "one file was written, and is whole".to_owned(),
                count => format!("{count} files were written, and are whole"),
            };
            // Nobody may be left to tell.
            let _ = writeln!(io::stderr(), "interrupted; {told}");
            post_host::leave_at_once(128 + signal as u8);
        }
    };
    let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(waiting);
}

/// The signals that whoever started the command has told it to ignore, a bit each from that of signal 1 up; none where the
/// system does not say.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

/// Other systems end the command without asking; what it leaves lies in the folder of the target.
#[cfg(not(unix))]
pub fn delete_on_signals() {}
