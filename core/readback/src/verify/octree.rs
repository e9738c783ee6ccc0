//! Places in cubes of cubes: how far a point is from the nearest, in memory that is bounded.

use nalgebra::Vector3;

/// Edge of the cells that a path is first put into, mm.
const FINEST: f64 = 0.05;

/// Cells that are kept; of a longer path they are made larger.
const MOST_CELLS: usize = 400_000;

/// Share by which a distance may be told too large: from far off all that is cut is nearly as far, and the nearest of it
/// would be looked for everywhere.
pub(super) const FAR: f64 = 1e-3;

/// Room for the cubes of one place beyond those.
const SPARE: usize = 64;

/// No child, no cell.
const NONE: u32 = u32::MAX;

/// A cube: eight cubes of half its edge, or a cell with a place in it.
#[derive(Clone, Copy, Debug)]
struct Cube {
    children: [u32; 8],
    /// A place of the path in it.
    place: Vector3<f64>,
}

/// Steps from the whole to a cell at most that are remembered: as many halvings as an edge of 10⁶ km has.
const DEEPEST: usize = 48;

/// A cube on the way to the cell of the place that was put last.
#[derive(Clone, Copy, Debug)]
struct Step {
    cube: u32,
    middle: Vector3<f64>,
    /// Half of its edge, mm.
    half: f64,
    /// Places that take the same way as far as here: from the least coordinates on, and below the most.
    least: Vector3<f64>,
    most: Vector3<f64>,
}

/// The places.
#[derive(Clone, Debug)]
pub struct Octree {
    cubes: Vec<Cube>,
    /// The way to the place that was put last, from the whole on; empty after the whole has changed.
    steps: Vec<Step>,
    root: u32,
    /// Middle of the whole, and half of its edge, mm.
    middle: Vector3<f64>,
    half: f64,
    /// Half of the edge of a cell, mm.
    cell: f64,
}

impl Octree {
    /// Of no place yet.
    pub fn new() -> Self {
        Self {
            cubes: Vec::new(),
            steps: Vec::new(),
            root: NONE,
            middle: Vector3::zeros(),
            half: 0.0,
            cell: 0.5 * FINEST,
        }
    }

    /// Half of the edge of a cell, mm.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// How finely distances are known, mm: the diagonal of a cell.
    pub fn blur(&self) -> f64 {
        2.0 * self.cell * 3f64.sqrt()
    }

    /// How finely distances are known at worst of places within a box of these edges, mm: of all grids whose cells cannot be
    /// too many in it, that of the smallest.
    pub fn coarsest_blur(extent: Vector3<f64>) -> f64 {
        let mut edge = FINEST;
        // A box takes a cell more along each axis than fit into it, and one for where the grid begins.
        let cubes = |edge: f64| extent.iter().map(|side| side / edge + 2.0).product::<f64>();
        let all = |edge: f64| -> f64 {
            (0..DEEPEST as i32).map(|level| cubes(libm::ldexp(edge, level))).sum()
        };
        while all(edge) > MOST_CELLS as f64 {
            edge *= 2.0;
        }
        edge * 3f64.sqrt()
    }

    /// Adds a place.
    pub fn add(&mut self, point: Vector3<f64>) {
        if self.root == NONE {
            self.middle = point;
            self.half = self.cell;
            self.root = self.cube(point);
        }
        while (point - self.middle).amax() > self.half {
            self.grow(point);
        }
        self.put(point);
        if self.cubes.len() > MOST_CELLS {
            self.coarsen();
        }
    }

    fn cube(&mut self, place: Vector3<f64>) -> u32 {
        let count = self.cubes.len();
        // Twice as much room as now would be more than is ever filled.
        if count == self.cubes.capacity() && 2 * count > MOST_CELLS {
            self.cubes.reserve_exact((MOST_CELLS + SPARE).saturating_sub(count).max(SPARE));
        }
        self.cubes.push(Cube { children: [NONE; 8], place });
        (self.cubes.len() - 1) as u32
    }

    /// Twice as large, towards a point.
    fn grow(&mut self, point: Vector3<f64>) {
        self.steps.clear();
        let side = (point - self.middle).map(|way| if way < 0.0 { -1.0 } else { 1.0 });
        let old = self.root;
        self.middle += side * self.half;
        let root = self.cube(point);
        // The old whole lies on the other side.
        self.cubes[root as usize].children[octant(-side)] = old;
        self.root = root;
        self.half *= 2.0;
    }

    fn put(&mut self, point: Vector3<f64>) {
        // Places follow one another along a path: most take the way of the last, nearly to its end.
        while self.steps.last().is_some_and(|step| !step.leads_to(&point)) {
            self.steps.pop();
        }
        let mut step = match self.steps.last() {
            Some(step) => *step,
            None => {
                let whole = Step::whole(self.root, self.middle, self.half);
                self.steps.push(whole);
                whole
            }
        };
        while step.half > self.cell * 1.5 {
            let at = step.cube;
            let side = step.down(&point);
            let place = octant(side);
            let child = self.cubes[at as usize].children[place];
            step.cube = match child {
                NONE => {
                    let child = self.cube(point);
                    self.cubes[at as usize].children[place] = child;
                    child
                }
                child => child,
            };
            if self.steps.len() < DEEPEST {
                self.steps.push(step);
            }
        }
    }

    /// Cells of twice the edge.
    fn coarsen(&mut self) {
        self.steps.clear();
        let leaves = self.cubes.iter().filter(|cube| cube.children == [NONE; 8]);
        let leaves: Vec<Vector3<f64>> = leaves.map(|cube| cube.place).collect();
        self.cubes.clear();
        self.root = NONE;
        self.cell *= 2.0;
        leaves.into_iter().for_each(|place| self.add(place));
    }

    /// The distance of a point from the nearest place that is kept, or by [`FAR`] of it more, mm; infinite if there is none.
    pub fn distance(&self, point: Vector3<f64>) -> f64 {
        let mut best = f64::INFINITY;
        if self.root != NONE {
            self.look(self.root, self.middle, self.half, point, &mut best);
        }
        best
    }

    fn look(&self, at: u32, middle: Vector3<f64>, half: f64, point: Vector3<f64>, best: &mut f64) {
        let cube = &self.cubes[at as usize];
        *best = best.min((cube.place - point).norm());
        let nearest = octant((point - middle).map(|way| if way < 0.0 { -1.0 } else { 1.0 }));
        for other in 0..8 {
            // The one that the point is nearest to first.
            let place = nearest ^ other;
            let child = cube.children[place];
            if child == NONE {
                continue;
            }
            let side = Vector3::from_fn(|axis, _| if place >> axis & 1 == 1 { 1.0 } else { -1.0 });
            let quarter = 0.5 * half;
            let centre = middle + side * quarter;
            let beyond = (point - centre).map(|way| (way.abs() - quarter).max(0.0));
            if beyond.norm() < *best * (1.0 - FAR) {
                self.look(child, centre, quarter, point, best);
            }
        }
    }
}

impl Step {
    /// At the whole, where all begin.
    fn whole(cube: u32, middle: Vector3<f64>, half: f64) -> Self {
        let [least, most] = [f64::NEG_INFINITY, f64::INFINITY].map(Vector3::repeat);
        Self { cube, middle, half, least, most }
    }

    /// Whether the way to `point` comes by here.
    #[inline]
    fn leads_to(&self, point: &Vector3<f64>) -> bool {
        (0..3).all(|axis| point[axis] >= self.least[axis] && point[axis] < self.most[axis])
    }

    /// To the middle of the next cube towards `point`, on the side that is told.
    #[inline]
    fn down(&mut self, point: &Vector3<f64>) -> Vector3<f64> {
        let side = (point - self.middle).map(|way| if way < 0.0 { -1.0 } else { 1.0 });
        for axis in 0..3 {
            let middle = self.middle[axis];
            match side[axis] < 0.0 {
                true => self.most[axis] = self.most[axis].min(middle),
                false => self.least[axis] = self.least[axis].max(middle),
            }
        }
        self.half *= 0.5;
        self.middle += side * self.half;
        side
    }
}

fn octant(side: Vector3<f64>) -> usize {
    let bit = |axis: usize| usize::from(side[axis] > 0.0) << axis;
    bit(0) | bit(1) | bit(2)
}

#[cfg(test)]
mod tests {
    use post_testkit::seeded;

    use super::*;

    #[test]
    fn distances_are_those_to_the_nearest_place() {
        let mut random = seeded(5);
        let mut path = Octree::new();
        let mut all = Vec::new();
        for _ in 0..2000 {
            let point = Vector3::from_fn(|_, _| random.range(-80.0, 120.0));
            path.add(point);
            all.push(point);
        }
        for _ in 0..500 {
            let point = Vector3::from_fn(|_, _| random.range(-150.0, 200.0));
            let truth = all.iter().map(|place| (place - point).norm());
            let truth = truth.fold(f64::INFINITY, f64::min);
            let found = path.distance(point);
            assert!((truth - found).abs() <= path.blur() + FAR * truth, "{truth} {found}");
        }
    }

    #[test]
    fn cells_are_those_that_are_found_from_the_whole_for_each_place() {
        let mut random = seeded(7);
        let [mut path, mut plain] = [(); 2].map(|()| Octree::new());
        let mut at = Vector3::zeros();
        for _ in 0..3000 {
            // Mostly near the last, on both sides of edges of cells, and now and then elsewhere.
            let far = if random.range(0.0, 1.0) < 0.02 { 90.0 } else { 0.2 };
            at += Vector3::from_fn(|_, _| random.range(-far, far));
            if random.range(0.0, 1.0) < 0.3 {
                at = at.map(|value| (value / FINEST).round() * FINEST);
            }
            plain.steps.clear();
            for tree in [&mut path, &mut plain] {
                tree.add(at);
            }
        }
        assert_eq!(path.cubes.len(), plain.cubes.len());
        for (one, other) in path.cubes.iter().zip(&plain.cubes) {
            assert_eq!((one.children, one.place), (other.children, other.place));
        }
    }

    #[test]
    fn memory_stays_bounded() {
        let mut path = Octree::new();
        let mut random = seeded(6);
        let mut at = Vector3::zeros();
        for _ in 0..20_000 {
            let next = Vector3::from_fn(|_, _| random.range(-200.0, 200.0));
            let way: Vector3<f64> = next - at;
            for step in 0..60 {
                path.add(at + way * (f64::from(step) / 60.0));
            }
            at = next;
        }
        assert!(path.cubes.len() <= MOST_CELLS + 16 && path.blur() < 40.0, "{}", path.blur());
        assert!(path.distance(at) <= path.blur());
    }
}
