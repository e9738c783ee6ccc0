//! The commanded path as a spline, as far as it is needed, and the nearest point on it.
//!
//! **Which point is the nearest.** The one before, a period further, is where the search begins; from there it goes
//! downhill until the distance rises both ways, however far that is: no window bounds it. A path comes close to itself,
//! and at a corner the tool passes from one leg to the other without standing on the corner: so other places are looked
//! at as far as [`REACH`] times that first distance along the path, and the nearest of them is taken. The distance at the
//! beginning is about the contour error itself, not the following error, so that a crossing is no corner: the way round a
//! loop is far longer. Where the tool goes back on its path, though, it is held against a piece ahead that it stands on as
//! well: out and back on one line (a peck) are told apart by their order. Points of the path that cannot be nearer are passed over by its length: a point `l` further along
//! it is no more than `l` nearer.

use std::collections::VecDeque;

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::spline::{Cubic, Tangents};
use crate::At;

/// Other places are looked for so many times the first distance along the path.
pub(super) const REACH: f64 = 16.0;

/// Knots behind the nearest point that are kept.
const BEHIND: usize = 2048;

/// Knots that are kept in all: a tool that is further behind is taken to have come so far.
const MOST: usize = 1 << 18;

/// Newton steps in a piece; they are bisections where Newton leaves its bracket.
const STEPS: usize = 60;

/// A Newton step that would go no further than this, mm, is none.
const SMALL: f64 = 1e-13;

/// How far the next one would go is told by the square of one that is no longer than this share of a piece.
const SHORT: f64 = 1e-3;

/// A share of a piece that is none.
const NONE: f64 = 1e-13;

/// Places whose distances differ by less, mm, are equally near: the one with the nearer tool axis counts. Where the tool
/// turns about its tip, this alone tells them apart.
const TIE: f64 = 1e-4;

/// A set-point that the spline passes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knot {
    /// Number of the set-point.
    pub number: u64,
    pub at: At,
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    /// How the tip reaches and leaves it, and the tool axis.
    pub tip_ways: Tangents,
    pub axis_ways: Tangents,
    /// No less than the way of the tip to it, mm.
    pub length: f64,
    /// What follows it begins elsewhere: between the two there is no path.
    pub gap: bool,
}

/// A place on the path: behind which knot, and what share of the piece that begins there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Foot {
    pub knot: usize,
    pub share: f64,
    /// Distance of the tip, mm.
    pub distance: f64,
}

/// How far along the path other places are looked for, mm.
#[derive(Clone, Copy, Debug)]
struct Within {
    ahead: f64,
    back: f64,
    /// They count if they are nearer by more than this, mm.
    gain: f64,
}

impl Within {
    fn all(reach: f64) -> Self {
        Self {
            ahead: reach,
            back: reach,
            gain: 0.0,
        }
    }
}

/// Pieces that the tool stands on alike are no farther apart than this, mm: the rounding of the spline.
const SAME: f64 = 5e-10;

/// What was found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub distance: f64,
    /// The knot that is nearer in time.
    pub at: At,
    /// The farthest point of what is passed over at a corner, mm.
    pub missed: f64,
    /// How far the place has gone on along the path, mm; zero where it went back.
    pub way: f64,
}

/// The path.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    knots: VecDeque<Knot>,
    /// The pieces behind all knots but the last; none where there is a gap.
    pieces: VecDeque<Option<Cubic>>,
    foot: Foot,
}

impl Path {
    pub fn clear(&mut self) {
        self.knots.clear();
        self.pieces.clear();
        self.foot = Foot::default();
    }

    /// Takes the first knot of a leg: where the last one ended, or behind a gap.
    pub fn join(&mut self, mut knot: Knot) {
        if let Some(last) = self.knots.back_mut() {
            if last.tip == knot.tip && last.axis == knot.axis {
                last.tip_ways[1] = knot.tip_ways[1];
                last.axis_ways[1] = knot.axis_ways[1];
                return;
            }
            last.gap = true;
            knot.length = last.length + (knot.tip - last.tip).norm();
            self.pieces.push_back(None);
        }
        self.knots.push_back(knot);
    }

    /// Takes the next knot; one on which the machine stands as on the one before is the same.
    pub fn push(&mut self, mut knot: Knot) {
        if let Some(last) = self.knots.back_mut() {
            if last.tip == knot.tip && last.axis == knot.axis {
                last.tip_ways[1] = knot.tip_ways[1];
                last.axis_ways[1] = knot.axis_ways[1];
                return;
            }
            let legs = [last.tip_ways[1] / 3.0, knot.tip_ways[0] / 3.0];
            let middle = knot.tip - last.tip - legs[0] - legs[1];
            knot.length = last.length + legs[0].norm() + middle.norm() + legs[1].norm();
            let ends = [&last.tip, &knot.tip];
            let piece = Cubic::new(ends, &last.tip_ways[1], &knot.tip_ways[0]);
            self.pieces.push_back(Some(piece));
        }
        self.knots.push_back(knot);
        if self.knots.len() > MOST {
            self.drop_first(1);
        }
    }

    fn drop_first(&mut self, count: usize) {
        self.knots.drain(..count);
        self.pieces.drain(..count);
        self.foot.knot = match self.foot.knot.checked_sub(count) {
            Some(knot) => knot,
            None => {
                self.foot.share = 0.0;
                0
            }
        };
    }

    /// The point nearest to where the tool is, while `commanded` is the set-point of the same time.
    pub fn nearest(&mut self, actual: &Pose, commanded: (u64, &Vector3<f64>)) -> Nearest {
        let start = self.further(self.foot);
        let first = (self.point(start) - actual.tip).norm();
        let found = self.descend(&actual.tip, start);
        let mut foot = self.least(&actual.tip, found, Within::all(REACH * first));
        // Back on the way it came, or beyond a turn: it may be on a way ahead meanwhile.
        let bound = match self.length(foot) < self.length(self.foot) - TIE {
            true => Some(foot.distance + SAME),
            false => Some(foot.distance - TIE).filter(|_| self.turns(foot)),
        };
        if let Some(bound) = bound.filter(|bound| *bound > 0.0)
            && let Some(other) = self.onward(&actual.tip, bound, self.place_of(commanded.0).knot)
        {
            foot = other;
        }
        let missed = self.missed(&actual.tip, found, foot);
        let following = (commanded.1 - actual.tip).norm();
        if foot.distance > following {
            // No contour error is larger than the following error.
            let here = self.place_of(commanded.0);
            let other = self.descend(&actual.tip, here);
            if other.distance < foot.distance {
                foot = self.least(&actual.tip, other, Within::all(REACH * following));
            }
        }
        let tip = self.point(foot);
        let (tied, axis) = self.tied(actual, foot);
        let at = self.at(tied);
        let way = (self.length(tied) - self.length(self.foot)).max(0.0);
        self.stand(tied);
        Nearest {
            way,
            tip,
            axis,
            distance: foot.distance,
            at,
            missed,
        }
    }

    /// The place nearest to a tool, from `start` on downhill, and further back than `back` mm along the path no other
    /// one.
    pub fn seek(&self, tool: &Pose, start: Foot, back: f64) -> Foot {
        let mut found = self.descend(&tool.tip, start);
        let first = (self.point(start) - tool.tip).norm();
        if self.length(found) < self.length(self.foot) - TIE {
            let last = self.after(start, REACH * first).knot + 1;
            if let Some(other) = self.onward(&tool.tip, found.distance + TIE, last) {
                found = other;
            }
        }
        self.among(tool, found, back.min(REACH * first), first)
    }

    /// The place nearest to a tool that was off the path meanwhile: from where it left on, and before that only where
    /// what lies ahead is farther (it comes down a hole again, above where it left), and no further back than other places
    /// are looked for at all: the end of an earlier cut may be near as well.
    pub fn seek_anew(&self, tool: &Pose) -> Foot {
        let first = (self.point(self.foot) - tool.tip).norm();
        let left = Foot {
            distance: first,
            ..self.foot
        };
        let ahead = self.among(tool, left, 0.0, first);
        let near = self.descend(&tool.tip, self.foot);
        let back = self.among(tool, near, REACH * ahead.distance, first);
        match back.distance < ahead.distance - TIE {
            true => back,
            false => ahead,
        }
    }

    fn among(&self, tool: &Pose, found: Foot, back: f64, first: f64) -> Foot {
        let within = Within {
            ahead: REACH * first,
            back,
            gain: TIE,
        };
        self.least(&tool.tip, found, within)
    }

    /// The tool axis that is asked for at a place: of places that are equally near, the one that is nearest to the tool's.
    pub fn axis_beside(&self, tool: &Pose, foot: Foot) -> Vector3<f64> {
        self.tied(tool, foot).1
    }

    /// The tool has come to a place: what lies far behind it is forgotten.
    pub fn stand(&mut self, foot: Foot) {
        self.foot = foot;
        if foot.knot > 2 * BEHIND {
            self.drop_first(BEHIND);
        }
    }

    pub fn foot(&self) -> Foot {
        self.foot
    }

    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }

    /// Knots ahead of the tool, and how far they reach, mm.
    pub fn ahead(&self) -> (usize, f64) {
        let knots = self.knots.len() - 1 - self.foot.knot;
        let last = self.knots.back().map_or(0.0, |last| last.length);
        (knots, last - self.length(self.foot))
    }

    /// The length of the way to a place, mm.
    pub fn length(&self, foot: Foot) -> f64 {
        let length = self.knots[foot.knot].length;
        let next = self.knots.get(foot.knot + 1);
        length + foot.share * next.map_or(0.0, |next| next.length - length)
    }

    /// The place so many mm behind another.
    pub fn after(&self, foot: Foot, way: f64) -> Foot {
        let wanted = self.length(foot) + way;
        let mut knot = foot.knot;
        while let Some(next) = self.knots.get(knot + 1) {
            let length = self.knots[knot].length;
            if next.length > wanted {
                let share = match self.knots[knot].gap {
                    true => 0.0,
                    false => (wanted - length) / (next.length - length),
                };
                return Foot {
                    knot,
                    share,
                    ..foot
                };
            }
            knot += 1;
        }
        Foot {
            knot,
            share: 0.0,
            ..foot
        }
    }

    /// What asks for a place: a piece is asked for by the knot at its end.
    pub fn at(&self, foot: Foot) -> At {
        let knot = foot.knot + usize::from(foot.share > 0.0);
        self.knots[knot.min(self.knots.len() - 1)].at
    }

    /// The place where a set-point stands.
    fn place_of(&self, number: u64) -> Foot {
        let knot = self.knots.partition_point(|knot| knot.number <= number);
        Foot {
            knot: knot.saturating_sub(1),
            ..Foot::default()
        }
    }

    /// The first place nearer than `bound` that lies ahead, in a piece before that of the knot `last`.
    fn onward(&self, from: &Vector3<f64>, bound: f64, last: usize) -> Option<Foot> {
        let last = last.min(self.knots.len() - 1);
        let reached = self.length(self.foot);
        (self.foot.knot + 1..last)
            .filter_map(|piece| self.nearer(from, piece, bound))
            .find(|foot| self.length(*foot) > reached)
    }

    /// A place a period later.
    fn further(&self, foot: Foot) -> Foot {
        match foot.knot + 1 < self.knots.len() {
            true => Foot {
                knot: foot.knot + 1,
                ..foot
            },
            false => foot,
        }
    }

    /// The piece behind a knot; none behind the last.
    #[inline]
    fn cubic(&self, knot: usize) -> Option<&Cubic> {
        self.pieces.get(knot)?.as_ref()
    }

    /// The tip at a place.
    pub fn point(&self, foot: Foot) -> Vector3<f64> {
        match self.cubic(foot.knot) {
            Some(cubic) if foot.share > 0.0 => cubic.at(foot.share),
            _ => self.knots[foot.knot].tip,
        }
    }

    /// The tool axis at a place, unit vector.
    fn axis(&self, foot: Foot) -> Vector3<f64> {
        let last = &self.knots[foot.knot];
        let Some(next) = self.knots.get(foot.knot + 1).filter(|_| foot.share > 0.0) else {
            return last.axis;
        };
        let ends = [&last.axis, &next.axis];
        let cubic = Cubic::new(ends, &last.axis_ways[1], &next.axis_ways[0]);
        let axis = cubic.at(foot.share);
        axis.try_normalize(0.1).unwrap_or(last.axis)
    }

    /// No path leads to a knot.
    fn begins(&self, knot: usize) -> bool {
        knot == 0 || self.knots[knot - 1].gap
    }

    /// Downhill from a place, to where the distance rises both ways.
    fn descend(&self, from: &Vector3<f64>, start: Foot) -> Foot {
        let mut foot = start;
        // The way that was gone last across a knot: going back over it means that the knot is the place.
        let mut went = 0;
        for _ in 0..2 * self.knots.len() + 4 {
            let Some(cubic) = self.cubic(foot.knot) else {
                // At the end of the path: inside it, or there.
                foot.share = 0.0;
                if went > 0 || self.begins(foot.knot) {
                    break;
                }
                (foot.knot, foot.share, went) = (foot.knot - 1, 1.0, -1);
                continue;
            };
            let share = lowest(cubic, from, foot.share);
            if share >= 1.0 && went >= 0 {
                (foot.knot, foot.share, went) = (foot.knot + 1, 0.0, 1);
                continue;
            }
            if share <= 0.0 && went <= 0 && !self.begins(foot.knot) {
                (foot.knot, foot.share, went) = (foot.knot - 1, 1.0, -1);
                continue;
            }
            foot.share = share;
            if share < 1.0 {
                foot.distance = (cubic.at(share) - from).norm();
                return foot;
            }
            break;
        }
        if foot.share >= 1.0 {
            (foot.knot, foot.share) = (foot.knot + 1, 0.0);
        }
        foot.distance = (self.point(foot) - from).norm();
        foot
    }

    /// The nearest place within a reach along the path of where it is itself.
    fn least(&self, from: &Vector3<f64>, mut found: Foot, within: Within) -> Foot {
        loop {
            let other = self.others(from, found, within);
            if other.distance >= found.distance {
                return found;
            }
            found = other;
        }
    }

    /// A place that is nearer than the one found, within a reach of it along the path both ways.
    fn others(&self, from: &Vector3<f64>, found: Foot, within: Within) -> Foot {
        if found.distance <= within.gain {
            return found;
        }
        let length = self.length(found);
        let mut best = found;
        let mut look = |piece: usize| {
            if let Some(other) = self.nearer(from, piece, best.distance - within.gain) {
                best = other;
            }
            best.distance
        };
        let last = self.knots.len() - 1;
        let mut nearest = found.distance;
        if self.bends(found) {
            nearest = look(found.knot);
        }
        // A piece lies where the ways from its two knots add up to no more than its length.
        let away = |knot: usize| (self.knots[knot].tip - from).norm();
        let mut knot = (found.knot + 1).min(last);
        let mut off = away(knot);
        while knot < last && self.knots[knot].length - length < within.ahead {
            let passed = self.knots[knot].length + off - nearest;
            let next = self.knots[knot + 1].length;
            knot += 1;
            if next > passed {
                let begins = off;
                off = away(knot);
                let way = next - self.knots[knot - 1].length;
                if begins + off - way < 2.0 * nearest {
                    nearest = look(knot - 1);
                }
                continue;
            }
            while knot < last && self.knots[knot + 1].length <= passed {
                knot += 1;
            }
            off = away(knot);
        }
        let mut knot = found.knot;
        let mut off = away(knot);
        while knot > 0 && length - self.knots[knot].length < within.back {
            let passed = self.knots[knot].length - off + nearest;
            let last = self.knots[knot - 1].length;
            knot -= 1;
            if last < passed {
                let begins = off;
                off = away(knot);
                let way = self.knots[knot + 1].length - last;
                if begins + off - way < 2.0 * nearest {
                    nearest = look(knot);
                }
                continue;
            }
            while knot > 0 && self.knots[knot - 1].length >= passed {
                knot -= 1;
            }
            off = away(knot);
        }
        best
    }

    /// The path turns back at a place, or in the piece that it stands in.
    fn turns(&self, foot: Foot) -> bool {
        let behind = foot.knot + usize::from(foot.share > 0.0);
        let Some(before) = foot.knot.checked_sub(1) else {
            return false;
        };
        self.knots.get(behind + 1).is_some_and(|next| {
            let [last, here, there] = [before, foot.knot, behind].map(|knot| self.knots[knot].tip);
            (here - last).dot(&(next.tip - there)) < 0.0
        })
    }

    /// The piece of a place bends so much that it may come nearer once more.
    fn bends(&self, found: Foot) -> bool {
        self.cubic(found.knot).is_some_and(|cubic| {
            let bend = cubic
                .bend(0.0)
                .norm_squared()
                .max(cubic.bend(1.0).norm_squared());
            let slope = cubic.slope(found.share).norm_squared();
            4.0 * bend * found.distance * found.distance > slope * slope
        })
    }

    /// The place in a piece that is nearer than `distance`, or beyond it downhill from there.
    fn nearer(&self, from: &Vector3<f64>, piece: usize, distance: f64) -> Option<Foot> {
        let (last, next) = (&self.knots[piece], &self.knots[piece + 1]);
        if last.gap {
            return None;
        }
        let chord = next.tip - last.tip;
        let square = chord.norm_squared();
        let offset = from - last.tip;
        let along = match square > 0.0 {
            true => (offset.dot(&chord) / square).clamp(0.0, 1.0),
            false => 0.0,
        };
        // The spline goes no further along the chord than its ends, and so far off it.
        let off = |way: &Vector3<f64>| match square > 0.0 {
            true => (way - chord * (way.dot(&chord) / square)).norm(),
            false => way.norm(),
        };
        let bow = 0.25 * off(&last.tip_ways[1]).max(off(&next.tip_ways[0]));
        if (offset - chord * along).norm() - bow >= distance {
            return None;
        }
        let cubic = self.cubic(piece)?;
        let mut best: Option<Foot> = None;
        for start in [along, 0.125, 0.375, 0.625, 0.875] {
            let share = lowest(cubic, from, start);
            let foot = Foot {
                knot: piece,
                share,
                distance: (cubic.at(share) - from).norm(),
            };
            if foot.distance < best.map_or(distance, |best| best.distance) {
                best = Some(foot);
            }
        }
        best.map(|best| self.descend(from, best))
    }

    /// Of places that are equally near, the one whose tool axis is nearest, downhill; and that axis.
    fn tied(&self, actual: &Pose, foot: Foot) -> (Foot, Vector3<f64>) {
        let bound = (foot.distance + TIE) * (foot.distance + TIE);
        let equal = |tip: &Vector3<f64>| (tip - actual.tip).norm_squared() <= bound;
        let axis = self.axis(foot);
        let mut best = (foot, axis);
        let mut least = (axis - actual.axis).norm_squared();
        let back = match foot.share > 0.0 {
            true => Some(foot.knot),
            false => foot.knot.checked_sub(1),
        };
        for (way, end) in [(-1, back), (1, Some(foot.knot + 1))] {
            let mut knot = end;
            while let Some(place) = knot {
                let Some(here) = self.knots.get(place).filter(|here| equal(&here.tip)) else {
                    break;
                };
                let off = (here.axis - actual.axis).norm_squared();
                if off >= least {
                    break;
                }
                let tied = Foot {
                    knot: place,
                    share: 0.0,
                    distance: foot.distance,
                };
                (best, least) = ((tied, here.axis), off);
                knot = place.checked_add_signed(way);
            }
        }
        if (best.0.knot, best.0.share) == (foot.knot, foot.share) {
            return best;
        }
        // Beside the knot, on the chord of its axes.
        let knot = best.0.knot;
        for piece in [knot.checked_sub(1), Some(knot)].into_iter().flatten() {
            let Some(next) = self.knots.get(piece + 1) else {
                continue;
            };
            let last = self.knots[piece].axis;
            let chord = next.axis - last;
            let share = (actual.axis - last).dot(&chord) / chord.norm_squared();
            if !(share > 0.0 && share < 1.0) {
                continue;
            }
            let place = Foot {
                knot: piece,
                share,
                distance: foot.distance,
            };
            let axis = self.axis(place);
            let off = (axis - actual.axis).norm_squared();
            if off < least && equal(&self.point(place)) {
                (best, least) = ((place, axis), off);
            }
        }
        best
    }

    /// The farthest knot of those that are passed over on the way from one place to another.
    fn missed(&self, from: &Vector3<f64>, last: Foot, next: Foot) -> f64 {
        let mut farthest: f64 = 0.0;
        for knot in last.knot + 1..next.knot {
            let off = (self.knots[knot].tip - from).norm_squared();
            farthest = farthest.max(off);
        }
        farthest.sqrt()
    }
}

/// The share of a piece at which the distance is least, downhill from `start`; 0 or 1 where it falls beyond the ends.
#[inline]
fn lowest(cubic: &Cubic, from: &Vector3<f64>, start: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    let mut share = start.clamp(0.0, 1.0);
    for _ in 0..STEPS {
        let offset = cubic.at(share) - from;
        let slope = cubic.slope(share);
        let bend = cubic.bend(share);
        let square = slope.norm_squared();
        let rise = match square == 0.0 {
            // Where the machine stands: as just inside the piece.
            true => offset.dot(&bend) * if share < 0.5 { 1.0 } else { -1.0 },
            false => offset.dot(&slope),
        };
        if offset == Vector3::zeros() {
            return share;
        }
        match rise > 0.0 {
            true => high = share,
            false => low = share,
        }
        if low >= high {
            return share;
        }
        let curve = square + offset.dot(&bend);
        if rise == 0.0 && curve > 0.0 && square > 0.0 {
            // Here it is, and the bracket closes upon nothing.
            break;
        }
        let next = share - rise / curve;
        // Newton; or downhill as far as the bracket goes, which is an end of the piece if none was passed before.
        let newton = curve > 0.0 && next > low && next < high;
        let next = match newton {
            true => next,
            false if curve > 0.0 && rise > 0.0 && low == 0.0 => 0.0,
            false if curve > 0.0 && rise <= 0.0 && high == 1.0 => 1.0,
            false => 0.5 * (low + high),
        };
        let done = match newton {
            // The next step would be the square of this one times half the change of the curve over the curve.
            true => {
                let step = next - share;
                let change = 3.0 * slope.dot(&bend) + offset.dot(&cubic.jerk());
                let left = step * step * change;
                libm::fabs(step) < SHORT
                    && left * left * square < 4.0 * curve * curve * (SMALL * SMALL)
            }
            false => high - low < NONE,
        };
        share = next;
        if done {
            break;
        }
    }
    match share {
        share if share < NONE => 0.0,
        share if share > 1.0 - NONE => 1.0,
        share => share,
    }
}

#[cfg(test)]
mod tests;
