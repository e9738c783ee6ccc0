//! The end of the process: a library that ends it (`exit(0)`) would look like success, with nothing done.

#![allow(unsafe_code)]

use std::io::Write as _;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};

use crate::PluginFault;
#[cfg(unix)]
use crate::Reason;
use crate::call::LoadedLibrary;
#[cfg(unix)]
use crate::call::at_work;

/// What tells the user.
type Tell = Box<dyn Fn(&PluginFault) + Send + Sync>;

static TELL: OnceLock<Tell> = OnceLock::new();

/// The program itself ends, and not a library.
static OURS: AtomicBool = AtomicBool::new(false);

/// The libraries that were opened.
static OPENED: Mutex<Vec<&'static LoadedLibrary>> = Mutex::new(Vec::new());

/// Until this value is dropped, a library that ends the process does not end it well.
#[derive(Debug)]
#[must_use]
pub struct ExitWatch(());

impl Drop for ExitWatch {
    /// The program itself goes to its end, a panic perhaps.
    fn drop(&mut self) {
        OURS.store(true, Ordering::SeqCst);
    }
}

/// From here on a library that ends the process does not end it well: `tell` is called with who it was, then the
/// process ends with exit code 1. The program itself ends by [`leave`].
///
/// What goes past the C library's `exit` is not seen: `_exit`, a signal.
pub fn watch_for_exit(tell: impl Fn(&PluginFault) + Send + Sync + 'static) -> ExitWatch {
    if TELL.set(Box::new(tell)).is_ok() {
        register();
    }
    ExitWatch(())
}

/// Ends the process with `code`. Nothing that a library left to be run at the end is run: it could change the code.
pub fn leave(code: u8) -> ! {
    // Nobody is left to tell of a standard output that is closed.
    let _ = std::io::stdout().flush();
    flush_libraries();
    leave_at_once(code)
}

/// As [`leave`], for the middle of the work: what libraries have printed and the system not yet taken is lost.
pub fn leave_at_once(code: u8) -> ! {
    OURS.store(true, Ordering::SeqCst);
    #[cfg(unix)]
    crate::isolation::kill_all();
    if opened().is_empty() {
        std::process::exit(code.into());
    }
    at_once(code)
}

#[cfg(not(target_family = "wasm"))]
pub(crate) fn library_opened(library: &'static LoadedLibrary) {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner).push(library);
}

fn opened() -> Vec<&'static LoadedLibrary> {
    let opened = OPENED.lock().unwrap_or_else(PoisonError::into_inner);
    opened.clone()
}

/// Whoever ends the process now.
#[cfg(unix)]
fn culprit() -> Option<PluginFault> {
    let fault = |library: &LoadedLibrary, message: &str| PluginFault {
        plugin: library.name.clone(),
        path: Some(library.path.clone()),
        reason: Reason::Nonsense { message: message.to_owned() },
    };
    if let Some(at_work) = at_work() {
        return Some(fault(at_work.library, "it ended the command in the middle of its work"));
    }
    let message = "the command was ended in the middle of its work, by a thread of this plugin";
    match opened().as_slice() {
        [] => None,
        [library] => Some(fault(library, message)),
        several => {
            let names: Vec<&str> = several.iter().map(|library| library.name.as_str()).collect();
            Some(PluginFault {
                plugin: names.join("`, `"),
                path: None,
                reason: Reason::Nonsense {
                    message: "the command was ended in the middle of its work, by a thread of one of these plugins"
                        .to_owned(),
                },
            })
        }
    }
}

#[cfg(unix)]
fn register() {
    // SAFETY: the function stays where it is. If there is no room for it nobody watches.
    unsafe {
        libc::atexit(ended);
        #[cfg(target_os = "linux")]
        at_quick_exit(ended);
    }
}

#[cfg(target_os = "linux")]
unsafe extern "C" {
    fn at_quick_exit(function: extern "C" fn()) -> i32;
}

#[cfg(unix)]
extern "C" fn ended() {
    if OURS.swap(true, Ordering::SeqCst) {
        return;
    }
    let Some(fault) = culprit() else { return };
    if let Some(tell) = TELL.get() {
        tell(&fault);
    }
    at_once(1)
}

/// What C code has printed waits in the C library.
#[cfg(unix)]
pub(crate) fn flush_libraries() {
    // SAFETY: null means every stream.
    unsafe { libc::fflush(std::ptr::null_mut()) };
}

#[cfg(unix)]
pub(crate) fn at_once(code: u8) -> ! {
    // SAFETY: it does not return.
    unsafe { libc::_exit(code.into()) }
}

/// Other systems have no way to see it.
#[cfg(not(unix))]
fn register() {}

#[cfg(not(unix))]
fn flush_libraries() {}

#[cfg(not(unix))]
fn at_once(code: u8) -> ! {
    std::process::exit(code.into())
}
