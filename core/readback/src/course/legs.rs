//! A course as the legs that a predicted tool is held against.

use post_machine::diagnostic::Diagnostic;
use post_motion::ProgramPlace;
use post_motion::contour::{ContourLeg, ReferencePath};

use super::{Course, Curve, Item, Piece};
use crate::{Interpolation, MOST_FAULTS, MotionKind};

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
                Ok(Some(Item::Piece(piece))) if piece.kind != MotionKind::Rapid => {
                    return Some(leg(piece, self.along));
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

fn leg(piece: Piece, along: f64) -> ContourLeg {
    let way = match piece.curve {
        Curve::Straight => Interpolation::TipAndAxis,
        Curve::Arc { centre, normal, sweep } => Interpolation::Arc { centre, normal, sweep },
        Curve::Spline(way) => Interpolation::Spline(way),
    };
    ContourLeg {
        at: ProgramPlace { task: 0, line: piece.line, cuts: true },
        way,
        from: piece.from,
        to: piece.to,
        along,
    }
}
