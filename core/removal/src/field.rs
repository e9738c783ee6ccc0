//! What is left of a stock, between two bounds.

use std::collections::HashMap;

use nalgebra::Vector3;

use crate::chip::{Chip, Gauge};
use crate::profile::{
    Frustum, Line, Run, ToolPose, along_axis, extents, frusta, grown, hull, runs, slid,
};
use crate::rays::{Bound, Grid, Rays, Span, Stretch, common, within};
use crate::sweep::Sweep;

/// Prisms of all three directions together that a stock has if no resolution is said.
const PRISMS: f64 = 150_000.0;

/// Prisms that a stock has at most: of 24 bytes each, and more where it is cut.
const MOST_PRISMS: f64 = 2e7;

/// Prisms of a tile, in each direction of the section.
pub(crate) const TILE: usize = 8;

/// What is left of a stock. All points are in its own frame: along the axes of the stock's, from its low corner, mm.
#[derive(Clone, Debug)]
pub struct Field {
    pub(crate) grid: Grid,
    /// What may be left, along each axis: what all three have in common.
    pub(crate) upper: [Rays; 3],
    /// What certainly is, along Z.
    pub(crate) lower: Rays,
    /// From the lowest to the highest of what may be left in each tile of Z prisms: none where it is to be looked up.
    pub(crate) tiles: Vec<Option<Stretch>>,
    pub(crate) guess: Option<[Vector3<f64>; 2]>,
    /// Of prisms along Z that a cut in pieces came by, what certainly was left before it: what a piece may have taken and a
    /// later one certainly takes, the cut certainly does.
    kept: Option<HashMap<[usize; 2], Vec<Span>>>,
}

/// Volume, between two bounds, mm³.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Volume {
    /// No less.
    pub at_least: f64,
    /// No more.
    pub at_most: f64,
}

impl std::ops::AddAssign for Volume {
    fn add_assign(&mut self, other: Self) {
        self.at_least += other.at_least;
        self.at_most += other.at_most;
    }
}

/// What a tool removes: its cutting part as what is certainly inside of it, and all of it that may touch.
#[derive(Clone, Debug)]
pub struct Cutter {
    pub(crate) inner: Vec<Run>,
    pub(crate) outer: Vec<Frustum>,
}

impl Cutter {
    /// The cutter of a profile, points [z, r] in mm, z from the tip.
    pub fn new(profile: &[[f64; 2]]) -> Self {
        Self::between(profile, profile)
    }

    /// The cutter between an inner and an outer outline.
    pub fn between(inner: &[[f64; 2]], outer: &[[f64; 2]]) -> Self {
        Self { inner: runs(inner), outer: frusta(outer) }
    }

    /// A body that removes nothing for certain, and may remove what it touches.
    pub fn vague(profile: &[[f64; 2]]) -> Self {
        Self { inner: Vec::new(), outer: frusta(profile) }
    }
}

impl Field {
    /// Resolution that a stock of this size has if none is said, mm.
    pub fn resolution(size: Vector3<f64>) -> f64 {
        (sections(size) / PRISMS).sqrt()
    }

    /// The least resolution that a stock of this size may have, mm: of a finer one there is no room.
    pub fn finest(size: Vector3<f64>) -> f64 {
        (sections(size) / MOST_PRISMS).sqrt()
    }

    /// A stock of a size that nothing is in yet.
    pub(crate) fn empty(size: Vector3<f64>, resolution: f64) -> Self {
        let resolution = resolution.max(Self::finest(size));
        let counts = [0, 1, 2].map(|axis| libm::ceil(size[axis] / resolution).max(1.0) as usize);
        let cell = Vector3::from_fn(|axis, _| size[axis] / counts[axis] as f64);
        let grid = Grid { cell, counts };
        let tiles = counts[0].div_ceil(TILE) * counts[1].div_ceil(TILE);
        Self {
            upper: [0, 1, 2].map(|axis| Rays::new(axis, &grid, Bound::Upper)),
            lower: Rays::new(2, &grid, Bound::Lower),
            tiles: vec![None; tiles],
            guess: None,
            kept: None,
            grid,
        }
    }

    /// A box from the origin to a corner, mm.
    pub fn block(size: Vector3<f64>, resolution: f64) -> Self {
        let mut field = Self::empty(size, resolution);
        for rays in field.upper.iter_mut().chain([&mut field.lower]) {
            rays.fill_all([0.0, size[rays.axis()]]);
        }
        field
    }

    /// A cylinder, the middles of its ends in mm, in a box from the origin to a corner.
    pub fn cylinder(
        size: Vector3<f64>,
        ends: [Vector3<f64>; 2],
        radius: f64,
        resolution: f64,
    ) -> Self {
        let mut field = Self::block(size, resolution);
        let axis = ends[1] - ends[0];
        let pose = ToolPose { tip: ends[0], axis: axis.normalize() };
        let profile = [[0.0, radius], [axis.norm(), radius]];
        let mut inside = field.lower.clone();
        // What it may touch is what the upper bound begins with, what is inside for certain the lower one.
        let Self { upper, lower, .. } = &mut field;
        for rays in upper {
            let solid = grown(&frusta(&profile), rays.half_diagonal());
            let mut kept = Vec::new();
            let along = rays.axis();
            let line = |point| hull(&solid, &Line::new(&pose, point, along));
            rays.touch(&extents(&solid, &pose), None, &line, &mut |place, _, stretch| {
                kept.push((place, stretch));
            });
            rays.fill(&kept, size[along]);
        }
        let mut kept = Vec::new();
        for run in runs(&profile) {
            let line = |point| run.inside(&Line::new(&pose, point, 2));
            inside.carve(&run.extents(&pose), &line, &mut |place, _, stretch| {
                kept.push((place, stretch));
            });
        }
        lower.fill(&kept, size.z);
        field
    }

    /// Takes away what a cutter certainly removes where it stands; what was left there.
    pub fn remove(&mut self, cutter: &Cutter, pose: &ToolPose) -> Volume {
        self.remove_at(cutter, pose, None)
    }

    /// The same, with what is taken measured.
    pub(crate) fn remove_at(
        &mut self,
        cutter: &Cutter,
        pose: &ToolPose,
        mut gauge: Option<&mut Gauge>,
    ) -> Volume {
        let mut removed = Volume::default();
        for run in &cutter.inner {
            let extents = run.extents(pose);
            let line = |point, axis| run.inside(&Line::new(pose, point, axis));
            removed += self.carve(&extents, &line, gauge.as_deref_mut());
        }
        removed
    }

    /// A cutter goes straight without turning, and strays from its line no farther than `stray`, mm: what it certainly removes is
    /// taken away, and what it may touch is not left for certain any more.
    pub fn cut_straight(&mut self, cutter: &Cutter, poses: [ToolPose; 2], stray: f64) -> Chip {
        let mut gauge = Gauge::new(poses);
        let mut volume = self.remove_measured(cutter, poses, &mut gauge);
        let [from, to] = poses;
        let way = to.tip - from.tip;
        // All of a way along the tool axis is touched at once, of others a piece that is two cells long.
        let slides = along_axis(poses);
        let pieces = match slides {
            Some(_) => 1.0,
            None => libm::ceil(way.norm() / (2.0 * self.grid.cell.max())).max(1.0),
        };
        let mut before = None;
        for piece in 0..pieces as u64 {
            let tip = from.tip + way * ((piece as f64 + 0.5) / pieces);
            let by = 0.5 * way.norm() / pieces + stray;
            let aside = Around { pose: ToolPose { tip, ..from }, by, up: 0.0 };
            let around = slides.map_or(aside, |(pose, up)| Around { pose, by: stray, up });
            volume += self.doubt_around(cutter, &around, before.as_ref(), Some(&mut gauge));
            before = Some(around);
        }
        Chip { volume, engagement: gauge.engagement(&cutter.outer) }
    }

    /// A cut in pieces begins, or ends.
    pub(crate) fn in_pieces(&mut self, begins: bool) {
        self.kept = begins.then(HashMap::new);
    }

    /// A cutter stands on its way between two poses: what it certainly removes there is taken away. Where it is said how
    /// far it strays, nothing of that is left for certain any more.
    pub(crate) fn cut_standing(
        &mut self,
        cutter: &Cutter,
        ends: [ToolPose; 2],
        pose: &ToolPose,
        strays: Option<Strays>,
    ) -> Chip {
        let mut gauge = Gauge::new(ends);
        gauge.stand(pose);
        gauge.no_higher(strays.as_ref().and_then(|strays| strays.highest));
        let mut volume = self.remove_at(cutter, pose, Some(&mut gauge));
        if let Some(Strays { around, before, tips, aside, .. }) = strays {
            gauge.stray(tips, aside);
            volume += self.doubt_around(cutter, &around, before.as_ref(), Some(&mut gauge));
        }
        Chip { volume, engagement: gauge.engagement(&cutter.outer) }
    }

    /// Takes away what a cutter certainly removes that goes straight without turning; what was left there.
    pub fn remove_straight(&mut self, cutter: &Cutter, poses: [ToolPose; 2]) -> Volume {
        self.remove_measured(cutter, poses, &mut Gauge::new(poses))
    }

    /// The same, with what is taken measured.
    fn remove_measured(
        &mut self,
        cutter: &Cutter,
        poses: [ToolPose; 2],
        gauge: &mut Gauge,
    ) -> Volume {
        let [from, to] = poses;
        let mut removed = Volume::default();
        if let Some((low, up)) = along_axis(poses) {
            for run in &cutter.inner {
                let run = run.slid(up);
                let line = |point, axis| run.inside(&Line::new(&low, point, axis));
                removed += self.carve(&run.extents(&low), &line, Some(gauge));
            }
            return removed;
        }
        let way = to.tip - from.tip;
        let length = way.norm();
        for run in &cutter.inner {
            // Long ways go in parts, so that their boxes hold little besides; they overlap by a cell, so that no prism lies
            // in two of them.
            let part = 2.0 * run.most().max(self.grid.cell.max());
            let parts = libm::ceil(length / part).max(1.0);
            let over = if length > 0.0 { self.grid.cell.norm() / length } else { 0.0 };
            for place in 0..parts as u64 {
                let start = (place as f64 / parts - over).max(0.0);
                let end = ((place + 1) as f64 / parts + over).min(1.0);
                let pose = ToolPose { tip: from.tip + way * start, ..from };
                let sweep = Sweep { run, pose, way: way * (end - start) };
                let line = |point, axis| sweep.inside(point, axis);
                removed += self.carve(&sweep.extents(), &line, Some(gauge));
            }
        }
        removed
    }

    /// Takes away what is inside of a convex body for certain; what was left of it.
    fn carve(
        &mut self,
        extents: &[Vector3<f64>; 2],
        line: &dyn Fn(Vector3<f64>, usize) -> Option<Stretch>,
        mut gauge: Option<&mut Gauge>,
    ) -> Volume {
        let Self { upper, lower, tiles, grid, kept, .. } = self;
        let width = grid.counts[0].div_ceil(TILE);
        let (mut length, mut at_most) = (0.0, 0.0);
        for (axis, rays) in upper.iter_mut().enumerate() {
            let taken = &mut |place: [usize; 2], left: &[Span], stretch: Stretch| {
                if axis == 2 {
                    tiles[place[1] / TILE * width + place[0] / TILE] = None;
                    // What another part of the same cut has removed was counted there.
                    let before = kept.as_ref().and_then(|kept| kept.get(&place));
                    let certain = before.map_or(lower.at(place), Vec::as_slice);
                    length += common(left, certain, stretch);
                    if let Some(gauge) = &mut gauge {
                        gauge.possible(grid, place, within(left, stretch));
                        gauge.certain(grid, place, within(lower.at(place), stretch));
                        gauge.certain_somewhere(grid, place, within(certain, stretch));
                    }
                }
            };
            // That of the last, along Z.
            at_most = rays.carve(extents, &|point| line(point, axis), taken);
        }
        Volume { at_least: length * lower.area(), at_most }
    }

    /// What is within `by` of a cutter, mm, is not left for certain any more; what may be left there.
    pub fn doubt(&mut self, cutter: &Cutter, pose: &ToolPose, by: f64) -> Volume {
        self.doubt_around(cutter, &Around { pose: *pose, by, up: 0.0 }, None, None)
    }

    /// The same of a cutter that stood `before` where what was left there is counted already, with what may be taken measured.
    pub(crate) fn doubt_around(
        &mut self,
        cutter: &Cutter,
        around: &Around,
        before: Option<&Around>,
        mut gauge: Option<&mut Gauge>,
    ) -> Volume {
        let Self { upper, lower, grid, kept, .. } = self;
        let half = lower.half_diagonal();
        let body = around.body(cutter, half);
        let counted = before.map(|before| (before.body(cutter, half), before.pose));
        let mut length = 0.0;
        let line = |point| hull(&body, &Line::new(&around.pose, point, 2));
        let extents = extents(&body, &around.pose);
        lower.touch(&extents, Some(&upper[2]), &line, &mut |place, certain, stretch| {
            if let Some(kept) = kept.as_mut() {
                kept.entry(place).or_insert_with(|| certain.to_vec());
            }
            let left = upper[2].left(place, stretch);
            if left <= 0.0 {
                return;
            }
            length += left;
            if let Some((body, pose)) = &counted {
                let line = Line::new(pose, upper[2].middle(place), 2);
                let [low, high] = hull(body, &line).unwrap_or([f64::INFINITY; 2]);
                length -= upper[2].left(place, [low.max(stretch[0]), high.min(stretch[1])]);
            }
            if let Some(gauge) = &mut gauge {
                gauge.possible(grid, place, within(upper[2].at(place), stretch));
            }
        });
        Volume { at_least: 0.0, at_most: length * lower.area() }
    }

    /// Nothing is left for certain: it is not known where a tool has been.
    pub fn doubt_all(&mut self) {
        self.lower.clear();
    }

    /// What is left.
    pub fn volume(&self) -> Volume {
        let most = self.upper.iter().map(Rays::volume).fold(f64::INFINITY, f64::min);
        Volume { at_least: self.lower.volume(), at_most: most }
    }

    /// Edges of its cells, mm.
    pub fn cell(&self) -> Vector3<f64> {
        self.grid.cell
    }

    /// Bytes that it takes.
    pub fn bytes(&self) -> usize {
        self.upper.iter().chain([&self.lower]).map(Rays::bytes).sum()
    }

    /// Whether a point may be left.
    pub fn may_hold(&self, point: Vector3<f64>) -> bool {
        self.upper.iter().all(|rays| rays.holds(point))
    }

    /// Whether a point is left for certain.
    pub fn holds(&self, point: Vector3<f64>) -> bool {
        self.lower.holds(point)
    }

    /// A point of a body that is left for certain, of convex parts of a profile.
    pub fn common(&self, profile: &[[f64; 2]], pose: &ToolPose) -> Option<Vector3<f64>> {
        runs(profile).iter().find_map(|run| {
            let line = |point| run.inside(&Line::new(pose, point, 2));
            self.lower.meets(&run.extents(pose), &line)
        })
    }
}

/// Where a cutter may touch: within `by` of it where it stands, and all the way `up` along its axis from there, mm.
#[derive(Clone, Copy)]
pub(crate) struct Around {
    pub pose: ToolPose,
    pub by: f64,
    pub up: f64,
}

/// How far a cutter strays from a place of its way.
#[derive(Clone, Copy)]
pub(crate) struct Strays {
    pub around: Around,
    /// Around the place before, where what was left is counted already.
    pub before: Option<Around>,
    /// How high the tip is along the tool axis at least and at most, mm.
    pub tips: [f64; 2],
    /// How far it goes aside, mm.
    pub aside: f64,
    /// How high the tip is at most anywhere on the whole way, mm, where that is known.
    pub highest: Option<f64>,
}

impl Around {
    /// All of it, and what is no farther than `more` away, mm.
    fn body(&self, cutter: &Cutter, more: f64) -> Vec<Frustum> {
        slid(&grown(&cutter.outer, self.by + more), self.up)
    }
}

/// Sum of the sections of a box across its three axes, mm².
fn sections(size: Vector3<f64>) -> f64 {
    size.x * size.y + size.y * size.z + size.z * size.x
}
