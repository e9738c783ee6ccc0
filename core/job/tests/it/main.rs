//! Tests of single files; what jobs do is tested by the command (`tests/it`) and by the Python package.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod units;
