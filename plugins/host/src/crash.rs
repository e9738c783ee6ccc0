//! A library that kills this process by a signal, where it has no process of its own: who it was is said, and temporary
//! files are deleted. All that the handler needs is prepared before; it allocates nothing and takes no lock.

#![allow(unsafe_code)]

use std::ffi::{CString, c_char, c_int};
use std::mem::MaybeUninit;
use std::os::unix::ffi::OsStrExt as _;
use std::path::Path;
use std::ptr::null_mut;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicPtr, Ordering};

use crate::call::{AtWork, at_work};

/// What a library dies of.
const DEADLY: [c_int; 5] = [libc::SIGSEGV, libc::SIGBUS, libc::SIGILL, libc::SIGFPE, libc::SIGABRT];

/// Names of temporary files. One more than there is room for stays behind.
static FILES: [AtomicPtr<c_char>; 64] = [const { AtomicPtr::new(null_mut()) }; 64];

/// What was done about [`DEADLY`] before.
static BEFORE: OnceLock<[libc::sigaction; DEADLY.len()]> = OnceLock::new();

/// From here on a library that dies in this process is named, and the files of [`delete_on_crash`] are deleted.
pub fn watch_for_crash() {
    let before = DEADLY.map(|signal| {
        // SAFETY: of zeros all fields are valid; the handler does what a handler may.
        unsafe {
            let mut action = MaybeUninit::<libc::sigaction>::zeroed().assume_init();
            let handler: extern "C" fn(c_int) = crashed;
            action.sa_sigaction = handler as libc::sighandler_t;
            // The stack may be what is used up.
            action.sa_flags = libc::SA_ONSTACK;
            let mut before = MaybeUninit::<libc::sigaction>::zeroed().assume_init();
            libc::sigaction(signal, &action, &mut before);
            before
        }
    });
    // Whoever was first knows what was before.
    let _ = BEFORE.set(before);
}

/// Deletes the file at `path` too if a signal kills the process.
pub fn delete_on_crash(path: &Path) {
    let Ok(name) = CString::new(path.as_os_str().as_bytes()) else { return };
    let name = name.into_raw();
    let free = |place: &&AtomicPtr<c_char>| {
        place.compare_exchange(null_mut(), name, Ordering::SeqCst, Ordering::SeqCst).is_ok()
    };
    let _ = FILES.iter().find(free);
}

/// The file at `path` has another name by now, or is gone.
pub fn keep_on_crash(path: &Path) {
    for place in &FILES {
        let name = place.load(Ordering::SeqCst);
        // SAFETY: a name that was put there stays for ever: a handler on another thread may read it still.
        let is_it = !name.is_null()
            && unsafe { std::ffi::CStr::from_ptr(name) }.to_bytes() == path.as_os_str().as_bytes();
        if is_it {
            place.store(null_mut(), Ordering::SeqCst);
        }
    }
}

extern "C" fn crashed(signal: c_int) {
    let say = |text: &[u8]| {
        // SAFETY: so many bytes. Nobody is left to tell that it failed.
        unsafe { libc::write(libc::STDERR_FILENO, text.as_ptr().cast(), text.len()) };
    };
    let at_work = at_work();
    if let Some(AtWork { library, function }) = at_work {
        say(b"error[plugin]: plugin `");
        say(library.name.as_bytes());
        say(b"` (");
        say(library.path.as_os_str().as_bytes());
        say(b"): the command died of signal ");
        let digits = [b'0' + (signal / 10 % 10) as u8, b'0' + (signal % 10) as u8];
        say(digits.strip_prefix(b"0").unwrap_or(&digits));
        say(b" in the middle of its work (`");
        say(function.name().as_bytes());
        say(b"`); nothing was written\n");
        say(b"help: without --no-isolate its event and line are told too\n");
    }
    for place in &FILES {
        let name = place.swap(null_mut(), Ordering::SeqCst);
        if !name.is_null() {
            // SAFETY: a name that was put there stays for ever.
            unsafe { libc::unlink(name) };
        }
    }
    if at_work.is_some() {
        // SAFETY: it does not return.
        unsafe { libc::_exit(1) };
    }
    // What was done before is done now: the instruction is run once more, or the signal waits until this returns.
    let before = BEFORE.get().and_then(|before| {
        let place = DEADLY.iter().position(|deadly| *deadly == signal)?;
        Some(before[place])
    });
    // SAFETY: as the system gave it.
    unsafe {
        match before {
            Some(before) => libc::sigaction(signal, &before, null_mut()),
            None => libc::signal(signal, libc::SIG_DFL) as c_int,
        };
        libc::raise(signal);
    }
}
