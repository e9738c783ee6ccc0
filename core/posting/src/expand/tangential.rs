//! Tangential control: where the leading edge of a knife or disc is headed, along the direction of travel, or along the
//! second vector of the CL points.
//!
//! A heading is a direction of the path, not yet laid across the tool axis: that is done at each instant, with the axis
//! of that instant. Along a path the heading at a point lies between the directions of the moves before and after it,
//! so that the edge turns steadily. At a corner it must be turned on the spot: drawn back first, if the machine has
//! `[rewind]`.

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::{ExpandedSink, PathMove};
use crate::findings::Findings;
use crate::program::{Command, MoveFeed, StraightMove};
use crate::stream::{HoleMoves, StreamItem, gathered};
use post_machine::description::{EdgeSource, Machine, Rewind};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::orientation::angle;

/// Ways shorter than this have no direction, mm.
const SHORT: f64 = 1e-6;

/// A way that makes a smaller angle with the tool axis (its sine; 3°) leads straight into the part or out of it, and has
/// no direction for an edge: the decimals of a CL file alone lay a short one anywhere across the axis.
const STRAIGHT_IN: f64 = 0.05;

/// Edges that differ by less are the same, radians.
const STANDS: f64 = 1e-6;

/// A heading leans if it is not square to the tool axis: by more than this cosine.
const LEANS: f64 = 1e-6;

/// A turn on the spot by more than this goes by the side, radians.
const HALF: f64 = 2.0;

/// So many moves and commands without a direction are held at most, those of the last hole beside them.
const MOST_HELD: usize = 1024;

/// Gives every move its edge; holds moves back until the next direction of travel is known.
#[derive(Debug)]
pub(super) struct Tangential {
    source: EdgeSource,
    /// Largest angle that is no corner, radians.
    corner: f64,
    rewind: Option<Rewind>,
    /// The edge in use, across the tool axis.
    edge: Vector3<f64>,
    /// Tip and tool axis of the last point that was taken.
    at: Option<[Vector3<f64>; 2]>,
    /// The last cut with a direction, and that direction at its end, of length one.
    cut: Option<(u64, StraightMove, Vector3<f64>)>,
    /// Whether there was such a cut since the tool came.
    has_cut: bool,
    /// What came after it: moves without a direction (rapids, straight in and out), holes, and commands.
    behind: VecDeque<StreamItem<PathMove>>,
    /// How many moves and commands wait: a hole is as many as it has moves.
    held: usize,
    /// Corners that the tool was drawn back at.
    pub(super) rewinds: u64,
    findings: Findings,
}

/// What is known of the moves that waited, while they are handed on.
struct HeldMoves {
    /// Direction of the cut that comes after them.
    go: Option<Vector3<f64>>,
    /// The edge was turned to it.
    turned: bool,
    /// The last of them before that.
    last: Option<(u64, StraightMove)>,
}

impl Tangential {
    /// None for a tool that turns.
    pub(crate) fn new(machine: &Machine, findings: &Findings) -> Option<Self> {
        Some(Self {
            source: machine.solution.edge,
            corner: machine.solution.corner,
            rewind: machine.rewind,
            edge: machine.edge?,
            at: None,
            cut: None,
            has_cut: false,
            behind: VecDeque::new(),
            held: 0,
            rewinds: 0,
            findings: findings.clone(),
        })
    }

    /// Line of the first step that waits.
    pub(super) fn first_line(&self) -> Option<u64> {
        let behind = || self.behind.front().map(StreamItem::line);
        self.cut.map(|(line, ..)| line).or_else(behind)
    }

    /// Takes an element; what is settled goes on.
    pub(super) fn take(&mut self, next: StreamItem<PathMove>, out: &mut ExpandedSink<'_>) {
        match next {
            StreamItem::Point(PathMove { line, motion }) => self.go(line, motion, out),
            StreamItem::Hole(hole) => self.hole(*hole, out),
            StreamItem::Command { line, command } => self.command(line, command, out),
            StreamItem::Note { line, note } => {
                self.leave(None, out);
                out.note(line, note);
            }
            // An edge turns with the path: it goes by its moves.
            StreamItem::Curve { curve, .. } => {
                for next in curve.moves {
                    self.take(next, out);
                }
            }
        }
    }

    /// Takes a move.
    fn go(&mut self, line: u64, motion: StraightMove, out: &mut ExpandedSink<'_>) {
        if self.source == EdgeSource::Cl {
            let along = if motion.edge == Vector3::zeros() {
                self.edge
            } else {
                if across(motion.edge, motion.axis, 1e-3).is_none() {
                    self.fault(line, "the leading edge lies along the tool axis");
                }
                motion.edge
            };
            self.pass(line, motion, Some(along), out);
            return;
        }
        let from = self.at.replace([motion.tip, motion.axis]);
        let way = from.filter(|_| motion.pace != MoveFeed::Rapid).and_then(|[from, axis]| {
            let way = (motion.tip - from).try_normalize(SHORT)?;
            let leads = |axis| across(way, axis, STRAIGHT_IN).is_some();
            (leads(axis) && leads(motion.axis)).then_some(way)
        });
        match way {
            Some(way) => {
                let [begin, end] = travel(&motion, way);
                self.settle(Some(begin), out);
                self.cut = Some((line, motion, end));
            }
            None => self.hold(StreamItem::Point(PathMove { line, motion }), out),
        }
    }

    /// Takes a command. Where the CL file says where the edge points, no move waits, and no command either.
    fn command(&mut self, line: u64, command: Command, out: &mut ExpandedSink<'_>) {
        if !command.leaves() && self.source == EdgeSource::Travel {
            self.hold(StreamItem::Command { line, command }, out);
            return;
        }
        let at = match command {
            Command::From { tip, axis } => Some([tip, axis]),
            _ => None,
        };
        self.leave(at, out);
        out.command(line, command);
    }

    /// The tool leaves the part; it stands `at` this tip with this axis after that, if that is known.
    fn leave(&mut self, at: Option<[Vector3<f64>; 2]>, out: &mut ExpandedSink<'_>) {
        self.settle(None, out);
        self.has_cut = false;
        self.at = at;
    }

    /// Takes a hole. Its ways lead straight in and out, or are rapids: they have no direction.
    fn hole(&mut self, hole: HoleMoves<PathMove>, out: &mut ExpandedSink<'_>) {
        if self.source == EdgeSource::Cl {
            let hole = hole.remade(|part| {
                gathered(|out| part.iter().for_each(|next| self.take(next.clone(), out)))
            });
            return out.element(StreamItem::Hole(Box::new(hole)));
        }
        let last = hole.above.iter().chain(&hole.into).rev().find_map(|next| match next {
            StreamItem::Point(at) => Some([at.motion.tip, at.motion.axis]),
            _ => None,
        });
        self.at = last.or(self.at);
        self.hold(StreamItem::Hole(Box::new(hole)), out);
    }

    /// What waits has nothing after it.
    pub(super) fn finish(&mut self, out: &mut ExpandedSink<'_>) {
        self.settle(None, out);
    }

    fn hold(&mut self, next: StreamItem<PathMove>, out: &mut ExpandedSink<'_>) {
        self.held += next.moves();
        self.behind.push_back(next);
        if self.held >= MOST_HELD {
            self.settle(None, out);
        }
    }

    /// Settles what waits; the next cut goes along `go`.
    fn settle(&mut self, go: Option<Vector3<f64>>, out: &mut ExpandedSink<'_>) {
        let moves = |next: &StreamItem<PathMove>| {
            matches!(next, StreamItem::Point(_) | StreamItem::Hole(_))
        };
        let moves = self.behind.iter().any(moves);
        // Where no cut came before, the edge stands as the first cut wants it from the beginning.
        self.has_cut |= self.cut.is_some();
        let mut held = HeldMoves { go, turned: !self.has_cut, last: None };
        if let Some((line, motion, come)) = self.cut.take() {
            match go.filter(|_| !moves) {
                Some(go) if turn(come, go, motion.axis) > self.corner => {
                    self.pass(line, motion, Some(come), out);
                    self.corner_turn((line, motion), [come, go], out);
                }
                Some(go) => self.pass(line, motion, Some(come + go), out),
                None => self.pass(line, motion, Some(come), out),
            }
        }
        self.held = 0;
        for next in std::mem::take(&mut self.behind) {
            self.pass_held(next, &mut held, out);
        }
        let HeldMoves { turned, last, .. } = held;
        let (false, Some(go), Some((line, motion))) = (turned, go, last) else {
            return;
        };
        // Straight from one cut into another: a corner, if it is one.
        let angle = turn(self.edge, go, motion.axis);
        if angle > self.corner {
            self.corner_turn((line, motion), [self.edge, go], out);
        } else if angle < STANDS {
            // The edge stands as the cut wants it, and the heading is that of the cut from its start.
            self.pass(line, motion, Some(go), out);
        }
    }

    /// Hands on what waited.
    fn pass_held(
        &mut self,
        next: StreamItem<PathMove>,
        held: &mut HeldMoves,
        out: &mut ExpandedSink<'_>,
    ) {
        match next {
            StreamItem::Point(PathMove { line, motion }) if held.turned => {
                self.pass(line, motion, held.go, out);
            }
            StreamItem::Point(PathMove { line, motion }) => {
                self.pass(line, motion, None, out);
                held.last = Some((line, motion));
                if held.go.is_some() && motion.pace == MoveFeed::Rapid {
                    // Off the part: turned here, before the way in.
                    self.pass(line, motion, held.go, out);
                    held.turned = true;
                }
            }
            StreamItem::Hole(hole) => {
                let hole = hole.remade(|part| {
                    gathered(|out| {
                        part.iter().for_each(|next| self.pass_held(next.clone(), held, out));
                    })
                });
                out.element(StreamItem::Hole(Box::new(hole)));
            }
            next => out.push(next),
        }
    }

    /// Turns the edge at a corner from one heading to another.
    fn corner_turn(
        &mut self,
        (line, motion): (u64, StraightMove),
        [come, heading]: [Vector3<f64>; 2],
        out: &mut ExpandedSink<'_>,
    ) {
        let away = self.rewind.and_then(|rewind| Some((rewind, motion.drawn_back(&rewind, 0.0)?)));
        let angle = turn(self.edge, heading, motion.axis);
        let laid = across(heading, motion.axis, 1e-3);
        if let Some((rewind, away)) = away {
            self.rewinds += 1;
            let away_from_part =
                StraightMove { pace: MoveFeed::feed_or_rapid(rewind.retract_feed), ..away };
            self.pass(line, away_from_part, None, out);
            let turn = StraightMove {
                pace: rewind.turn_feed.map_or(MoveFeed::Rapid, |feed| {
                    MoveFeed::InverseTime(feed / angle.to_degrees().max(1e-3))
                }),
                ..away
            };
            self.pass(line, turn, laid, out);
            let back = StraightMove {
                pace: rewind.plunge_feed.map_or(motion.pace, MoveFeed::PerMinute),
                ..motion
            };
            self.pass(line, back, Some(heading), out);
        } else {
            if self.rewind.is_some() {
                self.fault(
                    line,
                    "at this corner the tool must be drawn back and turned, and it cannot be: the plane of [rewind] lies below the tip, or the tool is nearly level",
                );
            }
            // The turn is even from edge to edge; headings that lean would have it begin and end in haste.
            let leans = |heading: Vector3<f64>| heading.dot(&motion.axis).abs() > LEANS;
            if leans(come) {
                self.pass(line, motion, None, out);
            }
            if angle > HALF {
                // Right about: by the side, for the way round must be said.
                let side = motion.axis.cross(&self.edge);
                self.pass(line, motion, Some(side), out);
            }
            self.pass(line, motion, laid, out);
            if leans(heading) {
                self.pass(line, motion, Some(heading), out);
            }
        }
    }

    /// A fault of the leading edge at `line`.
    fn fault(&self, line: u64, message: &str) {
        let fault = Diagnostic::error("edge", message)
            .help("[rewind] and [solution] edge say how a leading edge is turned");
        self.findings.at(line, fault);
    }

    /// Hands a move on that ends with this heading.
    fn pass(
        &mut self,
        line: u64,
        mut motion: StraightMove,
        heading: Option<Vector3<f64>>,
        out: &mut ExpandedSink<'_>,
    ) {
        let laid = |heading: Vector3<f64>| across(heading, motion.axis, 1e-3);
        let headed =
            heading.and_then(|heading| Some((heading.try_normalize(1e-9)?, laid(heading)?)));
        // Straight into the part there is no direction of travel: the edge stays as it is.
        let (heading, edge) = headed.unwrap_or_else(|| {
            let edge = laid(self.edge).or_else(|| laid(Vector3::x())).unwrap_or_else(Vector3::y);
            (edge, edge)
        });
        self.edge = edge;
        motion.edge = heading;
        out.push(StreamItem::Point(PathMove { line, motion }));
    }
}

/// The directions of travel at the beginning and the end of a move along `way`: of a chord those of its curve, which carries
/// that at its end as an edge, and turns as far before the chord's middle as behind it.
fn travel(motion: &StraightMove, way: Vector3<f64>) -> [Vector3<f64>; 2] {
    match motion.edge.try_normalize(SHORT).filter(|_| motion.chord > 0.0) {
        Some(end) => [way * (2.0 * way.dot(&end)) - end, end],
        None => [way; 2],
    }
}

/// The part of a direction across the tool axis, of length one; none if they make an angle of a sine below `least`.
fn across(direction: Vector3<f64>, axis: Vector3<f64>, least: f64) -> Option<Vector3<f64>> {
    let length = direction.norm();
    (direction - axis * axis.dot(&direction)).try_normalize(least * length.max(1e-9))
}

/// How far an edge turns about the tool axis from one heading to another, radians.
fn turn(from: Vector3<f64>, to: Vector3<f64>, axis: Vector3<f64>) -> f64 {
    let laid = |heading| across(heading, axis, 1e-6).unwrap_or(heading);
    angle(laid(from), laid(to))
}
