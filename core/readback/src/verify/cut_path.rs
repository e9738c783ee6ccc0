//! Where a course cuts, so that it is known how near a rapid comes to it: in memory that is bounded.

use std::fmt;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;

use super::chop;
use super::cut_bounds::CutBounds;
use super::octree::{FAR, Octree};
use super::place::{PlaceBound, ToolPlace};
use crate::course::{Course, CourseItem, CoursePiece, CutRun};
use crate::{MOST_FAULTS, MotionKind};

/// A path that is not looked up yet.
struct WaitingPath {
    bounds: CutBounds,
    course: Box<dyn Course>,
}

impl fmt::Debug for WaitingPath {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.bounds.fmt(to)
    }
}

/// The path of a course at feed.
#[derive(Debug)]
pub struct CutPath {
    /// Places of the path.
    kept: Octree,
    /// What is known of the path where its places are not looked up yet.
    waiting: Option<WaitingPath>,
    /// How far the guided point stands above the tip, mm.
    along: f64,
    places: Vec<ToolPlace>,
    /// What of a path that was looked up when somebody asked cannot be understood, or not be read.
    faults: Vec<Diagnostic>,
}

impl CutPath {
    /// An empty path; the guided point stands `along` mm above the tip.
    pub fn new(along: f64) -> Self {
        Self { kept: Octree::new(), waiting: None, along, places: Vec::new(), faults: Vec::new() }
    }

    /// The path of `course`, which is read when somebody asks for more than `bounds` tell of it.
    pub fn when_asked(bounds: CutBounds, course: Box<dyn Course>, along: f64) -> Self {
        Self { waiting: Some(WaitingPath { bounds, course }), ..Self::new(along) }
    }

    /// Its places, which are looked up then.
    fn places(&mut self) -> &Octree {
        if let Some(mut waiting) = self.waiting.take() {
            let (path, faults) = Self::of(&mut *waiting.course, self.along);
            self.kept = path.kept;
            self.faults = faults;
        }
        &self.kept
    }

    /// What of a path that was looked up when somebody asked is wrong.
    pub(super) fn into_faults(self) -> Vec<Diagnostic> {
        self.faults
    }

    /// A point is surely farther than `near` mm from the path, and from what is known of it.
    pub(super) fn is_off(&self, point: Vector3<f64>, near: f64) -> bool {
        self.waiting.as_ref().is_some_and(|waiting| waiting.bounds.is_off(point, near))
    }

    /// A way surely comes no nearer to the path than its ends are, or one of these is within `near` mm of it.
    pub(super) fn keeps_off(&self, places: &[ToolPlace], near: f64) -> bool {
        self.waiting.as_ref().is_some_and(|waiting| waiting.bounds.keeps_off(places, near))
    }

    /// Path of a course to its end, and what cannot be understood of it, as far as the first fifty faults.
    pub fn of(course: &mut (impl Course + ?Sized), along: f64) -> (Self, Vec<Diagnostic>) {
        let (mut path, mut faults) = (Self::new(along), Vec::new());
        let mut cuts = CutRun::default();
        loop {
            if course.next_cuts(&mut cuts) {
                path.take_cuts(&cuts);
                continue;
            }
            match course.next() {
                Ok(None) => return (path, faults),
                Ok(Some(item)) => path.take(&item),
                Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
                Err(_) => return (path, faults),
            }
        }
    }

    /// Takes a run of cuts.
    fn take_cuts(&mut self, cuts: &CutRun) {
        let sag = PlaceBound::new(self.kept.cell(), 1.0);
        for (place, ends) in cuts.poses.windows(2).enumerate() {
            let straight = (self.along == 0.0 && self.kept.cell() == sag.point)
                .then(|| chop::straight_cut_end([&ends[0], &ends[1]], &sag))
                .flatten();
            match straight {
                Some(end) => self.add_way(ends[0].tip, end),
                None => self.take_piece(&cuts.piece(place)),
            }
        }
    }

    /// Takes what is cut of an item.
    pub fn take(&mut self, item: &CourseItem) {
        let CourseItem::Piece(piece) = item else {
            return;
        };
        if piece.kind != MotionKind::Rapid {
            self.take_piece(piece);
        }
    }

    fn take_piece(&mut self, piece: &CoursePiece) {
        let sag = PlaceBound::new(self.kept.cell(), 1.0);
        if self.along == 0.0
            && let Some(end) = chop::straight_end(piece, &sag)
        {
            self.add_way(piece.from.tip, end);
            return;
        }
        let mut places = std::mem::take(&mut self.places);
        places.clear();
        places.push(ToolPlace::new(&piece.from, self.along));
        chop::piece(piece, self.along, &sag, &mut places);
        for ends in places.windows(2) {
            self.add_way(ends[0].point, ends[1].point);
        }
        self.places = places;
    }

    fn add_way(&mut self, from: Vector3<f64>, to: Vector3<f64>) {
        let way = to - from;
        let mut gone = 0.0;
        let length = way.norm();
        // No cell on the way is left out but for its corners.
        while gone < length {
            self.kept.add(from + way * (gone / length));
            gone += self.kept.cell();
        }
        self.kept.add(to);
    }

    /// How finely distances are known, mm: the diagonal of a cell.
    pub fn blur(&mut self) -> f64 {
        self.places().blur()
    }

    /// The distance of a point from the nearest place of the path that is kept, mm; infinite if nothing is cut.
    pub fn distance(&mut self, point: Vector3<f64>) -> f64 {
        self.places().distance(point)
    }

    /// The least distance on a straight way, or by twice [`FAR`] of it more, as far as it is less than `least`, mm.
    pub(super) fn least_on(&mut self, from: Vector3<f64>, to: Vector3<f64>, least: f64) -> f64 {
        let way = to - from;
        let length = way.norm();
        let (mut gone, mut found) = (0.0, f64::INFINITY);
        let places = self.places();
        while gone <= length {
            let share = if length > 0.0 { gone / length } else { 0.0 };
            let distance = places.distance(from + way * share);
            found = found.min(distance);
            // Nothing this far on can be as near as that.
            let surely = distance * (1.0 - FAR) - least.min(found);
            gone += surely.max(distance * FAR).max(2.0 * places.cell());
        }
        found
    }
}
