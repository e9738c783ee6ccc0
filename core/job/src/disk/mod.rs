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
    is_file, metadata, read, read_dir, read_link, read_to_string, remove_file, symlink_metadata,
    temp_dir, unnamed,
};
#[cfg(not(target_family = "wasm"))]
pub use system::{
    File, Metadata, OpenOptions, TryLockError, canonicalize, create_dir_all, exists, is_dir,
    is_file, metadata, read, read_dir, read_link, read_to_string, remove_file, symlink_metadata,
    temp_dir, unnamed,
};
