//! The plugins that are part of `post`: the dependencies in this crate's `Cargo.toml` are the list.

use post_plugin::Linked;

/// All of them, in the order of their names.
pub fn plugins() -> &'static [Linked] {
    const PLUGINS: &[Linked] = include!(concat!(env!("OUT_DIR"), "/plugins.rs"));
    PLUGINS
}

/// The one of this name.
pub fn plugin(name: &str) -> Option<Linked> {
    plugins().iter().find(|plugin| plugin.name() == name).copied()
}
