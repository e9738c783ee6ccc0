//! The disk of the system.

use std::io::{self, Read as _};
use std::path::Path;

pub use std::env::temp_dir;
pub use std::fs::{
    File, Metadata, OpenOptions, TryLockError, canonicalize, create_dir_all, metadata, read_dir,
    read_link, remove_file, symlink_metadata,
};

/// Opens a file to be read. A device is none: it may have no end (`/dev/zero`). A terminal has one, and what standard
/// input is the user has chosen.
///
/// # Errors
/// It is not there, or a device.
pub fn open(path: impl AsRef<Path>) -> io::Result<File> {
    let file = File::open(path)?;
    #[cfg(unix)]
    if is_endless(&file)? {
        return Err(io::Error::other("no regular file"));
    }
    Ok(file)
}

#[cfg(unix)]
fn is_endless(file: &File) -> io::Result<bool> {
    use std::io::IsTerminal as _;
    use std::os::fd::AsFd as _;
    use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _};
    let device = file.metadata()?;
    if !device.file_type().is_char_device() || file.is_terminal() {
        return Ok(false);
    }
    let standard = File::from(io::stdin().as_fd().try_clone_to_owned()?).metadata()?;
    Ok((device.dev(), device.ino()) != (standard.dev(), standard.ino()))
}

/// All of a file.
///
/// # Errors
/// As [`open`].
pub fn read(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// All of a text.
///
/// # Errors
/// As [`open`], or it is not UTF-8.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    let mut text = String::new();
    open(path)?.read_to_string(&mut text)?;
    Ok(text)
}

/// A regular file is there.
pub fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// A folder is there.
pub fn is_dir(path: &Path) -> bool {
    path.is_dir()
}

/// Something is there.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// A file without a name, gone once nobody has it open.
///
/// # Errors
/// There is no place for it.
pub fn unnamed() -> io::Result<File> {
    tempfile::tempfile()
}
