//! A curve or a hole whose points are decided one by one, put together again.

use super::ChosenPoint;
use crate::stream::StreamItem;

/// An element of the stream that is not whole yet.
#[derive(Debug)]
pub(super) struct PendingElement {
    /// The curve or the hole, with the moves that have come.
    pub element: StreamItem<ChosenPoint>,
    /// The moves that come now are those into the hole.
    inside: bool,
}

impl PendingElement {
    /// A curve or a hole without its moves.
    pub(super) fn new(element: StreamItem<ChosenPoint>) -> Self {
        Self { element, inside: false }
    }

    /// The moves that come now are those into the hole.
    pub(super) fn enter(&mut self) {
        self.inside = true;
    }

    /// Takes what comes next of it.
    pub(super) fn push(&mut self, next: StreamItem<ChosenPoint>) {
        match &mut self.element {
            StreamItem::Curve { curve, .. } => curve.moves.push(next),
            StreamItem::Hole(hole) if self.inside => hole.into.push(next),
            StreamItem::Hole(hole) => hole.above.push(next),
            _ => {}
        }
    }
}
