//! Cuts that go point by point with the course: what [`super::sweep`] finds of them is certain without it.
//!
//! Most programs have a block for each point of the CL file, and most of these end beside it, by less than what was told
//! already. The program then stands at the end of the element at hand and at the beginning of the next, and nowhere else:
//! which shares of both are within the tolerance follows from its place alone, and is worked out when somebody asks. A motion
//! goes on so if
//! - it ends so near to the end of the next element that its deviation is no larger than those that were told,
//! - it has left the element at hand, farther than the tolerance,
//! - the element behind the next is farther from all of it than the tolerance,
//! - all of them ask for the same, and nothing is wrong with what holds.
//!
//! Nothing of the tolerance's edge is decided here: what comes close to it is swept.

use std::sync::Arc;

use nalgebra::Vector3;

use super::Verifier;
use super::place::{PlaceDistance, ToolPlace, angle_of, free, nearest};
use super::track::{Element, ElementKind};
use crate::course::Course;
use crate::{Motion, MotionKind};

/// Share of a bound that rounding alone does not reach.
const CLEAR: f64 = 1.0 - 1e-9;

/// What rounding does to a distance as a share of the ways that it is worked out by, with room.
const ROUNDING: f64 = 1e-14;

/// Share of the tolerance within which a motion ends beside its element.
const WELL_WITHIN: f64 = 0.2;

/// How the program stands where it goes point by point.
#[derive(Debug, Default)]
pub(super) struct QuickStand {
    /// It goes point by point, and stands at the end of the first element of the track.
    on: bool,
    /// Ends of the motion that led there, if it was not swept: where the program can stand is not worked out then.
    last: Option<[ToolPlace; 2]>,
    /// How near the program came to the end of the first element is not known to be told: the next motion may come nearer.
    owes: bool,
    /// The largest deviation of the tool axis that was told, degrees, and a chord that is surely shorter.
    told: [f64; 2],
    /// A chord whose angle is no larger than that which was told.
    still: f64,
}

impl QuickStand {
    /// A chord between tool axes that is shorter than that of the angle which was told, degrees.
    fn chord(&mut self, told: f64) -> f64 {
        if self.told[0] != told {
            let chord = 2.0 * libm::sin(0.5 * told.to_radians());
            self.told = [told, chord * CLEAR - ROUNDING];
        }
        self.told[1]
    }

    /// Whether the angle of a chord is no larger than that which was told, degrees.
    fn tells(&mut self, chord: f64, told: f64) -> bool {
        if self.still == chord {
            return true;
        }
        let tells = angle_of(chord).to_degrees() <= told;
        if tells {
            self.still = chord;
        }
        tells
    }
}

impl<C: Course> Verifier<'_, C> {
    /// Takes a motion at feed that surely keeps to the course, and of which nothing is to be told; false if that is in doubt,
    /// and nothing is done then.
    #[inline]
    pub(super) fn goes_on(&mut self, motion: &Motion, places: &[ToolPlace]) -> bool {
        let cuts =
            motion.kind == MotionKind::Feed && !motion.machine && motion.along != Some(false);
        if !self.quick.on || !cuts {
            return false;
        }
        let &[from, to] = places else {
            return false;
        };
        if from.has_edge() || to.has_edge() || self.track.get(2).is_none() {
            return false;
        }
        let Some((state, asked)) = &self.agreed else {
            return false;
        };
        let quiet = self.turned.is_empty() && !self.running.changes();
        let kept = self.track.kept();
        let (left, next, behind) = (&kept[0], &kept[1], &kept[2]);
        let alike = [left, next, behind].iter().all(|element| {
            matches!(element.what, ElementKind::Cut)
                && Arc::ptr_eq(asked, &element.asked)
                && element.feed == left.feed
                && element.turned_feed.is_none()
        });
        if !quiet || !alike || !Arc::ptr_eq(state, &motion.state) {
            return false;
        }
        let bound = self.bound.point;
        if !passes(&left.from.point, &left.to.point, &to.point, bound)
            || !passes(&from.point, &to.point, &behind.to.point, bound)
        {
            return false;
        }
        let Some(end) = self.beside(&to, &next.to) else {
            return false;
        };
        let axes = [&left.to, &next.from, &behind.from].map(|place| place.axis);
        let still = from.axis == to.axis && axes == [next.to.axis; 3];
        let ways = [next.to.point - next.from.point, to.point - from.point];
        let long = bound + ways.iter().map(|way| way.abs().sum()).sum::<f64>();
        let tip = self.found.tip.value * CLEAR - ROUNDING * long;
        let angle = self.found.axis.value;
        // Where no axis turns a chord is worked out as it is in a sweep.
        let (chord, still) = (self.quick.chord(angle), still && self.quick.tells(end[1], angle));
        let is_told = |apart: [f64; 2]| apart[0] < tip && (still || apart[1] < chord);
        let is_told_on = |place: &ToolPlace, ends: [&ToolPlace; 2]| {
            let apart = apart_on(place, ends);
            is_told(apart) && apart[1] < self.bound.axis * CLEAR
        };
        let mut owes = false;
        if !is_told(end) {
            // Beside its end it may be nearer to the way, and the end to its own.
            if !is_told_on(&to, [&next.from, &next.to])
                && !is_told_on(&to, [&behind.from, &behind.to])
            {
                return false;
            }
            owes = !is_told_on(&next.to, [&from, &to]);
        }
        if self.quick.owes && !is_told_on(&left.to, [&from, &to])
            || !to.within(&behind.from, &self.bound)
        {
            return false;
        }
        let feed = next.feed;
        if !self.keeps_feed(motion, places, feed) {
            return false;
        }
        self.track.pop();
        self.quick.last = Some([from, to]);
        self.quick.owes = owes;
        self.found.cuts += 1;
        true
    }

    /// How far the end of a motion is from that of an element, mm, and the chord between their tool axes; none where it is not
    /// well within the tolerance.
    #[inline]
    fn beside(&self, place: &ToolPlace, end: &ToolPlace) -> Option<[f64; 2]> {
        let off = (place.point - end.point).norm();
        let chord = (place.axis - end.axis).norm();
        let within = off < self.bound.point * WELL_WITHIN && chord < self.bound.axis * CLEAR;
        (within && !end.has_edge()).then_some([off, chord])
    }

    /// Looks whether the program goes point by point from here on, behind a motion that was swept.
    pub(super) fn look_for_points(&mut self, places: &[ToolPlace]) {
        let &[_, to] = places else {
            return;
        };
        let stands = !self.apart && self.next.is_none() && self.hole.is_none();
        if self.rules.rows
            || self.rules.solutions
            || self.rules.linear_rapids
            || !stands
            || self.stray.is_some()
            || self.reach.len() != 2
            || to.has_edge()
        {
            return;
        }
        let kept = self.track.kept();
        let stands = |element: &Element| free(&to, &element.from, &element.to, &self.bound);
        let is_told = |near: &PlaceDistance| {
            near.point <= self.found.tip.value && near.axis.to_degrees() <= self.found.axis.value
        };
        self.quick.on = match (kept.front(), kept.get(1)) {
            (Some(at), Some(next)) => {
                is_told(&at.near)
                    && self.beside(&to, &at.to).is_some()
                    && self.reach.iter().all(|span| !span.is_empty())
                    && self.reach == [stands(at), stands(next)]
            }
            _ => false,
        };
    }

    /// Works out where on the course the program can stand, if that waits: what follows is no motion point by point.
    #[inline]
    pub(super) fn settle(&mut self) {
        if self.quick.on {
            self.quick.on = false;
            self.quick.owes = false;
            self.stand();
        }
    }

    fn stand(&mut self) {
        let Some([from, to]) = self.quick.last.take() else {
            return;
        };
        let bound = self.bound;
        self.reach.clear();
        for index in 0..2 {
            if let Some(element) = self.track.get(index) {
                self.reach.push(free(&to, &element.from, &element.to, &bound));
            }
        }
        if let Some(at) = self.track.get(0) {
            let top = free(&at.to, &from, &to, &bound);
            at.near = at.near.smaller(&nearest(&at.to, &from, &to, &top));
        }
    }
}

/// How far a place is from that of a straight piece where its point is nearest, mm, and the chord between their tool axes.
fn apart_on(place: &ToolPlace, [from, to]: [&ToolPlace; 2]) -> [f64; 2] {
    let (way, turn) = (to.point - from.point, to.axis - from.axis);
    let (offset, axis) = (from.point - place.point, from.axis - place.axis);
    let square = way.norm_squared();
    let share = if square > 0.0 { (-offset.dot(&way) / square).clamp(0.0, 1.0) } else { 1.0 };
    [(offset + way * share).norm(), (axis + turn * share).norm()]
}

/// Whether `place` is surely farther than `bound` beyond the end of the straight way from `from` to `to`, along it.
#[inline]
fn passes(from: &Vector3<f64>, to: &Vector3<f64>, place: &Vector3<f64>, bound: f64) -> bool {
    let way = to - from;
    let along = (place - to).dot(&way);
    along > 0.0 && along * along * CLEAR > bound * bound * way.norm_squared()
}
