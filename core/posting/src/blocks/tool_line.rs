//! The line of a tool that has cut: on it the tool may stand in the hole that it has made, and rapids leave it no room.

use nalgebra::Vector3;
use post_machine::description::AccuracyRules;

use super::{BlockStage, PathLeg};
use crate::accuracy::{MoveRoom, PathNode};

/// The line of a tool where a cut ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct ToolLine {
    /// Where the tip stood, mm, part frame.
    tip: Vector3<f64>,
    /// The tool axis, unit vector towards the holder, part frame.
    axis: Vector3<f64>,
}

impl ToolLine {
    /// The line of the tool at `node`; none of a knife, which makes no hole and is turned on its line.
    pub(super) fn of(node: &PathNode) -> Option<Self> {
        let target = &node.target;
        (target.edge == Vector3::zeros()).then_some(Self { tip: target.tip, axis: target.axis })
    }

    /// The tool stands on the line, within the tolerance of cuts.
    fn holds(&self, node: &PathNode, accuracy: &AccuracyRules) -> bool {
        let way = node.target.tip - self.tip;
        let aside = way - self.axis * way.dot(&self.axis);
        let lean = node.trace.pose.axis - self.axis;
        aside.norm() <= accuracy.tolerance && lean.norm() <= accuracy.axis_tolerance
    }
}

impl BlockStage<'_> {
    /// How much room a move between two nodes has; a rapid that leads off the line of the tool ends what is known of it.
    pub(super) fn room(&mut self, leg: &PathLeg<'_>, [from, to]: [&PathNode; 2]) -> MoveRoom {
        if !leg.loose {
            return MoveRoom::Part;
        }
        let accuracy = &self.machine.accuracy;
        let stays = |line: &ToolLine| line.holds(from, accuracy) && line.holds(to, accuracy);
        self.tool_line = self.tool_line.filter(stays);
        match self.tool_line {
            Some(_) => MoveRoom::ToolLine,
            None => MoveRoom::Free,
        }
    }
}
