//! A call into a library: what it leaves changed is put back, and who is at work is known if the process ends in it.

use std::cell::Cell;
use std::path::PathBuf;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::float_mode::FloatMode;
use crate::function::Function;
use crate::working_folder::WorkingFolder;

/// A library that was opened from a file. It stays for ever, like the library itself.
#[derive(Debug)]
pub(crate) struct LoadedLibrary {
    /// Name of the plugin.
    #[cfg_attr(target_family = "wasm", expect(dead_code, reason = "no library is opened there"))]
    pub(crate) name: String,
    /// The file as the user named it.
    pub(crate) path: PathBuf,
}

/// A way into a library, or into what is linked in.
#[derive(Debug)]
pub(crate) struct Caller {
    /// None for a plugin that is part of this program: it leaves things as they are.
    stranger: Option<(&'static LoadedLibrary, WorkingFolder)>,
}

/// A library in one of its functions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtWork {
    pub(crate) library: &'static LoadedLibrary,
    #[cfg_attr(not(unix), expect(dead_code, reason = "no crash is seen there"))]
    pub(crate) function: Function,
}

thread_local! {
    static AT_WORK: Cell<Option<AtWork>> = const { Cell::new(None) };
}

/// Where another process reads which function this one is in, by its number.
static SHARED: OnceLock<&AtomicU64> = OnceLock::new();

/// The library that is at work on this thread.
#[cfg(unix)]
pub(crate) fn at_work() -> Option<AtWork> {
    AT_WORK.get()
}

/// From here on the function that this process is in stands in `place` too, which another process reads.
#[cfg(unix)]
pub(crate) fn share_function(place: &'static AtomicU64) {
    // There is one host.
    let _ = SHARED.set(place);
}

impl Caller {
    /// For calls into `library`: the working folder will stay what it is now.
    pub(crate) fn new(library: Option<&'static LoadedLibrary>) -> Self {
        Caller { stranger: library.map(|library| (library, WorkingFolder::now())) }
    }

    /// Runs `call`, which is nothing but a call into the library. What the processor does with numbers is restored
    /// behind it, and so is the working folder.
    pub(crate) fn call<R>(&self, function: Function, call: impl FnOnce() -> R) -> R {
        let Some((library, folder)) = &self.stranger else {
            return call();
        };
        let result = enter(library, function, call);
        folder.restore();
        result
    }

    /// As [`Caller::call`], for calls so short that the system would take longer than they do: the folder waits for the
    /// next call, and a session ends with one.
    pub(crate) fn short_call<R>(&self, function: Function, call: impl FnOnce() -> R) -> R {
        match &self.stranger {
            Some((library, _)) => enter(library, function, call),
            None => call(),
        }
    }
}

fn enter<R>(library: &'static LoadedLibrary, function: Function, call: impl FnOnce() -> R) -> R {
    let before = AT_WORK.replace(Some(AtWork { library, function }));
    let tell = |number| {
        if let Some(place) = SHARED.get() {
            place.store(number, Ordering::Relaxed);
        }
    };
    tell(function.number());
    let mode = FloatMode::now();
    let result = call();
    mode.restore();
    tell(before.map_or(0, |before| before.function.number()));
    AT_WORK.set(before);
    result
}
