//! The working folder, which a library may change for the whole process.

#[cfg(unix)]
mod unix {
    #![allow(unsafe_code)]

    use std::fs::File;
    use std::os::fd::AsRawFd as _;

    /// The working folder as it was, whatever its name is by now. None if it cannot be opened: then it cannot be gone
    /// back to either.
    #[derive(Debug)]
    pub(crate) struct WorkingFolder(Option<File>);

    impl WorkingFolder {
        /// As it is.
        pub(crate) fn now() -> Self {
            Self(File::open(".").ok())
        }

        /// As it was. One call of the system: cheaper than to ask whether it is another.
        pub(crate) fn restore(&self) {
            if let Some(folder) = &self.0 {
                // SAFETY: the folder is open. Where the way back is barred by now there is nobody to tell.
                unsafe { libc::fchdir(folder.as_raw_fd()) };
            }
        }
    }
}

#[cfg(not(unix))]
mod other {
    use std::path::PathBuf;

    /// The working folder as it was.
    #[derive(Debug)]
    pub(crate) struct WorkingFolder(Option<PathBuf>);

    impl WorkingFolder {
        /// As it is.
        pub(crate) fn now() -> Self {
            Self(std::env::current_dir().ok())
        }

        /// As it was.
        pub(crate) fn restore(&self) {
            if let Some(folder) = &self.0 {
                // Where the way back is barred by now there is nobody to tell.
                let _ = std::env::set_current_dir(folder);
            }
        }
    }
}

#[cfg(not(unix))]
pub(crate) use other::WorkingFolder;
#[cfg(unix)]
pub(crate) use unix::WorkingFolder;
