//! Where a tool has been: there nothing is left that it could touch.

use nalgebra::Vector3;
use post_clearance::convex::Convex;

use crate::field::Field;
use crate::profile::ToolPose;

/// Ways that are remembered, the latest ones.
const MOST: usize = 512;

/// Tool axes whose difference is no more than this are the same, and points no farther apart than this the same, mm: what
/// rounding leaves of equal words.
const SAME: f64 = 1e-7;

/// A straight way without turning that a tool has gone.
#[derive(Clone, Copy, Debug)]
struct Gone {
    axis: Vector3<f64>,
    from: Vector3<f64>,
    way: Vector3<f64>,
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

/// Where a tool has been since it was changed.
#[derive(Clone, Debug)]
pub struct Been {
    heights: Option<Heights>,
    gone: Vec<Gone>,
    next: usize,
}

impl Been {
    /// A tool of a profile, points [z, r] in mm, z from the tip, that has been nowhere.
    pub fn new(profile: &[[f64; 2]]) -> Self {
        let rises = profile.windows(2).all(|pair| pair[0][0] <= pair[1][0]);
        let heights = profile.first().filter(|_| rises).map(|first| {
            let widens = profile.windows(2).take_while(|pair| pair[0][1] <= pair[1][1]).count();
            let [end, most] = profile[widens];
            let full = profile.iter().find(|point| point[1] >= most).unwrap_or(first);
            let thicker = profile[widens..].iter().position(|point| point[1] > most);
            // Between two points it is a cone: it is thicker behind the first of them.
            let thickens = thicker.map_or(f64::INFINITY, |place| profile[widens + place - 1][0]);
            Heights {
                full: full[0],
                thins: if widens + 1 == profile.len() { f64::INFINITY } else { end },
                thickens,
                top: profile[profile.len() - 1][0],
                widest: profile.iter().map(|point| point[1]).fold(0.0, f64::max),
            }
        });
        Self { heights, gone: Vec::new(), next: 0 }
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
    }

    /// A straight way without turning that is free: it goes where it has been before, or above that along its axis, and what
    /// sticks out above is nowhere in what may be left.
    pub fn covers(&self, field: &mut Field, [from, to]: [ToolPose; 2]) -> bool {
        let Some(heights) = self.heights else { return false };
        let way = to.tip - from.tip;
        let climb = way.dot(&from.axis);
        let axial = (way - from.axis * climb).norm() <= SAME;
        let same = self.gone.iter().filter(|gone| (gone.axis - from.axis).norm() <= SAME);
        let over: Vec<Over> = same.filter_map(|gone| gone.over([from.tip, to.tip])).collect();
        // Heights are those above the lower end of an axial way, else above the tip on the way; how far up it is free of what
        // a tool has touched that went below.
        let reach = |over: &Over| heights.thins - if axial { over.least } else { over.most };
        let below = over.iter().filter(|over| over.least >= -SAME);
        let Some(mut free) = below.map(reach).reduce(f64::max) else { return false };
        if free == f64::INFINITY {
            return true;
        }
        let needed = heights.top + if axial { libm::fabs(climb) } else { 0.0 };
        loop {
            let meets = over.iter().filter(|over| heights.full - over.least <= free);
            let farther = meets.map(|over| reach(over) + over.length).fold(free, f64::max);
            if farther <= free || free >= needed {
                break;
            }
            free = farther;
        }
        free = free.min(heights.thickens);
        if free >= needed {
            return true;
        }
        let low = if climb < 0.0 { to.tip } else { from.tip };
        let ends = [free, needed].map(|height| low + from.axis * height);
        let rest = Convex::frustum(ends, from.axis, [heights.widest; 2]);
        axial && field.apart(&[rest]).at_least > 0.0
    }
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
    /// How both ends of a way lie over it: none where they do not.
    fn over(&self, ends: [Vector3<f64>; 2]) -> Option<Over> {
        let split = |vector: Vector3<f64>| {
            let height = vector.dot(&self.axis);
            (height, vector - self.axis * height)
        };
        let (rise, across) = split(self.way);
        let along = across.norm();
        let above = |tip: Vector3<f64>| {
            let (height, aside) = split(tip - self.from);
            if along <= SAME {
                return (aside.norm() <= SAME).then_some(height - rise.min(0.0));
            }
            let share = aside.dot(&across) / (along * along);
            let over = SAME / along;
            let beside = (aside - across * share).norm();
            let is_over = (-over..=1.0 + over).contains(&share) && beside <= SAME;
            is_over.then_some(height - rise * share)
        };
        let [one, other] = [above(ends[0])?, above(ends[1])?];
        let length = if along <= SAME { libm::fabs(rise) } else { 0.0 };
        Some(Over { least: one.min(other), most: one.max(other), length })
    }
}
