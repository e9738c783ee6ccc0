//! Differential equations solved over a step of time.

use nalgebra::linalg::balancing::{balance_parlett_reinsch, unbalance};
use nalgebra::{DMatrix, DVector};

/// The exact solution of `x' = a·x + value·r + rate·r' + force·f` after a step of time in which r changes linearly by Δ and
/// f is constant: `x⁺ = transition·x + value·r + change·Δ + force·f`, r taken at the beginning.
#[derive(Clone, Debug)]
pub(super) struct Discrete {
    pub transition: DMatrix<f64>,
    pub value: DVector<f64>,
    pub change: DVector<f64>,
    pub force: DVector<f64>,
}

impl Discrete {
    /// Over `step` seconds. The inputs are states of their own of a larger system whose matrix exponential holds all
    /// (Van Loan 1978, "Computing integrals involving the matrix exponential"): over the step r grows by Δ, and neither Δ
    /// nor f changes.
    pub(super) fn new(
        a: &DMatrix<f64>,
        value: &DVector<f64>,
        rate: &DVector<f64>,
        force: &DVector<f64>,
        step: f64,
    ) -> Self {
        let order = a.nrows();
        let mut whole = DMatrix::zeros(order + 3, order + 3);
        whole
            .view_mut((0, 0), (order, order))
            .copy_from(&(a * step));
        for (place, column) in [value * step, rate.clone(), force * step]
            .iter()
            .enumerate()
        {
            whole
                .view_mut((0, order + place), (order, 1))
                .copy_from(column);
        }
        whole[(order, order + 1)] = 1.0;
        let scale = balance_parlett_reinsch(&mut whole);
        let mut solved = whole.exp();
        unbalance(&mut solved, &scale);
        let column = |place: usize| solved.view((0, order + place), (order, 1)).column(0).into();
        Self {
            transition: solved.view((0, 0), (order, order)).into(),
            value: column(0),
            change: column(1),
            force: column(2),
        }
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
