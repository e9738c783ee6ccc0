//! What a cut takes of a stock, and how far it goes into it.

use nalgebra::Vector3;

use crate::field::Volume;
use crate::profile::ToolPose;

/// What a cut takes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Chip {
    /// How much.
    pub volume: Volume,
    /// How far it goes into what may be left; none where it takes nothing, or does not go straight.
    pub engagement: Option<Engagement>,
}

/// How far a cut goes into what may be left at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Engagement {
    /// Up from the tip along the tool axis, mm.
    pub depth: f64,
    /// Across the tool axis and the way, mm; none of a way along the axis.
    pub width: Option<f64>,
}

/// Measures what is taken on a straight way.
pub(crate) struct Gauge {
    axis: Vector3<f64>,
    across: Option<Vector3<f64>>,
    /// The lowest that the tip is along the axis, mm.
    tip: f64,
    /// The highest of what is taken along the axis, mm.
    top: f64,
    /// Least and most of it across, mm.
    sides: [f64; 2],
}

impl Gauge {
    pub fn new([from, to]: [ToolPose; 2]) -> Self {
        let axis = from.axis;
        let across = axis.cross(&(to.tip - from.tip)).try_normalize(1e-6);
        let tip = axis.dot(&from.tip).min(axis.dot(&to.tip));
        let sides = [f64::INFINITY, f64::NEG_INFINITY];
        Self { axis, across, tip, top: f64::NEG_INFINITY, sides }
    }

    /// A box that something is taken of, from corner to corner, mm.
    pub fn take(&mut self, low: Vector3<f64>, high: Vector3<f64>) {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let range = |along: Vector3<f64>| {
            let (at, far) = (along.dot(&middle), along.abs().dot(&half));
            [at - far, at + far]
        };
        self.top = self.top.max(range(self.axis)[1]);
        if let Some(across) = self.across {
            let [least, most] = range(across);
            self.sides = [self.sides[0].min(least), self.sides[1].max(most)];
        }
    }

    /// What came of it; `cell`: as far may go what is taken of cells that not all is taken of, mm.
    pub fn engagement(&self, cell: f64) -> Option<Engagement> {
        let width = self.across.map(|_| self.sides[1] - self.sides[0] + 2.0 * cell);
        let depth = self.top - self.tip + cell;
        self.top.is_finite().then_some(Engagement { depth, width })
    }
}
