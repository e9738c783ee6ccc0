//! Where a course cuts, so that it is known how near a rapid comes to it: in memory that is bounded.

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;

use super::chop;
use super::octree::Octree;
use super::place::{PlaceBound, ToolPlace};
use crate::course::{Course, CourseItem};
use crate::{MOST_FAULTS, MotionKind};

/// The path of a course at feed.
#[derive(Clone, Debug)]
pub struct CutPath {
    /// Places of the path.
    kept: Octree,
    /// How far the guided point stands above the tip, mm.
    along: f64,
    places: Vec<ToolPlace>,
}

impl CutPath {
    /// An empty path; the guided point stands `along` mm above the tip.
    pub fn new(along: f64) -> Self {
        Self { kept: Octree::new(), along, places: Vec::new() }
    }

    /// Path of a course to its end, and what cannot be understood of it, as far as the first fifty faults.
    pub fn of(course: &mut impl Course, along: f64) -> (Self, Vec<Diagnostic>) {
        let (mut path, mut faults) = (Self::new(along), Vec::new());
        loop {
            match course.next() {
                Ok(None) => return (path, faults),
                Ok(Some(item)) => path.take(&item),
                Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
                Err(_) => return (path, faults),
            }
        }
    }

    /// Takes what is cut of an item.
    pub fn take(&mut self, item: &CourseItem) {
        let CourseItem::Piece(piece) = item else {
            return;
        };
        if piece.kind == MotionKind::Rapid {
            return;
        }
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
    pub fn blur(&self) -> f64 {
        self.kept.blur()
    }

    /// The distance of a point from the nearest place of the path that is kept, mm; infinite if nothing is cut.
    pub fn distance(&self, point: Vector3<f64>) -> f64 {
        self.kept.distance(point)
    }

    /// The least distance on a straight way, as far as it is less than `least`, mm.
    pub(super) fn least_on(&self, from: Vector3<f64>, to: Vector3<f64>, least: f64) -> f64 {
        let way = to - from;
        let length = way.norm();
        let (mut gone, mut found) = (0.0, f64::INFINITY);
        while gone <= length {
            let share = if length > 0.0 { gone / length } else { 0.0 };
            let distance = self.distance(from + way * share);
            found = found.min(distance);
            // Nothing this far on can be as near as that.
            gone += (distance - least.min(found)).max(2.0 * self.kept.cell());
        }
        found
    }
}
