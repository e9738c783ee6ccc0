//! The plan of a posted program as it is shown: [`map`], and how much it uses of each limit, [`posted`].

pub mod gauges;
mod interval;
pub mod keep;
pub mod map;
pub mod pictures;
pub mod posted;
pub mod tally;

use post_machine::description::Machine;

use gauges::PlanPoint;
use keep::PlanLimits;
use pictures::{DrawnLimits, DrawnPoint, PlanRooms, PlannedAxis};

/// Room for the pictures of a plan of these axes, with what it keeps.
pub fn rooms(machine: &Machine, axes: &[usize], keep: &PlanLimits) -> PlanRooms {
    let axes = axes.iter().enumerate().map(|(axis, place)| PlannedAxis {
        name: machine.axes[*place].name.clone(),
        rotary: machine.axes[*place].joint.rotary,
        limits: [keep.velocity[axis], keep.acceleration[axis], keep.jerk[axis]],
    });
    PlanRooms::new(
        axes.collect(),
        DrawnLimits {
            feed: keep.feed,
            chord_error: keep.chord_error,
            contour_error: keep.contour_error,
        },
    )
}

/// A point of a plan as its pictures take it.
pub fn drawn(point: &PlanPoint) -> DrawnPoint<'_> {
    DrawnPoint {
        way: point.way,
        feed: point.feed,
        velocity: &point.velocity,
        acceleration: &point.acceleration,
        jerk: &point.jerk,
        chord_error: point.chord_error,
        contour_error: point.contour_error,
    }
}
