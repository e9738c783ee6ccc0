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
    /// How far it goes into the stock; none where it takes nothing, or does not go straight.
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

/// How far a cut goes into the stock.
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
    /// The highest of it along the tool axis, mm.
    top: f64,
    /// Least and most of it across, mm.
    sides: [f64; 2],
}

impl Swath {
    const NOTHING: Self =
        Self { top: f64::NEG_INFINITY, sides: [f64::INFINITY, f64::NEG_INFINITY] };

    /// Takes a box, from corner to corner, mm.
    fn take(
        &mut self,
        axis: Vector3<f64>,
        across: Option<Vector3<f64>>,
        [low, high]: &[Vector3<f64>; 2],
    ) {
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let range = |along: Vector3<f64>| {
            let (at, far) = (along.dot(&middle), along.abs().dot(&half));
            [at - far, at + far]
        };
        self.top = self.top.max(range(axis)[1]);
        if let Some(across) = across {
            let [least, most] = range(across);
            self.sides = [self.sides[0].min(least), self.sides[1].max(most)];
        }
    }

    fn width(&self) -> f64 {
        (self.sides[1] - self.sides[0]).max(0.0)
    }
}

/// Measures what is taken on a straight way.
pub(crate) struct Gauge {
    axis: Vector3<f64>,
    across: Option<Vector3<f64>>,
    /// The lowest and the highest that the tip is along the axis, mm.
    tips: [f64; 2],
    /// What certainly is taken, and what may be.
    certain: Swath,
    possible: Swath,
}

impl Gauge {
    pub fn new([from, to]: [ToolPose; 2]) -> Self {
        let axis = from.axis;
        let across = axis.cross(&(to.tip - from.tip)).try_normalize(1e-6);
        let [one, other] = [from, to].map(|pose| axis.dot(&pose.tip));
        let tips = [one.min(other), one.max(other)];
        Self { axis, across, tips, certain: Swath::NOTHING, possible: Swath::NOTHING }
    }

    /// Stretches of a prism along Z that are taken for certain.
    pub fn certain(
        &mut self,
        grid: &Grid,
        place: [usize; 2],
        stretches: impl Iterator<Item = Stretch>,
    ) {
        stretches.for_each(|stretch| {
            self.certain.take(self.axis, self.across, &grid.block(place, stretch))
        });
    }

    /// Stretches of which some may be taken.
    pub fn possible(
        &mut self,
        grid: &Grid,
        place: [usize; 2],
        stretches: impl Iterator<Item = Stretch>,
    ) {
        stretches.for_each(|stretch| {
            self.possible.take(self.axis, self.across, &grid.block(place, stretch))
        });
    }

    /// What came of it, of a tool of these frusta.
    pub fn engagement(&self, tool: &[Frustum]) -> Option<Engagement> {
        let Self { certain, possible, tips, .. } = self;
        let most = |end: fn(&Frustum) -> f64| tool.iter().map(end).fold(0.0, f64::max);
        let long = most(|frustum| frustum.z[1]) + tips[1] - tips[0];
        let wide = 2.0 * most(|frustum| frustum.r[0].max(frustum.r[1]));
        let extent = |at_least: f64, at_most: f64| {
            let at_most = at_most.max(0.0);
            Extent { at_least: at_least.max(0.0).min(at_most), at_most }
        };
        possible.top.is_finite().then(|| Engagement {
            depth: extent(certain.top - tips[1], (possible.top - tips[0]).min(long)),
            width: self.across.map(|_| extent(certain.width(), possible.width().min(wide))),
        })
    }
}
