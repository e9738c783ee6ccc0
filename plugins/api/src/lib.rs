//! The contract between `post` and its plugins.
//!
//! An author implements [`Dialect`] or [`ErrorModel`] and writes one export line; everything else here
//! is what those traits speak of. Nothing in this crate depends on another crate.

mod batch;
mod dialect;
mod event;
mod model;
mod setup;

pub use batch::Batch;
pub use dialect::{Dialect, DialectSession, Format, WriteFault};
pub use event::{Compensation, Coolant, Event, Feed, Spindle, SpindleSense};
pub use model::{Curve, Deviation, ErrorModel, ModelSession, Tolerance};
pub use setup::{AxisWord, OptionKind, OptionSpec, Setup, Units, Value};
