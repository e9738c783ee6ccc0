//! Single files of the crate, each by itself.

mod options;
mod vocabulary;

// Nobody outside sees it: it is compiled here once more, with the tests that stand in it.
#[allow(dead_code, reason = "tests do not use all of a file")]
#[path = "../../../src/shown.rs"]
mod shown;
