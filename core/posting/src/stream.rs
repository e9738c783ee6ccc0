//! What runs from stage to stage: points of the path, the commands between them, and what solves the points, in one
//! stream, in order.
//!
//! Every stage takes a batch and hands on a batch. What a stage cannot decide yet it keeps, commands among it, so
//! that nothing overtakes anything.

use std::rc::Rc;

use crate::accuracy::Placer;
use crate::program::Command;

/// Points and commands are handed on in batches of about this length: long enough that work on neighbouring points
/// overlaps and that a call costs nothing, short enough to stay in the fastest cache.
pub(crate) const BATCH: usize = 128;

/// One element of the stream.
#[derive(Clone, Debug)]
pub enum StreamItem<P> {
    /// A point of the path, or what a stage made of it.
    Point(P),
    /// A command between points.
    Command {
        /// Line of the CL file.
        line: u64,
        /// What it says.
        command: Command,
    },
    /// What solves the points from here on.
    Placer(Rc<Placer>),
}

impl<P> StreamItem<P> {
    /// Line of the CL file, that of a point by `of`; none of what solves points.
    pub(crate) fn line(&self, of: impl FnOnce(&P) -> u64) -> Option<u64> {
        match self {
            Self::Point(point) => Some(of(point)),
            Self::Command { line, .. } => Some(*line),
            Self::Placer(_) => None,
        }
    }

    /// Whether this is a mark that says where the moves of a hole stand.
    #[inline]
    pub(crate) fn marks_hole(&self) -> bool {
        matches!(self, Self::Command { command: Command::Hole(_), .. })
    }
}

/// Where a stage puts what it hands on; a batch that is full goes to the next stage at once, so that one arc of a
/// million chords needs no more memory than another.
pub(crate) struct BatchSink<'o, T> {
    batch: &'o mut Vec<T>,
    next: &'o mut dyn FnMut(&mut Vec<T>),
}

impl<'o, T> BatchSink<'o, T> {
    /// An outlet into `batch`, which `next` takes when it is full; it leaves the batch empty.
    pub(crate) fn new(batch: &'o mut Vec<T>, next: &'o mut dyn FnMut(&mut Vec<T>)) -> Self {
        Self { batch, next }
    }

    /// Hands on one element.
    #[inline]
    pub(crate) fn push(&mut self, element: T) {
        self.batch.push(element);
        if self.batch.len() >= BATCH {
            self.flush();
        }
    }

    /// Hands on one element, made where it is to lie: large ones are not copied there.
    #[inline]
    pub(crate) fn push_with(&mut self, make: impl FnOnce() -> T) {
        self.batch.extend(std::iter::once_with(make));
        if self.batch.len() >= BATCH {
            self.flush();
        }
    }

    /// Hands on a batch as it is, after what there is; it is empty then.
    pub(crate) fn pass(&mut self, batch: &mut Vec<T>) {
        self.flush();
        (self.next)(batch);
        batch.clear();
    }

    /// Hands on what there is.
    pub(crate) fn flush(&mut self) {
        if !self.batch.is_empty() {
            (self.next)(self.batch);
            self.batch.clear();
        }
    }
}

impl<P> BatchSink<'_, StreamItem<P>> {
    /// Hands on a command.
    pub(crate) fn command(&mut self, line: u64, command: Command) {
        self.push(StreamItem::Command { line, command });
    }
}
