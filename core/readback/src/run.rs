//! A program that is run, whoever runs it.

use std::io::{Read, Seek};

use post_machine::diagnostic::Diagnostic;

use crate::BlockEffect;
use crate::interpret::Interpreter;

/// So many blocks of a program, or records of a CL file, that cannot be read are told; then it is given up.
pub const MOST_FAULTS: usize = 50;

/// A program, block by block.
pub trait BlockRunner {
    /// Runs the next block and puts what it did behind what `done` holds; false at the end. It can be called again after
    /// an error.
    ///
    /// # Errors
    /// What stands there that cannot be understood, with its place.
    fn next(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>>;
}

impl<R: Read + Seek> BlockRunner for Interpreter<R> {
    fn next(&mut self, done: &mut Vec<BlockEffect>) -> Result<bool, Box<Diagnostic>> {
        Interpreter::next(self, done)
    }
}

/// A program that is run to its end, past blocks that cannot be read, until these are [`MOST_FAULTS`].
#[derive(Debug)]
pub struct ProgramRun<P> {
    program: P,
    done: Vec<BlockEffect>,
    faults: Vec<Diagnostic>,
    over: bool,
}

impl<P: BlockRunner> ProgramRun<P> {
    /// A program from where it stands.
    pub fn new(program: P) -> Self {
        Self { program, done: Vec::new(), faults: Vec::new(), over: false }
    }

    /// What the next block did, which the caller may draw out of the list; none behind the last. A block that cannot be
    /// read did what stands before its fault.
    #[inline]
    pub fn block(&mut self) -> Option<&mut Vec<BlockEffect>> {
        if self.over {
            return None;
        }
        self.done.clear();
        match self.program.next(&mut self.done) {
            Ok(true) => {}
            Ok(false) => {
                self.over = true;
                return None;
            }
            Err(fault) => self.refuse(*fault),
        }
        Some(&mut self.done)
    }

    /// Counts a fault of the program that the caller has found.
    pub fn refuse(&mut self, fault: Diagnostic) {
        self.faults.push(fault);
        self.over |= self.faults.len() >= MOST_FAULTS;
    }

    /// The program.
    pub fn program(&self) -> &P {
        &self.program
    }

    /// What cannot be read of it, so far.
    pub fn faults(&self) -> &[Diagnostic] {
        &self.faults
    }

    /// What cannot be read of it.
    pub fn into_faults(self) -> Vec<Diagnostic> {
        self.faults
    }
}
