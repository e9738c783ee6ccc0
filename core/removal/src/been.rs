//! Where a tool has been at feed: there nothing is left that it could touch, and it may go there again at rapid.

use std::collections::VecDeque;

use nalgebra::Vector3;
use post_clearance::convex::Convex;
use post_clearance::piece::Way;
use post_machine::kinematics::Joints;
use post_motion::path::{Curve, Interpolation, Stance, turns};

use crate::field::Field;
use crate::profile::{Frustum, ToolPose, frusta};

/// Ways that are remembered, the latest ones.
const MOST: usize = 512;

/// Tool axes whose difference is no more than this are the same: what rounding leaves of equal words.
const SAME: f64 = 1e-7;

/// Radii that differ by no more are the same, mm.
const AS_THICK: f64 = 1e-9;

/// Half of the last place of a word, mm or degrees: controls have three decimals or more.
const HALF_PLACE: f64 = 0.5e-3;

/// How far a way of `length` mm along the tool axis may end beside it as its words are printed, mm: each of three linear words
/// at both ends, and the directions of two rotary ones.
pub fn lean(length: f64) -> f64 {
    6.0 * HALF_PLACE + 2.0 * HALF_PLACE.to_radians() * libm::fabs(length)
}

/// One axis goes alone from one stance to another, but for what its words are printed to.
pub fn goes_alone(from: &Joints, to: &Joints) -> bool {
    let ways = from.iter().zip(to).map(|(from, to)| libm::fabs(to - from));
    let (all, most) = ways.fold((0.0, 0.0f64), |(all, most), way| (all + way, most.max(way)));
    all - most <= lean(most)
}

/// A straight way without turning that a tool has gone.
#[derive(Clone, Copy, Debug)]
struct Gone {
    axis: Vector3<f64>,
    from: Vector3<f64>,
    way: Vector3<f64>,
}

/// A way on which a tool turns, all axes going evenly, or its tip going straight and the rotary axes evenly: by its ends alone
/// it is known where the tool goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Its ends.
    pub ends: [Stance; 2],
    /// The tip goes straight.
    pub led: bool,
}

impl Turn {
    /// That of a way on which the tool turns; none of another one, or where not so much is known.
    pub fn of(way: &Way<'_>) -> Option<Self> {
        let led = match way.interpolation {
            Interpolation::Axes => false,
            Interpolation::Tip(Curve::Straight) => true,
            _ => return None,
        };
        let turns = !way.independent && turns(way.solver.chain(), way.ends);
        turns.then(|| Self { ends: way.ends.map(|end| *end), led })
    }
}

/// How far up a tool frees the way that it is drawn out on, mm from its tip.
#[derive(Clone, Copy, Debug)]
struct Heights {
    /// From here on it is as thick as it gets below `thins`.
    full: f64,
    /// Above this it gets thinner: it need not have been there. Infinite where it never does: what is above its profile is
    /// taken to be no thinner.
    thins: f64,
    /// Above this it is thicker than below `thins`.
    thickens: f64,
    top: f64,
    widest: f64,
}

impl Heights {
    /// How far up a way is free of what a tool may have left on one that is gone: above the lower end of one along the axis, else
    /// above the tip on it, mm.
    fn reach(&self, over: &Over, axial: bool) -> f64 {
        self.thins - if axial { over.least } else { over.most }
    }

    /// The same by all that are gone, one above the other, from a height on that is free; no farther than is `needed`, mm.
    fn free(&self, over: &[Over], axial: bool, [mut free, needed]: [f64; 2]) -> f64 {
        while free < needed {
            let meets = over.iter().filter(|over| self.full - over.least <= free);
            let reach = |over: &Over| self.reach(over, axial) + over.length;
            let farther = meets.map(reach).fold(free, f64::max);
            if farther <= free {
                break;
            }
            free = farther;
        }
        free.min(self.thickens)
    }
}

/// Whether a way goes along the tool axis, and how far up, mm.
fn climb(from: &ToolPose, to: &ToolPose) -> (bool, f64) {
    let way = to.tip - from.tip;
    let climb = way.dot(&from.axis);
    ((way - from.axis * climb).norm() <= lean(climb), climb)
}

/// Where a tool has been since it was changed.
#[derive(Clone, Debug)]
pub struct Been {
    profile: Vec<[f64; 2]>,
    heights: Option<Heights>,
    gone: Vec<Gone>,
    next: usize,
    turned: VecDeque<Turn>,
}

impl Been {
    /// A tool of a profile, points [z, r] in mm, z from the tip, that has been nowhere. One without points is nowhere thinner
    /// than below.
    pub fn new(profile: &[[f64; 2]]) -> Self {
        let rises = profile.windows(2).all(|pair| pair[0][0] <= pair[1][0]);
        let first = profile.first().unwrap_or(&[0.0; 2]);
        let heights = rises.then(|| {
            let widens = profile.windows(2).take_while(|pair| pair[0][1] <= pair[1][1]).count();
            let [end, most] = *profile.get(widens).unwrap_or(first);
            let full = profile.iter().find(|point| point[1] >= most).unwrap_or(first);
            let thicker = profile.iter().skip(widens).position(|point| point[1] > most);
            // Between two points it is a cone: it is thicker behind the first of them.
            let thickens = thicker.map_or(f64::INFINITY, |place| profile[widens + place - 1][0]);
            Heights {
                full: full[0],
                thins: if widens + 1 >= profile.len() { f64::INFINITY } else { end },
                thickens,
                top: profile.last().unwrap_or(first)[0],
                widest: profile.iter().map(|point| point[1]).fold(0.0, f64::max),
            }
        });
        Self {
            profile: profile.to_vec(),
            heights,
            gone: Vec::new(),
            next: 0,
            turned: VecDeque::new(),
        }
    }

    /// The tool went straight from one pose to the other, without turning, and whatever was there is gone.
    pub fn add(&mut self, [from, to]: [ToolPose; 2]) {
        let gone = Gone { axis: from.axis, from: from.tip, way: to.tip - from.tip };
        match self.gone.get_mut(self.next) {
            Some(place) => *place = gone,
            None => self.gone.push(gone),
        }
        self.next = (self.next + 1) % MOST;
    }

    /// Nothing is known any more of where it has been.
    pub fn clear(&mut self) {
        (self.gone, self.next) = (Vec::new(), 0);
        self.turned.clear();
    }

    /// The tool turned on a way, and whatever was there is gone.
    pub fn add_turn(&mut self, turn: Turn) {
        if self.turned.len() == MOST {
            self.turned.pop_back();
        }
        self.turned.push_front(turn);
    }

    /// It goes a way on which it turns as it has gone it before, or back.
    pub fn covers_turn(&self, turn: &Turn) -> bool {
        let [from, to] = turn.ends;
        let back = Turn { ends: [to, from], ..*turn };
        self.turned.iter().any(|known| *known == *turn || *known == back)
    }

    /// A straight way without turning leads along one that is gone, and not along the tool axis.
    pub fn is_along(&self, poses: [ToolPose; 2]) -> bool {
        let (axial, _) = climb(&poses[0], &poses[1]);
        let on =
            |over: &Over| over.length == 0.0 && over.least.abs().max(over.most.abs()) <= lean(0.0);
        !axial && self.over(poses).iter().any(on)
    }

    /// Between these shares of a straight way without turning it is not known that the tool has been there: ahead of the
    /// first and behind the other it goes along lines that it has gone before.
    pub fn shares(&self, [from, to]: [ToolPose; 2]) -> [f64; 2] {
        let way = to.tip - from.tip;
        let same = self.gone.iter().filter(|gone| (gone.axis - from.axis).norm() <= SAME);
        let mut gone: Vec<[f64; 2]> = same.filter_map(|gone| gone.shares(from.tip, way)).collect();
        gone.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let free = |first: f64, [begins, ends]: &[f64; 2]| {
            if *begins <= first { first.max(*ends) } else { first }
        };
        let first = gone.iter().fold(0.0, free).min(1.0);
        gone.sort_by(|one, other| other[1].total_cmp(&one[1]));
        let free = |last: f64, [begins, ends]: &[f64; 2]| {
            if *ends >= last { last.min(*begins) } else { last }
        };
        [first, gone.iter().fold(1.0, free).max(first)]
    }

    /// What has been gone straight along the same line as a way, above it or below.
    fn over(&self, [from, to]: [ToolPose; 2]) -> Vec<Over> {
        let same = self.gone.iter().filter(|gone| (gone.axis - from.axis).norm() <= SAME);
        same.filter_map(|gone| gone.over([from.tip, to.tip])).collect()
    }

    /// A straight way without turning is free of what of the tool is more than `height` above its tip, mm: the tool has been
    /// there before, on ways above this one too.
    pub fn covers_above(&self, height: f64, [from, to]: [ToolPose; 2]) -> bool {
        let Some(heights) = self.heights else { return false };
        let (axial, climb) = climb(&from, &to);
        let needed = heights.top + if axial { libm::fabs(climb) } else { 0.0 };
        heights.free(&self.over([from, to]), axial, [height, needed]) >= needed
    }

    /// A way straight down along the tool axis on which edges, up to a height above the tip, cut before what is above them
    /// comes there, mm: this is no thicker, and what of it stays above where they began is clear of what may be left, or has
    /// been there before.
    pub fn leads(&self, field: &mut Field, edge: f64, [from, to]: [ToolPose; 2]) -> bool {
        let (axial, climb) = climb(&from, &to);
        let Some(Lead { cut, thickens, top, widest }) = self.lead(edge) else { return false };
        if !axial || climb >= 0.0 {
            return false;
        }
        if thickens >= top && self.covers_above(cut, [from; 2]) {
            return true;
        }
        let low = cut.min(thickens + climb);
        if low >= top {
            return true;
        }
        let ends = [low, top].map(|height| from.tip + from.axis * height);
        let rest = Convex::frustum(ends, from.axis, [widest; 2]);
        field.apart(&[rest]).at_least > 0.0
    }

    /// What edges up to a height above the tip leave free above them, mm; none of a profile that goes back.
    fn lead(&self, edge: f64) -> Option<Lead> {
        self.heights?;
        let frusta = frusta(&self.profile);
        let ends = |frustum: &Frustum| {
            let high = frustum.z[1].min(edge);
            [(frustum.z[0], frustum.r[0]), (high, frustum.at(high))]
        };
        let edges = || frusta.iter().filter(|frustum| frustum.z[0] < edge).flat_map(ends);
        let wide = edges().map(|(_, r)| r).reduce(f64::max)? + AS_THICK;
        let cut =
            edges().filter(|(_, r)| r + 2.0 * AS_THICK >= wide).map(|(z, _)| z).reduce(f64::max)?;
        let above = frusta.iter().filter(|frustum| frustum.z[1] > edge);
        let thicker = above.filter_map(|frustum| {
            let low = frustum.z[0].max(edge);
            (frustum.at(low).max(frustum.r[1]) > wide).then_some(low)
        });
        Some(Lead {
            cut,
            thickens: thicker.fold(f64::INFINITY, f64::min),
            top: frusta.last()?.z[1],
            widest: frusta.iter().flat_map(|frustum| frustum.r).fold(0.0, f64::max),
        })
    }

    /// A straight way without turning that is free: it goes where it has been before, or above that along its axis, and what
    /// sticks out above is nowhere in what may be left, as far as that is known.
    pub fn covers(&self, field: Option<&mut Field>, [from, to]: [ToolPose; 2]) -> bool {
        let (axial, climb) = climb(&from, &to);
        let over = self.over([from, to]);
        let below = over.iter().filter(|over| over.least >= -lean(0.0));
        if below.clone().any(|over| over.most <= over.length + lean(over.length)) {
            return true;
        }
        let Some(heights) = self.heights else { return false };
        let reach = |over: &Over| heights.reach(over, axial);
        let Some(free) = below.map(reach).reduce(f64::max) else { return false };
        let needed = heights.top + if axial { libm::fabs(climb) } else { 0.0 };
        let free = heights.free(&over, axial, [free, needed]);
        if free >= needed {
            return true;
        }
        let low = if climb < 0.0 { to.tip } else { from.tip };
        let ends = [free, needed].map(|height| low + from.axis * height);
        let rest = Convex::frustum(ends, from.axis, [heights.widest; 2]);
        axial && field.is_some_and(|field| field.apart(&[rest]).at_least > 0.0)
    }
}

/// What edges leave free that go straight down, mm above the tip.
struct Lead {
    /// The highest at which they are as thick as they get.
    cut: f64,
    /// From here on the tool is thicker than they are.
    thickens: f64,
    top: f64,
    widest: f64,
}

/// How a way lies over one that is gone.
#[derive(Clone, Copy, Debug)]
struct Over {
    /// How far its ends are above, mm along the tool axis, below zero under it.
    least: f64,
    most: f64,
    /// How far the one that is gone went along the axis, up from where it is lowest, mm.
    length: f64,
}

impl Gone {
    /// The shares of a way from a tip on at which this one begins and ends, the smaller first, and beyond 0 or 1 by no more than
    /// digits leave; none where it does not lie on its line.
    fn shares(&self, from: Vector3<f64>, way: Vector3<f64>) -> Option<[f64; 2]> {
        let length = way.norm();
        let slack = lean(0.0);
        if length <= slack {
            return None;
        }
        let along = way / length;
        let ends = [self.from, self.from + self.way].map(|end| end - from);
        let [one, other] = ends.map(|end| along.dot(&end));
        let beside = ends.map(|end| (end - along * along.dot(&end)).norm());
        let in_line = beside.iter().zip([one, other]).all(|(beside, at)| *beside <= lean(at));
        let [low, high] = [one.min(other), one.max(other)];
        let ends = [if low <= slack { low.min(0.0) } else { low }, high];
        let ends = [ends[0], if high >= length - slack { high.max(length) } else { high }];
        (in_line && high > low).then(|| ends.map(|at| at / length))
    }

    /// How both ends of a way lie over it: none where they do not.
    fn over(&self, ends: [Vector3<f64>; 2]) -> Option<Over> {
        let split = |vector: Vector3<f64>| {
            let height = vector.dot(&self.axis);
            (height, vector - self.axis * height)
        };
        let (rise, across) = split(self.way);
        let along = across.norm();
        let axial = along <= lean(rise);
        let above = |tip: Vector3<f64>| {
            let (height, aside) = split(tip - self.from);
            if axial {
                return (aside.norm() <= lean(height)).then_some(height - rise.min(0.0));
            }
            let share = aside.dot(&across) / (along * along);
            let over = lean(0.0) / along;
            let beside = (aside - across * share).norm();
            let is_over = (-over..=1.0 + over).contains(&share) && beside <= lean(height);
            // Beyond an end it is over that end: along a steep way what is small across it is much in height.
            is_over.then_some(height - rise * share.clamp(0.0, 1.0))
        };
        let [one, other] = [above(ends[0])?, above(ends[1])?];
        let length = if axial { libm::fabs(rise) } else { 0.0 };
        Some(Over { least: one.min(other), most: one.max(other), length })
    }
}
