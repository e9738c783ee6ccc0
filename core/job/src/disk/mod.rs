//! The disk: that of the system, or one in memory where there is none, as in a browser.
//!
//! Names are those of `std::fs`. What reads or writes files of the user's goes through here.

#[cfg(target_family = "wasm")]
pub mod memory;
#[cfg(not(target_family = "wasm"))]
mod system;

#[cfg(target_family = "wasm")]
pub use memory::{
    File, Metadata, OpenOptions, TryLockError, canonicalize, create_dir_all, exists, is_dir,
    is_file, metadata, open, read, read_dir, read_link, read_to_string, remove_file,
    symlink_metadata, temp_dir, unnamed,
};
#[cfg(not(target_family = "wasm"))]
pub use system::{
    File, Metadata, OpenOptions, TryLockError, canonicalize, create_dir_all, exists, is_dir,
    is_file, metadata, open, read, read_dir, read_link, read_to_string, remove_file,
    symlink_metadata, temp_dir, unnamed,
};

/// Largest table, bytes: 64 MiB.
pub const MOST_TABLE: u64 = 64 << 20;

/// The fault of a table that is larger than [`MOST_TABLE`].
pub fn too_large() -> std::io::Error {
    std::io::Error::other(format!("it is larger than {} MiB", MOST_TABLE >> 20))
}

/// All of a text that is read at once; of what has no end no more than [`MOST_TABLE`] is.
///
/// # Errors
/// As [`open`], it is larger, or not UTF-8.
pub fn read_table(path: impl AsRef<std::path::Path>) -> std::io::Result<String> {
    use std::io::Read as _;
    let mut bytes = Vec::new();
    open(path)?.take(MOST_TABLE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_TABLE {
        return Err(too_large());
    }
    String::from_utf8(bytes)
        .map_err(|_| std::io::Error::new(std::io::ErrorKind::InvalidData, "it is no UTF-8 text"))
}
