//! Which solution to take: here the one nearest to the last point, inside travel, with turns carried on.

use std::f64::consts::TAU;

use super::chain::{Joints, MAX_AXES};
use super::inverse::{RotarySet, RotarySolutions};

/// What the choice needs to know of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Place in the chain.
    pub joint: usize,
    /// Least and largest value: mm or radians.
    pub travel: [f64; 2],
}

/// Rotary angles with their turns, the nearest first.
#[derive(Clone, Copy, Debug)]
pub struct Choices {
    choices: [Joints; 2],
    count: usize,
    over: Option<OverTravel>,
}

/// A value outside the travel of its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverTravel {
    /// Place in the chain.
    pub joint: usize,
    /// The value asked for, mm or radians.
    pub value: f64,
    /// The limit that it passes.
    pub limit: f64,
}

impl Choices {
    /// The choices inside travel, the nearest first.
    pub fn as_slice(&self) -> &[Joints] {
        &self.choices[..self.count]
    }

    /// Why the nearest set of angles was left out, if one was.
    pub fn over_travel(&self) -> Option<OverTravel> {
        self.over
    }
}

/// Orders the sets of rotary angles by the sum of the turns from `last`, each angle taken on the turn that
/// is nearest to it and inside travel. Sets that no whole turn brings inside travel are left out.
///
/// `cyclic` lists the rotary joints without travel. A tie (a start on the pole) goes to the set that the
/// solver puts first.
#[inline]
pub fn nearest(
    solutions: &RotarySolutions,
    last: &Joints,
    limits: &[Limit],
    cyclic: &[usize],
) -> Choices {
    let mut chosen = Choices {
        choices: [[0.0; MAX_AXES]; 2],
        count: 0,
        over: None,
    };
    let mut costs = [f64::INFINITY; 2];
    for set in solutions.as_slice() {
        match near(set, last, limits, cyclic) {
            Err(over) => chosen.over = chosen.over.or(Some(over)),
            Ok((joints, cost)) => {
                let place = if chosen.count == 1 && cost < costs[0] - 1e-9 {
                    chosen.choices[1] = chosen.choices[0];
                    costs[1] = costs[0];
                    0
                } else {
                    chosen.count
                };
                chosen.choices[place] = joints;
                costs[place] = cost;
                chosen.count += 1;
            }
        }
    }
    chosen
}

/// One set on its nearest turns, and the sum of its turns from `last`.
#[inline]
fn near(
    set: &RotarySet,
    last: &Joints,
    limits: &[Limit],
    cyclic: &[usize],
) -> Result<(Joints, f64), OverTravel> {
    let mut joints = set.joints;
    let mut cost = 0.0;
    if let Some(free) = set.free {
        joints[free] = last[free];
    }
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
        if value > most || value < least {
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
    Ok((joints, cost))
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
