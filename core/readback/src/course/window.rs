//! A part of a course as a course of its own: what `post --split` makes a program of.

use std::ops::Range;

use post_machine::diagnostic::Diagnostic;

use super::{Course, Item, Reach};
use crate::{MotionKind, Told};

/// The items of some lines of a course, with what holds there.
#[derive(Debug)]
pub struct Window<C> {
    course: C,
    /// None: all.
    lines: Option<Range<u64>>,
    /// Something moved in the window.
    moved: bool,
}

impl<C> Window<C> {
    /// What the lines of `course` ask for; without lines all of it.
    pub fn new(course: C, lines: Option<Range<u64>>) -> Self {
        Self { course, lines, moved: false }
    }
}

impl<C: Course> Course for Window<C> {
    fn next(&mut self) -> Result<Option<Item>, Box<Diagnostic>> {
        loop {
            let Some(item) = self.course.next()? else {
                return Ok(None);
            };
            let Some(lines) = &self.lines else {
                return Ok(Some(item));
            };
            let line = match &item {
                Item::Piece(piece) => piece.line,
                Item::Reach(reach) => reach.line,
                Item::Away { line } | Item::Told { line, .. } => *line,
            };
            let inside = lines.contains(&line);
            match item {
                // What was switched before still holds.
                Item::Told {
                    told:
                        Told::ToolChange { .. }
                        | Told::Spindle(_)
                        | Told::Coolant(_)
                        | Told::Compensation { .. },
                    ..
                } if line < lines.end => return Ok(Some(item)),
                // How the tool comes to its first point is nobody's business.
                Item::Piece(piece) if inside && !self.moved && piece.kind == MotionKind::Rapid => {
                    self.moved = true;
                    return Ok(Some(Item::Reach(Reach {
                        line,
                        kind: piece.kind,
                        to: piece.to,
                        feed: None,
                        hole: piece.hole,
                    })));
                }
                item if inside => {
                    self.moved |= matches!(item, Item::Piece(_) | Item::Reach(_));
                    return Ok(Some(item));
                }
                _ => {}
            }
        }
    }
}
