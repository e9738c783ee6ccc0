//! Splines cut where their first or second derivatives jump.

use nalgebra::Vector3;
use post_machine::kinematics::ORDERS;
use post_motion::path::BSpline;

use super::file::{Pointing, Splines};

/// First and second derivatives that differ by no more, as a share, are the same on both sides of a knot.
const SMOOTH: f64 = 1e-6;

/// A part of splines: its first control point, and how many.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SplinePart {
    first: usize,
    count: usize,
}

impl SplinePart {
    pub fn curve<const D: usize>(self, splines: &Splines, points: &[[f64; D]]) -> BSpline<D> {
        let mut curve = self.unweighted(splines, points);
        for ((_, weight), told) in
            curve.poles.iter_mut().zip(splines.weights.iter().skip(self.first))
        {
            *weight = *told;
        }
        curve
    }

    pub fn unweighted<const D: usize>(self, splines: &Splines, points: &[[f64; D]]) -> BSpline<D> {
        let knots = &splines.knots[self.first..self.first + self.count + splines.degree + 1];
        let points = points[self.first..self.first + self.count].iter().copied();
        BSpline::unweighted(splines.degree, knots.to_vec(), points)
    }
}

/// The parts between knots at which first or second derivatives of the tip jump, or the tool axis may.
pub fn smooth_parts(splines: &Splines) -> Vec<SplinePart> {
    let (degree, count) = (splines.degree, splines.tip.len());
    let mut parts = vec![SplinePart { first: 0, count }];
    let mut at = degree + 1;
    while at < count {
        let times =
            (at..count).take_while(|place| splines.knots[*place] == splines.knots[at]).count();
        // Of degree less the times that a knot stands are the derivatives that are continuous there.
        if degree < times + 2 {
            let last = parts.len() - 1;
            let whole = parts[last];
            let before = SplinePart { first: whole.first, count: at - whole.first };
            let first = at + times - degree - 1;
            let after = SplinePart { first, count: count - first };
            if jumps(splines, before, after) {
                parts[last] = before;
                parts.push(after);
            }
        }
        at += times;
    }
    parts
}

/// Whether derivatives differ where one part meets the next.
fn jumps(splines: &Splines, before: SplinePart, after: SplinePart) -> bool {
    let differ = |left: [Vector3<f64>; ORDERS], right: [Vector3<f64>; ORDERS]| {
        // What is rounding of a line's second derivative is no jump.
        let rounding = 1e-9 * left[1].norm();
        (0..3).any(|order| {
            let (a, b) = (left[order], right[order]);
            (a - b).norm() > SMOOTH * (a.norm() + b.norm()) + rounding
        })
    };
    let differs = |points: &[[f64; 3]]| {
        let (left, right) = (before.curve(splines, points), after.curve(splines, points));
        differ(left.derivatives(left.range()[1]), right.derivatives(right.range()[0]))
    };
    differs(&splines.tip)
        || match &splines.pointing {
            Pointing::Fixed => false,
            Pointing::Second(points) | Pointing::Axis(points) => differs(points),
            // Control values of angles are seldom so arranged.
            Pointing::Rotary(_) => true,
        }
}
