//! The crate as its callers see it.

mod agreement;
mod five_axes;
mod infeasible;
mod paper;
mod streaming;
mod support;
