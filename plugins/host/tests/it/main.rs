//! Tests of the host, with plugins linked in, opened as libraries, and hostile ones.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

mod common;
mod guide;
mod libraries;
mod papers;
mod strangers;
mod units;
