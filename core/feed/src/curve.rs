//! B-splines and NURBS with derivatives to third order, by de Boor's scheme.

use std::fmt;

/// Highest degree that is evaluated.
pub const MAX_DEGREE: usize = 7;

/// A curve of `D` coordinates: B-spline, or NURBS where it has weights.
#[derive(Clone, Debug, PartialEq)]
pub struct NurbsCurve<const D: usize> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<[f64; D]>,
    /// Empty where all are 1.
    weights: Vec<f64>,
}

/// Why numbers are no curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveFault {
    /// The degree is 0 or above [`MAX_DEGREE`].
    Degree,
    /// Fewer control points than the degree and one.
    Points,
    /// Not as many knots as control points and degree and one together.
    Knots,
    /// A knot that is smaller than the one before, or not finite, or ends an empty parameter range.
    Order {
        /// Index of the knot.
        knot: usize,
    },
    /// Not as many weights as control points, or one that is not positive.
    Weight {
        /// Index of the control point.
        point: usize,
    },
    /// A control point that is not finite.
    Point {
        /// Index of the control point.
        point: usize,
    },
}

impl fmt::Display for CurveFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Degree => write!(f, "the degree is not one of 1 to {MAX_DEGREE}"),
            Self::Points => f.write_str("there are fewer control points than the degree and one"),
            Self::Knots => f.write_str(
                "there are not as many knots as control points, degree and one together",
            ),
            Self::Order { knot } => write!(f, "knot {knot} does not follow the one before"),
            Self::Weight { point } => {
                write!(f, "the weight of control point {point} is missing or not positive")
            }
            Self::Point { point } => write!(f, "control point {point} is not finite"),
        }
    }
}

impl std::error::Error for CurveFault {}

/// Value, first, second and third derivative by the curve's parameter.
pub type Derivatives<const D: usize> = [[f64; D]; 4];

impl<const D: usize> NurbsCurve<D> {
    /// A curve of this degree; `weights` is empty for a B-spline.
    ///
    /// # Errors
    /// What is wrong with the numbers.
    pub fn new(
        degree: usize,
        knots: Vec<f64>,
        points: Vec<[f64; D]>,
        weights: Vec<f64>,
    ) -> Result<Self, CurveFault> {
        if degree == 0 || degree > MAX_DEGREE {
            return Err(CurveFault::Degree);
        }
        let count = points.len();
        if count <= degree {
            return Err(CurveFault::Points);
        }
        if knots.len() != count + degree + 1 {
            return Err(CurveFault::Knots);
        }
        // What is not a number follows nothing.
        let follows = |pair: &[f64]| pair[0] <= pair[1];
        if let Some(pair) = knots.windows(2).position(|pair| !follows(pair)) {
            return Err(CurveFault::Order { knot: pair + 1 });
        }
        if !(knots[degree] < knots[count]
            && knots[0].is_finite()
            && knots[count + degree].is_finite())
        {
            return Err(CurveFault::Order { knot: count });
        }
        let finite = |point: &[f64; D]| point.iter().all(|value| value.is_finite());
        if let Some(point) = points.iter().position(|point| !finite(point)) {
            return Err(CurveFault::Point { point });
        }
        if !weights.is_empty() {
            let bad = |weight: &f64| !(*weight > 0.0 && weight.is_finite());
            let point = weights.iter().position(bad);
            if let Some(point) =
                point.or((weights.len() != count).then_some(weights.len().min(count)))
            {
                return Err(CurveFault::Weight { point });
            }
        }
        Ok(Self { degree, knots, points, weights })
    }

    /// First and last value of the parameter.
    #[must_use]
    pub fn range(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.points.len()]]
    }

    /// The parameters between which the curve is one polynomial (or quotient), from the first to the last.
    pub fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        let inner = &self.knots[self.degree..=self.points.len()];
        let mut before = None;
        inner.iter().copied().filter(move |&knot| before.replace(knot) != Some(knot))
    }

    /// Value and derivatives at `parameter`, which is moved into the range. At a knot they are those after it.
    #[must_use]
    pub fn derivatives(&self, parameter: f64) -> Derivatives<D> {
        let [first, last] = self.range();
        let at = parameter.clamp(first, last);
        let degree = self.degree;
        // The span that begins at or before the parameter and is not empty; at the end, the last.
        let inner = &self.knots[degree + 1..self.points.len()];
        let span = degree + inner.partition_point(|&knot| knot <= at);
        let base = span - degree;
        let knots = &self.knots[base + 1..base + 1 + 2 * degree];
        let coordinate = |axis: usize| {
            let mut local = [0.0; MAX_DEGREE + 1];
            for (index, value) in local[..=degree].iter_mut().enumerate() {
                *value = self.points[base + index][axis] * self.weight(base + index);
            }
            scalar(degree, knots, local, at)
        };
        let mut result = [[0.0; D]; 4];
        if self.weights.is_empty() {
            for axis in 0..D {
                store(&mut result, axis, coordinate(axis));
            }
            return result;
        }
        let mut local = [0.0; MAX_DEGREE + 1];
        local[..=degree].copy_from_slice(&self.weights[base..=span]);
        let weight = scalar(degree, knots, local, at);
        for axis in 0..D {
            store(&mut result, axis, quotient(coordinate(axis), weight));
        }
        result
    }

    fn weight(&self, point: usize) -> f64 {
        self.weights.get(point).copied().unwrap_or(1.0)
    }
}

fn store<const D: usize>(all: &mut Derivatives<D>, axis: usize, values: [f64; 4]) {
    for (all, value) in all.iter_mut().zip(values) {
        all[axis] = value;
    }
}

/// Value and derivatives of one coordinate from its `degree + 1` control values and the `2 * degree` knots around the
/// span.
fn scalar(degree: usize, knots: &[f64], mut control: [f64; MAX_DEGREE + 1], at: f64) -> [f64; 4] {
    let mut result = [0.0; 4];
    for (order, value) in result.iter_mut().enumerate().take(degree + 1) {
        let rest = degree - order;
        *value = de_boor(rest, &knots[order..2 * degree - order], control, at);
        if order == 3 || rest == 0 {
            break;
        }
        // The control values of the derivative, one degree lower.
        for index in 0..rest {
            let width = knots[order + index + rest] - knots[order + index];
            control[index] = rest as f64 * (control[index + 1] - control[index]) / width;
        }
    }
    result
}

/// The spline of this degree at `at`, by the `2 * degree` knots around its span.
fn de_boor(degree: usize, knots: &[f64], mut control: [f64; MAX_DEGREE + 1], at: f64) -> f64 {
    for level in 1..=degree {
        for index in (level..=degree).rev() {
            let low = knots[index - 1];
            let high = knots[index + degree - level];
            let share = (at - low) / (high - low);
            control[index] = (1.0 - share) * control[index - 1] + share * control[index];
        }
    }
    control[degree]
}

/// Derivatives of `a / w` from those of both, by Leibniz' rule.
fn quotient(a: [f64; 4], w: [f64; 4]) -> [f64; 4] {
    let value = a[0] / w[0];
    let first = (a[1] - w[1] * value) / w[0];
    let second = (a[2] - 2.0 * w[1] * first - w[2] * value) / w[0];
    let third = (a[3] - 3.0 * w[1] * second - 3.0 * w[2] * first - w[3] * value) / w[0];
    [value, first, second, third]
}
