//! Errors of axes that depend on where they stand, as ISO 230-1 and 230-7 name them: behind each joint of the chain a small
//! displacement and a small turn, interpolated linearly between the places at which they were measured.
//!
//! All are those of the tool as seen from the part, as directions of axes are: a positive EYX brings the tool too far to
//! +Y, or the table that carries the part too far to -Y.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::chain::{Chain, Joint, Joints, Pose};

/// Turns of 20 mm/m, the largest there are, come to no more than so many times their sum.
const SECOND_ORDER: f64 = 1.02;

/// Displacement, mm, and turn, radians, along and about X, Y and Z of the machine frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SmallMotion {
    /// mm.
    pub displacement: Vector3<f64>,
    /// Rotation vector, radians.
    pub turn: Vector3<f64>,
}

/// The errors of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisErrors {
    /// Place of the axis in the chain.
    pub joint: usize,
    /// Axis values at which they were measured, rising, mm or radians; at least one.
    pub places: Vec<f64>,
    /// The errors there.
    pub motions: Vec<SmallMotion>,
    /// The point whose displacement they tell, mm, machine frame, all axes at zero: of a linear axis it goes with what the
    /// axis moves, of a rotary one it stands.
    pub point: Vector3<f64>,
    /// They act on the part's side of the joint, else on the tool's.
    pub before: bool,
    /// The axis turns without end: values count by whole turns.
    pub endless: bool,
    /// By how much the tip may stray beside what was measured, mm.
    pub uncertainty: f64,
}

/// What errors do over a piece of the travel of an axis, mm and radians: how far they are off the line between their values
/// at its ends, how far they change, and how large they are.
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    bow: [f64; 2],
    change: [f64; 2],
    size: [f64; 2],
}

impl SmallMotion {
    fn mixed(from: &Self, to: &Self, share: f64) -> Self {
        Self {
            displacement: from.displacement.lerp(&to.displacement, share),
            turn: from.turn.lerp(&to.turn, share),
        }
    }

    /// Lengths of both.
    fn sizes(&self) -> [f64; 2] {
        [self.displacement.norm(), self.turn.norm()]
    }

    fn less(&self, other: &Self) -> Self {
        Self { displacement: self.displacement - other.displacement, turn: self.turn - other.turn }
    }

    /// A direction turned by it: to the second order, so that a turn of 1 mm/m is exact to a billionth.
    pub(super) fn turned(&self, vector: Vector3<f64>) -> Vector3<f64> {
        let first = self.turn.cross(&vector);
        vector + first + self.turn.cross(&first) * 0.5
    }

    /// A point moved by it, the turn being about `about`.
    pub(super) fn moved(&self, point: Vector3<f64>, about: Vector3<f64>) -> Vector3<f64> {
        about + self.turned(point - about) + self.displacement
    }
}

impl AxisErrors {
    /// The errors with the axis at `value`, mm or radians; beyond the last places those of these.
    pub fn at(&self, value: f64) -> SmallMotion {
        let value = self.counted(value);
        let after = self.places.partition_point(|place| *place <= value);
        let last = self.places.len() - 1;
        let (before, to, next) = match after {
            0 => return self.motions[0],
            // From the last place on an endless axis goes to the first one of the next turn.
            _ if after > last && self.endless => (last, self.places[0] + TAU, 0),
            _ if after > last => return self.motions[last],
            _ => (after - 1, self.places[after], after),
        };
        let from = self.places[before];
        if to <= from {
            return self.motions[before];
        }
        let share = (value - from) / (to - from);
        SmallMotion::mixed(&self.motions[before], &self.motions[next], share)
    }

    /// Takes a tool along, the axis standing at `value`.
    pub(super) fn carry(&self, value: f64, pose: &mut Pose) {
        let motion = self.at(value);
        pose.tip = motion.moved(pose.tip, self.point);
        pose.axis = motion.turned(pose.axis).normalize();
        pose.edge = motion.turned(pose.edge).try_normalize(1e-9).unwrap_or_default();
    }

    /// A value of an endless axis within the turn that begins with the first place.
    fn counted(&self, value: f64) -> f64 {
        if !self.endless {
            return value;
        }
        let first = self.places[0];
        let turns = libm::floor((value - first) / TAU);
        value - turns * TAU
    }

    /// What the errors do while the axis goes evenly from one value to the other.
    fn spread(&self, from: f64, to: f64) -> Spread {
        let ends = [self.at(from), self.at(to)];
        let mut spread = Spread::default();
        let mut take = |value: f64, motion: &SmallMotion| {
            let share = if to == from { 0.0 } else { (value - from) / (to - from) };
            let line = SmallMotion::mixed(&ends[0], &ends[1], share);
            let of = [motion.less(&line), motion.less(&ends[0]), *motion].map(|of| of.sizes());
            let own = [&mut spread.bow, &mut spread.change, &mut spread.size];
            for (own, of) in own.into_iter().flatten().zip(of.iter().flatten()) {
                *own = own.max(*of);
            }
        };
        take(from, &ends[0]);
        take(to, &ends[1]);
        let (least, most) = (from.min(to), from.max(to));
        for (place, motion) in self.places.iter().zip(&self.motions) {
            // Between places errors are straight: they are farthest off, and largest, at one of these.
            let first = match self.endless {
                true => place + TAU * libm::ceil((least - place) / TAU),
                false => *place,
            };
            let mut value = first;
            while value < most {
                if value > least {
                    take(value, motion);
                }
                if !self.endless {
                    break;
                }
                value += TAU;
            }
        }
        spread
    }
}

impl Chain {
    /// The errors of an axis, if it has any.
    #[inline]
    pub(super) fn errors_of(&self, joint: usize) -> Option<&AxisErrors> {
        self.errors().iter().find(|errors| errors.joint == joint)
    }

    /// By how much errors turn the tool axis at most, radians, what one turn makes of another with it: rotary axes are put as
    /// if there were none.
    pub(super) fn largest_error_turn(&self) -> f64 {
        let of = |errors: &AxisErrors| {
            errors.motions.iter().map(|motion| motion.turn.norm()).fold(0.0, f64::max)
        };
        SECOND_ORDER * self.errors().iter().map(of).sum::<f64>()
    }

    /// By how much errors move the tip and turn the tool axis at most, off the line between those at the ends, while the
    /// axes go evenly from one place to the other: mm and radians. No arm is longer than `reach`, mm.
    ///
    /// Beside what the errors bow themselves, they change while arms do and are turned while axes turn: products of small
    /// numbers, each bounded by what it is at most.
    pub fn error_bow(&self, [from, to]: [&Joints; 2], reach: f64) -> [f64; 2] {
        if self.errors().is_empty() {
            return [0.0; 2];
        }
        let (mut way, mut turns) = (0.0, 0.0);
        for (place, joint) in self.joints().iter().enumerate() {
            let own = libm::fabs(to[place] - from[place]);
            if joint.rotary {
                turns += own;
                way += own * reach;
            } else {
                way += own;
            }
        }
        let [mut tip, mut axis] = [0.0; 2];
        for errors in self.errors() {
            let Spread { bow, change, size } = errors.spread(from[errors.joint], to[errors.joint]);
            let turned = turns + 0.5 * turns * turns;
            tip += bow[0]
                + bow[1] * reach
                + change[1] * way
                + (change[0] + change[1] * reach) * turns
                + (size[0] + size[1] * reach) * turns * turned
                + errors.uncertainty;
            axis += bow[1] + change[1] * turns + size[1] * turns * turned;
        }
        [tip, axis]
    }
}

/// The errors of a joint act on the part's side of it where that is the side that stands.
pub(crate) fn acts_before(joint: &Joint, carries_part: bool) -> bool {
    carries_part != joint.rotary
}
