//! The verbs of the command.

pub mod check;
pub mod list_words;
pub mod new;
pub mod post;
pub mod study;
pub mod test_plugin;
