//! Places in cubes of cubes: how far a point is from the nearest, in memory that is bounded.

use nalgebra::Vector3;

/// Edge of the cells that a path is first put into, mm.
const FINEST: f64 = 0.05;

/// Cells that are kept; of a longer path they are made larger.
const MOST_CELLS: usize = 400_000;

/// No child, no cell.
const NONE: u32 = u32::MAX;

/// A cube: eight cubes of half its edge, or a cell with a place in it.
#[derive(Clone, Copy, Debug)]
struct Cube {
    children: [u32; 8],
    /// A place of the path in it.
    place: Vector3<f64>,
}

/// The places.
#[derive(Clone, Debug)]
pub struct Octree {
    cubes: Vec<Cube>,
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
        self.cubes.push(Cube { children: [NONE; 8], place });
        (self.cubes.len() - 1) as u32
    }

    /// Twice as large, towards a point.
    fn grow(&mut self, point: Vector3<f64>) {
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
        let (mut at, mut middle, mut half) = (self.root, self.middle, self.half);
        while half > self.cell * 1.5 {
            let side = (point - middle).map(|way| if way < 0.0 { -1.0 } else { 1.0 });
            half *= 0.5;
            middle += side * half;
            let place = octant(side);
            let child = self.cubes[at as usize].children[place];
            at = match child {
                NONE => {
                    let child = self.cube(point);
                    self.cubes[at as usize].children[place] = child;
                    child
                }
                child => child,
            };
        }
    }

    /// Cells of twice the edge.
    fn coarsen(&mut self) {
        let old = std::mem::take(&mut self.cubes);
        let leaves = old.iter().filter(|cube| cube.children == [NONE; 8]).map(|cube| cube.place);
        let leaves: Vec<Vector3<f64>> = leaves.collect();
        self.root = NONE;
        self.cell *= 2.0;
        leaves.into_iter().for_each(|place| self.add(place));
    }

    /// The distance of a point from the nearest place that is kept, mm; infinite if there is none.
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
            if beyond.norm() < *best {
                self.look(child, centre, quarter, point, best);
            }
        }
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
            assert!((truth - found).abs() <= path.blur(), "{truth} {found}");
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
