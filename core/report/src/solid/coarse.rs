//! Many triangles as few: corners in one cell of a grid become one.

use std::collections::{BTreeMap, BTreeSet};

use super::Corner;

/// Cells along the longest side of the box, to begin with.
const CELLS: f64 = 256.0;

/// Triangles that are kept while more come: beyond them the grid is made wider at once.
const MOST_KEPT: usize = 200_000;

type Cell = [i16; 3];

/// Triangles between cells of a grid.
pub(super) struct Coarse {
    low: Corner,
    size: f64,
    /// Sum and number of the corners in a cell.
    cells: BTreeMap<Cell, (Corner, f64)>,
    triangles: BTreeSet<[Cell; 3]>,
}

impl Coarse {
    /// A grid over a box.
    pub(super) fn new(low: Corner, high: Corner) -> Self {
        let sides = low.iter().zip(high).map(|(low, high)| high - low);
        Self {
            low,
            size: (sides.fold(0.0, f64::max) / CELLS).max(1e-6),
            cells: BTreeMap::new(),
            triangles: BTreeSet::new(),
        }
    }

    /// Takes a triangle.
    pub(super) fn add(&mut self, triangle: [Corner; 3]) {
        let cells = triangle.map(|corner| {
            let mut cell = [0; 3];
            for at in 0..3 {
                cell[at] = ((corner[at] - self.low[at]) / self.size) as i16;
            }
            join(&mut self.cells, cell, (corner, 1.0));
            cell
        });
        keep(&mut self.triangles, cells);
        if self.triangles.len() > MOST_KEPT {
            *self = self.wider(2.0);
        }
    }

    /// At most so many triangles.
    pub(super) fn triangles(self, most: usize) -> Vec<[Corner; 3]> {
        let mut coarse = self;
        if coarse.triangles.len() > most {
            // Of a surface there are as many as the square of how fine the grid is.
            let mut width = (coarse.triangles.len() as f64 / most.max(1) as f64).sqrt();
            let fine = coarse;
            coarse = fine.wider(width);
            while coarse.triangles.len() > most {
                width *= 1.08;
                coarse = fine.wider(width);
            }
        }
        let mean = |cell: &Cell| {
            let (sum, count) = coarse.cells[cell];
            sum.map(|sum| sum / count)
        };
        let triangles = coarse.triangles.iter();
        triangles
            .map(|triangle| triangle.each_ref().map(mean))
            .collect()
    }

    /// The same on a grid whose cells are so many times as wide.
    fn wider(&self, width: f64) -> Self {
        let mut wider = Self {
            low: self.low,
            size: self.size * width,
            cells: BTreeMap::new(),
            triangles: BTreeSet::new(),
        };
        let cell = |cell: Cell| cell.map(|place| (f64::from(place) / width) as i16);
        for (place, corners) in &self.cells {
            join(&mut wider.cells, cell(*place), *corners);
        }
        for triangle in &self.triangles {
            keep(&mut wider.triangles, triangle.map(cell));
        }
        wider
    }
}

/// Corners come to those of a cell.
fn join(cells: &mut BTreeMap<Cell, (Corner, f64)>, cell: Cell, (more, number): (Corner, f64)) {
    let (sum, count) = cells.entry(cell).or_default();
    for at in 0..3 {
        sum[at] += more[at];
    }
    *count += number;
}

/// Keeps a triangle that has not shrunk, its least corner first: the same one is kept once.
fn keep(triangles: &mut BTreeSet<[Cell; 3]>, [a, b, c]: [Cell; 3]) {
    if a == b || b == c || c == a {
        return;
    }
    triangles.insert(match () {
        () if a < b && a < c => [a, b, c],
        () if b < c => [b, c, a],
        () => [c, a, b],
    });
}
