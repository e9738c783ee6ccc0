//! Fewer triangles in place of many: the corners in one cell of a grid become one.

use std::collections::{BTreeMap, BTreeSet};

use super::Vertex;

/// Cells along the longest side of the box, to begin with.
const CELLS: f64 = 256.0;

/// Triangles that are kept while more come: beyond them the grid is made wider at once.
const MOST_KEPT: usize = 200_000;

/// Factor by which the cells are made wider, step by step.
const WIDER: f64 = 1.2;

type GridCell = [i16; 3];

/// Triangles between cells of a grid.
pub(super) struct ClusteredMesh {
    low: Vertex,
    middle: Vertex,
    size: f64,
    /// The corner of each cell that is farthest from the middle of the box: edges and corners of a body stay.
    cells: BTreeMap<GridCell, Vertex>,
    triangles: BTreeSet<[GridCell; 3]>,
}

impl ClusteredMesh {
    /// A grid over a box.
    pub(super) fn new(low: Vertex, high: Vertex) -> Self {
        let sides = low.iter().zip(high).map(|(low, high)| high - low);
        Self {
            low,
            middle: std::array::from_fn(|at| 0.5 * (low[at] + high[at])),
            size: (sides.fold(0.0, f64::max) / CELLS).max(1e-6),
            cells: BTreeMap::new(),
            triangles: BTreeSet::new(),
        }
    }

    /// Takes a triangle.
    pub(super) fn add(&mut self, triangle: [Vertex; 3]) {
        let cells = triangle.map(|corner| self.join(corner));
        keep(&mut self.triangles, cells);
        // Triangles that have shrunk leave their cells behind.
        if self.triangles.len() > MOST_KEPT || self.cells.len() > MOST_KEPT {
            *self = self.wider();
        }
    }

    /// At most `most` triangles, and at least one if there are any.
    pub(super) fn triangles(mut self, most: usize) -> Vec<[Vertex; 3]> {
        while self.triangles.len() > most {
            let wider = self.wider();
            if wider.triangles.is_empty() {
                break;
            }
            self = wider;
        }
        // What is no surface may be many triangles between few cells.
        let every = self.triangles.len().div_ceil(most.max(1)).max(1);
        let triangles = self.triangles.iter().step_by(every);
        triangles.map(|triangle| triangle.map(|cell| self.cells[&cell])).collect()
    }

    fn cell(&self, corner: Vertex) -> GridCell {
        std::array::from_fn(|at| ((corner[at] - self.low[at]) / self.size) as i16)
    }

    /// The same triangles on a grid whose cells are wider.
    fn wider(&self) -> Self {
        let mut wider = Self {
            size: self.size * WIDER,
            cells: BTreeMap::new(),
            triangles: BTreeSet::new(),
            ..*self
        };
        for corner in self.cells.values() {
            wider.join(*corner);
        }
        for triangle in &self.triangles {
            let cells = triangle.map(|cell| wider.cell(self.cells[&cell]));
            keep(&mut wider.triangles, cells);
        }
        wider
    }

    /// A corner comes to those of its cell.
    fn join(&mut self, corner: Vertex) -> GridCell {
        let cell = self.cell(corner);
        let far = |corner: Vertex| -> f64 {
            let way = corner.iter().zip(self.middle);
            way.map(|(to, from)| (to - from) * (to - from)).sum()
        };
        let kept = self.cells.entry(cell).or_insert(corner);
        if far(corner) > far(*kept) {
            *kept = corner;
        }
        cell
    }
}

/// Keeps a triangle that has not shrunk, its least cell first: the same one is kept once.
fn keep(triangles: &mut BTreeSet<[GridCell; 3]>, [a, b, c]: [GridCell; 3]) {
    if a == b || b == c || c == a {
        return;
    }
    triangles.insert(match () {
        () if a < b && a < c => [a, b, c],
        () if b < c => [b, c, a],
        () => [c, a, b],
    });
}
