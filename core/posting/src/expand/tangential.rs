//! Tangential control: where the leading edge of a knife or disc points, along the direction of travel, or along the second vector
//! of the CL points.
//!
//! Along a path the edge at a point lies between the directions of the moves before and behind it, so that it
//! turns steadily. At a corner it must be turned on the spot: drawn back first, if the machine has `[rewind]`.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::{Line, Out};
use crate::findings::Findings;
use crate::program::{Command, Motion, Pace};
use crate::stream::Flow;
use post_machine::description::{EdgeSource, Machine, Rewind};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::orientation::angle;

/// Ways shorter than this have no direction, mm.
const SHORT: f64 = 1e-6;

/// A turn on the spot by more than this goes by the side, radians.
const HALF: f64 = 2.0;

/// Steps without a direction are not held longer than this.
const MOST_HELD: usize = 1024;

/// Gives every move its edge; holds moves back until the next direction of travel is known.
#[derive(Debug)]
pub(super) struct Tangential {
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
    /// What came behind it: moves without a direction (rapids, straight in and out), and commands.
    behind: VecDeque<Flow<Line>>,
}

impl Tangential {
    /// None for a tool that turns.
    pub(crate) fn new(machine: &Machine) -> Option<Self> {
        Some(Self {
            source: machine.solution.edge,
            corner: machine.solution.corner,
            rewind: machine.rewind,
            edge: machine.edge?,
            tip: None,
            cut: None,
            behind: VecDeque::new(),
        })
    }

    /// Line of the first step that waits.
    pub(super) fn first_line(&self) -> Option<u64> {
        let behind = || match self.behind.front()? {
            Flow::Point(at) => Some(at.line),
            Flow::Command { line, .. } => Some(*line),
        };
        self.cut.map(|(line, ..)| line).or_else(behind)
    }

    /// Takes a move; what is settled goes on.
    pub(super) fn go(&mut self, line: u64, motion: Motion, out: &mut Out<'_>, findings: &Findings) {
        if self.source == EdgeSource::Cl {
            let along = if motion.edge == Vector3::zeros() {
                self.edge
            } else {
                if across(motion.edge, motion.axis).is_none() {
                    fault(findings, line, "the leading edge lies along the tool axis");
                }
                motion.edge
            };
            self.pass(line, motion, Some(along), out);
            return;
        }
        let from = self.tip.replace(motion.tip);
        let way = from
            .filter(|_| motion.pace != Pace::Rapid)
            .map(|from| motion.tip - from)
            .filter(|way| way.norm() > SHORT)
            .and_then(|way| across(way, motion.axis));
        match way {
            Some(way) => {
                self.settle(Some(way), out, findings);
                self.cut = Some((line, motion, way));
            }
            None => self.hold(Flow::Point(Line { line, motion }), out, findings),
        }
    }

    /// Takes a command.
    pub(super) fn command(
        &mut self,
        line: u64,
        command: Command,
        out: &mut Out<'_>,
        findings: &Findings,
    ) {
        if !command.leaves() {
            self.hold(Flow::Command { line, command }, out, findings);
            return;
        }
        self.settle(None, out, findings);
        self.tip = match command {
            Command::From { tip, .. } => Some(tip),
            _ => None,
        };
        out.command(line, command);
    }

    /// What waits has nothing behind it.
    pub(super) fn finish(&mut self, out: &mut Out<'_>, findings: &Findings) {
        self.settle(None, out, findings);
    }

    fn hold(&mut self, next: Flow<Line>, out: &mut Out<'_>, findings: &Findings) {
        self.behind.push_back(next);
        if self.behind.len() >= MOST_HELD {
            self.settle(None, out, findings);
        }
    }

    /// Settles what waits; the next cut goes along `go`.
    fn settle(&mut self, go: Option<Vector3<f64>>, out: &mut Out<'_>, findings: &Findings) {
        let moves = self
            .behind
            .iter()
            .any(|next| matches!(next, Flow::Point(_)));
        // Where no cut came before, the edge stands as the first cut wants it from the beginning.
        let mut turned = self.cut.is_none();
        let mut last = None;
        if let Some((line, motion, come)) = self.cut.take() {
            match go.filter(|_| !moves) {
                Some(go) if angle(come, go) > self.corner => {
                    self.pass(line, motion, Some(come), out);
                    self.corner_turn(line, motion, go, out, findings);
                }
                Some(go) => self.pass(line, motion, Some(come + go), out),
                None => self.pass(line, motion, Some(come), out),
            }
        }
        for next in std::mem::take(&mut self.behind) {
            let Flow::Point(Line { line, motion }) = next else {
                out.push(next);
                continue;
            };
            if turned {
                self.pass(line, motion, go, out);
                continue;
            }
            self.pass(line, motion, None, out);
            last = Some((line, motion));
            if let Some(go) = go
                && motion.pace == Pace::Rapid
            {
                // Off the part: turned here, before the way in.
                self.pass(line, motion, Some(go), out);
                turned = true;
            }
        }
        // Straight from one cut into another: a corner, if it is one.
        if let (false, Some(go), Some((line, motion))) = (turned, go, last)
            && angle(self.edge, go) > self.corner
        {
            self.corner_turn(line, motion, go, out, findings);
        }
    }

    /// Turns the edge at a corner.
    fn corner_turn(
        &mut self,
        line: u64,
        motion: Motion,
        edge: Vector3<f64>,
        out: &mut Out<'_>,
        findings: &Findings,
    ) {
        let away = self
            .rewind
            .and_then(|rewind| Some((rewind, motion.drawn_back(&rewind, 0.0)?)));
        if let Some((rewind, away)) = away {
            let away_from_part = Motion {
                pace: Pace::feed_or_rapid(rewind.retract_feed),
                ..away
            };
            self.pass(line, away_from_part, None, out);
            let turn = Motion {
                pace: rewind.turn_feed.map_or(Pace::Rapid, |feed| {
                    let way = angle(self.edge, edge).to_degrees();
                    Pace::InverseTime(feed / way.max(1e-3))
                }),
                ..away
            };
            self.pass(line, turn, Some(edge), out);
            let back = Motion {
                pace: rewind.plunge_feed.map_or(motion.pace, Pace::PerMinute),
                ..motion
            };
            self.pass(line, back, Some(edge), out);
        } else {
            if self.rewind.is_some() {
                fault(
                    findings,
                    line,
                    "at this corner the tool must be drawn back and turned, and it cannot be: the plane of [rewind] lies below the tip, or the tool is nearly level",
                );
            }
            if angle(self.edge, edge) > HALF {
                // Right about: by the side, for the way round must be said.
                let side = motion.axis.cross(&self.edge);
                self.pass(line, motion, Some(side), out);
            }
            self.pass(line, motion, Some(edge), out);
        }
    }

    fn pass(
        &mut self,
        line: u64,
        mut motion: Motion,
        along: Option<Vector3<f64>>,
        out: &mut Out<'_>,
    ) {
        // Straight into the part there is no direction of travel: the edge stays as it is.
        let edge = along
            .and_then(|along| across(along, motion.axis))
            .or_else(|| across(self.edge, motion.axis))
            .or_else(|| across(Vector3::x(), motion.axis))
            .unwrap_or_else(Vector3::y);
        self.edge = edge;
        motion.edge = edge;
        out.push(Flow::Point(Line { line, motion }));
    }
}

/// A fault of the leading edge at `line`.
fn fault(findings: &Findings, line: u64, message: &str) {
    findings.at(
        line,
        Diagnostic::error("edge", message)
            .help("[rewind] and [solution] edge say how a leading edge is turned"),
    );
}

/// The part of a direction across the tool axis, of length one.
fn across(direction: Vector3<f64>, axis: Vector3<f64>) -> Option<Vector3<f64>> {
    let length = direction.norm();
    (direction - axis * axis.dot(&direction)).try_normalize(1e-3 * length.max(1e-9))
}
