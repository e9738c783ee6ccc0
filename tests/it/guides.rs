//! The book under `docs/` says what is so: its examples run, its links lead somewhere, and its reference pages are what
//! the command, the schema and the tables say.
//!
//! - A block ```` ```console ```` holds commands behind `$ ` and what they print. The commands of a page run one after
//!   the other in a folder of the page's own that has copies of `machines` and of the samples under `tests`. `[..]`
//!   stands for anything within a line, a line `...` for any lines. `console,exit=1` says how its last command ends;
//!   all others must end well.
//! - A block ```` ```toml,file=NAME ```` (any language) is written to that file of the folder before what follows it.
//!
//! `UPDATE_GUIDE=1` writes into the pages what the commands print where it is something else, and the reference pages;
//! `GUIDE_PAGE=part/of/its/name` keeps to some pages.

mod codes;
#[cfg(unix)]
mod examples;
mod help;
mod links;
mod page;
mod pictures;
mod reference;
