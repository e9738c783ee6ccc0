//! Curves that are planned along: those of the file, and those that are laid through its points.

use post_feed::fit::{self, FitRules, FittedLeg, PathFit};
use post_motion::path::BSpline;

/// Derivatives that are known at the start of a piece, with its value.
const ORDERS: usize = 4;

const FACTORIALS: [f64; ORDERS] = [1.0, 1.0, 2.0, 6.0];

/// A curve of `D` coordinates by its parameter.
pub enum Track<const D: usize> {
    /// As the file has it.
    Spline(BSpline<D>),
    /// Through points.
    Pieces(Pieces<D>),
}

impl<const D: usize> Track<D> {
    /// Value and first to third derivative.
    pub fn derivatives(&self, parameter: f64) -> [[f64; D]; ORDERS] {
        match self {
            Self::Spline(curve) => curve.derivatives(parameter).map(Into::into),
            Self::Pieces(pieces) => pieces.derivatives(parameter),
        }
    }

    /// Where third derivatives may jump, and the ends.
    pub fn breaks(&self) -> Vec<f64> {
        match self {
            Self::Spline(curve) => curve.breaks().collect(),
            Self::Pieces(pieces) => pieces.knots.clone(),
        }
    }
}

/// Polynomials of degree five between knots.
#[derive(Default)]
pub struct Pieces<const D: usize> {
    knots: Vec<f64>,
    /// Coefficients of each by the parameter from its knot on, the constant first.
    polynomials: Vec<[[f64; D]; 6]>,
}

impl<const D: usize> Pieces<D> {
    /// The next polynomial, of degree five: value and derivatives at its start, value and first derivative at its end
    /// say all of it.
    fn push(&mut self, [from, to]: [f64; 2], start: [[f64; D]; ORDERS], end: [[f64; D]; ORDERS]) {
        let step = to - from;
        let mut polynomial = [[0.0; D]; 6];
        for axis in 0..D {
            let low: [f64; ORDERS] =
                std::array::from_fn(|order| start[order][axis] / FACTORIALS[order]);
            let value = low.iter().rev().fold(0.0, |sum, part| sum * step + part);
            let slope = low[1] + step * (2.0 * low[2] + step * 3.0 * low[3]);
            // What the last two powers have to add: a step⁴ + b step⁵ to the value, their derivative to the slope.
            let (miss, bend) = (end[0][axis] - value, end[1][axis] - slope);
            let fourth = step * step * step * step;
            for (order, low) in low.into_iter().enumerate() {
                polynomial[order][axis] = low;
            }
            polynomial[4][axis] = (5.0 * miss - bend * step) / fourth;
            polynomial[5][axis] = (bend * step - 4.0 * miss) / (fourth * step);
        }
        if self.knots.is_empty() {
            self.knots.push(from);
        }
        self.knots.push(to);
        self.polynomials.push(polynomial);
    }

    fn derivatives(&self, parameter: f64) -> [[f64; D]; ORDERS] {
        let last = self.knots.len() - 1;
        let at = parameter.clamp(self.knots[0], self.knots[last]);
        let place = self.knots[1..last].partition_point(|knot| *knot <= at);
        let way = at - self.knots[place];
        let mut all = [[0.0; D]; ORDERS];
        for (order, values) in all.iter_mut().enumerate() {
            for power in (order..6).rev() {
                let factor: usize = (power - order + 1..=power).product();
                for (value, part) in values.iter_mut().zip(&self.polynomials[place][power]) {
                    *value = *value * way + part * factor as f64;
                }
            }
        }
        all
    }
}

/// A smooth piece of a path through points: the tip, and the rotary axes.
#[derive(Default)]
pub struct SmoothPiece {
    pub tip: Pieces<3>,
    pub rotary: Vec<Pieces<1>>,
    /// Parameters of the points.
    pub points: Vec<f64>,
}

/// Lays smooth curves through points: the tip in mm, then `rotary` axes in radians. Between two curves there is a corner.
pub fn through(points: &[fit::FitPoint], rotary: usize, tolerance: f64) -> Vec<SmoothPiece> {
    let mut fit =
        PathFit::new(FitRules { dimensions: 3 + rotary, tolerance, ..FitRules::default() });
    let mut pieces: Vec<SmoothPiece> = Vec::new();
    let mut at = 0.0;
    let mut take = |leg: &FittedLeg<'_>| {
        if leg.length <= 0.0 {
            return;
        }
        if leg.begins || pieces.is_empty() {
            let mut piece = SmoothPiece::default();
            piece.rotary.resize_with(rotary, Pieces::default);
            piece.points.push(at);
            pieces.push(piece);
        }
        let last = pieces.len() - 1;
        let piece = &mut pieces[last];
        for pair in leg.samples.windows(2) {
            let ends = [at + pair[0].at, at + pair[1].at];
            let [start, end] = [0, 1].map(|side: usize| pair[side].values);
            let tip = |values: [fit::FitPoint; ORDERS]| values.map(|all| [all[0], all[1], all[2]]);
            piece.tip.push(ends, tip(start), tip(end));
            for (axis, turning) in piece.rotary.iter_mut().enumerate() {
                let angle = |values: [fit::FitPoint; ORDERS]| values.map(|all| [all[3 + axis]]);
                turning.push(ends, angle(start), angle(end));
            }
        }
        at += leg.length;
        piece.points.push(at);
    };
    for point in points {
        fit.push(point, &mut take);
    }
    fit.cut(&mut take);
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_through_points_of_an_arc_is_smooth_and_near() {
        let points: Vec<fit::FitPoint> = (0..=60)
            .map(|index| {
                let angle = f64::from(index) / 40.0;
                let mut point = [0.0; fit::MOST];
                let (sine, cosine) = libm::sincos(angle);
                (point[0], point[1], point[3]) = (20.0 * cosine, 20.0 * sine, angle);
                point
            })
            .collect();
        let pieces = through(&points, 1, 0.01);
        assert_eq!(pieces.len(), 1);
        let tip = Track::Pieces(pieces.into_iter().next().unwrap().tip);
        let knots = tip.breaks();
        let (first, last) = (knots[0], knots[knots.len() - 1]);
        // The parameter counts turns too, 10 mm a radian.
        let length = libm::hypot(30.0, 15.0);
        assert!((last - first - length).abs() < 0.1);
        for knot in &knots[1..] {
            let [left, right] = [knot - 1e-7, knot + 1e-7].map(|at| tip.derivatives(at));
            for order in 0..ORDERS {
                for axis in 0..3 {
                    let off = (left[order][axis] - right[order][axis]).abs();
                    assert!(off < 1e-4 || *knot > last - 1e-6, "{order} {off}");
                }
            }
        }
        for step in 0..=300 {
            let [at, slope, ..] = tip.derivatives(first + (last - first) * f64::from(step) / 300.0);
            assert!((libm::hypot(at[0], at[1]) - 20.0).abs() < 0.02);
            assert!((libm::hypot(slope[0], slope[1]) - 30.0 / length).abs() < 0.01);
        }
    }
}
