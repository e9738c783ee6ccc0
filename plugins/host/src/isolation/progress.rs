//! Where the events of a batch end and which function runs, in memory that two processes share: when the one that writes
//! is no more, the other sees how far it came.

#![allow(unsafe_code)]

use std::io;
use std::mem::ManuallyDrop;
use std::os::fd::{AsFd, OwnedFd};
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::mm::{MapFlags, ProtFlags, mmap, munmap};

use crate::call::share_function;
use crate::function::Function;

/// Events of which the end is shared; of the rest of a longer batch it is not known.
const EVENTS: usize = 1 << 16;

/// Behind the ends stands the number of the function.
const BYTES: usize = (EVENTS + 1) * size_of::<u64>();

/// The shared memory.
#[derive(Debug)]
pub(crate) struct Progress {
    ends: NonNull<u64>,
}

// SAFETY: the memory belongs to the process and not to a thread, and is written through `&mut` alone.
unsafe impl Send for Progress {}

impl Progress {
    /// Memory of its own, and the file by which another process shares it.
    pub(crate) fn new() -> io::Result<(Self, OwnedFd)> {
        let file = file()?;
        rustix::fs::ftruncate(&file, BYTES as u64)?;
        keep_size(&file)?;
        Ok((Self::of(&file)?, file))
    }

    /// The memory behind `file`, which must have been made by [`Progress::new`].
    pub(crate) fn of(file: impl AsFd) -> io::Result<Self> {
        if rustix::fs::fstat(&file)?.st_size as usize != BYTES {
            return Err(io::ErrorKind::InvalidData.into());
        }
        let (protection, shared) = (ProtFlags::READ | ProtFlags::WRITE, MapFlags::SHARED);
        // SAFETY: the system chooses a place where nothing is.
        let ends = unsafe { mmap(std::ptr::null_mut(), BYTES, protection, shared, file, 0) }?;
        let ends = NonNull::new(ends.cast()).ok_or(io::ErrorKind::OutOfMemory)?;
        Ok(Self { ends })
    }

    /// From here on the function that this process is in stands in the memory behind `file`, which stays for ever.
    pub(crate) fn share_function(file: impl AsFd) -> io::Result<()> {
        let shared = ManuallyDrop::new(Self::of(file)?);
        // SAFETY: within the memory, which is never given back, and aligned. Ends are written in front of it alone.
        share_function(unsafe { shared.function().as_ref() });
        Ok(())
    }

    /// The function that the other process was in last; none if it was in none.
    pub(crate) fn last_function(&self) -> Option<Function> {
        // SAFETY: within the memory. The other process may write still.
        Function::from_number(unsafe { self.function().as_ref() }.load(Ordering::Relaxed))
    }

    fn function(&self) -> NonNull<AtomicU64> {
        // SAFETY: within the memory, behind the ends.
        unsafe { self.ends.add(EVENTS) }.cast()
    }

    /// Room for the ends of `count` events, none of them told; none if there are too many. For the process of the library:
    /// the host writes there while that waits.
    pub(crate) fn room(&mut self, count: usize) -> Option<&mut [u64]> {
        if count > EVENTS {
            return None;
        }
        self.forget(count);
        // SAFETY: so long, aligned, and not written by the host, which waits.
        Some(unsafe { std::slice::from_raw_parts_mut(self.ends.as_ptr(), count) })
    }

    /// None of `count` events has been told.
    pub(crate) fn forget(&mut self, count: usize) {
        for index in 0..count.min(EVENTS) {
            // SAFETY: within the memory. A library that was left alone may write there still, so nothing borrows it.
            unsafe { self.ends.add(index).as_ptr().write_volatile(u64::MAX) };
        }
    }

    /// How many of `count` events were told to be written.
    pub(crate) fn told(&self, count: usize) -> usize {
        let told = |index: &usize| {
            // SAFETY: within the memory. The other process may write still, so it is read as it is.
            unsafe { self.ends.add(*index).as_ptr().read_volatile() != u64::MAX }
        };
        (0..count.min(EVENTS)).take_while(told).count()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // SAFETY: mapped so long, and nothing borrows it any more. If it stays it is but not used again.
        let _ = unsafe { munmap(self.ends.as_ptr().cast(), BYTES) };
    }
}

/// A file in memory that has no name.
#[cfg(any(target_os = "linux", target_os = "android", target_os = "freebsd"))]
fn file() -> io::Result<OwnedFd> {
    let flags = rustix::fs::MemfdFlags::CLOEXEC | rustix::fs::MemfdFlags::ALLOW_SEALING;
    Ok(rustix::fs::memfd_create("post", flags)?)
}

/// Nobody makes the file shorter: memory behind its end could not be read.
#[cfg(any(target_os = "linux", target_os = "android", target_os = "freebsd"))]
fn keep_size(file: &OwnedFd) -> io::Result<()> {
    use rustix::fs::SealFlags;
    Ok(rustix::fs::fcntl_add_seals(file, SealFlags::SHRINK | SealFlags::GROW | SealFlags::SEAL)?)
}

/// Such a file keeps no size.
#[cfg(not(any(target_os = "linux", target_os = "android", target_os = "freebsd")))]
fn keep_size(_file: &OwnedFd) -> io::Result<()> {
    Ok(())
}

/// A file in memory whose name is taken away at once.
#[cfg(not(any(target_os = "linux", target_os = "android", target_os = "freebsd")))]
fn file() -> io::Result<OwnedFd> {
    use rustix::fs::Mode;
    use rustix::shm::{OFlags, open, unlink};
    use std::sync::atomic::{AtomicU32, Ordering};

    static COUNT: AtomicU32 = AtomicU32::new(0);
    let name = format!("/post-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let file = open(&*name, OFlags::CREATE | OFlags::EXCL | OFlags::RDWR, Mode::RUSR | Mode::WUSR)?;
    unlink(&*name)?;
    Ok(file)
}
