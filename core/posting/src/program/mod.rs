//! From what a CL file says to what it means.

mod arc;
mod cycle;
mod edge;
mod frame;
mod interpret;
mod motion;
mod spline;
mod word_census;

pub(crate) use edge::Edges;
pub(crate) use interpret::record_place;
pub use interpret::{Interpreter, Reading};
pub use motion::{Motion, Pace, Step, Tool};
pub use word_census::Unknown;
