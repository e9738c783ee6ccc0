//! Whole runs that tests judge programs by:
//!
//! - [`posted`]: runs of posting, with the recorder of events, the sink and the models that go with them;
//! - [`walk`]: a run's words held against the path of its CL file;
//! - [`read_back`]: NC programs read back by a kinematics built from the machine's TOML.
#![allow(
    missing_docs,
    clippy::should_implement_trait,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests alone use it"
)]

pub mod posted;
pub mod read_back;
pub mod walk;
