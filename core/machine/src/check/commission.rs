//! What a commissioning program does: where the axes stand at its start, and how each is then moved by itself.

use super::probe::Probe;
use super::signs::{Sign, room, sign};
use crate::kinematics::Joints;
use crate::kinematics::travel::passed;

/// The longest way of a linear axis, mm, and the share of its travel that is enough.
const WAY: f64 = 50.0;
const SHARE: f64 = 0.1;

/// The largest turn of a rotary axis, and how much of a smaller room is used: degrees, share.
const TURN: f64 = 90.0;
const ROOM: f64 = 0.9;

/// How long a linear axis may take for its way, and a rotary one for its turn: largest feeds, mm/min and deg/min.
const LINEAR_FEED: f64 = 500.0;
const ROTARY_FEED: f64 = 360.0;
/// The share of an axis' largest feed that is never passed.
const SLOW: f64 = 0.05;

/// A plan for a program that moves one axis after the other.
#[derive(Clone, Debug)]
pub struct Commission {
    /// Where the axes stand at its start, mm and radians: retracted along the tool, in the middle across it, the
    /// rotary axes at rest.
    pub start: Joints,
    /// The moves, linear axes first.
    pub trials: Vec<CommissionMove>,
}

/// One axis moved in one direction from the start.
#[derive(Clone, Debug)]
pub struct CommissionMove {
    /// Place of the axis in the chain.
    pub place: usize,
    /// Way of the axis, mm or radians.
    pub by: f64,
    /// mm/min or deg/min.
    pub feed: f64,
    /// What must be seen.
    pub sign: Sign,
}

impl Commission {
    /// The plan for a machine; `order` gives the places of its axes.
    pub fn of(probe: &Probe<'_>, order: &[usize]) -> Self {
        let axes = &probe.machine().axes;
        let mut start = *probe.home();
        let (rotary, linear): (Vec<usize>, Vec<usize>) =
            order.iter().partition(|place| axes[**place].joint.rotary);
        for place in &linear {
            let axis = &axes[*place];
            if let (Some([least, most]), None) = (axis.travel, &axis.indexed) {
                let along = axis.joint.direction.dot(&probe.machine().tool_axis);
                // Away from the part, but with room for its own way to both sides.
                let clear = 2.0 * way(least, most);
                start[*place] = if along > 0.7 {
                    most - clear
                } else if along < -0.7 {
                    least + clear
                } else {
                    (least + most) / 2.0
                };
            }
        }
        let mut trials = Vec::new();
        for place in linear.into_iter().chain(rotary) {
            let axis = &axes[place];
            for sense in [1.0, -1.0] {
                let by = match (&axis.indexed, axis.travel) {
                    (Some(_), _) if !axis.joint.rotary => continue,
                    (None, Some([least, most])) if !axis.joint.rotary => way(least, most),
                    _ => turn(room(probe, place, sense)),
                };
                let mut to = start[place] + sense * by;
                if let Some(indexed) = &axis.indexed {
                    to = indexed.positions.nearest(to, axis.travel.is_none());
                }
                let by = to - start[place];
                let inside = passed(axis.travel, to, 0.0).is_none();
                if by * sense < 1e-3 || !inside {
                    continue;
                }
                let largest = SLOW * axis.max_feed / axis.unit();
                trials.push(CommissionMove {
                    place,
                    by,
                    feed: largest.min(if axis.joint.rotary { ROTARY_FEED } else { LINEAR_FEED }),
                    sign: sign(probe, place, by),
                });
            }
        }
        Self { start, trials }
    }
}

/// The way of a linear axis: whole millimetres where there is room for them.
fn way(least: f64, most: f64) -> f64 {
    let way = (SHARE * (most - least)).min(WAY);
    if way >= 1.0 { way.floor() } else { way }
}

/// The turn of a rotary axis with so much room, radians: whole degrees where there is room for them.
fn turn(room: f64) -> f64 {
    let turn = (ROOM * room.to_degrees() + 1e-9).min(TURN);
    (if turn >= 1.0 { turn.floor() } else { turn }).to_radians()
}
