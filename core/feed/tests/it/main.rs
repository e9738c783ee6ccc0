//! The crate as its callers see it.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod agreement;
mod closed_forms;
mod five_axes;
mod infeasible;
mod paper;
mod properties;
mod streaming;
mod support;
