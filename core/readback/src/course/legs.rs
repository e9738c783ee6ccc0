//! A course as the legs that a predicted tool is held against.

use post_machine::diagnostic::Diagnostic;
use post_motion::ProgramPlace;
use post_motion::contour::{ContourLeg, ReferencePath};

use super::{Course, CourseItem};
use crate::{MOST_FAULTS, MotionKind};

/// The cuts of a course.
#[derive(Debug)]
pub struct Legs<'c, C> {
    course: C,
    along: f64,
    faults: &'c mut Vec<Diagnostic>,
}

impl<'c, C: Course> Legs<'c, C> {
    /// Those of `course`, whose guided point stands `along` above the tip, mm (`[tool] control_point`); what of it cannot
    /// be understood goes to `faults`, as far as the first fifty.
    pub fn new(course: C, along: f64, faults: &'c mut Vec<Diagnostic>) -> Self {
        Self { course, along, faults }
    }
}

impl<C: Course> ReferencePath for Legs<'_, C> {
    fn next(&mut self) -> Option<ContourLeg> {
        loop {
            match self.course.next() {
                Ok(Some(CourseItem::Piece(piece))) if piece.kind != MotionKind::Rapid => {
                    return Some(ContourLeg {
                        at: ProgramPlace { task: 0, line: piece.line, cuts: true },
                        curve: piece.curve,
                        from: piece.from,
                        to: piece.to,
                        along: self.along,
                    });
                }
                Ok(Some(_)) => {}
                Ok(None) => return None,
                Err(fault) => {
                    if self.faults.len() >= MOST_FAULTS {
                        return None;
                    }
                    self.faults.push(*fault);
                }
            }
        }
    }
}
