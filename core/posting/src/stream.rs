//! What runs from stage to stage: points of the path, curves and holes with their moves, and the commands between them,
//! in one stream, in order.
//!
//! Every stage takes a batch and hands on a batch. What a stage cannot decide yet it keeps, commands among it, so
//! that nothing overtakes anything. A curve or a hole is one element with all its moves in it: no stage sees half of one.
//! Memory does not grow by that: a curve that would be more chords than `curve` allows goes by its moves, point by point,
//! a hole has no more of them than `program::limits` allows pecks, and a batch is full with as many moves as with points.

use std::fmt::Debug;

use nalgebra::Vector3;

use crate::program::{Command, HoleCycle};

/// Points and commands are handed on in batches of about this length: long enough that work on neighbouring points
/// overlaps and that a call costs nothing, short enough to stay in the fastest cache.
pub(crate) const BATCH: usize = 128;

/// A point of the path, or what a stage made of it; and what goes along with it between the same two stages.
pub trait StreamPoint: Clone + Debug {
    /// A curve.
    type Curve: Clone + Debug;
    /// What a stage says to the next of all elements from there on.
    type Note: Clone + Debug;

    /// Line of the CL file.
    fn line(&self) -> u64;

    /// How many moves a curve has.
    fn moves(curve: &Self::Curve) -> usize;
}

/// One element of the stream.
#[derive(Clone, Debug)]
pub enum StreamItem<P: StreamPoint> {
    /// A point of the path, or what a stage made of it.
    Point(P),
    /// A curve that may stay one, with its moves or as it is printed.
    Curve {
        /// Line of the CL file.
        line: u64,
        /// The curve.
        curve: Box<P::Curve>,
    },
    /// A hole that the control may have a cycle for, with its moves.
    Hole(Box<HoleMoves<P>>),
    /// A command between points.
    Command {
        /// Line of the CL file.
        line: u64,
        /// What it says.
        command: Command,
    },
    /// What holds from here on, from one stage to the next.
    Note {
        /// Line of the CL file.
        line: u64,
        /// What it says.
        note: P::Note,
    },
}

/// The moves of a cycle at one point, which the control may have a cycle for.
#[derive(Clone, Debug)]
pub struct HoleMoves<P: StreamPoint> {
    /// Line of the CL file.
    pub line: u64,
    /// The cycle in force.
    pub cycle: HoleCycle,
    /// The point that its heights count from, mm, part frame.
    pub point: Vector3<f64>,
    /// The tool axis, unit vector, part frame.
    pub axis: Vector3<f64>,
    /// Moves to the retract level above it.
    pub above: Vec<StreamItem<P>>,
    /// Moves into it and back to that level.
    pub into: Vec<StreamItem<P>>,
}

impl<P: StreamPoint> StreamItem<P> {
    /// Line of the CL file.
    pub(crate) fn line(&self) -> u64 {
        match self {
            Self::Point(point) => point.line(),
            Self::Curve { line, .. } | Self::Command { line, .. } | Self::Note { line, .. } => {
                *line
            }
            Self::Hole(hole) => hole.line,
        }
    }

    /// How many moves it has; a command and a note count as one.
    pub(crate) fn moves(&self) -> usize {
        match self {
            Self::Curve { curve, .. } => P::moves(curve),
            Self::Hole(hole) => hole.above.len() + hole.into.len(),
            _ => 1,
        }
    }
}

impl<P: StreamPoint> HoleMoves<P> {
    /// The hole with other moves, made of its own: first of those above it, then of those into it.
    pub(crate) fn remade<Q: StreamPoint>(
        &self,
        mut remake: impl FnMut(&[StreamItem<P>]) -> Vec<StreamItem<Q>>,
    ) -> HoleMoves<Q> {
        let Self { line, cycle, point, axis, .. } = *self;
        HoleMoves { line, cycle, point, axis, above: remake(&self.above), into: remake(&self.into) }
    }
}

/// All that `fill` hands on: what an element is made of.
pub(crate) fn gathered<T>(fill: impl FnOnce(&mut BatchSink<'_, T>)) -> Vec<T> {
    let mut all = Vec::new();
    fill(&mut BatchSink { batch: &mut all, moves: 0, next: None });
    all
}

/// What takes a batch from a stage; it leaves it empty.
type NextStage<'o, T> = dyn FnMut(&mut Vec<T>) + 'o;

/// Where a stage puts what it hands on; a batch that is full goes to the next stage at once. A curve or a hole that stays
/// one is in memory with all its moves, of which it has no more than `curve` and `program::limits` allow; an arc of more
/// goes on move by move, however many chords it has.
pub(crate) struct BatchSink<'o, T> {
    batch: &'o mut Vec<T>,
    /// Moves in the curves and holes of the batch.
    moves: usize,
    /// None where all is gathered that one element is made of.
    next: Option<&'o mut NextStage<'o, T>>,
}

impl<'o, T> BatchSink<'o, T> {
    /// An outlet into `batch`, which `next` takes when it is full; it leaves the batch empty.
    pub(crate) fn new(batch: &'o mut Vec<T>, next: &'o mut NextStage<'o, T>) -> Self {
        Self { batch, moves: 0, next: Some(next) }
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
        match &mut self.next {
            Some(next) => next(batch),
            None => self.batch.append(batch),
        }
        batch.clear();
    }

    /// Hands on what there is.
    pub(crate) fn flush(&mut self) {
        if let Some(next) = &mut self.next
            && !self.batch.is_empty()
        {
            next(self.batch);
            self.batch.clear();
            self.moves = 0;
        }
    }
}

impl<P: StreamPoint> BatchSink<'_, StreamItem<P>> {
    /// Hands on a curve or a hole, or any other element: the batch is full with as many moves in its curves and holes as
    /// with points.
    pub(crate) fn element(&mut self, element: StreamItem<P>) {
        self.moves += element.moves();
        self.push(element);
        if self.moves >= BATCH {
            self.flush();
        }
    }

    /// Hands on a command.
    pub(crate) fn command(&mut self, line: u64, command: Command) {
        self.push(StreamItem::Command { line, command });
    }

    /// Hands on a note.
    pub(crate) fn note(&mut self, line: u64, note: P::Note) {
        self.push(StreamItem::Note { line, note });
    }
}
