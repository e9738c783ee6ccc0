//! The commanded path as a spline, as far as it is needed.
//!
//! | part | does |
//! |---|---|
//! | `path` | knots, the pieces between them, and places on these |
//! | `nearest` | the place that a tool is nearest to, and which one is meant where several are near |
//! | `tied` | of places that are equally near, the one with the nearer tool axis |
//! | `lowest` | the nearest point of one piece |

mod lowest;
mod nearest;
mod tied;

use std::collections::VecDeque;

use nalgebra::Vector3;

use super::spline::{SplineSegment, Tangents};
use crate::ProgramPlace;
pub(super) use nearest::{CommandedTip, REACH};

/// Knots behind the nearest point that are kept.
const BEHIND: usize = 2048;

/// Knots that are kept in all: a tool that is further behind is taken to have come so far.
const MOST: usize = 1 << 18;

/// A set-point that the spline passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Number of the set-point.
    pub number: u64,
    pub at: ProgramPlace,
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    /// How the tip reaches and leaves it, and the tool axis.
    pub tip_ways: Tangents,
    pub axis_ways: Tangents,
    /// No less than the way of the tip to it, mm.
    pub length: f64,
    /// What follows it begins elsewhere: between the two there is no path.
    pub gap: bool,
}

/// A place on the path: after which knot, and what share of the piece that begins there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Foot {
    pub knot: usize,
    pub share: f64,
    /// Distance of the tip, mm.
    pub distance: f64,
}

/// A set-point that the place has passed without standing on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PassedSetPoint {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    /// Along the path from the place or the set-point before, mm.
    pub way: f64,
}

/// The commanded path: the spline through its knots.
#[derive(Clone, Debug, Default)]
pub(super) struct CommandedPath {
    knots: VecDeque<Knot>,
    /// The pieces behind all knots but the last; none where there is a gap.
    pieces: VecDeque<Option<SplineSegment>>,
    foot: Foot,
    /// Knots in cuts that the tool has passed since it was looked for the last time.
    pub passed: Vec<PassedSetPoint>,
}

impl CommandedPath {
    pub fn clear(&mut self) {
        self.knots.clear();
        self.pieces.clear();
        self.foot = Foot::default();
    }

    /// Takes the first knot of a leg: where the last one ended, or behind a gap.
    pub fn join(&mut self, mut knot: Knot) {
        if let Some(last) = self.knots.back_mut() {
            if last.tip == knot.tip && last.axis == knot.axis {
                last.tip_ways[1] = knot.tip_ways[1];
                last.axis_ways[1] = knot.axis_ways[1];
                return;
            }
            last.gap = true;
            knot.length = last.length + (knot.tip - last.tip).norm();
            self.pieces.push_back(None);
        }
        self.knots.push_back(knot);
    }

    /// Takes the next knot; one on which the machine stands as on the one before is the same.
    pub fn push(&mut self, mut knot: Knot) {
        if let Some(last) = self.knots.back_mut() {
            if last.tip == knot.tip && last.axis == knot.axis {
                last.tip_ways[1] = knot.tip_ways[1];
                last.axis_ways[1] = knot.axis_ways[1];
                return;
            }
            let legs = [last.tip_ways[1] / 3.0, knot.tip_ways[0] / 3.0];
            let middle = knot.tip - last.tip - legs[0] - legs[1];
            knot.length = last.length + legs[0].norm() + middle.norm() + legs[1].norm();
            let ends = [&last.tip, &knot.tip];
            let piece = SplineSegment::new(ends, &last.tip_ways[1], &knot.tip_ways[0]);
            self.pieces.push_back(Some(piece));
        }
        self.knots.push_back(knot);
        if self.knots.len() > MOST {
            self.drop_first(1);
        }
    }

    fn drop_first(&mut self, count: usize) {
        self.knots.drain(..count);
        self.pieces.drain(..count);
        self.foot.knot = match self.foot.knot.checked_sub(count) {
            Some(knot) => knot,
            None => {
                self.foot.share = 0.0;
                0
            }
        };
    }

    /// The tool has come to a place: what lies far behind it is forgotten.
    pub fn stand(&mut self, foot: Foot) {
        self.foot = foot;
        if foot.knot > 2 * BEHIND {
            self.drop_first(BEHIND);
        }
    }

    /// Keeps what lies between where the tool was and where it has come to.
    fn pass(&mut self, next: Foot) {
        self.passed.clear();
        let mut length = self.length(self.foot);
        for knot in self.foot.knot + 1..next.knot {
            let knot = &self.knots[knot];
            if knot.at.cuts {
                self.passed.push(PassedSetPoint {
                    tip: knot.tip,
                    axis: knot.axis,
                    way: (knot.length - length).max(0.0),
                });
                length = knot.length;
            }
        }
    }

    pub fn foot(&self) -> Foot {
        self.foot
    }

    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// Knots ahead of the tool, and how far they reach, mm.
    pub fn ahead(&self) -> (usize, f64) {
        let knots = self.knots.len() - 1 - self.foot.knot;
        let last = self.knots.back().map_or(0.0, |last| last.length);
        (knots, last - self.length(self.foot))
    }

    /// The length of the way to a place, mm.
    pub fn length(&self, foot: Foot) -> f64 {
        let length = self.knots[foot.knot].length;
        let next = self.knots.get(foot.knot + 1);
        length + foot.share * next.map_or(0.0, |next| next.length - length)
    }

    /// The place `way` mm after another.
    pub fn after(&self, foot: Foot, way: f64) -> Foot {
        let wanted = self.length(foot) + way;
        let mut knot = foot.knot;
        while let Some(next) = self.knots.get(knot + 1) {
            let length = self.knots[knot].length;
            if next.length > wanted {
                let share = match self.knots[knot].gap {
                    true => 0.0,
                    false => (wanted - length) / (next.length - length),
                };
                return Foot { knot, share, ..foot };
            }
            knot += 1;
        }
        Foot { knot, share: 0.0, ..foot }
    }

    /// What asks for a place: a piece is asked for by the knot at its end.
    pub fn at(&self, foot: Foot) -> ProgramPlace {
        let knot = foot.knot + usize::from(foot.share > 0.0);
        self.knots[knot.min(self.knots.len() - 1)].at
    }

    /// The place where a set-point stands.
    fn place_of(&self, number: u64) -> Foot {
        let knot = self.knots.partition_point(|knot| knot.number <= number);
        Foot { knot: knot.saturating_sub(1), ..Foot::default() }
    }

    /// The piece after a knot; none after the last.
    #[inline]
    fn cubic(&self, knot: usize) -> Option<&SplineSegment> {
        self.pieces.get(knot)?.as_ref()
    }

    /// The tip at a place.
    pub fn point(&self, foot: Foot) -> Vector3<f64> {
        match self.cubic(foot.knot) {
            Some(cubic) if foot.share > 0.0 => cubic.at(foot.share),
            _ => self.knots[foot.knot].tip,
        }
    }

    /// The tool axis at a place, unit vector.
    fn axis(&self, foot: Foot) -> Vector3<f64> {
        let last = &self.knots[foot.knot];
        let Some(next) = self.knots.get(foot.knot + 1).filter(|_| foot.share > 0.0) else {
            return last.axis;
        };
        let ends = [&last.axis, &next.axis];
        let cubic = SplineSegment::new(ends, &last.axis_ways[1], &next.axis_ways[0]);
        let axis = cubic.at(foot.share);
        axis.try_normalize(0.1).unwrap_or(last.axis)
    }

    /// No path leads to a knot.
    fn begins(&self, knot: usize) -> bool {
        knot == 0 || self.knots[knot - 1].gap
    }
}

#[cfg(test)]
mod tests;
