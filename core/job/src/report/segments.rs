//! A path that comes bit by bit as straight pieces, and what of them is nearest to a place.

use std::collections::VecDeque;

use nalgebra::Vector3;
use post_motion::path::nearest_share;
use post_readback::MotionKind;

use super::cl_points::ClPointRow;

/// Ends that are farther apart than this do not meet, mm.
const APART: f64 = 1e-6;

/// A straight piece of a path.
#[derive(Clone, Copy, Debug)]
pub struct Segment {
    /// Line that it comes from.
    pub line: u64,
    /// Start, mm, part frame.
    pub from: Vector3<f64>,
    /// End.
    pub to: Vector3<f64>,
}

impl Segment {
    /// Its point that is nearest to `tip`.
    pub fn nearest(&self, tip: Vector3<f64>) -> Vector3<f64> {
        self.from + (self.to - self.from) * nearest_share([&self.from, &self.to], &tip)
    }
}

/// The pieces of a path that are known, in order.
#[derive(Default)]
pub struct Segments {
    pub known: VecDeque<Segment>,
    /// Where the tool stands, if that is known.
    pub at: Option<Vector3<f64>>,
}

impl Segments {
    /// The tool goes from `from` along `tips`; `row` is told of each, and of the beginning where it does not stand there.
    pub fn go(
        &mut self,
        line: u64,
        kind: MotionKind,
        mut from: Vector3<f64>,
        tips: impl Iterator<Item = Vector3<f64>>,
        mut row: impl FnMut(ClPointRow),
    ) {
        if self.at.is_none_or(|at| (at - from).norm() > APART) {
            row(ClPointRow { line, at: from, rapid: 2.0 });
        }
        let rapid = if kind == MotionKind::Rapid { 1.0 } else { 0.0 };
        for to in tips {
            self.known.push_back(Segment { line, from, to });
            row(ClPointRow { line, at: to, rapid });
            from = to;
        }
        self.at = Some(from);
    }

    /// From the nearest point of the first `count` of them to `tip`, mm; none where there are none.
    pub fn off(&self, tip: Vector3<f64>, count: usize) -> Option<Vector3<f64>> {
        let off = self.known.iter().take(count).map(|segment| tip - segment.nearest(tip));
        off.min_by(|one, other| one.norm_squared().total_cmp(&other.norm_squared()))
    }
}
