//! Blocks of a program that are run ahead of whoever judges them, and items of a CL file's course.

use std::io::Read;

use post_machine::diagnostic::Diagnostic;
use post_readback::course::cl::ClCourse;
use post_readback::course::{Course, CourseItem, CutRun};
use post_readback::{BlockEffect, ProgramRun};

use crate::beside::{Maker, Work};
use crate::nc_program::RunningProgram;

/// Blocks, or items of a course, that are handed over together: fewer are worth less than waking a thread.
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

/// What comes next of a course.
type NextItem = Result<CourseItem, Box<Diagnostic>>;

/// Items of a course that are read, the first of them last.
pub type ReadItems = Vec<NextItem>;

impl<R: Read + Send> Maker for ClCourse<R> {
    type Batch = ReadItems;

    fn make(&mut self, batch: &mut ReadItems, most: usize) -> bool {
        batch.clear();
        while batch.len() < most
            && let Some(item) = self.next().transpose()
        {
            batch.push(item);
        }
        batch.reverse();
        !batch.is_empty()
    }
}

/// The course of a CL file, read here or beside.
pub struct CourseAhead<'s, R: Read + Send> {
    work: Work<'s, ClCourse<R>>,
    items: ReadItems,
}

impl<'s, R: Read + Send> CourseAhead<'s, R> {
    /// What `work` reads.
    pub fn new(work: Work<'s, ClCourse<R>>) -> Self {
        Self { work, items: ReadItems::new() }
    }
}

impl<R: Read + Send> Course for CourseAhead<'_, R> {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        if let Work::Here(course) = &mut self.work {
            return course.next();
        }
        if self.items.is_empty() && !self.work.next(&mut self.items) {
            return Ok(None);
        }
        self.items.pop().transpose()
    }

    fn next_cuts(&mut self, cuts: &mut CutRun) -> bool {
        match &mut self.work {
            Work::Here(course) => course.next_cuts(cuts),
            // They come one by one.
            Work::Beside { .. } => false,
        }
    }
}
