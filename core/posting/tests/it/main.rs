//! Tests of posting: from CL text to the events that a dialect is asked to write.
#![allow(
    clippy::unwrap_used,
    reason = "clippy lets test functions unwrap, but not the helpers beside them"
)]

mod accuracy;
mod arcs;
mod certificate;
mod events;
mod feed;
mod helices;
mod holes;
mod path;
mod plan;
mod planes;
mod program;
mod route;
mod units;
