//! The nearest point on the path.
//!
//! **Which point is the nearest.** The one before, a period further, is where the search begins; from there it goes
//! downhill until the distance rises both ways, however far that is: no window bounds it. A path comes close to itself,
//! and at a corner the tool passes from one leg to the other without standing on the corner: so other places are looked
//! at as far as [`REACH`] times that first distance along the path, and the nearest of them is taken. The distance at
//! the beginning is about the contour error itself, not the following error, so that a crossing is no corner: the way
//! round a loop is far longer. Where the tool goes back on its path, though, it is held against a piece ahead that it
//! stands on as well: out and back on one line (a peck) are told apart by their order. Points of the path that cannot
//! be nearer are passed over by its length: a point `l` further along it is no more than `l` nearer.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::lowest::lowest;
use super::tied::TIE;
use super::{CommandedPath, Foot};
use crate::ProgramPlace;

/// Other places are looked for so many times the first distance along the path.
pub(in super::super) const REACH: f64 = 16.0;

/// How far along the path other places are looked for, mm.
#[derive(Clone, Copy, Debug)]
struct SearchReach {
    ahead: f64,
    back: f64,
    /// Distance by which they must be nearer to count, mm.
    gain: f64,
}

impl SearchReach {
    fn all(reach: f64) -> Self {
        Self { ahead: reach, back: reach, gain: 0.0 }
    }
}

/// Pieces that the tool stands on alike are no farther apart than this, mm: the rounding of the spline.
const SAME: f64 = 5e-10;

/// A set-point's number, and where it has the tip, mm, part frame.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct CommandedTip {
    pub number: u64,
    pub tip: Vector3<f64>,
}

/// The nearest place of the path, and how far it is.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Nearest {
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub distance: f64,
    /// The knot that is nearer in time.
    pub at: ProgramPlace,
    /// The farthest point of what is passed over at a corner, mm.
    pub missed: f64,
    /// How far the place has gone on along the path, mm; zero where it went back.
    pub way: f64,
}

impl CommandedPath {
    /// The point nearest to where the tool is, while `commanded` is the set-point of the same time.
    pub fn nearest(&mut self, actual: &Pose, commanded: CommandedTip) -> Nearest {
        let start = self.further(self.foot);
        let first = (self.point(start) - actual.tip).norm();
        let found = self.descend(&actual.tip, start);
        let mut foot = self.least(&actual.tip, found, SearchReach::all(REACH * first));
        // Back on the way it came, or beyond a turn: it may be on a way ahead meanwhile.
        let bound = match self.length(foot) < self.length(self.foot) - TIE {
            true => Some(foot.distance + SAME),
            false => Some(foot.distance - TIE).filter(|_| self.turns(foot)),
        };
        if let Some(bound) = bound.filter(|bound| *bound > 0.0)
            && let Some(other) =
                self.onward(&actual.tip, bound, self.place_of(commanded.number).knot)
        {
            foot = other;
        }
        let missed = self.missed(&actual.tip, found, foot);
        let following = (commanded.tip - actual.tip).norm();
        if foot.distance > following {
            // No contour error is larger than the following error.
            let here = self.place_of(commanded.number);
            let mut other = self.descend(&actual.tip, here);
            // Where the path turns back the descent may end on another piece, farther away than where it began.
            let distance = (self.point(here) - actual.tip).norm();
            if distance + SAME < other.distance {
                other = Foot { distance, ..here };
            }
            if other.distance < foot.distance {
                foot = self.least(&actual.tip, other, SearchReach::all(REACH * following));
            }
        }
        let tip = self.point(foot);
        let (tied, axis) = self.tied(actual, foot);
        let at = self.at(tied);
        let way = (self.length(tied) - self.length(self.foot)).max(0.0);
        self.pass(tied);
        self.stand(tied);
        Nearest { way, tip, axis, distance: foot.distance, at, missed }
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
    /// what lies ahead is farther (it comes down a hole again, above where it left), and no further back than other
    /// places are looked for at all: the end of an earlier cut may be near as well.
    pub fn seek_anew(&self, tool: &Pose) -> Foot {
        let first = (self.point(self.foot) - tool.tip).norm();
        let left = Foot { distance: first, ..self.foot };
        let ahead = self.among(tool, left, 0.0, first);
        let near = self.descend(&tool.tip, self.foot);
        let back = self.among(tool, near, REACH * ahead.distance, first);
        match back.distance < ahead.distance - TIE {
            true => back,
            false => ahead,
        }
    }

    fn among(&self, tool: &Pose, found: Foot, back: f64, first: f64) -> Foot {
        let within = SearchReach { ahead: REACH * first, back, gain: TIE };
        self.least(&tool.tip, found, within)
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
            true => Foot { knot: foot.knot + 1, ..foot },
            false => foot,
        }
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
    fn least(&self, from: &Vector3<f64>, mut found: Foot, within: SearchReach) -> Foot {
        loop {
            let other = self.others(from, found, within);
            if other.distance >= found.distance {
                return found;
            }
            found = other;
        }
    }

    /// A place that is nearer than the one found, within a reach of it along the path both ways.
    fn others(&self, from: &Vector3<f64>, found: Foot, within: SearchReach) -> Foot {
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
            let bend = cubic.bend(0.0).norm_squared().max(cubic.bend(1.0).norm_squared());
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
            let foot = Foot { knot: piece, share, distance: (cubic.at(share) - from).norm() };
            if foot.distance < best.map_or(distance, |best| best.distance) {
                best = Some(foot);
            }
        }
        best.map(|best| self.descend(from, best))
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
