//! Moves that cannot be made in one block: index axes, axes that exclude one another, axes shown over one turn.

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::{Joints, Pose};

use super::{Blocks, LONGEST, Leg, Reason, Surroundings, TURN};
use crate::accuracy::{Node, Placer};
use crate::refusal;

/// Axis values that differ by less are the same: mm or radians.
const EQUAL: f64 = 1e-9;

impl Blocks<'_> {
    /// An indexed axis stands differently.
    pub(super) fn indexes(&self, from: &Node, to: &Node) -> bool {
        let axes = self.machine.axes.iter().zip(&from.trace.joints);
        axes.zip(&to.trace.joints)
            .any(|((axis, from), to)| axis.indexed.is_some() && (from - to).abs() > TURN)
    }

    /// The move cannot be made in one go: an axis shown over one turn would take the other way round, or axes
    /// that exclude one another would move together.
    #[inline]
    pub(super) fn special(&self, from: &Node, to: &Node) -> bool {
        let way = |joint: usize| (to.trace.joints[joint] - from.trace.joints[joint]).abs();
        let mut axes = self.machine.axes.iter().enumerate();
        axes.any(|(joint, axis)| axis.range.is_some() && way(joint) > LONGEST)
            || !self.excluded(from, to).is_empty()
    }

    /// Axes that exclude one another and would move together, group by group.
    fn excluded(&self, from: &Node, to: &Node) -> Vec<Vec<usize>> {
        let moves =
            |joint: &usize| (to.trace.joints[*joint] - from.trace.joints[*joint]).abs() > EQUAL;
        let groups = self.machine.solution.exclusive.iter();
        groups
            .map(|group| group.iter().copied().filter(moves).collect::<Vec<_>>())
            .filter(|moving| moving.len() > 1)
            .collect()
    }

    pub(super) fn by_stages(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        from: &Node,
        node: &Node,
        to: &mut Surroundings<'_, '_>,
    ) {
        let (first, last) = (from.trace.joints, node.trace.joints);
        let mut at = *from;
        let excluded = self.excluded(from, node);
        if !excluded.is_empty() && leg.loose && self.on_part {
            // Away from the part first, as the tool stands.
            self.stage(placer, leg, &mut at, (node.target, 1.0), &first, to);
        }
        let turned_at = at.target;
        for moving in excluded {
            if !leg.loose {
                let names: Vec<&str> = moving
                    .iter()
                    .map(|joint| self.machine.axes[*joint].name.as_str())
                    .collect();
                to.findings.at(leg.line,
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
                self.stage(placer, leg, &mut at, (turned_at, 1.0), &joints, to);
            }
        }
        let begin = at.trace.joints;
        let longest = self
            .machine
            .axes
            .iter()
            .enumerate()
            .filter(|(_, axis)| axis.range.is_some())
            .map(|(joint, _)| (last[joint] - begin[joint]).abs())
            .fold(0.0, f64::max);
        let count = libm::ceil(longest / LONGEST).max(1.0) as u32;
        for part in 1..count {
            let t = f64::from(part) / f64::from(count);
            let joints: Joints =
                std::array::from_fn(|joint| begin[joint] * (1.0 - t) + last[joint] * t);
            let target = Pose {
                tip: turned_at.tip * (1.0 - t) + node.target.tip * t,
                axis: (from.target.axis * (1.0 - t) + node.target.axis * t)
                    .try_normalize(1e-6)
                    .unwrap_or(node.target.axis),
                ..node.target
            };
            self.stage(placer, leg, &mut at, (target, t), &joints, to);
        }
        self.cut(placer, leg, &at, node, to);
    }

    /// A stop on the way of a move that is made in stages.
    fn stage(
        &mut self,
        placer: &Placer,
        leg: &Leg<'_>,
        at: &mut Node,
        (target, t): (Pose, f64),
        joints: &Joints,
        to: &mut Surroundings<'_, '_>,
    ) {
        let settled = placer.settled(target, t, joints);
        match settled {
            Ok(node) => {
                let leg = Leg {
                    reason: Reason::Stage,
                    ..*leg
                };
                self.cut(placer, &leg, at, &node, to);
                *at = node;
            }
            Err(refused) => to
                .findings
                .at(leg.line, refusal::refused(self.machine, &refused)),
        }
    }
}
