//! What is left against the part that is wanted: where it is cut into, and where something is left on it.

use nalgebra::Vector3;
use post_clearance::convex::Convex;
use post_clearance::distance::{Apart, of_shapes};
use post_clearance::placement::Placement;
use post_clearance::shape::Shape;

use crate::field::{Field, Volume};
use crate::rays::{Span, Stretch};

/// How far something is from the surface of the part at most, between two bounds, mm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Farthest {
    /// It is as far at `point`.
    pub at_least: f64,
    /// It is nowhere farther.
    pub at_most: f64,
    /// Where, frame of the field.
    pub point: Vector3<f64>,
}

/// What is left against the part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Compared {
    /// Volume of the part that is gone.
    pub gouge: Volume,
    /// How deep that is in the part.
    pub deepest: Farthest,
    /// Volume that is left beside the part.
    pub rest: Volume,
    /// How thick that is on the part.
    pub thickest: Farthest,
}

/// The surface of a mesh, corners in mm: its triangles alone, so that what is inside is as far from it as from them. None
/// where no triangle has an area.
pub fn surface_of(triangles: &[[Vector3<f64>; 3]]) -> Option<Shape> {
    let kept = triangles.iter().filter(|[a, b, c]| a != b && b != c && c != a);
    Shape::new(kept.copied().map(Convex::triangle).collect())
}

/// How far points are from a surface.
#[derive(Debug)]
pub struct Nearness<'a> {
    surface: &'a Shape,
    dot: Shape,
    guess: [usize; 2],
}

impl<'a> Nearness<'a> {
    /// Of points from `surface`.
    pub fn of(surface: &'a Shape) -> Option<Self> {
        let dot = Shape::new(vec![Convex::ball(Vector3::zeros(), 0.0)])?;
        Some(Self { surface, dot, guess: [0; 2] })
    }

    /// A point is no farther than this, mm.
    pub fn from(&mut self, point: Vector3<f64>) -> f64 {
        self.apart(point).at_most
    }

    fn apart(&mut self, point: Vector3<f64>) -> Apart {
        let at = Placement { shift: point, ..Placement::identity() };
        let apart = of_shapes(self.surface, &self.dot, &at, self.guess, f64::INFINITY);
        self.guess = apart.nearest;
        apart
    }
}

/// One of the two, as it is certainly and as it may be.
#[derive(Clone, Copy)]
struct Solid<'a>(&'a Field);

impl Field {
    /// What is left against a part, of which `part` is a field of the same size and resolution and `surface` that of its
    /// mesh ([`surface_of`]), all in the frame of the field.
    pub fn compare(&self, part: &Self, surface: &Shape) -> Compared {
        let (left, part) = (Solid(self), Solid(part));
        let [gouge, rest] = [part.without(left), left.without(part)];
        let deepest = part.farthest(left, surface);
        let thickest = left.farthest(part, surface);
        Compared { gouge, deepest, rest, thickest }
    }

    fn prisms(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [columns, rows, _] = self.grid.counts;
        (0..rows).flat_map(move |row| (0..columns).map(move |column| [column, row]))
    }
}

impl Solid<'_> {
    /// Volume of what is in this one and not in the other.
    fn without(self, other: Self) -> Volume {
        let length = |one: &[Span], other: &[Span]| -> f64 {
            self.within(one, other).iter().map(|[low, high]| high - low).sum()
        };
        let mut volume = Volume::default();
        for place in self.0.prisms() {
            volume.at_least += length(self.0.lower.at(place), other.0.upper[2].at(place));
            volume.at_most += length(self.0.upper[2].at(place), other.0.lower.at(place));
        }
        let area = self.0.lower.area();
        Volume { at_least: volume.at_least * area, at_most: volume.at_most * area }
    }

    /// What of some spans is not in others, within the grid.
    fn within(self, one: &[Span], other: &[Span]) -> Vec<Stretch> {
        let top = self.0.grid.cell.z * self.0.grid.counts[2] as f64;
        let mut parts = Vec::new();
        for span in one {
            let [mut low, high] = [f64::from(span[0]).max(0.0), f64::from(span[1]).min(top)];
            for [from, to] in other.iter().map(|span| span.map(f64::from)) {
                if from > low && low < high {
                    parts.push([low, from.min(high)]);
                }
                low = low.max(to);
            }
            parts.push([low, high]);
        }
        parts.retain(|[low, high]| low < high);
        parts
    }

    /// How far what is in this one and not in the other is from the surface of the part.
    fn farthest(self, other: Self, surface: &Shape) -> Farthest {
        let cell = self.0.grid.cell;
        let mut farthest = Farthest::default();
        let Some(mut near) = Nearness::of(surface) else {
            return Farthest { at_most: f64::INFINITY, ..farthest };
        };
        // The distance of the last point that was asked for: of one beside it, it is no more than the way between longer.
        let mut last: Option<(Vector3<f64>, f64)> = None;
        for place in self.0.prisms() {
            for [low, high] in self.within(self.0.upper[2].at(place), other.0.lower.at(place)) {
                let steps = libm::ceil((high - low) / cell.z).max(1.0);
                let height = (high - low) / steps;
                let around = 0.5 * Vector3::new(cell.x, cell.y, height).norm();
                for step in 0..steps as u64 {
                    let [x, y] = place.map(|place| place as f64 + 0.5);
                    let z = low + (step as f64 + 0.5) * height;
                    let point = Vector3::new(x * cell.x, y * cell.y, z);
                    let bound = last.map_or(f64::INFINITY, |(at, far)| far + (point - at).norm());
                    if bound + around <= farthest.at_most && bound <= farthest.at_least {
                        continue;
                    }
                    let apart = near.apart(point);
                    last = Some((point, apart.at_most));
                    farthest.at_most = farthest.at_most.max(apart.at_most + around);
                    let certain = self.0.holds(point) && !other.0.may_hold(point);
                    if certain && apart.at_least > farthest.at_least {
                        (farthest.at_least, farthest.point) = (apart.at_least, point);
                    }
                }
            }
        }
        farthest
    }
}
