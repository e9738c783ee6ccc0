//! Where the leading edge of a knife or disc points: along the direction of travel, or along the second vector
//! of the CL points.
//!
//! Along a path the edge at a point lies between the directions of the moves before and behind it, so that it
//! turns steadily. At a corner it must be turned on the spot: drawn back first, if the machine has `[rewind]`.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::motion::{Motion, Pace, Step};
use crate::kinematics::orientation::angle;
use crate::machine::{EdgeSource, Machine, Rewind};

/// Ways shorter than this have no direction, mm.
const SHORT: f64 = 1e-6;

/// Gives every move its edge; holds one move back until the next is known.
#[derive(Debug)]
pub(crate) struct Edges {
    source: EdgeSource,
    /// Radians.
    corner: f64,
    rewind: Option<Rewind>,
    /// The edge in use, and the last point.
    edge: Vector3<f64>,
    from: Option<Vector3<f64>>,
    /// The move that waits, and the commands behind it.
    held: Option<(u64, Motion)>,
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
            from: None,
            held: None,
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
                    motion.edge
                };
                self.pass(line, motion, Some(along), emit);
            }
            Step::Move(motion) => {
                self.settle(Some(&motion), emit);
                self.held = Some((line, motion));
            }
            Step::From { tip, .. } => {
                self.settle(None, emit);
                self.from = Some(tip);
                emit(line, step);
            }
            step if step.leaves() => {
                self.settle(None, emit);
                self.from = None;
                emit(line, step);
            }
            step if self.held.is_some() => self.behind.push_back((line, step)),
            step => emit(line, step),
        }
    }

    /// The move that waits has nothing behind it.
    pub(crate) fn finish(&mut self, emit: &mut dyn FnMut(u64, Step)) {
        self.settle(None, emit);
    }

    fn settle(&mut self, next: Option<&Motion>, emit: &mut dyn FnMut(u64, Step)) {
        if let Some((line, motion)) = self.held.take() {
            let cuts = |motion: &Motion| motion.pace != Pace::Rapid;
            let way = |from: Vector3<f64>, to: Vector3<f64>| {
                Some(to - from).filter(|way| way.norm() > SHORT)
            };
            let come = self
                .from
                .filter(|_| cuts(&motion))
                .and_then(|from| way(from, motion.tip))
                .and_then(|way| across(way, motion.axis));
            let go = next
                .filter(|next| cuts(next))
                .and_then(|next| way(motion.tip, next.tip))
                .and_then(|way| across(way, motion.axis));
            match (come, go) {
                (Some(come), Some(go)) if angle(come, go) > self.corner => {
                    self.pass(line, motion, Some(come), emit);
                    self.corner_turn(line, motion, go, emit);
                }
                (Some(come), Some(go)) => self.pass(line, motion, Some(come + go), emit),
                (come, go) => self.pass(line, motion, go.or(come), emit),
            }
        }
        for (line, step) in self.behind.drain(..) {
            emit(line, step);
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
            .and_then(|rewind| Some((rewind, motion.drawn_back(&rewind)?)));
        let pace = |feed: Option<f64>| feed.map_or(Pace::Rapid, Pace::PerMinute);
        if let Some((rewind, away)) = away {
            let out = Motion {
                pace: pace(rewind.retract_feed),
                ..away
            };
            self.pass(line, out, None, emit);
            let turn = Motion {
                pace: Pace::Rapid,
                ..away
            };
            self.pass(line, turn, Some(edge), emit);
            let back = Motion {
                pace: rewind.plunge_feed.map_or(motion.pace, Pace::PerMinute),
                ..motion
            };
            self.pass(line, back, Some(edge), emit);
        } else {
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
        self.from = Some(motion.tip);
        motion.edge = edge;
        emit(line, Step::Move(motion));
    }
}

/// The part of a direction across the tool axis, of length one.
fn across(direction: Vector3<f64>, axis: Vector3<f64>) -> Option<Vector3<f64>> {
    let length = direction.norm();
    (direction - axis * axis.dot(&direction)).try_normalize(1e-3 * length.max(1e-9))
}
