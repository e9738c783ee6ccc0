//! The path of a CL file, for the tool to be held against.

use post_machine::diagnostic::Diagnostic;
use post_motion::contour::ReferencePath;
use post_readback::MOST_FAULTS;
use post_readback::course::cl::{ClCourse, ClTool};
use post_readback::course::{Course, CourseWindow, Legs};

use super::PredictionSetup;
use crate::failure::Failure;
use crate::files::ClSource;
use crate::read_back;

/// The tools of a CL file: what they are called and how long they are stands anywhere in it.
///
/// # Errors
/// The file cannot be read, or something in it cannot be understood.
pub fn tools(asked: &PredictionSetup<'_>, source: &mut ClSource) -> Result<Vec<ClTool>, Failure> {
    let input = source.open()?;
    let settings = read_back::course_settings(asked.arguments, asked.machine, &input);
    let mut course = ClCourse::new(settings, input.bytes);
    let mut faults: Vec<Diagnostic> = Vec::new();
    loop {
        match course.next() {
            Ok(Some(_)) => {}
            Ok(None) => break,
            Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
            Err(_) => break,
        }
    }
    match faults.is_empty() {
        true => Ok(course.tools().to_vec()),
        false => Err(faults.into()),
    }
}

/// The path of a CL file that [`tools`] has found nothing wrong in, as far as the program is made of it, and how messages
/// call the file.
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
