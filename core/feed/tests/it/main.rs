//! The crate as its callers see it.

mod agreement;
mod infeasible;
mod streaming;
mod support;
