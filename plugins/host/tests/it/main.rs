//! Tests of the host, with plugins linked in, opened as libraries, and hostile ones.

mod boastful;
mod common;
mod conformance;
mod guide;
mod libraries;
mod papers;
mod sloppy;
mod strangers;
