//! The contract between `post` and its plugins.
//!
//! An author implements [`Dialect`] or [`ErrorModel`] and writes one export line; everything else here
//! is what those traits speak of. Nothing in this crate depends on another crate.

mod batch;
mod block;
mod deviation;
mod dialect;
mod event;
#[doc(hidden)]
pub mod export;
mod iso;
mod model;
mod number;
pub mod raw;
mod setup;
mod text;

pub use batch::Batch;
pub use block::{Axes, Block, Group, Modal, NumberStyle};
pub use deviation::{ask, length};
pub use dialect::{Dialect, DialectSession, Format, WriteFault};
pub use event::{Compensation, Coolant, Event, Feed, Spindle, SpindleSense};
pub use export::Linked;
pub use iso::{FeedDecimals, IsoMotion};
pub use model::{Curve, Deviation, ErrorModel, ModelSession, Tolerance};
pub use number::{fixed, quantise};
pub use setup::{AxisWord, OptionKind, OptionSpec, Setup, Units, Value};
pub use text::{ascii, remark};
