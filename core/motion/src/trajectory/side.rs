//! What a corner, a kink and a curve between two moves have to know of either of them.

use nalgebra::Vector3;

use super::bounds::MoveBounds;
use crate::Move;
use crate::limits::{AxisLimits, MoveLimits};
use crate::path::turns;

/// A move as a corner sees it.
#[derive(Clone, Copy)]
pub(super) struct CornerSide<'a> {
    pub task: &'a Move,
    pub found: &'a MoveLimits,
    /// Bounds with whole accelerations.
    pub whole: &'a MoveBounds,
    /// Bounds with half of the accelerations.
    pub half: &'a MoveBounds,
    /// The move before overlaps it.
    pub overlapped: bool,
}

impl CornerSide<'_> {
    /// A rotary axis turns on it.
    pub fn turns(&self) -> bool {
        turns(self.task.solver.chain(), [&self.task.from, &self.task.to])
    }

    /// The direction of the way where it begins (0) or ends (1), and how long all of it would be at that pace; none
    /// where it has none.
    ///
    /// That of the programmed coordinates where these are limited. A move on which rotary axes alone turn goes along X
    /// then, its length counted in degrees: recorded so of LinuxCNC 2.9.
    pub fn heading(&self, end: usize, rules: &AxisLimits) -> Option<(Vector3<f64>, f64)> {
        let unit = |way: Vector3<f64>| {
            let length = way.norm();
            (length > 0.0).then(|| (way / length, length))
        };
        let Some(coordinates) = &rules.programmed else {
            return unit(self.found.tip_ends[end]);
        };
        let mut way = Vector3::zeros();
        let mut turned = 0.0;
        let joints = self.task.solver.chain().joints();
        for (place, joint) in joints.iter().enumerate() {
            let value = self.found.ends[end][place];
            match coordinates[place] {
                Some(coordinate) => way[coordinate] = value,
                None if joint.rotary => turned += value.to_degrees() * value.to_degrees(),
                None => {}
            }
        }
        unit(way).or_else(|| (turned > 0.0).then(|| (Vector3::x(), turned.sqrt())))
    }
}
