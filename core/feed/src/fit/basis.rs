//! B-splines of one degree on knots of any spacing: values and derivatives of those that are not zero on a span.

/// Degree of the curve: third derivatives, which the jerk of drives follows, are smooth.
pub(super) const DEGREE: usize = 5;
/// Number of control points that a span depends on.
pub(super) const ORDER: usize = DEGREE + 1;
/// Number of Gauss points that integrate the square of a third derivative exactly.
pub(super) const GAUSS: usize = DEGREE - 2;

/// What multiplies the control points of a span.
pub(super) type BasisRow = [f64; ORDER];

/// The B-splines of one span.
pub(super) struct Basis {
    /// The knots around the span, which lies between the two in the middle.
    knots: [f64; 2 * DEGREE],
    /// Reciprocal widths of the supports, by degree.
    inverse: [[f64; DEGREE]; DEGREE],
}

impl Basis {
    /// Makes the B-splines of the span in the middle of `2 * DEGREE` knots; it is not empty.
    pub(super) fn new(around: &[f64]) -> Self {
        let mut knots = [0.0; 2 * DEGREE];
        knots.copy_from_slice(&around[..2 * DEGREE]);
        let mut inverse = [[0.0; DEGREE]; DEGREE];
        for (degree, row) in inverse.iter_mut().enumerate() {
            for (index, inverse) in row[..=degree].iter_mut().enumerate() {
                *inverse = 1.0 / (knots[DEGREE + index] - knots[DEGREE - 1 - degree + index]);
            }
        }
        Self { knots, inverse }
    }

    /// First and last parameter of the span.
    pub(super) fn span(&self) -> [f64; 2] {
        [self.knots[DEGREE - 1], self.knots[DEGREE]]
    }

    /// Value, first, second and third derivative.
    pub(super) fn rows(&self, at: f64) -> [BasisRow; 4] {
        let mut result = [[0.0; ORDER]; 4];
        let mut values = [0.0; ORDER];
        values[0] = 1.0;
        for degree in 0..=DEGREE {
            let order = DEGREE - degree;
            if order <= 3 {
                result[order] = self.differentiated(values, degree);
            }
            if degree < DEGREE {
                values = self.raised(&values, degree, at);
            }
        }
        result
    }

    /// Third derivative.
    pub(super) fn third(&self, at: f64) -> BasisRow {
        let mut values = [0.0; ORDER];
        values[0] = 1.0;
        for degree in 0..DEGREE - 3 {
            values = self.raised(&values, degree, at);
        }
        self.differentiated(values, DEGREE - 3)
    }

    /// Values of the B-splines of one degree more than `degree`.
    fn raised(&self, values: &BasisRow, degree: usize, at: f64) -> BasisRow {
        let mut next = [0.0; ORDER];
        for (index, value) in values[..=degree].iter().enumerate() {
            let share = value * self.inverse[degree][index];
            next[index] += (self.knots[DEGREE + index] - at) * share;
            next[index + 1] += (at - self.knots[DEGREE - 1 - degree + index]) * share;
        }
        next
    }

    /// Turns values of one degree into the derivative, of the order that is missing, of the full one.
    fn differentiated(&self, mut values: BasisRow, degree: usize) -> BasisRow {
        for degree in degree..DEGREE {
            let mut next = [0.0; ORDER];
            for (index, value) in values[..=degree].iter().enumerate() {
                let share = (degree + 1) as f64 * value * self.inverse[degree][index];
                next[index] -= share;
                next[index + 1] += share;
            }
            values = next;
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::BSpline;

    /// The evaluation by de Boor's scheme gives the same values and derivatives.
    #[test]
    fn rows_agree_with_de_boor() {
        let mut knots = vec![0.0; ORDER];
        knots.extend([0.3, 0.5, 1.7, 1.9, 2.0, 4.0, 4.5]);
        knots.extend([5.0; ORDER]);
        let count = knots.len() - ORDER;
        for chosen in 0..count {
            let point = |index| [f64::from(u8::from(index == chosen))];
            let curve = BSpline::unweighted(DEGREE, knots.clone(), (0..count).map(point));
            for step in 0..100 {
                let at = 0.05 * f64::from(step);
                let span = (DEGREE..count).rfind(|&span| knots[span] <= at).unwrap();
                let basis = Basis::new(&knots[span + 1 - DEGREE..]);
                let want = curve.derivatives(at);
                let rows = basis.rows(at);
                assert_eq!(rows[3], basis.third(at));
                for (row, want) in rows.iter().zip(want) {
                    let local = (chosen + DEGREE).checked_sub(span);
                    let got = local.and_then(|local| row.get(local)).unwrap_or(&0.0);
                    assert!((got - want[0]).abs() < 1e-9 * (1.0 + want[0].abs()));
                }
            }
        }
    }
}
