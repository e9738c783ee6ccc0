//! Arcs and lines laid along points: which arcs through two of them leave those between near enough, and how far one is
//! from the path at most. In the frame of the linear words, mm.
//!
//! Arcs through two ends are nested: with the tangent of a quarter of their angle (the bulge, above zero to the left of
//! the way) they move to the left everywhere. So the bulges that pass a point near enough are an interval, and those
//! that pass all points the intersection of all intervals.

use nalgebra::{Vector2, Vector3};

use super::printed_arc::{PrintedArc, in_plane};

/// A piece of an arc along one leg is checked at this many places.
const LOOKS: u32 = 4;

/// The bulges no larger than `most` of the arcs through `ends` about an axis that pass every one of `points` within
/// `within`; none if there are none.
pub(crate) fn bulges(
    axis: usize,
    [start, end]: [Vector3<f64>; 2],
    points: impl Iterator<Item = Vector3<f64>>,
    within: f64,
    most: f64,
) -> Option<[f64; 2]> {
    let chord = in_plane(axis, end - start);
    let length = chord.norm();
    if length <= 2.0 * within {
        return None;
    }
    let along = chord / length;
    let left = Vector2::new(-along.y, along.x);
    let half = length / 2.0;
    let (mut least, mut largest) = (-most, most);
    for point in points {
        let arm = in_plane(axis, point - start);
        let (x, y) = (arm.dot(&along) - half, arm.dot(&left));
        // The bulge of the arc that has the point `off` to its left: `-(y + off)·b² + slope·b + (y - off) = 0`.
        let bulge = |off: f64| {
            let slope = (x * x + y * y - half * half - off * off) / half;
            let root = libm::sqrt(slope * slope + 4.0 * (y + off) * (y - off));
            match slope < 0.0 {
                true => 2.0 * (y - off) / (root - slope),
                false => (slope + root) / (2.0 * (y + off)),
            }
        };
        let (low, high) = (bulge(within), bulge(-within));
        // So near to an end that it says nothing.
        if low.is_nan() || high.is_nan() {
            continue;
        }
        least = least.max(low.min(high));
        largest = largest.min(low.max(high));
        if least > largest {
            return None;
        }
    }
    Some([least, largest])
}

/// Sense and centre of the arc through `ends` with this bulge; none for a line.
pub(crate) fn by_bulge(
    axis: usize,
    [start, end]: [Vector3<f64>; 2],
    bulge: f64,
) -> Option<(f64, Vector3<f64>)> {
    if bulge == 0.0 {
        return None;
    }
    let chord = in_plane(axis, end - start);
    let left = Vector2::new(-chord.y, chord.x) * (-(1.0 - bulge * bulge) / (4.0 * bulge));
    let mut centre = (start + end) / 2.0;
    centre[axis] = start[axis];
    centre[(axis + 1) % 3] += left.x;
    centre[(axis + 2) % 3] += left.y;
    Some((-libm::copysign(1.0, bulge), centre))
}

impl PrintedArc {
    /// A bound on how far the arc is from a `path` of straight legs, both gone along in order; infinite as soon as it is
    /// more than `most`.
    ///
    /// Each corner of the path has the share of the arc at which that is beside it, and no lesser one than the corner
    /// before. Over a leg the difference has the second derivative of the arc alone, so that it strays from the chord
    /// between two looks by no more than an eighth of that.
    pub(crate) fn off_path(&self, path: &[Vector3<f64>], most: f64) -> f64 {
        let (mut worst, mut before): (f64, f64) = (0.0, 0.0);
        let largest = self.radii[0].max(self.radii[1]);
        let last = path.len().saturating_sub(2);
        for (leg, pair) in path.windows(2).enumerate() {
            let next = match leg == last {
                true => 1.0,
                false => self.beside(pair[1], before),
            };
            let turn = self.turn * (next - before);
            let bend = turn * (largest * turn + 2.0 * self.mismatch() * (next - before));
            let blind = bend / f64::from(8 * LOOKS * LOOKS);
            for look in 0..=LOOKS {
                let share = f64::from(look) / f64::from(LOOKS);
                let place = self.at(before + (next - before) * share);
                let wanted = pair[0] * (1.0 - share) + pair[1] * share;
                worst = worst.max((place - wanted).norm() + blind);
            }
            if worst > most {
                return f64::INFINITY;
            }
            before = next;
        }
        worst
    }

    /// The share of the arc that is beside a place, no less than `least`.
    fn beside(&self, place: Vector3<f64>, least: f64) -> f64 {
        let arm = in_plane(self.axis, place - self.centre);
        let angle = self.sense * (libm::atan2(arm.y, arm.x) - self.from);
        let near = least * self.turn;
        let ahead = near + super::printed_arc::least_turn(angle - near);
        (ahead / self.turn).clamp(least, 1.0)
    }
}

/// How far the straight line between `ends` is from a `path` of straight legs, both gone along in order.
pub(crate) fn off_line([start, end]: [Vector3<f64>; 2], path: &[Vector3<f64>]) -> f64 {
    let way = end - start;
    let square = way.norm_squared();
    let (mut worst, mut share): (f64, f64) = (0.0, 0.0);
    let last = path.len().saturating_sub(1);
    for (corner, place) in path.iter().enumerate() {
        if corner == last {
            share = 1.0;
        } else if corner > 0 && square > 0.0 {
            share = ((place - start).dot(&way) / square).clamp(share, 1.0);
        }
        worst = worst.max((start + way * share - place).norm());
    }
    worst
}
