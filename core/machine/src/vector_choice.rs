//! Which of several axis values a control takes that is told the tool axis as a vector (A3 B3 C3, TX TY TZ, I J K): those
//! next to where the axes stand.

use std::f64::consts::TAU;

use crate::description::Machine;
use crate::kinematics::travel::AT_END;
use crate::kinematics::{Joints, MAX_AXES};

/// How far the tool may be from a vector, radians: nearer to a pole than this an axis that the vector leaves free stands.
pub const AIMED: f64 = 1e-4;

/// More than any way of the rotary axes, radians.
const OUTSIDE: f64 = 1e6;

/// The rotary axes of a machine, whose ways decide.
#[derive(Clone, Debug)]
pub struct VectorChoice {
    rotary: [bool; MAX_AXES],
    travel: [Option<[f64; 2]>; MAX_AXES],
}

impl VectorChoice {
    /// The choice of a machine's control.
    pub fn of(machine: &Machine) -> Self {
        let axis = |place: usize| machine.axes.get(place);
        Self {
            rotary: std::array::from_fn(|place| axis(place).is_some_and(|axis| axis.joint.rotary)),
            travel: std::array::from_fn(|place| axis(place)?.travel),
        }
    }

    /// Of axis values that point the tool alike, those with the least sum of rotary ways from `last`, each axis on the turn
    /// next to where it stands that its travel has. Values outside a travel are taken only where there are no others.
    pub fn taken(&self, found: &[Joints], last: &Joints) -> Option<Joints> {
        let mut best: Option<(f64, Joints)> = None;
        for solution in found {
            let mut joints = *solution;
            let mut way = 0.0;
            let mut inside = true;
            for place in (0..MAX_AXES).filter(|place| self.rotary[*place]) {
                joints[place] = nearest_turn(joints[place], last[place], self.travel[place]);
                if let Some([least, most]) = self.travel[place] {
                    inside &= joints[place] >= least - AT_END && joints[place] <= most + AT_END;
                }
                way += libm::fabs(joints[place] - last[place]);
            }
            let way = if inside { way } else { way + OUTSIDE };
            if best.as_ref().is_none_or(|(least, _)| way < *least) {
                best = Some((way, joints));
            }
        }
        best.map(|(_, joints)| joints)
    }

    /// How far apart the rotary axes of two sets of values stand at most, radians.
    pub fn apart(&self, one: &Joints, other: &Joints) -> f64 {
        let rotary = (0..MAX_AXES).filter(|place| self.rotary[*place]);
        rotary.map(|place| libm::fabs(one[place] - other[place])).fold(0.0, f64::max)
    }
}

/// `value` (radians) by whole turns next to `last`, or a turn beside where only that lies inside the travel.
pub fn nearest_turn(value: f64, last: f64, travel: Option<[f64; 2]>) -> f64 {
    // Of half a turn either way the one that goes on is taken.
    let turns = libm::ceil((value - last) / TAU - 0.5 - 1e-12);
    let near = value - turns * TAU;
    let Some([least, most]) = travel else {
        return near;
    };
    if near > most + AT_END && near - TAU >= least - AT_END {
        near - TAU
    } else if near < least - AT_END && near + TAU <= most + AT_END {
        near + TAU
    } else {
        near
    }
}
