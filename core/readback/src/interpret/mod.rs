//! Blocks become motions.

use std::io::{BufRead, Seek};

use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;

use crate::lexicon::Lexicon;
use crate::{Done, Offsets};

/// How far a program may go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Blocks that are run in all, those of loops and subprograms each time.
    pub blocks: u64,
    /// Subprograms and loops inside one another.
    pub depth: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            blocks: 100_000_000,
            depth: 32,
        }
    }
}

/// What a reading found, apart from motions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadReport {
    /// Blocks that were run.
    pub blocks: u64,
    /// Lines in front of `%` that were skipped.
    pub header: u64,
    /// Words that are not known, how often each, and the line of the first.
    pub unknown: Vec<(String, u64, u64)>,
    /// What was taken for granted.
    pub notes: Vec<Diagnostic>,
}

/// Runs a program block by block.
#[derive(Debug)]
pub struct Interpreter<R> {
    input: R,
    report: ReadReport,
}

impl<R: BufRead + Seek> Interpreter<R> {
    /// A program from `input`, which messages call `file`, on `machine`.
    ///
    /// # Errors
    /// The machine cannot be solved.
    pub fn new(
        machine: &Machine,
        lexicon: &Lexicon,
        offsets: &Offsets,
        limits: Limits,
        file: &str,
        input: R,
    ) -> Result<Self, Box<Diagnostic>> {
        let _ = (machine, lexicon, offsets, limits, file);
        Ok(Self {
            input,
            report: ReadReport::default(),
        })
    }

    /// Runs the next block and puts what it did behind what `done` holds; false at the end. It can be called again after
    /// an error, and goes on with the block behind.
    ///
    /// # Errors
    /// What stands there that cannot be understood, or is not run, with its place.
    pub fn next(&mut self, done: &mut Vec<Done>) -> Result<bool, Box<Diagnostic>> {
        let _ = (&mut self.input, done);
        todo!()
    }

    /// What was found so far.
    pub fn report(&self) -> &ReadReport {
        &self.report
    }
}
