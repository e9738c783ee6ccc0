//! A CL file becomes a program: what is meant, where the axes go, how far that strays, and how fast.
//!
//! A record of the CL file takes one way through, never back:
//! [`program`] settles what is meant, the route finds the axis values, [`accuracy`] puts points in and
//! proves the deviation, [`feed`] says how fast, and the events go to a dialect. [`Post`] joins them.
//! There is no input or output here, no unsafe code and no dialect's name.

pub mod accuracy;
pub mod feed;
mod path;
mod post;
pub mod program;
mod recent;
mod refusal;
pub mod report;
mod route;

pub use path::{Output, Watch};
pub use post::{Job, MOST_FAULTS, Post};
