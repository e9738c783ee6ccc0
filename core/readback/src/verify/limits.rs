//! Limits that depend on other axes, along the motions of a program.

use post_machine::description::{Machine, RapidAxes};
use post_machine::kinematics::{AxisBits, Joints, MAX_AXES};

use super::axes::looked;
use crate::{Curve, Interpolation, Motion, MotionKind};

/// A parabola strays from a chord by this share of its second difference, and what is near to one by a little more.
const SAG: f64 = 1.1 / 8.0;

/// A limit that a motion passes.
#[derive(Clone, Debug)]
pub struct PassedLimit {
    /// What is to be said of it.
    pub message: String,
    /// By how much, mm or degrees; zero where it is not proven to hold.
    pub by: f64,
    /// Its place among the limits of the machine.
    pub limit: usize,
}

/// What is known of where the axes stand. A program is not asked where it begins: an axis is judged once it has moved, and
/// all of them once something is cut.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitCheck {
    moved: AxisBits,
}

impl LimitCheck {
    /// The first limit that a motion passes.
    pub fn passed(&mut self, machine: &Machine, motion: &Motion) -> Option<PassedLimit> {
        if machine.limits.is_empty() {
            return None;
        }
        let before = self.moved;
        for joint in 0..MAX_AXES {
            let moves = motion.from.joints[joint] != motion.to.joints[joint];
            let cuts = motion.kind != MotionKind::Rapid;
            self.moved |= AxisBits::from(moves || cuts) << joint;
        }
        let ends = [&motion.from.joints, &motion.to.joints];
        machine.limits.iter().enumerate().find_map(|(place, limit)| {
            let known = |bits: AxisBits| limit.joints().all(|joint| bits >> joint & 1 == 1);
            let passed = match (known(before), known(self.moved)) {
                (true, _) => on_way(machine, place, motion),
                (false, true) => Some(motion.to.joints).filter(|to| !limit.holds(to)),
                (false, false) => None,
            }?;
            let between = ends.iter().all(|end| limit.holds(end));
            let behind = if between { ", between the ends of this motion" } else { "" };
            let message = format!("{}{behind}", limit.told(machine, &passed));
            Some(PassedLimit { message, by: limit.excess(&passed), limit: place })
        })
    }
}

/// A place at which a limit is passed on a motion.
fn on_way(machine: &Machine, place: usize, motion: &Motion) -> Option<Joints> {
    let limit = &machine.limits[place];
    let ends = [&motion.from.joints, &motion.to.joints];
    match &motion.way {
        Interpolation::Axes => {
            let apart = machine.clearance.rapid_axes == RapidAxes::Independent;
            match motion.kind == MotionKind::Rapid && apart {
                true => limit.passed_by_each(ends),
                false => limit.passed_straight(ends),
            }
        }
        Interpolation::Tip(Curve::Straight) => {
            limit.passed_keeping_tip(&motion.state.solver, 0.0, ends)
        }
        Interpolation::Tip(_) | Interpolation::TipAndAxis | Interpolation::TipAndFrame(_) => {
            let mut places = vec![motion.from.joints];
            places.extend(looked(motion));
            let last = places.len() - 1;
            (0..last).find_map(|place| {
                let first = place.min(last.saturating_sub(2));
                let three = &places[first..(first + 3).min(places.len())];
                let (least, most) = piece([&places[place], &places[place + 1]], three);
                limit.passed_between([&least, &most])
            })
        }
    }
}

/// Between two neighbouring places of a curve: least and largest values of the axes, which go as parabolas do through
/// `three` places.
fn piece([from, to]: [&Joints; 2], three: &[Joints]) -> (Joints, Joints) {
    let sag = |joint: usize| match three {
        [a, b, c] => SAG * libm::fabs(a[joint] - 2.0 * b[joint] + c[joint]),
        _ => 0.0,
    };
    let of = |sign: f64, end: fn(f64, f64) -> f64| -> Joints {
        std::array::from_fn(|joint| end(from[joint], to[joint]) + sign * sag(joint))
    };
    (of(-1.0, f64::min), of(1.0, f64::max))
}
