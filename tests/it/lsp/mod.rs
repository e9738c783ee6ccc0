//! The language server, spoken to as an editor does: over standard input and output.

mod cl;
mod client;
mod editor;
mod machine;
mod nc;
mod protocol;
