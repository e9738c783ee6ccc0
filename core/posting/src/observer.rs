//! Observers of a program while it is made, and where its text goes.

use std::cell::RefCell;

use crate::accuracy::NodeMove;
use crate::blocks::MotionBlock;
use crate::curve::CurveBlock;
use crate::program::Command;
use crate::stream::{HoleMoves, StreamItem};

/// Where the text of the program goes. It may be written to from another thread than that which made it, from one at a
/// time.
pub trait TextSink: Send {
    /// Takes text.
    ///
    /// # Errors
    /// Why it cannot.
    fn write(&mut self, text: &[u8]) -> Result<(), String>;
}

/// Observes a program while it is made. Each method does nothing unless it is written.
pub trait Observer {
    /// A cut between two CL points, before any point is put in. Chords of arcs, splines and cycles come one by
    /// one. Where `reduce` gathers CL points, cuts go by unseen.
    fn cut(&mut self, line: u64, cut: &NodeMove<'_>) {
        let _ = (line, cut);
    }

    /// A block as it went to the dialect.
    fn block(&mut self, block: &MotionBlock) {
        let _ = block;
    }

    /// A block along a curve: a block as any other.
    fn curve(&mut self, curve: &CurveBlock) {
        self.block(&curve.block);
    }

    /// A hole, as a cycle of the control or by its moves: these one by one.
    fn hole(&mut self, hole: &HoleMoves<MotionBlock>) {
        self.blocks(&hole.above);
        self.blocks(&hole.into);
    }

    /// A command between blocks, from this line of the CL file.
    fn command(&mut self, line: u64, command: &Command) {
        let _ = (line, command);
    }

    /// Blocks and the commands between them, in order: each goes to the method for it.
    fn blocks(&mut self, blocks: &[StreamItem<MotionBlock>]) {
        for next in blocks {
            match next {
                StreamItem::Point(block) => self.block(block),
                StreamItem::Curve { curve, .. } => self.curve(curve),
                StreamItem::Hole(hole) => self.hole(hole),
                StreamItem::Command { line, command } => self.command(*line, command),
                StreamItem::Note { .. } => {}
            }
        }
    }
}

/// All observers of a run.
#[derive(Default)]
pub(crate) struct Observers<'a> {
    all: RefCell<Vec<&'a mut dyn Observer>>,
}

impl<'a> Observers<'a> {
    pub(crate) fn add(&self, observer: &'a mut dyn Observer) {
        self.all.borrow_mut().push(observer);
    }

    pub(crate) fn blocks(&self, blocks: &[StreamItem<MotionBlock>]) {
        for observer in self.all.borrow_mut().iter_mut() {
            observer.blocks(blocks);
        }
    }

    pub(crate) fn cut(&self, line: u64, cut: &NodeMove<'_>) {
        for observer in self.all.borrow_mut().iter_mut() {
            observer.cut(line, cut);
        }
    }
}
