//! Single files of the crate, each by itself.

mod dialect;
mod texts;
