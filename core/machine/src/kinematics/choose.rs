//! Which solution to take: here the one nearest to the last point, inside travel, with turns carried on.

use std::f64::consts::TAU;

use super::chain::Joints;
use super::inverse::Solver;
use super::orientation::{Branches, RotarySet};
use super::travel::{OverTravel, passed};

/// What the choice needs to know of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotaryTravel {
    /// Place in the chain.
    pub joint: usize,
    /// Least and largest value: mm or radians.
    pub travel: [f64; 2],
}

/// Travel and turns of the rotary axes.
#[derive(Clone, Debug, Default)]
pub struct RotaryAxes {
    /// Rotary axes with travel.
    pub limits: Vec<RotaryTravel>,
    /// Places in the chain of rotary axes without travel.
    pub cyclic: Vec<usize>,
}

/// A branch with its angles on their nearest turns.
#[derive(Clone, Copy, Debug)]
pub struct BranchChoice {
    /// Which branch.
    pub index: usize,
    /// The rotary angles, or why they are outside travel.
    pub joints: Result<Joints, OverTravel>,
}

impl RotaryAxes {
    /// The branch nearest to `last` by the sum of the turns, each angle taken on the turn that is nearest and
    /// inside travel. `likely` is the branch to look at first: where the other is provably farther, it is not
    /// even worked out. A tie (a start on the pole) goes to the larger angle of the axis nearer the tool.
    /// If no branch is inside travel, the fault is that of the likely one.
    #[inline]
    pub fn nearest(
        &self,
        solver: &Solver,
        branches: &Branches,
        last: &Joints,
        likely: usize,
    ) -> BranchChoice {
        let likely = likely.min(branches.count() - 1);
        let (first, cost) = self.choice(solver, branches, last, likely);
        if branches.count() == 1 || 2.0 * cost < branches.apart() {
            return first;
        }
        let (second, other_cost) = self.choice(solver, branches, last, 1 - likely);
        let joint = solver.last_rotary();
        let better = match (&first.joints, &second.joints) {
            (_, Err(_)) => false,
            (Err(_), Ok(_)) => true,
            (Ok(a), Ok(b)) => {
                let tie = (other_cost - cost).abs() < 1e-9;
                if tie { b[joint] > a[joint] } else { other_cost < cost }
            }
        };
        if better { second } else { first }
    }

    /// The solution that makes the way from `first` over it to `last` shortest, by the sum of the turns.
    ///
    /// # Errors
    /// Of the first branch, if all are outside travel.
    pub fn between(
        &self,
        solver: &Solver,
        branches: &Branches,
        first: &Joints,
        last: &Joints,
    ) -> Result<Joints, OverTravel> {
        let halfway: Joints = std::array::from_fn(|joint| (first[joint] + last[joint]) / 2.0);
        let way = |joints: &Joints| -> f64 {
            let limited = self.limits.iter().map(|limit| limit.joint);
            limited
                .chain(self.cyclic.iter().copied())
                .map(|joint| {
                    (joints[joint] - first[joint]).abs() + (last[joint] - joints[joint]).abs()
                })
                .sum()
        };
        let mut best: Option<(Joints, f64)> = None;
        let mut fault = None;
        for index in 0..branches.count() {
            match self.choice(solver, branches, &halfway, index).0.joints {
                Ok(joints) => {
                    let cost = way(&joints);
                    if best.as_ref().is_none_or(|(_, least)| cost < *least - 1e-9) {
                        best = Some((joints, cost));
                    }
                }
                Err(over) => {
                    fault.get_or_insert(over);
                }
            }
        }
        match (best, fault) {
            (Some((joints, _)), _) => Ok(joints),
            (None, Some(over)) => Err(over),
            // There is one branch at least.
            (None, None) => Ok(halfway),
        }
    }

    /// A branch, and the sum of its turns from `last`; infinite outside travel.
    #[inline]
    fn choice(
        &self,
        solver: &Solver,
        branches: &Branches,
        last: &Joints,
        index: usize,
    ) -> (BranchChoice, f64) {
        let set = solver.angles(branches, index);
        match near(set, last, &self.limits, &self.cyclic) {
            Ok((joints, cost)) => (BranchChoice { index, joints: Ok(joints) }, cost),
            Err(over) => (BranchChoice { index, joints: Err(over) }, f64::INFINITY),
        }
    }
}

/// One set on its nearest turns, and the sum of its turns from `last`.
#[inline]
fn near(
    mut set: RotarySet,
    last: &Joints,
    limits: &[RotaryTravel],
    cyclic: &[usize],
) -> Result<(Joints, f64), OverTravel> {
    let mut cost = 0.0;
    set.keep(last);
    let joints = &mut set.joints;
    for &joint in cyclic {
        let value = unwound(joints[joint], last[joint]);
        joints[joint] = value;
        cost += (value - last[joint]).abs();
    }
    for limit in limits {
        let joint = limit.joint;
        let mut value = unwound(joints[joint], last[joint]);
        let [least, most] = limit.travel;
        if value > most {
            value -= TAU * f64::ceil((value - most) / TAU);
        } else if value < least {
            value += TAU * f64::ceil((least - value) / TAU);
        }
        if passed(Some(limit.travel), value, 0.0).is_some() {
            let asked = unwound(joints[joint], (least + most) / 2.0);
            return Err(OverTravel {
                joint,
                value: asked,
                limit: if asked > most { most } else { least },
            });
        }
        joints[joint] = value;
        cost += (value - last[joint]).abs();
    }
    Ok((set.joints, cost))
}

/// `angle` on the turn nearest to `last`.
#[inline]
fn unwound(angle: f64, last: f64) -> f64 {
    let difference = angle - last;
    if difference.abs() <= TAU / 2.0 {
        return angle;
    }
    angle - TAU * f64::round(difference / TAU)
}
