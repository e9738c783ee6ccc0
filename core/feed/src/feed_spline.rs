//! The feed of a plan as a spline along the path: the last step of the feedrate paper (section 3.2).
//!
//! The paper fits a spline to the feed itself. Off from rest that cannot be: the feed begins as the square root of the
//! way, and a polynomial feed of the way never leaves rest. `q = (ds/dt)²` begins as the way itself, so the spline is one
//! of `q`: of degree 2, so that acceleration is continuous. The feed is `|dP/ds| * sqrt(q)`.

use crate::jerk::{IntervalLaw, Law};

/// `q = (ds/dt)²` by the path parameter: pieces between knots, value and slope continuous.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FeedSpline {
    /// Parameters at which pieces meet, from the first to the last, growing.
    pub knots: Vec<f64>,
    /// `q` between each knot and the next.
    pub pieces: Vec<IntervalLaw>,
}

impl FeedSpline {
    /// Makes the spline of a plan whose `q` is linear between samples: each corner of it is rounded by the parabola
    /// that touches both sides half the shorter step off the sample.
    ///
    /// The parabola stays inside the corner, so what is a limit of `q` and its slope *at the sample* is kept; beside it
    /// both are by a term of first order in the step. [`FeedSpline::slow`] makes up for it where it counts.
    ///
    /// # Panics
    /// If there are fewer than two samples, or not one `q` for each.
    #[must_use]
    pub fn rounded(parameters: &[f64], q: &[f64]) -> Self {
        assert!(parameters.len() == q.len() && q.len() > 1, "a q for each of two samples or more");
        let last = q.len() - 1;
        let mut spline =
            Self { knots: vec![parameters[0]], pieces: Vec::with_capacity(2 * q.len()) };
        let mut at = q[0];
        for sample in 1..last {
            let [before, here, next] =
                [parameters[sample - 1], parameters[sample], parameters[sample + 1]];
            let half = 0.5 * (here - before).min(next - here);
            let side = |step: f64, other: f64| q[sample] + (other - q[sample]) * half / step;
            let left = side(here - before, q[sample - 1]);
            let right = side(next - here, q[sample + 1]);
            spline.line(here - half, &mut at, left);
            spline.pieces.push(IntervalLaw::Quadratic([left, q[sample], right]));
            spline.knots.push(here + half);
            at = right;
        }
        spline.line(parameters[last], &mut at, q[last]);
        if let Some(knot) = spline.knots.last_mut() {
            *knot = parameters[last];
        }
        spline
    }

    /// A straight piece up to `knot`, unless the last piece ends there.
    fn line(&mut self, knot: f64, at: &mut f64, to: f64) {
        let from = self.knots[self.knots.len() - 1];
        let size = knot.abs().max(from.abs());
        if knot - from > 1e-13 * size {
            let middle = f64::midpoint(*at, to);
            self.pieces.push(IntervalLaw::Quadratic([*at, middle, to]));
            self.knots.push(knot);
        }
        *at = to;
    }

    /// Makes the spline of a plan with jerk limits, whose law is such a spline, over the samples that it was made for.
    ///
    /// # Panics
    /// If there is not one sample more than pieces.
    #[must_use]
    pub fn of_law(parameters: &[f64], law: &Law) -> Self {
        assert_eq!(parameters.len(), law.pieces.len() + 1, "samples of the law");
        Self { knots: parameters.to_vec(), pieces: law.pieces.clone() }
    }

    /// The piece that a parameter lies on; the first and the last go on beyond their ends.
    #[must_use]
    pub fn piece(&self, parameter: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.partition_point(|&knot| knot <= parameter)
    }

    /// `q` and its first and second derivative by the parameter, at a share (0 to 1) of a piece.
    #[must_use]
    pub fn within(&self, piece: usize, share: f64) -> [f64; 3] {
        self.pieces[piece].at(share, self.knots[piece + 1] - self.knots[piece])
    }

    /// Evaluates `q` and its derivatives at a parameter.
    #[must_use]
    pub fn at(&self, parameter: f64) -> [f64; 3] {
        let piece = self.piece(parameter);
        let [from, to] = [self.knots[piece], self.knots[piece + 1]];
        self.within(piece, ((parameter - from) / (to - from)).clamp(0.0, 1.0))
    }

    /// Time from one share of a piece to a later one, s.
    #[must_use]
    pub fn time_within(&self, piece: usize, [from, to]: [f64; 2]) -> f64 {
        let step = self.knots[piece + 1] - self.knots[piece];
        match self.pieces[piece] {
            // By q = q1 * share^(4/3), as in `IntervalLaw::duration`.
            IntervalLaw::Leave(q) => 3.0 * step * (libm::cbrt(to) - libm::cbrt(from)) / q.sqrt(),
            IntervalLaw::Arrive(q) => {
                3.0 * step * (libm::cbrt(1.0 - from) - libm::cbrt(1.0 - to)) / q.sqrt()
            }
            IntervalLaw::Quadratic(_) => {
                let part = step * (to - from);
                let [start, slope, _] = self.within(piece, from);
                let [end, ..] = self.within(piece, to);
                IntervalLaw::Quadratic([start, start + 0.5 * slope * part, end]).duration(part)
            }
        }
    }

    /// The share of a piece that is reached `seconds` after another, at most its end.
    #[must_use]
    pub fn share_after(&self, piece: usize, from: f64, seconds: f64) -> f64 {
        let (mut low, mut high) = (from, 1.0);
        for _ in 0..52 {
            let middle = f64::midpoint(low, high);
            if self.time_within(piece, [from, middle]) > seconds {
                high = middle;
            } else {
                low = middle;
            }
        }
        low
    }

    /// Takes everything at `share` of the speed: velocities by it, accelerations by its square, jerks by its cube.
    pub fn slow(&mut self, share: f64) {
        let factor = share * share;
        for piece in &mut self.pieces {
            match piece {
                IntervalLaw::Quadratic(q) => *q = q.map(|q| q * factor),
                IntervalLaw::Leave(q) | IntervalLaw::Arrive(q) => *q *= factor,
            }
        }
    }

    /// Time of the whole, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        let steps = self.knots.windows(2).map(|pair| pair[1] - pair[0]);
        let each = self.pieces.iter().zip(steps);
        each.map(|(piece, step)| piece.duration(step)).sum()
    }

    /// The B-spline of degree 2: its knots, the first and the last three times, and its coefficients, three fewer.
    ///
    /// Where the first piece leaves rest with constant jerk (or the last comes to rest so), `q` is no polynomial on it:
    /// it is the value at the inner knot times the share of the piece to the power of 4/3. The B-spline goes on beyond
    /// the rest there, over half as much again, and counts from the inner knot on.
    #[must_use]
    pub fn b_spline(&self) -> (Vec<f64>, Vec<f64>) {
        let last = self.pieces.len();
        let jerk =
            |piece: &IntervalLaw| matches!(piece, IntervalLaw::Leave(_) | IntervalLaw::Arrive(_));
        let mut inner = self.knots.clone();
        if jerk(&self.pieces[0]) {
            inner[0] = self.knots[1] - 1.5 * (self.knots[1] - self.knots[0]);
        }
        if jerk(&self.pieces[last - 1]) {
            inner[last] = self.knots[last - 1] + 1.5 * (self.knots[last] - self.knots[last - 1]);
        }
        let mut knots = vec![inner[0]; 2];
        knots.extend_from_slice(&inner);
        knots.extend([inner[last]; 2]);
        let mut coefficients = vec![self.within(0, 0.0)[0]];
        coefficients.extend(self.pieces.iter().map(|piece| match piece {
            IntervalLaw::Quadratic([_, middle, _]) => *middle,
            IntervalLaw::Leave(_) | IntervalLaw::Arrive(_) => 0.0,
        }));
        coefficients.push(self.within(last - 1, 1.0)[0]);
        (knots, coefficients)
    }
}
