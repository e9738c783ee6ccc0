//! `--report`: what a run came to, as one HTML file to look at.
//!
//! Tables and texts are packed as they come, into scratch files, and put together at the end: memory does not grow with the
//! program, and what does not fit is left out as a whole.

mod axes;
mod block_rows;
mod branch;
mod cl_points;
mod cl_window;
mod derived;
mod findings;
mod machine;
mod made;
mod motion_rows;
mod old_path;
mod parts;
mod path_rows;
mod predicted_lines;
mod predicted_parts;
mod predicted_rows;
pub mod solids;
mod told_by_prediction;

pub use block_rows::BlockRows;
pub use cl_window::ClWindow;
pub use findings::warnings;
pub use machine::machine;
pub use made::Made;
pub use motion_rows::{Besides, Heard, Hears, MotionRows};
pub use old_path::OldPath;
pub use parts::{Parts, excludes};
pub use predicted_lines::PredictedLines;
pub use predicted_parts::PredictedParts;
pub use told_by_prediction::{is_exceeded, predicted_facts, predicted_maxima};

use std::fs::File;
use std::path::Path;

use post_machine::description::Machine;
use post_readback::Offsets;
use post_readback::course::Course as _;
use post_readback::course::cl::{ClCourse, ClTool};
use post_readback::interpret::{Interpreter, Limits};
use post_readback::lexicon::Lexicon;
use post_report::meta::{FORMAT, Meta, Names, Tolerances};

use crate::arguments::JobArguments;
use crate::failure::Failure;
use crate::files::{ClSource, PathArg};
use crate::job::{nc_program, read_back};
use post_host::Finder;

/// The name of a file without its folders: the same job gives the same bytes wherever it lies.
pub fn name_of(file: &PathArg) -> String {
    let name = file.path().and_then(|path| path.file_name());
    name.map_or_else(|| "standard input".to_owned(), |name| name.to_string_lossy().into_owned())
}

/// A text that names a file, without the file's folders.
pub fn without_folder(text: &str, file: Option<&Path>) -> String {
    match file.and_then(|path| Some((path, path.file_name()?))) {
        Some((path, name)) => text.replace(&path.display().to_string(), &name.to_string_lossy()),
        None => text.to_owned(),
    }
}

/// What every report says of its job.
pub fn about(job: &'static str, machine: &Machine, title: String, names: Names) -> Meta {
    let accuracy = &machine.accuracy;
    Meta {
        format: FORMAT,
        by: format!("post {}", env!("CARGO_PKG_VERSION")),
        job,
        title,
        names,
        tolerances: Tolerances {
            tip: accuracy.tolerance,
            axis: accuracy.axis_tolerance.to_degrees(),
            rapid: accuracy.rapid_tolerance,
        },
        machine: Some(self::machine(machine)),
        heads: machine.heads.iter().map(|head| self::machine(&head.machine)).collect(),
        ..Meta::default()
    }
}

/// What a program is read back with once more, for its rows.
pub struct Again<'a> {
    /// The command line of the job.
    pub arguments: &'a JobArguments,
    /// The machine with its settings.
    pub machine: &'a Machine,
    /// Its plugins.
    pub finder: &'a Finder,
    /// What stands in the control's tables, if it was told.
    pub offsets: Option<&'a Offsets>,
    /// How far a program may go.
    pub limits: Limits,
}

impl Again<'_> {
    /// The program `name` in `file`, from its beginning, as it was read before.
    ///
    /// # Errors
    /// The CL file cannot be read, or the machine not be used.
    pub fn program(
        &self,
        source: Option<&ClSource>,
        name: &str,
        file: File,
    ) -> Result<Interpreter<File>, Failure> {
        let Self { arguments, machine, .. } = *self;
        let words = nc_program::spoken(self.finder, machine)?.words;
        let offsets = match self.offsets {
            Some(offsets) => offsets.clone(),
            None => read_back::offsets(arguments, machine, &self.tools(source)?),
        };
        let machine = read_back::as_counted(machine, &words, &offsets);
        let lexicon = Lexicon::new(&words);
        let program = Interpreter::new(&machine, &lexicon, &offsets, self.limits, name, file);
        Ok(program.map_err(|fault| *fault)?)
    }

    /// The path of the CL file.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn cl(&self, source: &ClSource) -> Result<ClWindow, Failure> {
        let input = source.open_beside()?;
        let settings = read_back::course_settings(self.arguments, self.machine, &input.name);
        ClWindow::new(self.machine, settings, input.bytes)
    }

    fn tools(&self, source: Option<&ClSource>) -> Result<Vec<ClTool>, Failure> {
        let Some(source) = source else {
            return Ok(Vec::new());
        };
        let input = source.open_beside()?;
        let settings = read_back::course_settings(self.arguments, self.machine, &input.name);
        let mut course = ClCourse::new(settings, input.bytes);
        // What is wrong with the file was told when it was read for its own sake.
        let mut faults = 0;
        while faults < 1000 {
            match course.next() {
                Ok(Some(_)) => {}
                Ok(None) => break,
                Err(_) => faults += 1,
            }
        }
        Ok(course.tools().to_vec())
    }
}
