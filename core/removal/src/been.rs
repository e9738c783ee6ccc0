//! Where a tool has been: there nothing is left that it could touch.

use nalgebra::Vector3;

use crate::profile::ToolPose;

/// Ways that are remembered, the latest ones.
const MOST: usize = 512;

/// Tool axes whose difference is no more than this are the same, and points no farther apart than this the same, mm: what
/// rounding leaves of equal words.
const SAME: f64 = 1e-7;

/// A straight way without turning that a tool has gone, and what is above it along the tool axis: its cutter, nowhere
/// thinner above than below, came in from there or could have.
#[derive(Clone, Copy, Debug)]
struct Gone {
    axis: Vector3<f64>,
    from: Vector3<f64>,
    way: Vector3<f64>,
}

/// Where a tool has been since it was changed.
#[derive(Clone, Debug, Default)]
pub struct Been {
    gone: Vec<Gone>,
    next: usize,
}

impl Been {
    /// The tool went straight from one pose to the other, without turning, and whatever was there is gone.
    pub fn add(&mut self, [from, to]: [ToolPose; 2]) {
        let gone = Gone { axis: from.axis, from: from.tip, way: to.tip - from.tip };
        match self.gone.get_mut(self.next) {
            Some(place) => *place = gone,
            None => self.gone.push(gone),
        }
        self.next = (self.next + 1) % MOST;
    }

    /// Another tool has been nowhere.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// A straight way without turning, along which it has been before: all of it lies on or above one that was gone.
    pub fn covers(&self, [from, to]: [ToolPose; 2]) -> bool {
        let ends = [from.tip, to.tip];
        self.gone.iter().rev().any(|gone| {
            (gone.axis - from.axis).norm() <= SAME && ends.iter().all(|end| gone.is_below(*end))
        })
    }
}

impl Gone {
    /// A point of it is below `tip`, along the tool axis.
    fn is_below(&self, tip: Vector3<f64>) -> bool {
        let split = |vector: Vector3<f64>| {
            let height = vector.dot(&self.axis);
            (height, vector - self.axis * height)
        };
        let ((height, aside), (rise, across)) = (split(tip - self.from), split(self.way));
        let length = across.norm();
        if length <= SAME {
            // It went along its axis: from the lower end up.
            return aside.norm() <= SAME && height >= rise.min(0.0) - SAME;
        }
        let share = aside.dot(&across) / (length * length);
        let over = SAME / length;
        let beside = (aside - across * share).norm();
        (-over..=1.0 + over).contains(&share) && beside <= SAME && height >= rise * share - SAME
    }
}
