//! Cuts that follow one another, told together.

use post_machine::kinematics::Pose;

use super::{CoursePiece, Curve};
use crate::MotionKind;

/// Straight pieces at one feed that follow one another, none of a hole; the pieces of a [`super::Course`] otherwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CutRun {
    /// Line of the source that asks for the first.
    pub line: u64,
    /// Lines from one to the next.
    pub lines: u64,
    /// Feed of the tip, mm/min; none where the source states none.
    pub feed: Option<f64>,
    /// Where the first begins, and where each ends: mm, part frame.
    pub poses: Vec<Pose>,
}

impl CutRun {
    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.poses.len().saturating_sub(1)
    }

    /// Line of the source that asks for a piece, by its place in the run.
    pub fn line(&self, place: usize) -> u64 {
        self.line + place as u64 * self.lines
    }

    /// A piece, by its place in the run.
    pub fn piece(&self, place: usize) -> CoursePiece {
        CoursePiece {
            line: self.line(place),
            kind: MotionKind::Feed,
            curve: Curve::Straight,
            from: self.poses[place],
            to: self.poses[place + 1],
            feed: self.feed,
            turned_feed: None,
            hole: false,
        }
    }
}
