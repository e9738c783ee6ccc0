//! Single files of the crate, each by itself.

mod along;
mod foreign;
mod line;
mod scan;
mod text;

// Nobody outside sees it: it is compiled here once more, with the tests that stand in it.
#[allow(dead_code, reason = "tests do not use all of a file")]
#[path = "../../../src/decimal.rs"]
mod decimal;
