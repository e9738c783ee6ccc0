//! Symmetric positive definite matrices with a narrow band: factor and solve in linear time.

/// A symmetric matrix whose entry `(i + k, i)` is `rows[i][k]`, for `k` below `K`.
#[derive(Clone, Debug, Default)]
pub(super) struct Band<const K: usize> {
    pub(super) rows: Vec<[f64; K]>,
}

impl<const K: usize> Band<K> {
    pub(super) fn reset(&mut self, size: usize) {
        self.rows.clear();
        self.rows.resize(size, [0.0; K]);
    }

    /// Factors into `L D L'` in place: `D` takes the diagonal, `L` the rest.
    pub(super) fn factor(&mut self) {
        let size = self.rows.len();
        for column in 0..size {
            let pivot = self.rows[column];
            let mut factor = pivot;
            for k in 1..K.min(size - column) {
                factor[k] = pivot[k] / pivot[0];
                let row = self.rows[column + k].iter_mut();
                for (entry, pivot) in row.zip(&pivot[k..]) {
                    *entry -= factor[k] * pivot;
                }
            }
            self.rows[column] = factor;
        }
    }

    /// Solves for a right side in place, after [`Band::factor`].
    pub(super) fn solve(&self, side: &mut [f64]) {
        let size = self.rows.len();
        for column in 0..size {
            let value = side[column];
            for k in 1..K.min(size - column) {
                side[column + k] -= self.rows[column][k] * value;
            }
        }
        for column in (0..size).rev() {
            let mut value = side[column] / self.rows[column][0];
            for k in 1..K.min(size - column) {
                value -= self.rows[column][k] * side[column + k];
            }
            side[column] = value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_of_five_diagonals_is_solved() {
        let rows = vec![
            [4.0, 1.0, 0.5],
            [5.0, -1.0, 0.2],
            [6.0, 2.0, -0.3],
            [7.0, 1.5, 0.0],
            [8.0, 0.0, 0.0],
        ];
        let solution = [1.0, -2.0, 3.0, 0.5, -1.0];
        let mut side = [0.0; 5];
        for (column, row) in rows.iter().enumerate() {
            side[column] += row[0] * solution[column];
            for k in 1..3.min(5 - column) {
                side[column + k] += row[k] * solution[column];
                side[column] += row[k] * solution[column + k];
            }
        }
        let mut band = Band { rows };
        band.factor();
        band.solve(&mut side);
        for (got, want) in side.iter().zip(solution) {
            assert!((got - want).abs() < 1e-14);
        }
    }
}
