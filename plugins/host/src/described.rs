//! What a plugin says about itself.

#[cfg(unix)]
use std::sync::Arc;

use post_plugin::OptionSpec;
use post_plugin::raw::{PostDialect, PostModel};

#[cfg(unix)]
use crate::isolation::IsolatedLibrary;

/// The functions of a plugin. Every pointer in them was found not to be null, but for those that came later: what a
/// library of an earlier version does not have is null.
#[derive(Clone, Debug)]
pub(crate) enum FunctionTable {
    Dialect(PostDialect),
    Model(PostModel),
    /// They are called in a process of their own.
    #[cfg(unix)]
    Isolated(Arc<IsolatedLibrary>),
}

/// What a plugin says about itself, once it was found to hold together.
pub(crate) struct Described {
    pub(crate) name: String,
    pub(crate) version: String,
    pub(crate) about: String,
    pub(crate) table: FunctionTable,
    pub(crate) options: &'static [OptionSpec],
}

/// `name` can be part of a symbol, and of a file name without leaving its folder.
pub(crate) fn is_name(name: &str) -> bool {
    let known = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    !name.is_empty() && name.bytes().all(known)
}
