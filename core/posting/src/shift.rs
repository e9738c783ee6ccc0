//! Points of the path are moved by a little, so that the servos bring the tool where the CL file wants it.
//!
//! What is moved is the path after `expand`: points of the CL file, and those that stand for its arcs and splines. Rapids,
//! holes, and what the control offsets by the cutter's radius stay. No point moves by more than the machine file allows.

use nalgebra::Vector3;
use post_plugin::Compensation;

use crate::expand::{FixedAxis, PathMove};
use crate::program::{Command, MoveFeed};
use crate::stream::StreamItem;

/// A point of the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// Line of the CL file.
    pub line: u64,
    /// Tip, mm, part frame.
    pub tip: Vector3<f64>,
    /// Tool axis, unit vector, part frame.
    pub axis: Vector3<f64>,
    /// The tool reaches it at feed.
    pub cuts: bool,
    /// The tool has left the part since the point before.
    pub begins: bool,
    /// The point may be moved.
    pub moves: bool,
}

/// Says by how much points are moved.
pub trait PathShift {
    /// Shift of the next point, mm, part frame: every point of the path is asked for, in order, those that may
    /// not be moved too.
    fn next(&mut self, point: &PathPoint) -> Vector3<f64>;
}

/// The stage.
pub(crate) struct ShiftStage<'a> {
    by: &'a mut dyn PathShift,
    /// Largest shift, mm.
    bound: f64,
    begins: bool,
    hole: bool,
    offset: bool,
}

impl<'a> ShiftStage<'a> {
    pub fn new(by: &'a mut dyn PathShift, bound: f64) -> Self {
        Self { by, bound, begins: true, hole: false, offset: false }
    }

    /// Moves the points of a batch.
    pub fn take(&mut self, batch: &mut [StreamItem<PathMove>]) {
        for next in batch {
            match next {
                StreamItem::Point(at) => self.point(at),
                StreamItem::Curve { curve, .. } => self.take(&mut curve.moves),
                StreamItem::Hole(hole) => {
                    self.hole = true;
                    self.take(&mut hole.above);
                    self.take(&mut hole.into);
                    self.hole = false;
                }
                StreamItem::Command { command, .. } => {
                    if let Command::Compensate(side) = command {
                        self.offset = *side != Compensation::Off;
                    }
                    self.begins |= command.leaves();
                }
                StreamItem::Note { note: FixedAxis(_), .. } => self.begins = true,
            }
        }
    }

    fn point(&mut self, PathMove { line, motion }: &mut PathMove) {
        let cuts = motion.pace != MoveFeed::Rapid;
        let moves = cuts && !self.hole && !self.offset;
        let by = self.by.next(&PathPoint {
            line: *line,
            tip: motion.tip,
            axis: motion.axis,
            cuts,
            begins: std::mem::take(&mut self.begins),
            moves,
        });
        if moves {
            motion.tip += no_longer(by, self.bound);
        }
    }
}

/// A vector no longer than `most`; nothing of one that is no number.
fn no_longer(vector: Vector3<f64>, most: f64) -> Vector3<f64> {
    let length = vector.norm();
    match length {
        length if length <= most => vector,
        length if length.is_finite() => vector * (most / length),
        _ => Vector3::zeros(),
    }
}
