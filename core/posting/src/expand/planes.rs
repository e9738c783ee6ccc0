//! Where tilted planes of the control begin and end: from what a first pass found out.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::preview::{FilePreview, FixedAxisRange};
use crate::program::ProgramStep;

/// Tool axes that differ by less are one, as unit vectors.
const SAME: f64 = 1e-9;

/// Follows the stretches on which the tool axis stays.
#[derive(Debug)]
pub(super) struct PlaneTracker {
    ahead: Arc<FilePreview>,
    /// The next of its stretches that is not passed.
    next: usize,
    /// The tool axis of the plane in force.
    axis: Option<Vector3<f64>>,
}

impl PlaneTracker {
    pub(super) fn new(ahead: Arc<FilePreview>) -> Self {
        Self { ahead, next: 0, axis: None }
    }

    /// The plane that begins ahead of a step from `line`, as the origin of its frame (that of the part, so that the work
    /// offset means what it means outside); none within if one ends. Nothing if all stays as it is.
    #[inline]
    pub(super) fn change(&mut self, line: u64, step: &ProgramStep) -> Option<Option<Vector3<f64>>> {
        if !matches!(
            step,
            ProgramStep::Move(_)
                | ProgramStep::Arc(_)
                | ProgramStep::Spline(_)
                | ProgramStep::Cycle(_)
        ) {
            return None;
        }
        let axis = self.at(line).map(|still| still.axis);
        let same = match (self.axis, axis) {
            (None, None) => true,
            (Some(present), Some(axis)) => (present - axis).norm() <= SAME,
            _ => false,
        };
        self.axis = axis;
        (!same).then_some(axis.map(|_| Vector3::zeros()))
    }

    /// No plane begins or ends up to `line`.
    pub(super) fn stays_until(&self, line: u64) -> bool {
        match (self.ahead.still.get(self.next), self.axis) {
            (None, None) => true,
            (Some(next), None) => line < next.first,
            (Some(present), Some(axis)) => line <= present.last && axis == present.axis,
            (None, Some(_)) => false,
        }
    }

    fn at(&mut self, line: u64) -> Option<&FixedAxisRange> {
        let stretches = &self.ahead.still;
        while stretches.get(self.next).is_some_and(|still| still.last < line) {
            self.next += 1;
        }
        stretches.get(self.next).filter(|still| still.first <= line)
    }
}
