//! Going on from one stand to the next: full turns, what stands still, and what may bulge in between.

use std::f64::consts::{PI, TAU};

use super::solution::{AxisSolution, ChoiceAxes, unwound};
use post_machine::kinematics::Joints;
use post_machine::kinematics::travel::{OverTravel, over};

/// Values that differ by less are the same, mm or radians.
const SAME: f64 = 1e-9;

impl ChoiceAxes {
    /// Puts the pointing joints of `stand` on the turns nearest to `last`.
    ///
    /// # Errors
    /// The axis that this takes out of its travel.
    #[inline]
    pub(crate) fn carried(
        &self,
        stand: &AxisSolution,
        last: &Joints,
    ) -> Result<Joints, OverTravel> {
        let mut joints = stand.joints;
        for axis in &self.turning {
            let joint = axis.joint;
            if stand.free & (1 << joint) != 0 {
                joints[joint] = last[joint];
                continue;
            }
            let away = last[joint] - joints[joint];
            if away.abs() > PI {
                joints[joint] += TAU * f64::round(away / TAU);
            }
            let value = joints[joint];
            over(joint, axis.travel, value, 0.0)?;
            if axis.forbids(value) {
                return Err(OverTravel { joint, value, limit: -axis.zero });
            }
        }
        Ok(joints)
    }

    /// Are two sets of joints the same, or, on one branch, the same but for full turns of endless axes?
    pub(crate) fn alike(&self, (a_branch, a): (u8, &Joints), (b_branch, b): (u8, &Joints)) -> bool {
        let endless = if a_branch == b_branch { self.endless } else { 0 };
        a.iter().zip(b).enumerate().all(|(joint, (a, b))| {
            let apart = (a - b).abs();
            apart < SAME
                || (endless & (1 << joint) != 0
                    && (apart - TAU * f64::round(apart / TAU)).abs() < SAME)
        })
    }

    /// The full turns of pointing axes that lead from one set of joints to another, radians, if nothing else does.
    pub(crate) fn whole_turns(&self, from: &Joints, to: &Joints) -> Option<Joints> {
        let mut turns = Joints::default();
        for (joint, (from, to)) in from.iter().zip(to).enumerate() {
            let away = to - from;
            if self.turning.iter().any(|axis| axis.joint == joint) {
                turns[joint] = TAU * f64::round(away / TAU);
            }
            if (away - turns[joint]).abs() >= SAME {
                return None;
            }
        }
        Some(turns)
    }

    /// Is an axis that tilts closer to an end of its travel than `way`, at one of two points?
    #[inline]
    pub(crate) fn near_end(&self, from: &Joints, to: &Joints, way: f64) -> bool {
        self.turning.iter().any(|axis| {
            let (a, b) = (from[axis.joint], to[axis.joint]);
            !axis.first
                && axis
                    .travel
                    .is_some_and(|[least, most]| a.min(b) - least < way || most - a.max(b) < way)
        })
    }

    /// Calls `take` with the stand whose first axis is a full turn farther to either side than nearest to `last`,
    /// where that is inside travel.
    pub(crate) fn other_turns(
        &self,
        stand: &AxisSolution,
        last: &Joints,
        take: &mut dyn FnMut(&Joints),
    ) {
        self.first_turned(stand, last, &[-1.0, 1.0], take);
    }

    /// Calls `take` with the stand on the turns nearest to `last`, and with its first axis on every other turn
    /// inside travel; where a third axis turns against the first, on the nearest alone.
    pub(crate) fn unheld(
        &self,
        stand: &AxisSolution,
        last: &Joints,
        take: &mut dyn FnMut(&Joints),
    ) {
        let turns: &[f64] =
            if self.turning.len() > 2 { &[0.0] } else { &[0.0, -1.0, 1.0, -2.0, 2.0] };
        self.first_turned(stand, last, turns, take);
    }

    fn first_turned(
        &self,
        stand: &AxisSolution,
        last: &Joints,
        turns: &[f64],
        take: &mut dyn FnMut(&Joints),
    ) {
        let mut nearest = stand.joints;
        for axis in &self.turning {
            nearest[axis.joint] = if stand.free & (1 << axis.joint) != 0 {
                last[axis.joint]
            } else {
                unwound(nearest[axis.joint], last[axis.joint])
            };
        }
        let Some(first) = self.turning.iter().find(|axis| axis.first) else {
            return;
        };
        for turn in turns {
            let mut joints = nearest;
            joints[first.joint] += TAU * turn;
            if self.turning.iter().all(|axis| axis.allows(joints[axis.joint])) {
                take(&joints);
            }
        }
    }

    /// Calls `take` with every set of turns that `stand` can have inside travel; axes without travel are put on
    /// the turn nearest to `last` (or on the next beyond it too), free ones where they were.
    pub(crate) fn turned(
        &self,
        stand: &AxisSolution,
        last: &Joints,
        take: &mut dyn FnMut(&Joints),
    ) {
        let mut joints = stand.joints;
        self.turn_from(0, stand, last, &mut joints, take);
    }

    fn turn_from(
        &self,
        place: usize,
        stand: &AxisSolution,
        last: &Joints,
        joints: &mut Joints,
        take: &mut dyn FnMut(&Joints),
    ) {
        let Some(axis) = self.turning.get(place) else {
            take(joints);
            return;
        };
        let joint = axis.joint;
        let base = stand.joints[joint];
        let mut go = |value: f64| {
            if axis.forbids(value) {
                return;
            }
            joints[joint] = value;
            self.turn_from(place + 1, stand, last, joints, take);
        };
        if stand.free & (1 << joint) != 0 {
            go(last[joint]);
            return;
        }
        match axis.travel {
            None => {
                let nearest = base + TAU * f64::round((last[joint] - base) / TAU);
                go(nearest);
                if self.both_ways {
                    go(nearest + TAU.copysign(last[joint] - nearest));
                }
            }
            Some([least, most]) => {
                let mut turn = f64::ceil((least - base) / TAU);
                while base + TAU * turn <= most {
                    go(base + TAU * turn);
                    turn += 1.0;
                }
            }
        }
    }

    /// Leaves indexed axes where they are in a cut; false if they would have to move by more than the decimals of
    /// a CL file make them.
    #[inline]
    pub(crate) fn stand_still(&self, from: &Joints, to: &mut Joints) -> bool {
        for &joint in &self.indexed {
            if (to[joint] - from[joint]).abs() > 0.5 * self.axis_tolerance {
                return false;
            }
            to[joint] = from[joint];
        }
        true
    }

    /// The largest turn of a pointing axis, radians.
    #[inline]
    pub(crate) fn largest_turn(&self, from: &Joints, to: &Joints) -> f64 {
        self.turning
            .iter()
            .fold(0.0, |largest: f64, axis| largest.max((to[axis.joint] - from[axis.joint]).abs()))
    }
}
