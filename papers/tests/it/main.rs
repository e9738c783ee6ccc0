//! Tests of `papers` as its users run it.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod common;
mod guides;
mod plan;
mod study;
mod units;
