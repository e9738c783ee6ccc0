//! The path of the CL file, read along with the blocks: its points become a table, and a window of it is what deviations
//! are drawn from.

use std::io::Read;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_motion::path::{arc_chords, piece_ends};
use post_readback::course::cl::{ClCourse, ClSettings};
use post_readback::course::{Course, CourseItem, CoursePiece, Curve};

use super::cl_points::{self, ClPointRow, Points};
use super::parts::Parts;
use super::segments::Segments;
use crate::failure::Failure;
use crate::files::ClSource;
use crate::read_back;
use crate::settings::JobSettings;

/// Chords of a curve at most.
const MOST_CHORDS: f64 = 4096.0;

/// Chords of a span of a spline.
const SPAN: u64 = 64;

/// So many records that cannot be read are passed over: posting tells of them.
const MOST_FAULTS: u32 = 1000;

/// Segments of the path that are kept behind.
const MOST_KEPT: usize = 100_000;

/// Reads the path as far as it is asked for.
pub struct ClWindow {
    course: ClCourse<Box<dyn Read>>,
    points: Points,
    /// How far chords may stray from curves, mm.
    chord: f64,
    along: f64,
    /// The next piece, read and not taken yet.
    next: Option<CoursePiece>,
    segments: Segments,
    faults: u32,
    /// Why its file could not be read to its end.
    unread: Option<Box<Diagnostic>>,
    ended: bool,
}

impl ClWindow {
    /// That of the CL file of a job, on the machine with its settings.
    ///
    /// # Errors
    /// The file cannot be read, or there is no place for its table.
    pub fn of(
        arguments: &JobSettings,
        machine: &Machine,
        source: &ClSource,
    ) -> Result<Self, Failure> {
        let input = source.open_beside()?;
        let settings = read_back::course_settings(arguments, machine, &input);
        Self::new(machine, settings, input.bytes)
    }

    /// Of a CL file, read as posting reads it.
    ///
    /// # Errors
    /// There is no place for its table.
    pub fn new(
        machine: &Machine,
        settings: ClSettings,
        input: Box<dyn Read>,
    ) -> Result<Self, Failure> {
        Ok(Self {
            course: ClCourse::new(settings, input),
            points: Points::new()?,
            chord: machine.accuracy.tolerance / 10.0,
            along: machine.control_point.along,
            next: None,
            segments: Segments::default(),
            faults: 0,
            unread: None,
            ended: false,
        })
    }

    /// Reads to the end of `line`.
    pub fn advance(&mut self, line: u64) {
        while !self.ended || self.next.is_some() {
            if let Some(piece) = &self.next {
                if piece.line > line {
                    return;
                }
                let piece = piece.clone();
                self.next = None;
                self.piece(&piece);
            }
            match self.course.next() {
                Ok(Some(CourseItem::Piece(piece))) => self.next = Some(piece),
                Ok(Some(CourseItem::Reach(reach))) => {
                    self.points.push(reach.line, reach.to.tip, 2.0);
                    self.segments.at = Some(reach.to.tip);
                }
                Ok(Some(_)) => {}
                Ok(None) => self.ended = true,
                Err(fault) if fault.code == "read" => {
                    self.unread = Some(fault);
                    self.ended = true;
                }
                Err(_) => {
                    self.faults += 1;
                    self.ended = self.faults > MOST_FAULTS;
                }
            }
        }
    }

    /// Lines before this one are not asked for any more.
    pub fn forget(&mut self, before: u64) {
        while let Some(first) = self.segments.known.front()
            && (first.line < before || self.segments.known.len() > MOST_KEPT)
        {
            self.segments.known.pop_front();
        }
    }

    /// From the nearest point of the path to `tip`, mm; none where no path is known.
    pub fn off(&self, tip: Vector3<f64>) -> Option<Vector3<f64>> {
        self.segments.off(tip, usize::MAX)
    }

    /// Points of the path between those that are nearest to two places, the first behind it.
    pub fn between(&self, from: Vector3<f64>, to: Vector3<f64>) -> Vec<Vector3<f64>> {
        let nearest = |tip: Vector3<f64>, start: usize| {
            let later = self.segments.known.iter().enumerate().skip(start);
            let far =
                later.map(|(place, segment)| (place, (tip - segment.nearest(tip)).norm_squared()));
            far.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
        };
        let Some(first) = nearest(from, 0) else {
            return Vec::new();
        };
        let last = nearest(to, first).unwrap_or(first);
        let inner = self.segments.known.range(first..last);
        inner.map(|segment| segment.to).collect()
    }

    /// Reads the rest; the table goes to `parts`, told against the ends of these blocks.
    ///
    /// # Errors
    /// The file could not be read, or the table not be kept.
    pub fn finish(
        mut self,
        machine: &Machine,
        blocks: Points,
        parts: &mut Parts,
    ) -> Result<(), Failure> {
        while !self.ended || self.next.is_some() {
            self.forget(u64::MAX);
            let line = self.next.as_ref().map_or(0, |piece| piece.line);
            self.advance(line);
        }
        if let Some(fault) = self.unread {
            return Err(fault.into());
        }
        cl_points::pack(machine, self.points, blocks, parts)
    }

    fn piece(&mut self, piece: &CoursePiece) {
        let (along, chords) = (self.along, self.chords(piece));
        let tips = piece_ends(chords, piece.to.tip, |t| piece.at(t, along).tip);
        let row = |row: ClPointRow| self.points.push(row.line, row.at, row.rapid);
        self.segments.go(piece.line, piece.kind, piece.from.tip, tips, row);
    }

    fn chords(&self, piece: &CoursePiece) -> u64 {
        match &piece.curve {
            Curve::Straight if self.along == 0.0 => 1,
            // The point above goes straight, and the tip on a bow.
            Curve::Straight => 16,
            Curve::Arc { centre, sweep, .. } => {
                let radius = (piece.from.tip - centre).norm();
                arc_chords(radius, *sweep, self.chord).clamp(1.0, MOST_CHORDS) as u64
            }
            Curve::Spline(way) => way.spans().count() as u64 * SPAN,
        }
    }
}
