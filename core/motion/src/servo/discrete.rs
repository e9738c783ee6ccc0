//! Differential equations solved over a step of time.

use nalgebra::linalg::balancing::{balance_parlett_reinsch, unbalance};
use nalgebra::{DMatrix, DVector};
use post_machine::servo::StateSpace;

/// No servo whose machine file was not refused, over a step of a second at most, has a larger number in its matrix.
const LARGEST: f64 = 1e100;

/// The exact solution of `x' = a·x + value·r + rate·r' + force·f` after a step of time in which r changes linearly by Δ
/// and f is constant: `x⁺ = transition·x + value·r + change·Δ + force·f`, r taken at the beginning.
#[derive(Clone, Debug)]
pub(super) struct DiscreteSolution {
    pub transition: DMatrix<f64>,
    pub value: DVector<f64>,
    pub change: DVector<f64>,
    pub force: DVector<f64>,
}

impl DiscreteSolution {
    /// Solves over `step` seconds. The inputs are states of their own of a larger system whose matrix exponential holds
    /// all (Van Loan 1978, "Computing integrals involving the matrix exponential"): over the step r grows by Δ, and
    /// neither Δ nor f changes. None where the equations are out of all proportion to the step.
    pub(super) fn new(
        a: &DMatrix<f64>,
        value: &DVector<f64>,
        rate: &DVector<f64>,
        force: &DVector<f64>,
        step: f64,
    ) -> Option<Self> {
        let order = a.nrows();
        let mut whole = DMatrix::zeros(order + 3, order + 3);
        whole.view_mut((0, 0), (order, order)).copy_from(&(a * step));
        for (place, column) in [value * step, rate.clone(), force * step].iter().enumerate() {
            whole.view_mut((0, order + place), (order, 1)).copy_from(column);
        }
        whole[(order, order + 1)] = 1.0;
        let sound = |part: &f64| libm::fabs(*part) < LARGEST;
        if !whole.iter().all(sound) {
            return None;
        }
        let scale = balance_parlett_reinsch(&mut whole);
        let mut solved = whole.exp();
        unbalance(&mut solved, &scale);
        let column = |place: usize| solved.view((0, order + place), (order, 1)).column(0).into();
        Some(Self {
            transition: solved.view((0, 0), (order, order)).into(),
            value: column(0),
            change: column(1),
            force: column(2),
        })
    }
}

/// A vector at the head of an array, the rest zero.
pub(super) fn padded<const N: usize>(values: impl IntoIterator<Item = f64>) -> [f64; N] {
    let mut array = [0.0; N];
    for (place, value) in array.iter_mut().zip(values) {
        *place = value;
    }
    array
}

/// The columns of a matrix at the head of an array of columns, the rest zero.
pub(super) fn columns<const N: usize>(matrix: &DMatrix<f64>) -> [[f64; N]; N] {
    let mut array = [[0.0; N]; N];
    for (place, column) in array.iter_mut().zip(matrix.column_iter()) {
        *place = padded(column.iter().copied());
    }
    array
}

/// `sum += vector·factor`.
#[inline(always)]
pub(super) fn add<const N: usize>(sum: &mut [f64; N], vector: &[f64; N], factor: f64) {
    for (sum, value) in sum.iter_mut().zip(vector) {
        *sum += value * factor;
    }
}

/// Scalar product.
#[inline(always)]
pub(super) fn dot<const N: usize>(row: &[f64; N], vector: &[f64; N]) -> f64 {
    row.iter().zip(vector).map(|(one, other)| one * other).sum()
}

/// Where a servo stands, and what it was told last.
#[derive(Clone, Debug)]
pub(super) struct ServoState<const N: usize> {
    /// States at rest at the command 1.
    pub rest: [f64; N],
    pub states: [f64; N],
    pub commanded: f64,
    pub last_change: f64,
    /// Where the table is within the play behind the loops.
    pub table: f64,
}

impl<const N: usize> ServoState<N> {
    pub(super) fn new(space: &StateSpace) -> Self {
        Self {
            rest: padded(space.rest().iter().flatten().copied()),
            states: [0.0; N],
            commanded: 0.0,
            last_change: 0.0,
            table: 0.0,
        }
    }

    /// Brings the servo to rest at `value`.
    pub(super) fn settle(&mut self, value: f64) {
        self.states = self.rest.map(|part| part * value);
        self.commanded = value;
        self.last_change = 0.0;
        self.table = value;
    }
}

/// Where a table stands that stood at `table` while the motor has gone to `motor`, with play between them.
#[inline(always)]
pub(super) fn play(table: f64, motor: f64, half_play: f64) -> f64 {
    if half_play > 0.0 { table.max(motor - half_play).min(motor + half_play) } else { motor }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    /// The series of the matrix exponential over a step so small that few terms do, then doubled: no Padé fraction, no
    /// balancing, and the integrals of the inputs as sums of their own.
    fn by_series(
        a: &DMatrix<f64>,
        b: &DVector<f64>,
        step: f64,
        doublings: i32,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let order = a.nrows();
        let small = step * libm::pow(2.0, f64::from(-doublings));
        let mut term = DMatrix::identity(order, order);
        let mut transition = term.clone();
        let mut integral = &term * small;
        for power in 1..20 {
            term = &term * a * small / f64::from(power);
            transition += &term;
            integral += &term * (small / f64::from(power + 1));
        }
        for _ in 0..doublings {
            integral = &transition * &integral + integral;
            transition = &transition * &transition;
        }
        (transition, integral * b)
    }

    #[test]
    fn the_exponential_is_its_series() {
        // A stiff winding beside a table that swings, states of very different sizes.
        let a = DMatrix::from_row_slice(
            4,
            4,
            &[
                0.0, 1.0, 0.0, 0.0, -3.5e5, -12.0, 3.5e5, 2e2, 0.0, 0.0, -40.0, 1e-3, 5e3, -2e4,
                0.0, -4e3,
            ],
        );
        let b = DVector::from_column_slice(&[0.0, 1e3, 40.0, 1e6]);
        let none = DVector::zeros(4);
        for step in [2.5e-4, 1e-3, 1.5e-2] {
            let solved = DiscreteSolution::new(&a, &b, &none, &b, step).unwrap();
            let (transition, input) = by_series(&a, &b, step, 20);
            let apart = (&solved.transition - &transition).amax();
            assert!(apart < 1e-9 * transition.amax(), "{step}: {apart:e}");
            for found in [&solved.value, &solved.force] {
                let apart = (found - &input).amax();
                assert!(apart < 1e-9 * input.amax(), "{step}: {apart:e}");
            }
        }
    }
}
