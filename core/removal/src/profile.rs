//! A tool as a body of revolution, and where a line is inside of it.

use nalgebra::Vector3;

/// So much is a cutter that removes taken to be smaller, and one that may touch to be larger, mm: what rounding may take.
const MARGIN: f64 = 1e-6;

/// Where a tool stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolPose {
    /// Its tip, mm.
    pub tip: Vector3<f64>,
    /// Its axis, from the tip to the spindle, unit vector.
    pub axis: Vector3<f64>,
}

/// A frustum about the axis of a tool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// Where it begins and ends, mm from the tip, rising.
    pub z: [f64; 2],
    /// Radii there, mm.
    pub r: [f64; 2],
}

/// A convex part of a tool: frusta on one another, from the tip on.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    frusta: Vec<Frustum>,
    most: f64,
}

/// A line along an axis of the grid as a tool sees it: at λ mm from its point its height above the tip is z + c·λ, and the
/// square of its distance from the tool axis a + 2·b·λ + q·λ².
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub z: f64,
    pub c: f64,
    a: f64,
    b: f64,
    q: f64,
}

impl Line {
    pub fn new(pose: &ToolPose, point: Vector3<f64>, axis: usize) -> Self {
        let arm = point - pose.tip;
        let z = arm.dot(&pose.axis);
        let c = pose.axis[axis];
        // The line and its point across the tool axis, so that what is nearly along it keeps its digits.
        let (aside, across) = (arm - pose.axis * z, Vector3::ith(axis, 1.0) - pose.axis * c);
        Self { z, c, a: aside.norm_squared(), b: aside.dot(&across), q: across.norm_squared() }
    }

    /// Where it is within `radius` of the tool axis and at a height between two.
    fn within(&self, z: [f64; 2], radius: f64) -> Option<[f64; 2]> {
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        if self.q > 1e-20 {
            let middle = -self.b / self.q;
            let half = (radius * radius - self.a + self.b * self.b / self.q) / self.q;
            let half = (half >= 0.0).then(|| half.sqrt())?;
            range = [middle - half, middle + half];
        } else if self.a > radius * radius {
            return None;
        }
        if libm::fabs(self.c) > 1e-12 {
            let ends = z.map(|z| (z - self.z) / self.c);
            range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
        } else if self.z < z[0] || self.z > z[1] {
            return None;
        }
        (range[0] < range[1]).then_some(range)
    }

    fn radius(&self, at: f64) -> f64 {
        (self.a + at * (2.0 * self.b + at * self.q)).max(0.0).sqrt()
    }
}

impl Frustum {
    fn slope(&self) -> f64 {
        (self.r[1] - self.r[0]) / (self.z[1] - self.z[0])
    }

    /// Its radius at a height of it, mm.
    pub(crate) fn at(&self, z: f64) -> f64 {
        self.r[0] + self.slope() * (z - self.z[0])
    }

    /// Where a line is inside of it.
    pub(crate) fn inside(&self, line: &Line) -> Option<[f64; 2]> {
        let [low, high] = line.within(self.z, self.r[0].max(self.r[1]))?;
        let slope = self.slope();
        if slope == 0.0 {
            return Some([low, high]);
        }
        // The radius of the frustum along the line, less that of the line: concave, so that it is above zero on one stretch.
        let rise = slope * line.c;
        let base = self.r[0] + slope * (line.z - self.z[0]);
        let spare = |at: f64| base + rise * at - line.radius(at);
        let (starts, ends) = (spare(low) >= 0.0, spare(high) >= 0.0);
        if starts && ends {
            return Some([low, high]);
        }
        let [a, b, c] = [line.q - rise * rise, line.b - base * rise, line.a - base * base];
        let roots = roots(a, b, c).into_iter().flatten();
        let inner = roots.filter(|at| (low..=high).contains(at) && base + rise * at >= 0.0);
        let between = inner.fold(None, |range: Option<[f64; 2]>, at| {
            let [first, last] = range.unwrap_or([at; 2]);
            Some([first.min(at), last.max(at)])
        });
        let range = match (between, starts, ends) {
            (Some([_, last]), true, _) => [low, last],
            (Some([first, _]), _, true) => [first, high],
            (Some(range), ..) => range,
            // The root is within rounding of an end: what is between the ends tells of which.
            (None, ..) if (starts || ends) && spare(0.5 * (low + high)) >= 0.0 => [low, high],
            _ => return None,
        };
        (range[0] < range[1]).then_some(range)
    }

    /// Frusta that hold all that is within `by` of this one, mm: its side, moved out, up to its ends and as far as it is
    /// wide.
    fn grown(&self, by: f64) -> [Self; 2] {
        let slope = self.slope();
        let z = [self.z[0] - by, self.z[1] + by];
        let most = self.r[0].max(self.r[1]) + by;
        let out = by * (libm::hypot(1.0, slope) - libm::fabs(slope));
        let aside = by * libm::hypot(1.0, slope);
        // Where the side that was moved out is as wide as it gets.
        let wide = match slope > 0.0 {
            true => self.z[1] + (by - aside) / slope,
            false if slope < 0.0 => self.z[0] + (by - aside) / slope,
            false => z[1],
        };
        let wide = wide.clamp(z[0], z[1]);
        let [low, high] = [[z[0], wide], [wide, z[1]]];
        match slope > 0.0 {
            true => [Self { z: low, r: [self.r[0] + out, most] }, Self { z: high, r: [most; 2] }],
            false => [Self { z: low, r: [most; 2] }, Self { z: high, r: [most, self.r[1] + out] }],
        }
    }
}

/// Roots of a·x² + 2·b·x + c.
fn roots(a: f64, b: f64, c: f64) -> [Option<f64>; 2] {
    let square = b * b - a * c;
    if square < 0.0 {
        return [None, None];
    }
    let sum = -(b + libm::copysign(square.sqrt(), b));
    let root = |over: f64, under: f64| (under != 0.0).then(|| over / under);
    [root(sum, a), root(c, sum)]
}

/// The frusta of a profile, points [z, r] in mm, z from the tip.
pub fn frusta(profile: &[[f64; 2]]) -> Vec<Frustum> {
    let pairs = profile.windows(2).filter(|pair| pair[0][0] != pair[1][0]);
    let frusta = pairs.map(|pair| match pair[0][0] < pair[1][0] {
        true => Frustum { z: [pair[0][0], pair[1][0]], r: [pair[0][1], pair[1][1]] },
        false => Frustum { z: [pair[1][0], pair[0][0]], r: [pair[1][1], pair[0][1]] },
    });
    frusta.collect()
}

/// What of a profile lies between two heights above the tip, mm.
pub fn between(profile: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for frustum in frusta(profile) {
        let [low, high] = [frustum.z[0].max(from), frustum.z[1].min(to)];
        if low < high {
            points.extend([[low, frustum.at(low)], [high, frustum.at(high)]]);
        }
    }
    points.dedup();
    points
}

/// The convex parts of a profile that removes material, points [z, r] in mm, z from the tip: certainly inside of it. Where
/// two of them meet a third bridges them, so that nothing is left between.
pub fn runs(profile: &[[f64; 2]]) -> Vec<Run> {
    let mut parts: Vec<Vec<Frustum>> = Vec::new();
    let mut bridges = Vec::new();
    for frustum in frusta(profile) {
        let before = parts.last().and_then(|part| part.last());
        let meets = before.filter(|before| before.z[1] == frustum.z[0]);
        match (meets.copied(), parts.last_mut()) {
            (Some(before), Some(part))
                if before.r[1] == frustum.r[0] && frustum.slope() <= before.slope() =>
            {
                part.push(frustum);
            }
            (meets, _) => {
                bridges.extend(meets.map(|before| bridge(&before, &frustum)));
                parts.push(vec![frustum]);
            }
        }
    }
    parts.extend(bridges.into_iter().map(|bridge| vec![bridge]));
    parts.into_iter().filter_map(Run::new).collect()
}

/// A cylinder across the place where one frustum goes over into the next.
fn bridge(below: &Frustum, above: &Frustum) -> Frustum {
    let half = [below, above].map(|frustum| 0.5 * (frustum.z[1] - frustum.z[0]));
    let half = half[0].min(half[1]).min(1e-3);
    let least = (below.r[1] - below.slope() * half).min(below.r[1]);
    let least = least.min(above.r[0]).min(above.r[0] + above.slope() * half);
    Frustum { z: [below.z[1] - half, above.z[0] + half], r: [least; 2] }
}

impl Run {
    /// Frusta that stand on one another, less the margin.
    fn new(mut frusta: Vec<Frustum>) -> Option<Self> {
        for frustum in &mut frusta {
            // No less than nothing: what is thinner than the margin removes nothing to speak of.
            frustum.r = frustum.r.map(|r| (r - MARGIN).max(0.0));
        }
        frusta.first_mut()?.z[0] += MARGIN;
        frusta.last_mut()?.z[1] -= MARGIN;
        let most = frusta.iter().flat_map(|frustum| frustum.r).fold(0.0, f64::max);
        let stands = most > 0.0 && frusta.iter().all(|frustum| frustum.z[0] < frustum.z[1]);
        stands.then_some(Self { frusta, most })
    }

    /// Its largest radius, mm.
    pub(crate) fn most(&self) -> f64 {
        self.most
    }

    /// From where to where it goes above the tip, mm.
    pub(crate) fn heights(&self) -> [f64; 2] {
        let ends =
            |place: Option<&Frustum>, end: usize| place.map_or(0.0, |frustum| frustum.z[end]);
        [ends(self.frusta.first(), 0), ends(self.frusta.last(), 1)]
    }

    /// Where a line is inside of it: it is convex, so that it is one stretch.
    pub(crate) fn inside(&self, line: &Line) -> Option<[f64; 2]> {
        hull(&self.frusta, line)
    }

    /// Extents at a pose, mm.
    pub(crate) fn extents(&self, pose: &ToolPose) -> [Vector3<f64>; 2] {
        extents(&self.frusta, pose)
    }

    /// What it sweeps that goes up along its axis, mm: convex as it is.
    pub(crate) fn slid(&self, up: f64) -> Self {
        Self { frusta: slid(&self.frusta, up), most: self.most }
    }
}

/// What frusta sweep that go up along their axis, mm: each stays where it widens upwards, goes along where it narrows, and
/// is as wide between as its wide end.
pub(crate) fn slid(frusta: &[Frustum], up: f64) -> Vec<Frustum> {
    let parts = frusta.iter().flat_map(|frustum| {
        let Frustum { z: [low, high], r } = *frustum;
        let narrows = r[1] < r[0];
        let [from, to] = if narrows { [low, low + up] } else { [high, high + up] };
        let between = Frustum { z: [from, to], r: [r[0].max(r[1]); 2] };
        let end = if narrows { Frustum { z: [low + up, high + up], r } } else { *frustum };
        [between, end]
    });
    parts.filter(|frustum| frustum.z[0] < frustum.z[1]).collect()
}

/// The lower of two poses and how far the other is above it, mm, if it is straight along the tool axis.
pub(crate) fn along_axis([from, to]: [ToolPose; 2]) -> Option<(ToolPose, f64)> {
    let way = to.tip - from.tip;
    let climb = way.dot(&from.axis);
    let low = if climb < 0.0 { to } else { from };
    ((way - from.axis * climb).norm() <= 1e-3 * MARGIN).then_some((low, libm::fabs(climb)))
}

/// How much frusta sweep at most that go aside and along their axis, mm, where nothing is higher above the tip than `depth`:
/// what is not where they began, mm³.
pub(crate) fn swept_ahead(frusta: &[Frustum], depth: f64, [aside, along]: [f64; 2]) -> f64 {
    let front = frusta.iter().map(|frustum| {
        let [low, high] = [frustum.z[0], frustum.z[1].min(depth)];
        if low < high { (high - low) * (frustum.at(low) + frustum.at(high)) } else { 0.0 }
    });
    let wide = frusta.iter().flat_map(|frustum| frustum.r).fold(0.0, f64::max);
    aside * front.sum::<f64>() + along * std::f64::consts::PI * wide * wide
}

/// From where a line comes into the first of some frusta to where it leaves the last.
pub(crate) fn hull(frusta: &[Frustum], line: &Line) -> Option<[f64; 2]> {
    let inside = frusta.iter().filter_map(|frustum| frustum.inside(line));
    inside.reduce(|one, other| [one[0].min(other[0]), one[1].max(other[1])])
}

/// Extents of frusta at a pose, mm.
pub(crate) fn extents(frusta: &[Frustum], pose: &ToolPose) -> [Vector3<f64>; 2] {
    let aside = pose.axis.map(|part| (1.0 - part * part).max(0.0).sqrt());
    let infinite = Vector3::repeat(f64::INFINITY);
    let discs = frusta.iter().flat_map(|frustum| frustum.z.into_iter().zip(frustum.r));
    discs.fold([infinite, -infinite], |[low, high], (z, r)| {
        let centre = pose.tip + pose.axis * z;
        [low.inf(&(centre - aside * r)), high.sup(&(centre + aside * r))]
    })
}

/// All that is within `by` of frusta, mm, and a margin more.
pub(crate) fn grown(frusta: &[Frustum], by: f64) -> Vec<Frustum> {
    let grown = frusta.iter().flat_map(|frustum| frustum.grown(by + MARGIN));
    grown.filter(|frustum| frustum.z[0] < frustum.z[1]).collect()
}
