//! Blocks of a program that are run ahead of whoever judges them.

use post_readback::{BlockEffect, ProgramRun};

use crate::beside::Maker;
use crate::nc_program::RunningProgram;

/// Blocks that are handed over together: fewer are worth less than waking a thread.
pub const TOGETHER: usize = 256;

/// Blocks of a program that were run.
#[derive(Default)]
pub struct RunBlocks {
    /// What they did.
    effects: Vec<BlockEffect>,
    /// How much of it each of them ends behind.
    ends: Vec<usize>,
}

impl RunBlocks {
    /// What each of them did.
    pub fn iter(&self) -> impl Iterator<Item = &[BlockEffect]> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).map(|(start, end)| &self.effects[*start..*end])
    }
}

impl<'i> Maker for ProgramRun<RunningProgram<'i>> {
    type Batch = RunBlocks;

    fn make(&mut self, batch: &mut RunBlocks, most: usize) -> bool {
        batch.effects.clear();
        batch.ends.clear();
        while batch.ends.len() < most
            && let Some(done) = self.block()
        {
            match batch.effects.is_empty() {
                true => std::mem::swap(&mut batch.effects, done),
                false => batch.effects.append(done),
            }
            batch.ends.push(batch.effects.len());
        }
        !batch.ends.is_empty()
    }
}
