//! Observers of planned feeds.

use post_machine::description::Machine;
use post_machine::kinematics::{JointDerivatives, ORDERS};

/// A place of the planned path, on one side of a sample: the plan's acceleration may jump there.
#[derive(Clone, Copy, Debug)]
pub struct PlannedPoint<'p> {
    /// Whose axes they are: of a machine with heads, that with the head.
    pub machine: &'p Machine,
    /// Line of the CL file of its block.
    pub line: u64,
    /// Step from the place before, in units of the parameter.
    pub step: f64,
    /// What the plan takes between the two places of an interval, s; the same at each of them.
    pub seconds: f64,
    /// The control point and its first three derivatives by the parameter, mm, part frame.
    pub tip: &'p [[f64; 3]; ORDERS],
    /// The axes and theirs, and how each moves the control point.
    pub course: &'p JointDerivatives,
    /// Squared speed of the parameter, and its first and second derivative by it.
    pub q: [f64; 3],
    /// The limit that is used most.
    pub limit: &'static str,
    /// Place in the chain of the axis that it is of; after them X, Y and Z of the tip.
    pub axis: Option<u16>,
}

/// Observes the feeds that are planned.
pub trait PlanWatch {
    /// The next place, in order along the path.
    fn planned(&mut self, point: &PlannedPoint<'_>);
}
