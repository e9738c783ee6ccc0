//! From what a CL file says to what it means: records become steps.

mod arc;
mod cycle;
mod frame;
mod interpret;
mod met;
mod spline;
mod step;
mod words;

pub use arc::Arc;
pub use cycle::{DrillCycle, Leg};
pub use interpret::{Interpreter, Reading};
pub use met::Unknown;
pub use spline::Spline;
pub use step::{ArcStep, Command, CycleStep, Motion, Pace, PlaneStep, SplineStep, Step, Tool};
pub use words::{Usage, usage};
