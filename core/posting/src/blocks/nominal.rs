//! The nominal time of a move: what the CL file asks for, whatever the axes can do.

use post_machine::description::Machine;
use post_machine::kinematics::batch::{Column, LANES};
use post_machine::kinematics::{Joints, MAX_AXES};

use super::{BlockStage, PathLeg};
use crate::accuracy::{PathNode, RunPosition};
use crate::program::MoveFeed;

/// A tip that moves by no more than this stands still but for the rounding of the words, mm.
pub(crate) const STILL: f64 = 2e-3;

/// The time that a block is due by the CL file.
///
/// It is found for the move and shared out: pieces that are shorter than the words' decimals, or put off the path,
/// have no pace of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NominalTime {
    /// Minutes.
    pub minutes: f64,
    /// The tip moves; else the feed is that of the axes.
    pub moves: bool,
}

impl NominalTime {
    /// A share of it.
    #[inline]
    pub(super) fn share(self, share: f64) -> Self {
        Self { minutes: self.minutes * share, ..self }
    }

    /// What is due between two places of a run; `legs` has that of each leg.
    pub(super) fn between(legs: &[Self], from: RunPosition, to: RunPosition) -> Self {
        let (first, last) = (from.leg, to.leg);
        if first == last {
            return legs[first].share(to.t - from.t);
        }
        let whole: f64 = legs[first + 1..last].iter().map(|leg| leg.minutes).sum();
        Self {
            minutes: legs[first].minutes * (1.0 - from.t) + whole + legs[last].minutes * to.t,
            moves: true,
        }
    }

    /// Time of a move in which the tip goes `length` mm.
    #[inline]
    pub(crate) fn of(pace: MoveFeed, length: f64, travels: impl FnOnce() -> AxisTravels) -> Self {
        let moves = length > STILL;
        let minutes = match pace {
            MoveFeed::PerMinute(feed) if moves => length / feed,
            // The tip stands still: the feed is taken along the axes, degrees as millimetres, as controls do.
            MoveFeed::PerMinute(feed) => travels().combined / feed,
            MoveFeed::InverseTime(feed) => 1.0 / feed,
            MoveFeed::Rapid | MoveFeed::PerRevolution(_) => 0.0,
        };
        Self { minutes, moves }
    }
}

impl BlockStage<'_> {
    /// What a move is due.
    #[inline]
    pub(super) fn nominal(&self, leg: &PathLeg<'_>, from: &PathNode, to: &PathNode) -> NominalTime {
        NominalTime::of(leg.motion.pace, self.way(from, to), || {
            self.kinds.travels(&from.trace.joints, &to.trace.joints)
        })
    }

    /// Way of the tip between two nodes as they are printed, mm: it has the feed, whichever point of the tool is
    /// guided, and it is what a control that keeps the tip will time.
    #[inline]
    pub(super) fn way(&self, from: &PathNode, to: &PathNode) -> f64 {
        let way = to.tip - from.tip;
        match self.machine.control_point.along {
            0.0 => way.norm(),
            along => (way - (to.trace.pose.axis - from.trace.pose.axis) * along).norm(),
        }
    }

    /// [`BlockStage::way`] as the CL file asks for it.
    pub(super) fn wanted_way(&self, from: &PathNode, to: &PathNode) -> f64 {
        let along = self.machine.control_point.along;
        let tip = |node: &PathNode| node.target.tip - node.target.axis * along;
        (tip(to) - tip(from)).norm()
    }
}

/// Which axes of a chain are rotary.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AxisKinds {
    rotary: [bool; MAX_AXES],
    /// What a degree of each counts.
    degree: [f64; MAX_AXES],
    count: usize,
}

/// How far the axes go in a block: mm and degrees.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct AxisTravels {
    pub linear: f64,
    pub rotary: f64,
    pub combined: f64,
    pub linear_longest: f64,
    pub rotary_longest: f64,
}

impl AxisKinds {
    pub(crate) fn new(machine: &Machine) -> Self {
        let mut kinds =
            Self { count: machine.axes.len(), degree: [1.0; MAX_AXES], ..Self::default() };
        for (rotary, axis) in kinds.rotary.iter_mut().zip(&machine.axes) {
            *rotary = axis.joint.rotary;
        }
        kinds
    }

    /// As a control counts ways whose units of length are `unit` mm, and whose rotary axes may count along circles.
    pub(crate) fn counted(machine: &Machine, unit: f64) -> Self {
        let mut kinds = Self::new(machine);
        for (degree, axis) in kinds.degree.iter_mut().zip(&machine.axes) {
            if let Some(diameter) = axis.feed_diameter {
                *degree = 1f64.to_radians() * diameter / 2.0 / unit;
            }
        }
        kinds
    }

    /// Some rotary axis turns.
    #[inline]
    pub(crate) fn turning(&self, from: &Joints, to: &Joints) -> bool {
        (0..MAX_AXES).any(|index| self.rotary[index] && from[index] != to[index])
    }

    /// [`AxisKinds::turning`] from each of `count` places to the next.
    pub(crate) fn turning_all(
        &self,
        joints: &[Column; MAX_AXES],
        count: usize,
        turns: &mut [bool; LANES],
    ) {
        for (column, _) in joints.iter().zip(&self.rotary).filter(|(_, rotary)| **rotary) {
            let pairs = column[..count].iter().zip(&column[1..=count]);
            for (turns, (from, to)) in turns.iter_mut().zip(pairs) {
                *turns |= from != to;
            }
        }
    }

    pub(crate) fn travels(&self, from: &Joints, to: &Joints) -> AxisTravels {
        let mut travels = AxisTravels::default();
        let (mut linear, mut rotary) = (0.0, 0.0);
        for index in 0..self.count.min(MAX_AXES) {
            let travel = (to[index] - from[index]).abs();
            if self.rotary[index] {
                let degrees = travel.to_degrees() * self.degree[index];
                rotary += degrees * degrees;
                travels.rotary_longest = travels.rotary_longest.max(degrees);
            } else {
                linear += travel * travel;
                travels.linear_longest = travels.linear_longest.max(travel);
            }
        }
        travels.combined = (linear + rotary).sqrt();
        travels.linear = linear.sqrt();
        travels.rotary = rotary.sqrt();
        travels
    }
}
