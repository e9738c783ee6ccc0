//! What a cut takes of a stock, and how far it goes into it.

use nalgebra::Vector3;

use crate::field::Volume;
use crate::profile::{Frustum, ToolPose};
use crate::rays::{Grid, Stretch};

/// What a cut takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chip {
    /// How much.
    pub volume: Volume,
    /// How far it goes into the stock; none where it takes nothing, or that is not known.
    pub engagement: Option<Engagement>,
}

/// A length between two bounds, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// No less.
    pub at_least: f64,
    /// No more.
    pub at_most: f64,
}

/// How far a cut goes into the stock: as far as it does anywhere on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Engagement {
    /// Up from the tip along the tool axis.
    pub depth: Extent,
    /// Across the tool axis and the way, all that it takes; none of a way along the axis.
    pub width: Option<Extent>,
}

impl Extent {
    /// That of the longer of two.
    pub fn max(self, other: Self) -> Self {
        let at_least = self.at_least.max(other.at_least);
        Self { at_least, at_most: self.at_most.max(other.at_most) }
    }
}

impl Chip {
    /// It is no more than this, mm³.
    pub(crate) fn no_more_than(&mut self, volume: f64) {
        let Volume { at_least, at_most } = &mut self.volume;
        *at_most = at_most.min(volume);
        *at_least = at_least.min(*at_most);
        if *at_most <= 0.0 {
            self.engagement = None;
        }
    }
}

impl std::ops::AddAssign for Chip {
    /// With what another cut takes: volumes add up, of lengths the longest counts.
    fn add_assign(&mut self, other: Self) {
        self.volume += other.volume;
        let longer = |one: Engagement, other: Engagement| Engagement {
            depth: one.depth.max(other.depth),
            width: one.width.map(|width| width.max(other.width.unwrap_or(width))).or(other.width),
        };
        self.engagement = match (self.engagement, other.engagement) {
            (Some(one), Some(other)) => Some(longer(one, other)),
            (one, other) => one.or(other),
        };
    }
}

/// Where something is taken.
#[derive(Clone, Copy)]
struct Swath {
    /// How far up from the tip along the tool axis, mm.
    depth: f64,
    /// Least and most of it across, mm.
    sides: [f64; 2],
}

impl Swath {
    const NOTHING: Self =
        Self { depth: f64::NEG_INFINITY, sides: [f64::INFINITY, f64::NEG_INFINITY] };

    fn width(&self) -> f64 {
        (self.sides[1] - self.sides[0]).max(0.0)
    }
}

/// Measures what is taken on a way.
pub(crate) struct Gauge {
    /// The tool axis where the tool stands, and the lowest and the highest that its tip is along it, mm.
    axis: Vector3<f64>,
    tips: [f64; 2],
    /// Across the way and the tool axis.
    across: Option<Vector3<f64>>,
    /// The tool strays aside from its way by no more than this, mm.
    aside: f64,
    /// The highest that its tip is anywhere on a way in pieces, without a turn.
    highest: Option<f64>,
    /// What certainly is taken, and what may be.
    certain: Swath,
    possible: Swath,
}

impl Gauge {
    /// On a way from one pose to another, or a piece of one: until it is told where the tool stands, this is anywhere between
    /// them, and its axis that of both.
    pub fn new([from, to]: [ToolPose; 2]) -> Self {
        let across = from.axis.cross(&(to.tip - from.tip)).try_normalize(1e-6);
        let [one, other] = [from, to].map(|pose| from.axis.dot(&pose.tip));
        let tips = [one.min(other), one.max(other)];
        let (certain, possible) = (Swath::NOTHING, Swath::NOTHING);
        Self { axis: from.axis, tips, across, aside: 0.0, highest: None, certain, possible }
    }

    /// The tool stands at a pose.
    pub fn stand(&mut self, pose: &ToolPose) {
        let tip = pose.axis.dot(&pose.tip);
        (self.axis, self.tips, self.aside) = (pose.axis, [tip; 2], 0.0);
    }

    /// Nowhere on its way, which has more pieces, is its tip higher along its axis than this, mm.
    pub fn no_higher(&mut self, highest: Option<f64>) {
        self.highest = highest;
    }

    /// It goes about there: its tip between two heights along its axis, and aside from its way by no more than this, mm.
    pub fn stray(&mut self, tips: [f64; 2], aside: f64) {
        (self.tips, self.aside) = (tips, aside);
    }

    /// Stretches of a prism along Z that are taken for certain.
    pub fn certain(
        &mut self,
        grid: &Grid,
        place: [usize; 2],
        stretches: impl Iterator<Item = Stretch>,
    ) {
        for stretch in stretches {
            let (top, sides) = self.extents(&grid.block(place, stretch));
            let Swath { depth, sides: known } = &mut self.certain;
            *depth = depth.max(top - self.tips[1]);
            *known = [known[0].min(sides[0]), known[1].max(sides[1])];
        }
    }

    /// Stretches of a prism along Z that one of the pieces of the way takes for certain: how deep that is.
    pub fn certain_somewhere(
        &mut self,
        grid: &Grid,
        place: [usize; 2],
        stretches: impl Iterator<Item = Stretch>,
    ) {
        let Some(highest) = self.highest else { return };
        for stretch in stretches {
            let (top, _) = self.extents(&grid.block(place, stretch));
            self.certain.depth = self.certain.depth.max(top - highest);
        }
    }

    /// Stretches of which some may be taken.
    pub fn possible(
        &mut self,
        grid: &Grid,
        place: [usize; 2],
        stretches: impl Iterator<Item = Stretch>,
    ) {
        for stretch in stretches {
            let (top, sides) = self.extents(&grid.block(place, stretch));
            let Swath { depth, sides: known } = &mut self.possible;
            *depth = depth.max(top - self.tips[0]);
            *known = [known[0].min(sides[0]), known[1].max(sides[1])];
        }
    }

    /// The top of a box along the tool axis, and its sides across, mm.
    fn extents(&self, [low, high]: &[Vector3<f64>; 2]) -> (f64, [f64; 2]) {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let range = |along: Vector3<f64>| {
            let (at, far) = (along.dot(&middle), along.abs().dot(&half));
            [at - far, at + far]
        };
        (range(self.axis)[1], self.across.map_or([0.0; 2], range))
    }

    /// What came of it, of a tool of these frusta.
    pub fn engagement(&self, tool: &[Frustum]) -> Option<Engagement> {
        let Self { certain, possible, .. } = self;
        let most = |end: fn(&Frustum) -> f64| tool.iter().map(end).fold(0.0, f64::max);
        let long = most(|frustum| frustum.z[1]) + self.tips[1] - self.tips[0];
        let wide = 2.0 * (most(|frustum| frustum.r[0].max(frustum.r[1])) + self.aside);
        let extent = |at_least: f64, at_most: f64| {
            let at_most = at_most.max(0.0);
            Extent { at_least: at_least.max(0.0).min(at_most), at_most }
        };
        possible.depth.is_finite().then(|| Engagement {
            depth: extent(certain.depth, possible.depth.min(long)),
            width: self.across.map(|_| extent(certain.width(), possible.width().min(wide))),
        })
    }
}
