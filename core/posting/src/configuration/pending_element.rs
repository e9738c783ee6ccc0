//! A curve or a hole whose points are decided one by one, put together again.

use super::ChosenPoint;
use crate::curve::{CurveMove, CurveMoves};
use crate::expand::PathMove;
use crate::stream::{Hole, StreamItem};

/// An element of the stream that is not whole yet.
#[derive(Debug)]
pub(super) enum PendingElement {
    /// A curve, with its line.
    Curve(u64, CurveMoves<ChosenPoint>),
    /// A hole.
    Hole {
        /// The hole.
        hole: Hole<ChosenPoint>,
        /// Its points are those into it.
        inside: bool,
    },
}

impl PendingElement {
    /// A curve without its moves.
    pub(super) fn curve(line: u64, curve: CurveMove) -> Self {
        Self::Curve(line, CurveMoves { curve, moves: Vec::new() })
    }

    /// A hole without its moves.
    pub(super) fn hole(hole: &Hole<PathMove>) -> Self {
        Self::Hole { hole: hole.remade(|_| Vec::new()), inside: false }
    }

    /// Line of the CL file.
    pub(super) fn line(&self) -> u64 {
        match self {
            Self::Curve(line, _) => *line,
            Self::Hole { hole, .. } => hole.line,
        }
    }

    /// The points of a hole are those into it from here on.
    pub(super) fn enter(&mut self) {
        if let Self::Hole { inside, .. } = self {
            *inside = true;
        }
    }

    /// Takes what comes next of it.
    pub(super) fn push(&mut self, next: StreamItem<ChosenPoint>) {
        match self {
            Self::Curve(_, curve) => curve.moves.push(next),
            Self::Hole { hole, inside: false } => hole.above.push(next),
            Self::Hole { hole, inside: true } => hole.into.push(next),
        }
    }

    /// The element, when all of it has come.
    pub(super) fn whole(self) -> StreamItem<ChosenPoint> {
        match self {
            Self::Curve(line, curve) => StreamItem::Curve { line, curve: Box::new(curve) },
            Self::Hole { hole, .. } => StreamItem::Hole(Box::new(hole)),
        }
    }
}
