//! Distances and proofs, held against closed forms and brute force.
#![allow(clippy::unwrap_used, reason = "tests")]

mod beside;
mod distance;
mod oracle;
mod proof;
