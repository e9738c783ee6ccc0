//! Settles what a CL file means: records become steps.

mod arc;
mod cycle;
mod frame;
pub(crate) mod interpret;
pub mod limits;
pub(crate) mod spline;
mod step;
mod word_census;

pub use arc::PathArc;
pub use cycle::{CycleLeg, DrillCycle, HoleCycle};
pub use interpret::{ClInterpreter, DefaultSpindle, ReadingOptions};
pub use step::{
    ArcStep, Command, CycleStep, MoveFeed, PlaneStep, ProgramStep, SplineStep, StraightMove,
    SyncWait, ToolChange,
};
pub use word_census::UnknownWordPolicy;
