//! How far a body is from what may be left.

use nalgebra::Vector3;
use post_clearance::ALLOWANCE;
use post_clearance::convex::Convex;
use post_clearance::distance::{Apart, meeting, of_convex};

use crate::field::{Field, TILE};
use crate::rays::{Span, Stretch, within};

/// Boxes that are no nearer than this share of the nearest found are not looked at.
const CLOSE: f64 = 0.98;

/// Lines that are looked at for what is left for certain, in each direction.
const MOST_LINES: usize = 48;

/// Planes that are remembered of a search: the walls of a slot, its floor, and more.
const MOST_PLANES: usize = 6;

/// A box along the axes, from corner to corner, mm.
type Block = [Vector3<f64>; 2];

impl Field {
    /// How far a body is from what may be left, both in the frame of the field: a lower bound, and what was found. What is
    /// there may be farther away than that; nothing is nearer than the lower bound.
    pub fn apart(&mut self, pieces: &[Convex]) -> Apart {
        self.look_up_tiles();
        let spheres = pieces.iter().map(Convex::sphere).collect();
        let nothing = Apart {
            at_least: f64::INFINITY,
            at_most: f64::INFINITY,
            points: [Vector3::zeros(); 2],
            nearest: [0; 2],
            along: Vector3::zeros(),
        };
        let mut search = Search {
            pieces,
            spheres,
            best: nothing,
            passed: f64::INFINITY,
            planes: Vec::new(),
            next: 0,
            at: None,
        };
        // What was nearest the last time may be gone: a cell of it that is left is near all the same.
        if let Some(guess) = self.guess {
            let middle = (guess[0] + guess[1]) * 0.5;
            let cells = [0, 1].map(|axis| (middle[axis] / self.grid.cell[axis]) as usize);
            self.prism(&mut search, cells);
        }
        let width = self.grid.counts[0].div_ceil(TILE);
        let tiles = self.tiles.iter().enumerate();
        let mut tiles: Vec<(f64, usize)> = tiles
            .filter_map(|(place, range)| {
                let block = self.tile([place % width, place / width], (*range)?);
                Some((search.bound(&block), place))
            })
            .collect();
        tiles.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        for (bound, place) in tiles {
            if search.passes(bound) {
                // Those that follow are no nearer.
                break;
            }
            let Some(range) = self.tiles[place] else { continue };
            let tile = [place % width, place / width];
            if search.passes(search.plane_bound(&self.tile(tile, range))) {
                continue;
            }
            let [columns, rows] = tile_places(tile, self.grid.counts);
            for row in rows {
                for column in columns.clone() {
                    self.prism(&mut search, [column, row]);
                }
            }
        }
        self.guess = search.at;
        let mut apart = search.best;
        apart.at_least = apart.at_least.min(search.passed).max(0.0);
        apart
    }

    /// A point that is left for certain in a body, both in the frame of the field, on a line through the middle of a prism: of
    /// many no more than [`MOST_LINES`] in each direction are looked at.
    pub fn common_of(&self, pieces: &[Convex]) -> Option<Vector3<f64>> {
        pieces.iter().find_map(|piece| {
            let [low, high] = piece.extents();
            let prisms = |axis: usize| {
                let count = self.lower.counts()[axis];
                let [from, to] = [low, high].map(|end| end[axis] / self.grid.cell[axis]);
                let prisms = from.max(0.0) as usize..(libm::ceil(to).max(0.0) as usize).min(count);
                let step = prisms.len().div_ceil(MOST_LINES).max(1);
                prisms.step_by(step)
            };
            let mut places = prisms(1).flat_map(|row| prisms(0).map(move |column| [column, row]));
            places.find_map(|place| {
                let [x, y] = [0, 1].map(|axis| (place[axis] as f64 + 0.5) * self.grid.cell[axis]);
                within(self.lower.at(place), [low.z, high.z]).find_map(|ends| {
                    let ends = ends.map(|z| Vector3::new(x, y, z));
                    let line = Convex::frustum(ends, Vector3::z(), [0.0; 2]);
                    let meets = of_convex(piece, &line).at_most <= 0.0;
                    meets.then(|| meeting(piece, &line)[1])
                })
            })
        })
    }

    /// Looks at what may be left in a prism along Z.
    fn prism(&self, search: &mut Search<'_>, [column, row]: [usize; 2]) {
        let [columns, rows, _] = self.grid.counts;
        if column >= columns || row >= rows {
            return;
        }
        for span in self.upper[2].at([column, row]) {
            let span: Stretch = span.map(f64::from);
            let whole = self.grid.block([column, row], span);
            if search.passes(search.bound(&whole).max(search.plane_bound(&whole))) {
                continue;
            }
            let layers = self.grid.counts[2] - 1;
            let [first, last] =
                span.map(|end| ((end / self.grid.cell.z).max(0.0) as usize).min(layers));
            for layer in first..=last {
                if let Some(block) = self.cell_left([column, row, layer], &whole) {
                    search.block(&block);
                }
            }
        }
    }

    /// What all three directions may have left of a cell within a box.
    fn cell_left(&self, place: [usize; 3], within: &Block) -> Option<Block> {
        let mut block = *within;
        for (axis, rays) in self.upper.iter().enumerate().rev() {
            let cell = self.grid.cell[axis];
            let from = place[axis] as f64 * cell;
            let ends = [from.max(within[0][axis]), (from + cell).min(within[1][axis])];
            // Of the highest layer what rounding has put beyond it.
            let top = place[axis] + 1 == self.grid.counts[axis];
            let ends = if top { [ends[0], within[1][axis]] } else { ends };
            let section = rays.section().map(|axis| place[axis]);
            let [low, high] = rays.hull(section, ends)?;
            (block[0][axis], block[1][axis]) = (low, high);
        }
        Some(block)
    }

    /// The box around what may be left of a tile.
    fn tile(&self, tile: [usize; 2], range: Stretch) -> Block {
        let cell = &self.grid.cell;
        let [columns, rows] = tile_places(tile, self.grid.counts);
        let [low, high] = [[columns.start, rows.start], [columns.end, rows.end]]
            .map(|place| [place[0] as f64 * cell.x, place[1] as f64 * cell.y]);
        [Vector3::new(low[0], low[1], range[0]), Vector3::new(high[0], high[1], range[1])]
    }

    fn look_up_tiles(&mut self) {
        let width = self.grid.counts[0].div_ceil(TILE);
        for (place, range) in self.tiles.iter_mut().enumerate() {
            if range.is_some() {
                continue;
            }
            let [columns, rows] = tile_places([place % width, place / width], self.grid.counts);
            let places = rows.flat_map(|row| columns.clone().map(move |column| [column, row]));
            let spans = places.flat_map(|place| self.upper[2].at(place));
            let empty = [f64::INFINITY, f64::NEG_INFINITY];
            *range = Some(spans.fold(empty, |[low, high], span: &Span| {
                [low.min(f64::from(span[0])), high.max(f64::from(span[1]))]
            }));
        }
    }
}

/// Places of the prisms of a tile.
fn tile_places(tile: [usize; 2], counts: [usize; 3]) -> [std::ops::Range<usize>; 2] {
    [0, 1].map(|axis: usize| tile[axis] * TILE..((tile[axis] + 1) * TILE).min(counts[axis]))
}

struct Search<'a> {
    pieces: &'a [Convex],
    spheres: Vec<(Vector3<f64>, f64)>,
    best: Apart,
    /// The least that is proven of what was not looked at, mm.
    passed: f64,
    /// Across planes between the body and boxes that were near, the latest, and how far the body goes along each, mm.
    planes: Vec<(Vector3<f64>, f64)>,
    /// The place of the one that is replaced next.
    next: usize,
    /// The nearest box.
    at: Option<Block>,
}

impl Search<'_> {
    /// Boxes that are no nearer than this need not be looked at, which is remembered.
    fn passes(&mut self, bound: f64) -> bool {
        let passes = bound >= CLOSE * self.best.at_most || self.best.at_most <= 0.0;
        if passes {
            self.passed = self.passed.min(bound);
        }
        passes
    }

    /// No piece is nearer to a box than this by its sphere, mm.
    fn bound(&self, block: &Block) -> f64 {
        let bounds = self.spheres.iter().map(|sphere| from_sphere(block, sphere));
        bounds.fold(f64::INFINITY, f64::min)
    }

    /// The same by the planes that hold near ones apart.
    fn plane_bound(&self, block: &Block) -> f64 {
        let [low, high] = block;
        let bound = |(along, far): &(Vector3<f64>, f64)| {
            let least = |along: f64, low: f64, high: f64| (along * low).min(along * high);
            along.zip_zip_map(low, high, least).sum() - far - ALLOWANCE
        };
        self.planes.iter().map(bound).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Remembers the planes across a direction.
    fn remember(&mut self, along: Vector3<f64>) {
        let reach = |piece: &Convex| along.dot(&piece.core.support(along)) + piece.round;
        let far = self.pieces.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
        match self.planes.get_mut(self.next) {
            Some(place) => *place = (along, far),
            None => self.planes.push((along, far)),
        }
        self.next = (self.next + 1) % MOST_PLANES;
    }

    fn block(&mut self, block: &Block) {
        let bound = self.plane_bound(block);
        if self.passes(bound) {
            return;
        }
        let body = Convex::block(block[0], block[1]);
        for place in 0..self.pieces.len() {
            let bound = from_sphere(block, &self.spheres[place]);
            if self.passes(bound) {
                continue;
            }
            let found = of_convex(&self.pieces[place], &body);
            let nearer = found.at_most < self.best.at_most;
            let at_least = self.best.at_least.min(found.at_least);
            if found.along != Vector3::zeros() {
                self.remember(found.along);
            }
            if nearer {
                self.at = Some(*block);
                self.best = found;
                if found.at_most <= 0.0 {
                    self.best.points = meeting(&self.pieces[place], &body);
                }
            }
            self.best.at_least = at_least;
        }
    }
}

/// No point of a box is nearer to a sphere than this, mm.
fn from_sphere(block: &Block, (centre, radius): &(Vector3<f64>, f64)) -> f64 {
    let nearest = centre.sup(&block[0]).inf(&block[1]);
    (nearest - centre).norm() - radius - ALLOWANCE
}
