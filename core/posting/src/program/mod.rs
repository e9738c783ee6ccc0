//! Settles what a CL file means: records become steps.

mod arc;
mod cycle;
mod frame;
pub(crate) mod interpret;
pub mod limits;
mod spline;
mod step;
mod word_census;

pub use arc::Arc;
pub use cycle::{DrillCycle, Drilling, Leg};
pub use interpret::{Interpreter, Reading, ToldSpindle};
pub use spline::Spline;
pub use step::{
    ArcStep, Command, CycleStep, HoleMark, Motion, Pace, PlaneStep, SplineStep, Step, Tool,
};
pub use word_census::Unknown;
