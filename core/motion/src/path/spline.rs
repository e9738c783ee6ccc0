//! Rational B-splines: points, derivatives to third order, blossoms.

use nalgebra::SVector;

/// The highest degree that is evaluated.
const MOST_DEGREE: usize = 9;

/// Pieces whose chords are added up, for each span of the knots.
const CHORDS: u32 = 64;

/// A rational B-spline of `D` coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline<const D: usize = 3> {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as poles + degree + 1.
    pub knots: Vec<f64>,
    /// Poles, mm, part frame, and their weights.
    pub poles: Vec<(SVector<f64, D>, f64)>,
}

/// A pole times its weight, and the weight.
type Weighted<const D: usize> = (SVector<f64, D>, f64);

impl<const D: usize> BSpline<D> {
    /// Makes one whose weights are all 1.
    pub fn unweighted(
        degree: usize,
        knots: Vec<f64>,
        poles: impl IntoIterator<Item = impl Into<SVector<f64, D>>>,
    ) -> Self {
        let poles = poles.into_iter().map(|pole| (pole.into(), 1.0)).collect();
        Self { degree, knots, poles }
    }

    /// Places the spline elsewhere: `map` takes points, by a rotation and a shift.
    pub fn placed(mut self, map: impl Fn(SVector<f64, D>) -> SVector<f64, D>) -> Self {
        for (pole, _) in &mut self.poles {
            *pole = map(*pole);
        }
        self
    }

    /// Whether it can be evaluated: the degree is from 1 to 9, the knots never fall and are as many as poles + degree + 1,
    /// and its weights lie above zero.
    pub fn is_sound(&self) -> bool {
        let rises = self.knots.windows(2).all(|pair| pair[0] <= pair[1]);
        let [first, last] = self.range();
        (1..=MOST_DEGREE).contains(&self.degree)
            && self.poles.len() > self.degree
            && self.knots.len() == self.poles.len() + self.degree + 1
            && rises
            && first < last
            && self.poles.iter().all(|(_, weight)| *weight > 0.0)
    }

    /// The parameters that it begins and ends with.
    pub fn range(&self) -> [f64; 2] {
        let knot = |place: usize| self.knots.get(place).copied().unwrap_or_default();
        [knot(self.degree), knot(self.poles.len())]
    }

    /// The spans of its knots that are not empty, in order: place of the first knot.
    pub fn spans(&self) -> impl Iterator<Item = usize> + '_ {
        (self.degree..self.poles.len()).filter(|place| self.knots[*place] < self.knots[place + 1])
    }

    /// Length, mm, by chords of each span: too short by less than a thousandth.
    pub fn length(&self) -> f64 {
        let mut length = 0.0;
        for span in self.spans() {
            let (low, high) = (self.knots[span], self.knots[span + 1]);
            let mut last = self.point(low);
            for piece in 1..=CHORDS {
                let u = low + (high - low) * f64::from(piece) / f64::from(CHORDS);
                let next = self.point(u);
                length += (next - last).norm();
                last = next;
            }
        }
        length
    }

    /// The parameters between which it is one polynomial (or quotient), from the first to the last.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.spans().map(|span| self.knots[span]).chain([self.range()[1]])
    }

    /// The point at a share of its range, from 0 to 1.
    pub fn at(&self, share: f64) -> SVector<f64, D> {
        let [first, last] = self.range();
        self.point(first + (last - first) * share.clamp(0.0, 1.0))
    }

    /// The point at the parameter `u`.
    pub fn point(&self, u: f64) -> SVector<f64, D> {
        self.blossom(self.span(u), |_| u)
    }

    /// The blossom of the span that begins with a knot at as many parameters as the degree: where all are the same, the
    /// point there; where some are the first and the others the last of the span, a control point of it.
    pub fn blossom(&self, span: usize, parameter: impl Fn(usize) -> f64) -> SVector<f64, D> {
        let (point, weight) = self.de_boor(self.degree, span, self.control(span), parameter);
        point / weight
    }

    /// Control points and weights of the part of a span, which begins with a knot, between two parameters: the part stays
    /// in their hull.
    pub fn part(&self, span: usize, [from, to]: [f64; 2]) -> Vec<(SVector<f64, D>, f64)> {
        let control = |ups: usize| {
            let parameter = |level: usize| if level < ups { to } else { from };
            let (point, weight) = self.de_boor(self.degree, span, self.control(span), parameter);
            (point / weight, weight)
        };
        (0..=self.degree).map(control).collect()
    }

    /// The point at `u`, which is moved into the range, and its first to third derivative. At a knot they are those after it.
    pub fn derivatives(&self, u: f64) -> [SVector<f64, D>; 4] {
        let [first, last] = self.range();
        let u = u.clamp(first, last);
        self.derivatives_on(self.span(u), u)
    }

    /// The point at `u` of the span that begins with a knot, and its first to third derivative.
    pub fn derivatives_on(&self, span: usize, u: f64) -> [SVector<f64, D>; 4] {
        let mut control = self.control(span);
        let mut orders = [(SVector::zeros(), 0.0); 4];
        for (order, derivative) in orders.iter_mut().enumerate().take(self.degree + 1) {
            let rest = self.degree - order;
            *derivative = self.de_boor(rest, span, control, |_| u);
            // The control points of the next derivative, one degree lower.
            for index in 0..rest {
                let knot = span - rest + 1 + index;
                let width = self.knots[knot + rest] - self.knots[knot];
                let (low, high) = (control[index], control[index + 1]);
                let share = |change: f64| rest as f64 * change / width;
                control[index] = ((high.0 - low.0).map(share), share(high.1 - low.1));
            }
        }
        // Derivatives of a quotient from those of both, by Leibniz' rule.
        let [(a0, w0), (a1, w1), (a2, w2), (a3, w3)] = orders;
        let value = a0 / w0;
        let first = (a1 - value * w1) / w0;
        let second = (a2 - first * (2.0 * w1) - value * w2) / w0;
        let third = (a3 - second * (3.0 * w1) - first * (3.0 * w2) - value * w3) / w0;
        [value, first, second, third]
    }

    /// The last span that begins at or before `u`, and is not empty.
    fn span(&self, u: f64) -> usize {
        let span = self.knots[self.degree..self.poles.len()].partition_point(|knot| *knot <= u);
        (self.degree + span).saturating_sub(1).max(self.degree)
    }

    /// Poles times weights that a span depends on.
    fn control(&self, span: usize) -> [Weighted<D>; MOST_DEGREE + 1] {
        let mut control = [(SVector::zeros(), 0.0); MOST_DEGREE + 1];
        let poles = &self.poles[span - self.degree..=span];
        for (control, (pole, weight)) in control.iter_mut().zip(poles) {
            *control = (pole * *weight, *weight);
        }
        control
    }

    /// De Boor's rule on a span of a spline of `degree`, each level at a parameter of its own.
    fn de_boor(
        &self,
        degree: usize,
        span: usize,
        mut work: [Weighted<D>; MOST_DEGREE + 1],
        parameter: impl Fn(usize) -> f64,
    ) -> Weighted<D> {
        for level in 1..=degree {
            let u = parameter(level - 1);
            for place in (level..=degree).rev() {
                let knot = span - degree + place;
                let (low, high) = (self.knots[knot], self.knots[knot + degree + 1 - level]);
                let share = match high > low {
                    true => (u - low) / (high - low),
                    false => 0.0,
                };
                let (before, at) = (work[place - 1], work[place]);
                work[place] = (
                    before.0 * (1.0 - share) + at.0 * share,
                    before.1 * (1.0 - share) + at.1 * share,
                );
            }
        }
        work[degree]
    }
}
