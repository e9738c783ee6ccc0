//! A CL file as a course: what a CAM programmer means by it.
//!
//! Everything modal is settled here, apart from the stages that post the file: units, tool axis, feed, frames, cycles,
//! radius compensation and tools. Memory does not grow with the file: records are taken one by one.
//!
//! What the CAM systems mean where they differ (samples of each; the numbers of NX are those of its CLSF documentation):
//! NX's `CIRCLE` of eleven numbers goes clockwise about its axis, all others right-handed unless a word says otherwise;
//! CAMWorks states index angles in radians and from zero; NX repeats `LOAD` for the same tool, and every `TOOL PATH`
//! begins with the tool along Z; `NURBS` of NX is cubic, clamped, its first pole where the tool stands.

mod curves;
mod feed;
mod frame;
mod hole;
mod holes;
mod modal;
mod run;
mod settings;
mod strange;
mod tools;
mod turned;

use std::collections::VecDeque;
use std::io::Read;

use post_grammar::{ClReader, GotoRun, ReadError};
use post_machine::diagnostic::{Diagnostic, unreadable};

use super::{Course, CourseItem, CutRun};
use modal::ClModal;
pub use settings::ClSettings;
pub use tools::ClTool;

/// A CL file, read record by record.
#[derive(Debug)]
pub struct ClCourse<R> {
    reader: ClReader<R>,
    modal: ClModal,
    waiting: VecDeque<CourseItem>,
    ended: bool,
    gotos: Box<GotoRun>,
    /// Records that are read one by one: one of them cannot be told with others.
    alone: usize,
    /// Cuts are told together.
    together: bool,
}

impl<R: Read> ClCourse<R> {
    /// The file from `input`, which need not be buffered.
    pub fn new(settings: ClSettings, input: R) -> Self {
        Self {
            reader: ClReader::new(input),
            modal: ClModal::new(settings),
            waiting: VecDeque::new(),
            ended: false,
            gotos: Box::default(),
            alone: 0,
            together: true,
        }
    }

    /// Tells each cut by itself.
    pub fn one_by_one(mut self) -> Self {
        self.together = false;
        self
    }

    /// The tools that the file has loaded so far, each number once, in order: after a first pass over it all of them.
    pub fn tools(&self) -> &[ClTool] {
        self.modal.tools()
    }

    /// Texts of the file so far that are lines of the program letter for letter (`INSERT`, `PPRINT`), each once.
    pub fn own_lines(&self) -> impl Iterator<Item = &str> {
        self.modal.own_lines.iter().map(String::as_str)
    }

    /// Bytes of the file that were read so far, for a progress bar.
    pub fn bytes_read(&self) -> u64 {
        self.reader.bytes_read()
    }
}

impl<R: Read> ClCourse<R> {
    fn next_item(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        loop {
            if let Some(item) = self.waiting.pop_front() {
                return Ok(Some(item));
            }
            if self.ended {
                return Ok(None);
            }
            self.alone = self.alone.saturating_sub(1);
            match self.reader.next_record() {
                Ok(Some(record)) => self.modal.record(&record, &mut self.waiting)?,
                Ok(None) => {
                    self.ended = true;
                    self.modal.finish()?;
                }
                Err(ReadError::Syntax(fault)) => {
                    return Err(unreadable(self.modal.file(), &fault).boxed());
                }
                Err(ReadError::Io(error)) => {
                    self.ended = true;
                    let message = format!("{} cannot be read: {error}", self.modal.file());
                    return Err(Diagnostic::error("read", message).boxed());
                }
            }
        }
    }
}

impl<R: Read> Course for ClCourse<R> {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        self.next_item().map_err(|mut fault| {
            self.modal.settings.files().place(&mut fault);
            fault
        })
    }

    fn next_cuts(&mut self, cuts: &mut CutRun) -> bool {
        let Self { reader, modal, gotos, .. } = self;
        if !self.together || self.alone > 0 || !self.waiting.is_empty() || self.ended {
            return false;
        }
        let Some(feed) = modal.goes_on() else {
            return false;
        };
        reader.gotos_ahead(gotos);
        if !modal.cuts(gotos, feed, cuts) {
            self.alone = gotos.count();
            return false;
        }
        reader.pass_gotos(gotos);
        true
    }
}
