//! Parts of a course as a course of its own: what `post --split` and `--operations` make a program of.

use std::ops::Range;

use post_machine::diagnostic::Diagnostic;

use super::{Course, CourseItem, CutRun, ReachedPose};
use crate::{MotionKind, ProgramEvent};

/// The items of some lines of a course, with what holds there.
#[derive(Debug)]
pub struct CourseWindow<C> {
    course: C,
    /// None: all.
    lines: Option<Vec<Range<u64>>>,
    /// The range that is read or comes next.
    range: usize,
    /// Something moved in the window.
    moved: bool,
}

impl<C> CourseWindow<C> {
    /// What the lines of `course` ask for, in some ranges; without any all of it.
    pub fn new(course: C, lines: Option<Vec<Range<u64>>>) -> Self {
        Self { course, lines, range: 0, moved: false }
    }
}

impl<C: Course> Course for CourseWindow<C> {
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>> {
        loop {
            let Some(item) = self.course.next()? else {
                return Ok(None);
            };
            let Some(lines) = &self.lines else {
                return Ok(Some(item));
            };
            let line = match &item {
                CourseItem::Piece(piece) => piece.line,
                CourseItem::Reach(reach) => reach.line,
                CourseItem::Away { line } | CourseItem::Event { line, .. } => *line,
            };
            if lines.get(self.range).is_some_and(|lines| lines.end <= line) {
                self.range +=
                    lines[self.range..].iter().take_while(|lines| lines.end <= line).count();
                self.moved = false;
            }
            let lines = lines.get(self.range);
            let inside = lines.is_some_and(|lines| lines.contains(&line));
            match item {
                // What was switched before still holds.
                CourseItem::Event {
                    event:
                        ProgramEvent::ToolChange { .. }
                        | ProgramEvent::Spindle(_)
                        | ProgramEvent::Coolant(_)
                        | ProgramEvent::Compensation { .. }
                        | ProgramEvent::WorkOffset(_),
                    ..
                } if lines.is_some() => return Ok(Some(item)),
                // How the tool comes to its first point is nobody's business.
                CourseItem::Piece(piece)
                    if inside && !self.moved && piece.kind == MotionKind::Rapid =>
                {
                    self.moved = true;
                    return Ok(Some(CourseItem::Reach(ReachedPose {
                        line,
                        kind: piece.kind,
                        to: piece.to,
                        feed: None,
                        hole: piece.hole,
                    })));
                }
                item if inside => {
                    self.moved |= matches!(item, CourseItem::Piece(_) | CourseItem::Reach(_));
                    return Ok(Some(item));
                }
                _ => {}
            }
        }
    }

    fn next_cuts(&mut self, cuts: &mut CutRun) -> bool {
        self.lines.is_none() && self.course.next_cuts(cuts)
    }
}
