//! Finds, checks, opens and calls plugins: the host's side of the contract in `post-plugin`.
//!
//! An error model that is linked in and one that is opened from a file are called through the same pointers; a
//! linked-in dialect writes straight into the host's text instead, by the code that stands behind those pointers.
//! Nothing that a plugin returns is believed before it was checked.

mod call;
#[cfg(unix)]
mod crash;
mod described;
mod dialect;
mod ends;
pub mod examples;
mod fault;
mod finder;
mod float_mode;
mod function;
#[cfg(unix)]
mod isolation;
#[cfg(not(unix))]
#[path = "no_isolation.rs"]
mod isolation;
mod judge;
mod leave;
#[cfg(not(target_family = "wasm"))]
mod library;
mod library_dialect;
#[cfg(not(target_family = "wasm"))]
mod library_file;
mod library_model;
mod linked_plugin;
mod model;
mod options;
mod plugin;
mod program_setup;
mod results;
mod shown;
mod sink;
mod vocabulary;
mod working_folder;

#[cfg(unix)]
pub use crash::{delete_on_crash, keep_on_crash, watch_for_crash};
pub use dialect::OpenedDialect;
pub use fault::{OptionFault, PluginFault, Reason, of_the_source};
pub use finder::{Finder, ListedPlugin};
pub use isolation::{Isolation, Limits, serve_if_asked};
pub use leave::{ExitWatch, leave, leave_at_once, watch_for_exit};
pub use linked_plugin::LinkedPlugin;
pub use model::OpenedModel;
pub use options::{GivenValue, check_options, default_of, takes};
pub use plugin::{Plugin, PluginKind};
pub use program_setup::{ProgramAhead, ProgramSetup, ProgramTool, ProgramWord};
pub use results::keep_results_apart;

/// What tests look into; no part of the crate's face.
#[doc(hidden)]
pub mod internals {
    pub use crate::vocabulary::judge;
}
