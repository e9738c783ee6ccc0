//! What a course is about, from one pass over it.

use nalgebra::Vector3;

use super::{Course, CourseItem, Curve};
use crate::{MOST_FAULTS, MotionKind, ProgramEvent};
use post_machine::diagnostic::Diagnostic;

/// What a course is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CourseFacts {
    /// Pieces at feed, arcs and splines counted once; of them those of holes.
    pub cuts: u64,
    /// Pieces at rapid.
    pub rapids: u64,
    /// Poses that are reached by whatever way.
    pub reached: u64,
    /// Arcs.
    pub arcs: u64,
    /// Splines.
    pub splines: u64,
    /// Holes of cycles.
    pub holes: u64,
    /// Way of the tip at feed, mm.
    pub cut_way: f64,
    /// Least and largest coordinates of the tip, mm, part frame; none if it never moves.
    pub extents: Option<[Vector3<f64>; 2]>,
    /// The same of what is cut at feed.
    pub cut_extents: Option<[Vector3<f64>; 2]>,
    /// The largest angle of the tool axis from Z of the part, radians.
    pub lean: f64,
    /// Operations, in order.
    pub operations: Vec<CourseOperation>,
}

/// An operation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CourseOperation {
    /// Line on which it begins.
    pub line: u64,
    /// Its name.
    pub name: String,
    /// Tool that it began with.
    pub tool: Option<u32>,
}

impl CourseFacts {
    /// Goes over a course to its end; what is wrong with it beside it, as far as the first fifty faults.
    pub fn of(course: &mut impl Course) -> (Self, Vec<Diagnostic>) {
        let (mut facts, mut faults, mut tool) = (Self::default(), Vec::new(), None);
        loop {
            match course.next() {
                Ok(None) => return (facts, faults),
                Ok(Some(item)) => facts.take(&item, &mut tool),
                Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
                Err(_) => return (facts, faults),
            }
        }
    }

    fn take(&mut self, item: &CourseItem, tool: &mut Option<u32>) {
        match item {
            CourseItem::Piece(piece) => {
                let extents = piece.extents();
                widen(&mut self.extents, extents);
                let z = Vector3::z();
                for axis in [piece.from.axis, piece.to.axis] {
                    let lean = libm::atan2(axis.cross(&z).norm(), axis.z);
                    self.lean = self.lean.max(lean);
                }
                match piece.kind {
                    MotionKind::Rapid => self.rapids += 1,
                    MotionKind::Feed | MotionKind::Thread => {
                        self.cuts += 1;
                        self.cut_way += piece.length();
                        widen(&mut self.cut_extents, extents);
                    }
                }
                match piece.curve {
                    Curve::Straight => {}
                    Curve::Arc { .. } => self.arcs += 1,
                    Curve::Spline(_) => self.splines += 1,
                }
            }
            CourseItem::Reach(reach) => {
                self.reached += 1;
                widen(&mut self.extents, [reach.to.tip; 2]);
            }
            CourseItem::Away { .. } => {}
            CourseItem::Event { line, event } => match event {
                ProgramEvent::Cycle(_) => self.holes += 1,
                ProgramEvent::ToolChange { number, .. } => *tool = *number,
                ProgramEvent::Operation(name) => self.operations.push(CourseOperation {
                    line: *line,
                    name: name.clone(),
                    tool: *tool,
                }),
                _ => {}
            },
        }
    }
}

fn widen(extents: &mut Option<[Vector3<f64>; 2]>, more: [Vector3<f64>; 2]) {
    *extents = Some(match extents {
        None => more,
        Some([least, most]) => [least.inf(&more[0]), most.sup(&more[1])],
    });
}
