//! `post --plan --plan-pictures`: how much of each limit the plan of a posted program uses, along its way.

use post_machine::axis_words;
use post_machine::description::{Machine, PlanSolver};
use post_posting::plan::PlannedPoint;
use serde::Serialize;

use super::gauges::Gauges;
use super::interval::{Interval, Intervals};
use super::keep::PlanLimits;
use super::pictures::PlanRooms;
use super::tally::{LimitFound, Tally};
use crate::files::{self, FolderMark};
use crate::text::number;

/// The file that tells in numbers what the pictures show, and how it begins.
pub const MARK: FolderMark<'_> = FolderMark { name: "plan.json", begins: "{\n  \"program\": " };

/// Parts of an interval that are drawn one by one, at least and at most.
const PARTS: [f64; 2] = [2.0, 2048.0];

/// What a plan on a machine is held against.
pub struct PlanReference<'m> {
    machine: &'m Machine,
    /// Places in the chain of the axes that are drawn.
    axes: Vec<usize>,
    keep: PlanLimits,
}

impl<'m> PlanReference<'m> {
    /// The limits of a machine.
    pub fn new(machine: &'m Machine) -> Self {
        let mut axes = axis_words::order(machine);
        axes.retain(|place| machine.axes[*place].indexed.is_none());
        let keep = PlanLimits::new(machine, &axes);
        Self { machine, axes, keep }
    }

    /// What is used of them.
    pub fn gauges(&self) -> Gauges<'_> {
        let turns = !self.machine.pointing().is_empty();
        let jerk = self.machine.plan.solver == PlanSolver::Jerk;
        Gauges::new(self.machine, &self.axes, turns, &self.keep, jerk)
    }
}

/// A plan as it is gone along.
pub struct PlanTrace<'a> {
    limited: &'a PlanReference<'a>,
    gauges: &'a Gauges<'a>,
    intervals: Intervals,
    rooms: PlanRooms,
    tally: Tally<'a>,
    /// So far, in units of the parameter, mm and s.
    parameter: f64,
    way: f64,
    time: f64,
}

/// What the pictures show, in numbers.
#[derive(Debug, Serialize)]
struct PlanSummary<'f> {
    program: &'f str,
    machine: &'f str,
    /// Way of the tip in planned cuts.
    length_mm: f64,
    /// By the plan.
    seconds: f64,
    limits: Vec<LimitFound>,
}

impl<'a> PlanTrace<'a> {
    /// Nothing so far.
    pub fn new(limited: &'a PlanReference<'a>, gauges: &'a Gauges<'a>) -> Self {
        Self {
            limited,
            gauges,
            intervals: Intervals::default(),
            rooms: super::rooms(limited.machine, &limited.axes, &limited.keep),
            tally: Tally::new(gauges),
            parameter: 0.0,
            way: 0.0,
            time: 0.0,
        }
    }

    /// Takes the next place of the plan.
    pub fn take(&mut self, point: &PlannedPoint<'_>) {
        let Some(interval) = self.intervals.take(point) else {
            return;
        };
        let way = interval.way();
        let parts = libm::ceil(way / self.rooms.width()).clamp(PARTS[0], PARTS[1]);
        let step = [way / parts, interval.seconds / parts];
        self.place(&interval, 0.0, [0.0; 2]);
        for part in 1..=parts as u32 {
            self.place(&interval, f64::from(part) / parts, step);
        }
        self.parameter += interval.length;
    }

    fn place(&mut self, interval: &Interval<'_>, share: f64, [way, time]: [f64; 2]) {
        let mut point = self.gauges.measure(&interval.station(share), interval.q(share));
        self.way += way;
        self.time += time;
        point.parameter = self.parameter + share * interval.length;
        (point.way, point.time) = (self.way, self.time);
        self.tally.take(&point, Some(way), time);
        self.rooms.take(&super::drawn(&point));
    }

    /// The pictures of a program that is called so, and what they show in numbers.
    pub fn files(&self, program: &str) -> Vec<(&'static str, String)> {
        let machine = &self.limited.machine.name;
        let seconds = self.tally.time();
        let found = PlanSummary {
            program,
            machine,
            length_mm: self.way,
            seconds,
            limits: match self.way > 0.0 {
                true => self.tally.limits(),
                false => Vec::new(),
            },
        };
        let note = format!("{program} on {machine}, planned cuts: {} s", number(seconds, 3));
        let mut files = self.rooms.files(&note);
        files.push((MARK.name, files::json(&found)));
        files
    }
}
