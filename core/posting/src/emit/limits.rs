//! Limits that depend on other axes, held along everything that is written: cuts, rapids, and the ways between passes.

use std::rc::Rc;

use post_machine::dependent_limit::DependentLimit;
use post_machine::description::{RapidAxes, Tcp};
use post_machine::kinematics::{AxisBits, Joints, Leg, MAX_AXES};

use super::EmitStage;
use super::frame::AxisRole;
use crate::accuracy::Placer;
use crate::blocks::{BlockKind, BlockReason, MotionBlock};
use crate::curve::PrintedCurve;
use crate::refusal;
use crate::report::DriveRange;

/// Where the axes stand, as far as the program has told them.
#[derive(Clone, Debug, Default)]
pub(super) struct LimitWatch {
    /// Axis values after the last motion, mm and radians.
    at: Joints,
    /// Axes that the program has moved to a place, one bit each.
    known: AxisBits,
    /// Where the drives that are no axes came to.
    pub drives: Vec<DriveRange>,
    /// What solves the points where the control keeps the tip.
    pub placer: Option<Rc<Placer>>,
}

impl LimitWatch {
    /// A drive comes to where the axes stand.
    fn note(&mut self, leg: &Leg) {
        let Some(value) = leg.value(&self.at).map(|value| leg.reading(value)) else {
            return;
        };
        match self.drives.iter_mut().find(|drive| drive.name == leg.name) {
            Some(drive) => {
                drive.min = drive.min.min(value);
                drive.max = drive.max.max(value);
            }
            None => self.drives.push(DriveRange {
                name: leg.name.clone(),
                unit: if leg.turns() { "deg" } else { "mm" },
                min: value,
                max: value,
                travel: leg.travel.map(|travel| travel.map(|end| leg.reading(end))),
            }),
        }
    }
}

/// How axes come from one place to another.
#[derive(Clone, Copy)]
enum AxesWay {
    /// Each for itself.
    Apart,
    /// All together.
    Straight,
    /// As the tip asks for, which the control keeps.
    KeepingTip,
}

impl EmitStage<'_> {
    /// What a block does to limits that depend on other axes.
    pub(super) fn keep_limits(&mut self, block: &MotionBlock, printed: Option<&PrintedCurve>) {
        if self.machine.limits.is_empty() {
            return;
        }
        let line = block.line;
        match block.kind {
            BlockKind::Position | BlockKind::Reference => self.keep_on_approach(block),
            BlockKind::Arc | BlockKind::Spline => {
                // The rotary axes stand; between these places no axis turns back.
                let places = printed.map_or(&[][..], |printed| printed.between.as_slice());
                for place in places.iter().chain([&block.joints]) {
                    self.keep_to(line, place, AxisBits::MAX, AxesWay::Apart);
                }
            }
            BlockKind::Rapid | BlockKind::Linear => {
                let apart = block.time.feed.is_none()
                    && self.machine.clearance.rapid_axes == RapidAxes::Independent;
                let way = match self.machine.control.tcp {
                    Tcp::Control if !self.plane.on => AxesWay::KeepingTip,
                    _ if apart => AxesWay::Apart,
                    _ => AxesWay::Straight,
                };
                self.keep_to(line, &block.joints, AxisBits::MAX, way);
            }
        }
    }

    /// The way to a first position: the rotary axes turn, and then the tool comes near.
    fn keep_on_approach(&mut self, block: &MotionBlock) {
        let machine = self.machine;
        let of = |wanted: AxisRole| {
            let axes =
                (0..machine.axes.len()).filter(|joint| AxisRole::of(machine, *joint) == wanted);
            axes.fold(0, |bits: AxisBits, joint| bits | 1 << joint)
        };
        let across = match block.reason {
            BlockReason::Above | BlockReason::AtOnce => 0,
            _ => of(AxisRole::Plane),
        };
        for part in [of(AxisRole::Rotary), across, AxisBits::MAX] {
            self.keep_to(block.line, &block.joints, part, AxesWay::Apart);
        }
    }

    /// Axes go to positions of the machine, each for itself.
    pub(super) fn keep_going(&mut self, line: u64, positions: &[(usize, f64)]) {
        if self.machine.limits.is_empty() {
            return;
        }
        let mut to = Joints::default();
        let mut part = 0;
        for (joint, value) in positions {
            to[*joint] = *value;
            part |= 1 << joint;
        }
        self.keep_to(line, &to, part, AxesWay::Apart);
    }

    /// The axes in `part` go to their values in `to`.
    fn keep_to(&mut self, line: u64, to: &Joints, part: AxisBits, way: AxesWay) {
        let machine = self.machine;
        let from = self.limits.at;
        let known = self.limits.known;
        let moves = |joint: usize| part >> joint & 1 == 1;
        let to: Joints = std::array::from_fn(|joint| {
            if joint < MAX_AXES && moves(joint) { to[joint] } else { from[joint] }
        });
        self.limits.at = to;
        self.limits.known |= part;
        for limit in &machine.limits {
            let all = |bits: AxisBits| limit.joints().all(|joint| bits >> joint & 1 == 1);
            // Of a way from nobody knows where the end alone is judged.
            let passed = match (all(known), all(self.limits.known)) {
                (true, _) => self.passed(limit, way, [&from, &to]),
                (false, true) => Some(to).filter(|to| !limit.holds(to)),
                (false, false) => None,
            };
            if let (Some(leg), true) = (limit.leg(), all(self.limits.known)) {
                self.limits.note(leg);
            }
            if let Some(place) = passed {
                let ends = limit.holds(&from) && limit.holds(&to);
                let behind = if ends { ", between the ends of this motion" } else { "" };
                self.findings.at(line, refusal::beyond_limit(machine, limit, &place, behind));
            }
        }
    }

    /// A place at which a limit is passed on a way.
    fn passed(&self, limit: &DependentLimit, way: AxesWay, ends: [&Joints; 2]) -> Option<Joints> {
        match (way, &self.limits.placer) {
            (AxesWay::Straight, _) => limit.passed_straight(ends),
            (AxesWay::KeepingTip, Some(placer)) => {
                let along = placer.control_point().along;
                limit.passed_keeping_tip(placer.solver(), along, ends)
            }
            (AxesWay::Apart | AxesWay::KeepingTip, _) => limit.passed_by_each(ends),
        }
    }
}
