//! The heart of `post`: machine, kinematics, path, error control and feed.
//!
//! A record of the CL file takes one way through, never back:
//! [`program`] settles what is meant, [`kinematics`] finds the axis values, [`accuracy`] puts points in and
//! proves the deviation, [`feed`] says how fast, and the events go to a dialect. [`Post`] joins them.
//! [`check`] derives from a machine what its builder can compare, [`study`] takes the deviation of a file apart.
//! There is no input or output here, no unsafe code and no dialect's name.

pub mod accuracy;
pub mod check;
pub mod diagnostic;
pub mod feed;
pub mod kinematics;
pub mod machine;
mod path;
mod post;
pub mod program;
mod recent;
mod refusal;
pub mod report;
mod route;
pub mod study;
pub mod words;

pub use path::{Output, Watch};
pub use post::{Job, MOST_FAULTS, Post};
