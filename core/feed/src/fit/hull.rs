//! How far a spline is off between two sites, by its hull.

use super::basis::{DEGREE, ORDER};

/// Residual, first and second derivative of the spline.
pub(super) type ResidualJet<const W: usize> = [[f64; W]; 3];

/// How often an interval is halved before its hull is believed.
const DEPTH: usize = 3;

pub(super) fn norm<const W: usize>(values: &[f64; W]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// The difference of spline and polyline between two sites as a Bézier curve.
pub(super) struct Hull<const W: usize>([[f64; W]; ORDER]);

impl<const W: usize> Hull<W> {
    /// Makes the hull from what the spline is at both ends of an interval, where the polyline has this slope.
    pub(super) fn new(
        before: &ResidualJet<W>,
        behind: &ResidualJet<W>,
        slope: &[f64; W],
        width: f64,
    ) -> Self {
        let degree = DEGREE as f64;
        let side = |jet: &ResidualJet<W>, width: f64| -> [[f64; W]; 3] {
            let first = width / degree;
            let second = first * width / (degree - 1.0);
            let mut points = [jet[0]; 3];
            for axis in 0..W {
                let tilt = first * (jet[1][axis] - slope[axis]);
                points[1][axis] += tilt;
                points[2][axis] += 2.0 * tilt + second * jet[2][axis];
            }
            points
        };
        let [a, b, c] = side(before, width);
        let [f, e, d] = side(behind, -width);
        Self([a, b, c, d, e, f])
    }

    /// A bound on its size, by control points, which it never passes; exact enough where that is more than `enough`.
    pub(super) fn bound(&self, enough: f64) -> f64 {
        self.bound_within(enough, DEPTH)
    }

    fn bound_within(&self, enough: f64, depth: usize) -> f64 {
        let hull = self.0.iter().map(norm).fold(0.0, f64::max);
        if depth == 0 || hull <= enough {
            return hull;
        }
        let halves = self.cut(0.5).map(|half| half.bound_within(enough, depth - 1));
        halves[0].max(halves[1])
    }

    /// What lies before and after a share of the interval.
    fn cut(&self, share: f64) -> [Self; 2] {
        let mut left = self.0;
        let mut right = self.0;
        for round in 1..ORDER {
            right[ORDER - round] = left[DEGREE];
            for index in (round..ORDER).rev() {
                let before = left[index - 1];
                for (value, before) in left[index].iter_mut().zip(before) {
                    *value = (1.0 - share) * before + share * *value;
                }
            }
        }
        right[0] = left[DEGREE];
        [Self(left), Self(right)]
    }

    /// The quarter of the interval where the size is largest, and what it is there.
    pub(super) fn peak(&self) -> (usize, f64) {
        let size = |quarter: usize| norm(&self.cut(0.25 * quarter as f64)[1].0[0]);
        let sizes = (0..=4).map(|quarter| (quarter, size(quarter)));
        sizes.fold((0, 0.0), |best, other| if other.1 > best.1 { other } else { best })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `x³ - x` between -1 and 1.3, against its samples: the bound holds and is close.
    #[test]
    fn the_hull_holds_what_is_inside() {
        let jet = |x: f64| [[x * x * x - x], [3.0 * x * x - 1.0], [6.0 * x]];
        let hull = Hull::new(&jet(-1.0), &jet(1.3), &[0.0], 2.3);
        let largest = (0..=1000)
            .map(|step| jet(-1.0 + 2.3 * f64::from(step) / 1000.0)[0][0].abs())
            .fold(0.0, f64::max);
        let bound = hull.bound(0.0);
        assert!(bound >= largest && bound < 1.05 * largest, "{bound} {largest}");
        assert_eq!(hull.peak().0, 4);
        // A slope of the polyline is taken off.
        let hull = Hull::new(&[[0.0], [2.0], [0.0]], &[[0.0], [2.0], [0.0]], &[2.0], 1.0);
        assert!(hull.bound(0.0) < 1e-15);
    }
}
