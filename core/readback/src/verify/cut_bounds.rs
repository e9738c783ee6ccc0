//! Where a course cuts, as a box and the ends of its cuts: enough for most rapids.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;

use super::chop;
use super::octree::Octree;
use super::place::{PlaceBound, ToolPlace};
use crate::course::{Course, CourseItem, CutRun};
use crate::{Curve, MOST_FAULTS, MotionKind};

/// Ends of cuts that are kept.
const MOST_ENDS: usize = 4096;

/// Chords of a curve stay nearer to it, mm.
const CURVED: f64 = 0.1;

/// What rounding moves a place by, and more, mm.
const ROUNDED: f64 = 1e-6;

/// Edge of the cubes that boxes are first gathered in, mm.
const FINEST: f64 = 1.0;

/// Boxes that are kept; of more they are gathered in larger cubes.
const MOST_BOXES: usize = 2048;

/// A box along the axes: least and largest coordinates, mm.
type Extents = [Vector3<f64>; 2];

/// Where a course cuts, roughly.
#[derive(Clone, Debug)]
pub struct CutBounds {
    /// How far the guided point stands above the tip, mm.
    along: f64,
    /// Boxes around pieces of the path at feed, mm, part frame, those whose middles lie in one cube as one.
    boxes: BTreeMap<[i64; 3], Extents>,
    /// Edge of these cubes, mm.
    cube: f64,
    /// Where cuts that follow one another begin and end, mm; not all, if there are many.
    ends: Vec<Vector3<f64>>,
    /// Where the last cut ended, if nothing came behind it.
    last: Option<Vector3<f64>>,
}

impl CutBounds {
    /// Of a course to its end, whose guided point stands `along` mm above the tip; and what cannot be understood of it, as far as
    /// the first fifty faults.
    pub fn of(course: &mut impl Course, along: f64) -> (Self, Vec<Diagnostic>) {
        let mut bounds =
            Self { along, boxes: BTreeMap::new(), cube: FINEST, ends: Vec::new(), last: None };
        let (mut faults, mut cuts) = (Vec::new(), CutRun::default());
        loop {
            if course.next_cuts(&mut cuts) {
                bounds.take_cuts(&cuts);
                continue;
            }
            match course.next() {
                Ok(Some(item)) => bounds.take(&item),
                Ok(None) => break,
                Err(fault) if faults.len() < MOST_FAULTS => faults.push(*fault),
                Err(_) => break,
            }
        }
        bounds.leave();
        (bounds, faults)
    }

    fn take_cuts(&mut self, cuts: &CutRun) {
        let along = self.along;
        let point = |pose: &Pose| match along == 0.0 {
            true => pose.tip,
            false => pose.tip + pose.axis * along,
        };
        if let (Some(first), Some(last)) = (cuts.poses.first(), cuts.poses.last()) {
            self.begin(point(first));
            self.last = Some(point(last));
        }
        let mut extents = NONE;
        for pose in &cuts.poses {
            let point = point(pose);
            extents = [extents[0].inf(&point), extents[1].sup(&point)];
        }
        self.add(extents);
    }

    fn take(&mut self, item: &CourseItem) {
        let CourseItem::Piece(piece) = item else {
            return match item {
                CourseItem::Event { .. } => {}
                _ => self.leave(),
            };
        };
        if piece.kind == MotionKind::Rapid {
            return self.leave();
        }
        let [from, to] = [&piece.from, &piece.to].map(|pose| ToolPlace::new(pose, self.along));
        self.begin(from.point);
        let mut extents = [from.point.inf(&to.point), from.point.sup(&to.point)];
        if piece.curve != Curve::Straight {
            let mut places = Vec::new();
            chop::piece(piece, self.along, &PlaceBound::new(0.5 * CURVED, 1.0), &mut places);
            for ToolPlace { point, .. } in places {
                extents = [extents[0].inf(&point), extents[1].sup(&point)];
            }
            let room = Vector3::repeat(CURVED);
            extents = [extents[0] - room, extents[1] + room];
        }
        self.add(extents);
        self.last = Some(to.point);
    }

    fn add(&mut self, extents: Extents) {
        let room = Vector3::repeat(ROUNDED);
        self.gather([extents[0] - room, extents[1] + room]);
        while self.boxes.len() > MOST_BOXES {
            self.cube *= 2.0;
            for extents in std::mem::take(&mut self.boxes).into_values() {
                self.gather(extents);
            }
        }
    }

    fn gather(&mut self, extents: Extents) {
        let middle = (extents[0] + extents[1]) * 0.5;
        let key = std::array::from_fn(|axis| libm::floor(middle[axis] / self.cube) as i64);
        let kept = self.boxes.entry(key).or_insert(extents);
        *kept = joined(kept, &extents);
    }

    /// A cut begins.
    fn begin(&mut self, at: Vector3<f64>) {
        if self.last != Some(at) {
            self.leave();
            self.keep(at);
        }
    }

    /// No cut goes on here.
    fn leave(&mut self) {
        if let Some(last) = self.last.take() {
            self.keep(last);
        }
    }

    fn keep(&mut self, end: Vector3<f64>) {
        if self.ends.len() < MOST_ENDS {
            self.ends.push(end);
        }
    }

    /// How finely distances from the path may be known at worst, mm.
    fn blur(&self) -> f64 {
        let [least, most] = self.boxes.values().fold(NONE, |all, extents| joined(&all, extents));
        Octree::coarsest_blur(most - least)
    }

    /// A point is surely farther than `near` mm from all that is cut, and from what is known of it.
    pub(super) fn is_off(&self, point: Vector3<f64>, near: f64) -> bool {
        let off = |[least, most]: &Extents| {
            (least - point).sup(&(point - most)).sup(&Vector3::zeros()).norm()
        };
        let nearest = self.boxes.values().map(off).fold(f64::INFINITY, f64::min);
        nearest > near && nearest > near + self.blur()
    }

    /// A way surely comes no nearer to what is cut than its ends are, but for `near` mm, or one of these is within `near` of
    /// it: first it leads away from all of it, then towards all of it.
    pub(super) fn keeps_off(&self, places: &[ToolPlace], near: f64) -> bool {
        let ends = [&places[0], &places[places.len() - 1]];
        let cuts = |place: &ToolPlace| {
            self.ends.iter().any(|end| (end - place.point).norm() < near * (1.0 - 1e-9))
        };
        if ends.into_iter().any(cuts) {
            return true;
        }
        let slack = 0.5 * near / places.len() as f64;
        let mut pieces = places.windows(2).map(|ends| [ends[0].point, ends[1].point]).peekable();
        while pieces.next_if(|[from, to]| self.leads_away(from, to, slack)).is_some() {}
        pieces.all(|[from, to]| self.leads_away(&to, &from, slack))
    }

    /// Whether all that is cut lies behind the beginning of a way, but for `slack` mm along it: by so much at most it comes
    /// nearer to any of it.
    fn leads_away(&self, from: &Vector3<f64>, to: &Vector3<f64>, slack: f64) -> bool {
        let way = to - from;
        let ahead = |[least, most]: &Extents| -> f64 {
            (0..3)
                .map(|axis| {
                    let [least, most] = [least, most].map(|side| side[axis] - from[axis]);
                    (way[axis] * least).max(way[axis] * most)
                })
                .sum()
        };
        let allowed = slack * way.norm();
        self.boxes.values().all(|extents| ahead(extents) <= allowed)
    }
}

/// A box with nothing in it.
const NONE: Extents = {
    let far = f64::INFINITY;
    [Vector3::new(far, far, far), Vector3::new(-far, -far, -far)]
};

/// The box around two others.
fn joined(one: &Extents, other: &Extents) -> Extents {
    [one[0].inf(&other[0]), one[1].sup(&other[1])]
}
