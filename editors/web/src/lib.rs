//! `post` as a WebAssembly module, for whom has JavaScript: a page, Node, VS Code for the Web.
//!
//! | part | does |
//! |---|---|
//! | `exports` | the functions that JavaScript calls and those that it lends |
//! | `request` | a request as it comes, and its answer |
//! | `command` | runs a command line of `post` on the files in memory |
//! | `editor` | the language server, without streams |
//!
//! It is the command itself: the same words, the same messages, the same bytes. Files lie on a disk in memory
//! (`post_job::disk`), put there and fetched from there by requests.

mod command;
mod editor;
mod exports;
mod request;
