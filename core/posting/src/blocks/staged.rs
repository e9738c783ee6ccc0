//! Moves that cannot be made in one block: index axes, axes that exclude one another.

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, Pose};

use super::{BlockReason, BlockSink, BlockStage, PathLeg, TURN};
use crate::accuracy::PathNode;
use crate::refusal;

/// Axis values that differ by less are the same: mm or radians.
const EQUAL: f64 = 1e-9;

impl BlockStage<'_> {
    /// An indexed axis stands differently.
    pub(super) fn indexes(&self, from: &PathNode, to: &PathNode) -> bool {
        let axes = self.machine.axes.iter().zip(&from.trace.joints);
        axes.zip(&to.trace.joints)
            .any(|((axis, from), to)| axis.indexed.is_some() && (from - to).abs() > TURN)
    }

    /// Axes turn with the tool retracted, not somewhere over the part: an index axis, and any axis where the CL file has turned
    /// the part.
    pub(super) fn turns_retracted(
        &self,
        from: &PathNode,
        to: &PathNode,
        part_turned: bool,
    ) -> bool {
        self.machine.indexes && self.indexes(from, to)
            || part_turned && self.turn_between(from, to) > TURN
    }

    /// Axes that exclude one another and would move together, group by group.
    pub(super) fn excluded(&self, from: &PathNode, to: &PathNode) -> Vec<Vec<usize>> {
        let moves =
            |joint: &usize| (to.trace.joints[*joint] - from.trace.joints[*joint]).abs() > EQUAL;
        let groups = self.machine.solution.exclusive.iter();
        groups
            .map(|group| group.iter().copied().filter(moves).collect::<Vec<_>>())
            .filter(|moving| moving.len() > 1)
            .collect()
    }

    /// A move with axes that exclude one another: off the part one goes after the other, a cut is refused.
    pub(super) fn by_stages(
        &mut self,
        leg: &PathLeg<'_>,
        from: &PathNode,
        node: &PathNode,
        out: &mut BlockSink<'_>,
    ) {
        let (first, last) = (from.trace.joints, node.trace.joints);
        let mut at = *from;
        let excluded = self.excluded(from, node);
        if !excluded.is_empty() && leg.loose && self.on_part {
            // Away from the part first, as the tool stands.
            self.stage(leg, &mut at, (node.target, 1.0), &first, out);
        }
        let turned_at = at.target;
        for moving in excluded {
            if !leg.loose {
                let names: Vec<&str> =
                    moving.iter().map(|joint| self.machine.axes[*joint].name.as_str()).collect();
                self.findings.at(leg.line,
                    Diagnostic::error(
                        "exclusive",
                        format!(
                            "this cut moves {} at once, and the machine moves one of them at a time",
                            names.join(" and ")
                        ),
                    )
                    .help("it can be reached in a rapid; or the machine file's [solution] exclusive is wrong"),
                );
                return;
            }
            // One after the other, the tip where it was.
            for joint in &moving[..moving.len() - 1] {
                let mut joints = at.trace.joints;
                joints[*joint] = last[*joint];
                self.stage(leg, &mut at, (turned_at, 1.0), &joints, out);
            }
        }
        self.cut(leg, &at, node, out);
    }

    /// A stop on the way of a move that is made in stages.
    fn stage(
        &mut self,
        leg: &PathLeg<'_>,
        at: &mut PathNode,
        (target, t): (Pose, f64),
        joints: &Joints,
        out: &mut BlockSink<'_>,
    ) {
        let settled = leg.placer.settled(target, t, joints);
        match settled {
            Ok(node) => {
                let leg = PathLeg { reason: BlockReason::Stage, ..*leg };
                self.cut(&leg, at, &node, out);
                *at = node;
            }
            Err(refused) => self.findings.at(leg.line, refusal::refused(self.machine, &refused)),
        }
    }
}
