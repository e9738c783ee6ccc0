//! Where the leading edge of a knife or disc points: along the direction of travel, or along the second vector
//! of the CL points.
//!
//! Along a path the edge at a point lies between the directions of the moves before and behind it, so that it
//! turns steadily. At a corner it must be turned on the spot: drawn back first, if the machine has `[rewind]`.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::motion::{Motion, Pace, Step};
use post_machine::description::{EdgeSource, Machine, Rewind};
use post_machine::kinematics::orientation::angle;

/// Ways shorter than this have no direction, mm.
const SHORT: f64 = 1e-6;

/// A turn on the spot by more than this goes by the side, radians.
const HALF: f64 = 2.0;

/// Steps without a direction are not held longer than this.
const MOST_HELD: usize = 1024;

/// Gives every move its edge; holds moves back until the next direction of travel is known.
#[derive(Debug)]
pub(crate) struct Edges {
    source: EdgeSource,
    /// Radians.
    corner: f64,
    rewind: Option<Rewind>,
    /// The edge in use.
    edge: Vector3<f64>,
    /// The last point that was taken.
    tip: Option<Vector3<f64>>,
    /// The last cut with a direction, and that direction.
    cut: Option<(u64, Motion, Vector3<f64>)>,
    /// What is wrong, each with its line.
    faults: Vec<(u64, &'static str)>,
    /// What came behind it: moves without a direction (rapids, straight in and out), and commands.
    behind: VecDeque<(u64, Step)>,
}

impl Edges {
    /// None for a tool that turns.
    pub(crate) fn new(machine: &Machine) -> Option<Self> {
        Some(Self {
            source: machine.solution.edge,
            corner: machine.solution.corner,
            rewind: machine.rewind,
            edge: machine.edge?,
            tip: None,
            cut: None,
            faults: Vec::new(),
            behind: VecDeque::new(),
        })
    }

    /// Takes a step; what is settled comes out.
    pub(crate) fn step(&mut self, line: u64, step: Step, emit: &mut dyn FnMut(u64, Step)) {
        match step {
            Step::Move(motion) if self.source == EdgeSource::Cl => {
                let along = if motion.edge == Vector3::zeros() {
                    self.edge
                } else {
                    if across(motion.edge, motion.axis).is_none() {
                        self.faults
                            .push((line, "the leading edge lies along the tool axis"));
                    }
                    motion.edge
                };
                self.pass(line, motion, Some(along), emit);
            }
            Step::Move(motion) => {
                let from = self.tip.replace(motion.tip);
                let way = from
                    .filter(|_| motion.pace != Pace::Rapid)
                    .map(|from| motion.tip - from)
                    .filter(|way| way.norm() > SHORT)
                    .and_then(|way| across(way, motion.axis));
                match way {
                    Some(way) => {
                        self.settle(Some(way), emit);
                        self.cut = Some((line, motion, way));
                    }
                    None => self.hold(line, Step::Move(motion), emit),
                }
            }
            Step::From { tip, .. } => {
                self.settle(None, emit);
                self.tip = Some(tip);
                emit(line, step);
            }
            step if step.leaves() => {
                self.settle(None, emit);
                self.tip = None;
                emit(line, step);
            }
            step => self.hold(line, step, emit),
        }
    }

    /// Faults since the last call.
    pub(crate) fn take_faults(&mut self) -> Vec<(u64, &'static str)> {
        std::mem::take(&mut self.faults)
    }

    /// What waits has nothing behind it.
    pub(crate) fn finish(&mut self, emit: &mut dyn FnMut(u64, Step)) {
        self.settle(None, emit);
    }

    fn hold(&mut self, line: u64, step: Step, emit: &mut dyn FnMut(u64, Step)) {
        self.behind.push_back((line, step));
        if self.behind.len() >= MOST_HELD {
            self.settle(None, emit);
        }
    }

    /// Settles what waits; the next cut goes along `go`.
    fn settle(&mut self, go: Option<Vector3<f64>>, emit: &mut dyn FnMut(u64, Step)) {
        let moves = self
            .behind
            .iter()
            .any(|(_, step)| matches!(step, Step::Move(_)));
        // Where no cut came before, the edge stands as the first cut wants it from the beginning.
        let mut turned = self.cut.is_none();
        let mut last = None;
        if let Some((line, motion, come)) = self.cut.take() {
            match go.filter(|_| !moves) {
                Some(go) if angle(come, go) > self.corner => {
                    self.pass(line, motion, Some(come), emit);
                    self.corner_turn(line, motion, go, emit);
                }
                Some(go) => self.pass(line, motion, Some(come + go), emit),
                None => self.pass(line, motion, Some(come), emit),
            }
        }
        for (line, step) in std::mem::take(&mut self.behind) {
            let Step::Move(motion) = step else {
                emit(line, step);
                continue;
            };
            if turned {
                self.pass(line, motion, go, emit);
                continue;
            }
            self.pass(line, motion, None, emit);
            last = Some((line, motion));
            if let Some(go) = go
                && motion.pace == Pace::Rapid
            {
                // Off the part: turned here, before the way in.
                self.pass(line, motion, Some(go), emit);
                turned = true;
            }
        }
        // Straight from one cut into another: a corner, if it is one.
        if let (false, Some(go), Some((line, motion))) = (turned, go, last)
            && angle(self.edge, go) > self.corner
        {
            self.corner_turn(line, motion, go, emit);
        }
    }

    /// Turns the edge at a corner.
    fn corner_turn(
        &mut self,
        line: u64,
        motion: Motion,
        edge: Vector3<f64>,
        emit: &mut dyn FnMut(u64, Step),
    ) {
        let away = self
            .rewind
            .and_then(|rewind| Some((rewind, motion.drawn_back(&rewind, 0.0)?)));
        if let Some((rewind, away)) = away {
            let out = Motion {
                pace: Pace::feed_or_rapid(rewind.retract_feed),
                ..away
            };
            self.pass(line, out, None, emit);
            let turn = Motion {
                pace: rewind.turn_feed.map_or(Pace::Rapid, |feed| {
                    let way = angle(self.edge, edge).to_degrees();
                    Pace::InverseTime(feed / way.max(1e-3))
                }),
                ..away
            };
            self.pass(line, turn, Some(edge), emit);
            let back = Motion {
                pace: rewind.plunge_feed.map_or(motion.pace, Pace::PerMinute),
                ..motion
            };
            self.pass(line, back, Some(edge), emit);
        } else {
            if self.rewind.is_some() {
                self.faults.push((
                    line,
                    "at this corner the tool must be drawn back and turned, and it cannot be: the plane of [rewind] lies below the tip, or the tool is nearly level",
                ));
            }
            if angle(self.edge, edge) > HALF {
                // Right about: by the side, for the way round must be said.
                let side = motion.axis.cross(&self.edge);
                self.pass(line, motion, Some(side), emit);
            }
            self.pass(line, motion, Some(edge), emit);
        }
    }

    fn pass(
        &mut self,
        line: u64,
        mut motion: Motion,
        along: Option<Vector3<f64>>,
        emit: &mut dyn FnMut(u64, Step),
    ) {
        // Straight into the part there is no direction of travel: the edge stays as it is.
        let edge = along
            .and_then(|along| across(along, motion.axis))
            .or_else(|| across(self.edge, motion.axis))
            .or_else(|| across(Vector3::x(), motion.axis))
            .unwrap_or_else(Vector3::y);
        self.edge = edge;
        motion.edge = edge;
        emit(line, Step::Move(motion));
    }
}

/// The part of a direction across the tool axis, of length one.
fn across(direction: Vector3<f64>, axis: Vector3<f64>) -> Option<Vector3<f64>> {
    let length = direction.norm();
    (direction - axis * axis.dot(&direction)).try_normalize(1e-3 * length.max(1e-9))
}
