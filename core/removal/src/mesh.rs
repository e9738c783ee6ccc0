//! A stock from a closed mesh.

use nalgebra::Vector3;

use crate::field::Field;
use crate::rays::{Rays, Stretch};

/// A triangle, mm.
pub type Triangle = [Vector3<f64>; 3];

impl Field {
    /// What a closed mesh encloses, in a box from the origin to a corner, mm.
    pub fn mesh(size: Vector3<f64>, triangles: &[Triangle], resolution: f64) -> Self {
        let mut field = Self::empty(size, resolution);
        for rays in field.upper.iter_mut() {
            let bands = Bands::of(rays, triangles);
            bands.fill(rays, true);
        }
        let bands = Bands::of(&field.lower, triangles);
        bands.fill(&mut field.lower, false);
        field
    }
}

/// Where the surface of a mesh runs through prisms.
struct Bands {
    /// Of each prism the stretches that hold surface.
    surface: Vec<Vec<Stretch>>,
    /// Of each prism where the line through its middle passes the surface, and whether it comes out there.
    passes: Vec<Vec<(f64, bool)>>,
}

impl Bands {
    fn of(rays: &Rays, triangles: &[Triangle]) -> Self {
        let counts = rays.counts();
        let all = counts[0] * counts[1];
        let mut bands = Self { surface: vec![Vec::new(); all], passes: vec![Vec::new(); all] };
        let [u, v] = rays.section();
        let cell = rays.cells();
        for triangle in triangles {
            // In cells of the section, and mm along the axis.
            let flat = triangle.map(|corner| {
                Vector3::new(corner[u] / cell[0], corner[v] / cell[1], corner[rays.axis()])
            });
            let range = |index: usize| {
                let ends = flat.iter().map(|corner| corner[index]);
                let low = ends.clone().fold(f64::INFINITY, f64::min) - 1e-6;
                let high = ends.fold(f64::NEG_INFINITY, f64::max) + 1e-6;
                let most = counts[index] as f64;
                let [low, high] = [libm::floor(low), libm::ceil(high)];
                low.clamp(0.0, most) as usize..high.clamp(0.0, most) as usize
            };
            for row in range(1) {
                for column in range(0) {
                    let place = row * counts[0] + column;
                    let low = Vector3::new(column as f64, row as f64, 0.0);
                    bands.surface[place].extend(clipped(&flat, low));
                    let middle = low + Vector3::new(0.5, 0.5, 0.0);
                    bands.passes[place].extend(pass(&flat, middle));
                }
            }
        }
        bands
    }

    /// Sets what is left: between bands of surface what is inside by the passes below it, and the bands themselves or not.
    fn fill(mut self, rays: &mut Rays, surface: bool) {
        let counts = rays.counts();
        for (place, bands) in self.surface.iter_mut().enumerate() {
            bands.sort_by(|one, other| one[0].total_cmp(&other[0]));
            let mut merged: Vec<Stretch> = Vec::new();
            for [low, high] in bands.drain(..) {
                match merged.last_mut() {
                    Some(last) if low <= last[1] => last[1] = last[1].max(high),
                    _ => merged.push([low, high]),
                }
            }
            let passes = &self.passes[place];
            let inside = |at: f64| {
                let below = passes.iter().filter(|(height, _)| *height < at);
                below.map(|(_, out)| if *out { -1 } else { 1 }).sum::<i32>() != 0
            };
            let gaps = merged.windows(2).map(|pair| [pair[0][1], pair[1][0]]);
            let gaps: Vec<Stretch> =
                gaps.filter(|[low, high]| inside(0.5 * (low + high))).collect();
            let mut left: Vec<Stretch> = match surface {
                true => merged.iter().chain(&gaps).copied().collect(),
                false => gaps,
            };
            left.sort_by(|one, other| one[0].total_cmp(&other[0]));
            left.dedup_by(|next, last| {
                let meets = next[0] <= last[1];
                if meets {
                    last[1] = last[1].max(next[1]);
                }
                meets
            });
            rays.set([place % counts[0], place / counts[0]], &left);
        }
    }
}

/// From where to where a triangle goes along the axis within the cell with its low corner at `low`, one wide and a little
/// more.
fn clipped(triangle: &Triangle, low: Vector3<f64>) -> Option<Stretch> {
    const AROUND: f64 = 1e-6;
    let mut corners = triangle.to_vec();
    for (axis, sense) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
        let edge = if sense > 0.0 { low[axis] - AROUND } else { low[axis] + 1.0 + AROUND };
        let inside = |corner: &Vector3<f64>| sense * (corner[axis] - edge);
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (place, corner) in corners.iter().enumerate() {
            let before = &corners[(place + corners.len() - 1) % corners.len()];
            let [from, to] = [inside(before), inside(corner)];
            if (from < 0.0) != (to < 0.0) {
                kept.push(before + (corner - before) * (from / (from - to)));
            }
            if to >= 0.0 {
                kept.push(*corner);
            }
        }
        corners = kept;
    }
    let heights = corners.iter().map(|corner| corner.z);
    let stretch = heights.fold(None, |stretch: Option<Stretch>, height| {
        let [low, high] = stretch.unwrap_or([height; 2]);
        Some([low.min(height), high.max(height)])
    });
    stretch.map(|[low, high]| [low - AROUND, high + AROUND])
}

/// Where the line through `at` passes a triangle, and whether it comes out of the body there. Of an edge that two triangles
/// share one of them has the line: the sign of a product of the same numbers is the same.
fn pass(triangle: &Triangle, at: Vector3<f64>) -> Option<(f64, bool)> {
    let side = |from: &Vector3<f64>, to: &Vector3<f64>| {
        // From the lower corner to the higher one, whichever triangle asks.
        let swap = (to.x, to.y) < (from.x, from.y);
        let [from, to] = if swap { [to, from] } else { [from, to] };
        let area = (to.x - from.x) * (at.y - from.y) - (to.y - from.y) * (at.x - from.x);
        if swap { -area } else { area }
    };
    let [a, b, c] = triangle;
    let sides = [side(b, c), side(c, a), side(a, b)];
    let left = |side: f64| side > 0.0 || (side == 0.0 && side.is_sign_positive());
    let turns = sides.map(left);
    if turns != [true; 3] && turns != [false; 3] {
        return None;
    }
    let sum: f64 = sides.iter().sum();
    if sum == 0.0 {
        return None;
    }
    let height = (a.z * sides[0] + b.z * sides[1] + c.z * sides[2]) / sum;
    Some((height, sum > 0.0))
}
