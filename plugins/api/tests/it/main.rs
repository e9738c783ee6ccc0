//! Tests of the contract between the command and its plugins.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]
#![allow(unsafe_code, reason = "raw forms are read back")]

mod header;
mod units;

// As the files in `units` name them.
mod setup {
    pub use post_plugin::{AxisWord, Setup};
}
