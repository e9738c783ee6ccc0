//! What the user sees while a verb is at work.

pub mod findings;
pub mod progress;
