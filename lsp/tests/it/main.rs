//! Tests of single files; what an editor hears is tested by the command (`tests/it/lsp`).
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod units;
