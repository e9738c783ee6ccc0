//! The path of a CL file, for the tool to be held against.

use post_machine::diagnostic::Diagnostic;
use post_motion::contour::ReferencePath;
use post_readback::course::cl::ClCourse;
use post_readback::course::{CourseWindow, Legs};

use super::PredictionSetup;
use crate::failure::Failure;
use crate::files::ClSource;
use crate::read_back;

/// The path of a CL file that nothing wrong was found in ([`ClFacts`](crate::cl_facts::ClFacts)), as far as the program is
/// made of it, and how messages call the file.
///
/// # Errors
/// The file cannot be read.
pub fn open<'f>(
    asked: &PredictionSetup<'_>,
    source: &mut ClSource,
    faults: &'f mut Vec<Diagnostic>,
) -> Result<(Box<dyn ReferencePath + 'f>, String), Failure> {
    let input = source.open()?;
    let settings = read_back::course_settings(asked.arguments, asked.machine, &input);
    let course = ClCourse::new(settings, input.bytes);
    let course = CourseWindow::new(course, asked.lines.clone());
    let legs = Legs::new(course, asked.machine.control_point.along, faults);
    Ok((Box::new(legs), input.name))
}
