//! The crate as its callers see it.

mod agreement;
mod five_axes;
mod infeasible;
mod streaming;
mod support;
