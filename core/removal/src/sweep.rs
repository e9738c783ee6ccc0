//! Where a line is inside of what a convex body sweeps that goes straight.

use nalgebra::Vector3;

use crate::profile::{Line, Run, ToolPose};

/// Steps of the search for where the body reaches farthest along a line.
const STEPS: usize = 7;

/// Share of a stretch that a step of the search keeps.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A convex part of a tool on a straight way without turning. What it sweeps is convex, so that of a line everything between
/// two poses' stretches is inside too; whatever poses are looked at, no more is said than what is.
pub(crate) struct Sweep<'a> {
    pub run: &'a Run,
    /// Where it begins.
    pub pose: ToolPose,
    /// From there to its end, mm.
    pub way: Vector3<f64>,
}

impl Sweep<'_> {
    fn at(&self, share: f64) -> ToolPose {
        ToolPose { tip: self.pose.tip + self.way * share, ..self.pose }
    }

    /// Extents of all of it, mm.
    pub fn extents(&self) -> [Vector3<f64>; 2] {
        let [from, to] = [0.0, 1.0].map(|share| self.run.extents(&self.at(share)));
        [from[0].inf(&to[0]), from[1].sup(&to[1])]
    }

    /// Where the line along `axis` through `point` is inside.
    pub fn inside(&self, point: Vector3<f64>, axis: usize) -> Option<[f64; 2]> {
        let at = |share: f64| self.run.inside(&Line::new(&self.at(share), point, axis));
        let [from, to] = self.shares(point, axis)?;
        let join = |one: Option<[f64; 2]>, other: Option<[f64; 2]>| match (one, other) {
            (Some(one), Some(other)) => Some([one[0].min(other[0]), one[1].max(other[1])]),
            (one, other) => one.or(other),
        };
        let mut found = join(join(at(from), at(to)), at(0.5 * (from + to)));
        if (to - from) * self.way.norm() < 0.05 * self.run.most() {
            return found;
        }
        // How far the body reaches along the line is concave over the way: a search by thirds finds the most of it.
        for sense in [-1.0, 1.0] {
            let reach = |stretch: Option<[f64; 2]>| {
                stretch.map_or(f64::NEG_INFINITY, |[low, high]| (low * sense).max(high * sense))
            };
            let [mut low, mut high] = [from, to];
            let mut inner = [high - GOLDEN * (high - low), low + GOLDEN * (high - low)];
            let mut stretches = inner.map(at);
            for _ in 0..STEPS {
                found = join(found, join(stretches[0], stretches[1]));
                if reach(stretches[0]) > reach(stretches[1]) {
                    (high, inner[1], stretches[1]) = (inner[1], inner[0], stretches[0]);
                    inner[0] = high - GOLDEN * (high - low);
                    stretches[0] = at(inner[0]);
                } else {
                    (low, inner[0], stretches[0]) = (inner[0], inner[1], stretches[1]);
                    inner[1] = low + GOLDEN * (high - low);
                    stretches[1] = at(inner[1]);
                }
            }
        }
        found
    }

    /// Between which shares of the way the line may be inside.
    fn shares(&self, point: Vector3<f64>, axis: usize) -> Option<[f64; 2]> {
        let arm = point - self.pose.tip;
        let tool = self.pose.axis;
        let along = Vector3::ith(axis, 1.0);
        // Distance of the line from the tool axis, as a vector that goes with the share.
        let across = along.cross(&tool);
        let length = across.norm();
        let [here, change] = match length > 1e-9 {
            true => {
                [arm, self.way].map(|vector| across * (across.dot(&vector) / (length * length)))
            }
            false => [arm, self.way].map(|vector| vector - tool * tool.dot(&vector)),
        };
        let mut range = [0.0f64, 1.0f64];
        let speed = change.norm_squared();
        if speed > 1e-18 {
            let nearest = here.dot(&change) / speed;
            let miss = (here - change * nearest).norm_squared();
            let half = (self.run.most() * self.run.most() - miss) / speed;
            let half = (half >= 0.0).then(|| half.sqrt())?;
            range = [range[0].max(nearest - half), range[1].min(nearest + half)];
        } else if here.norm() > self.run.most() {
            return None;
        }
        // A line across the tool is at one height above its tip.
        let rise = self.way.dot(&tool);
        if libm::fabs(tool[axis]) < 1e-9 && libm::fabs(rise) > 1e-9 {
            let ends = self.run.heights().map(|height| (arm.dot(&tool) - height) / rise);
            range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
        }
        (range[0] <= range[1]).then_some(range)
    }
}
