//! Symmetric positive definite matrices with a narrow band: factor and solve in linear time.

/// A symmetric matrix whose entry `(i + k, i)` is `rows[i][k]`, for `k` below `K`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Band<const K: usize> {
    pub(crate) rows: Vec<[f64; K]>,
}

impl<const K: usize> Band<K> {
    pub(crate) fn reset(&mut self, size: usize) {
        self.rows.clear();
        self.rows.resize(size, [0.0; K]);
    }

    /// Factors into `L D L'` in place: `D` takes the diagonal, `L` the rest.
    pub(crate) fn factor(&mut self) {
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
    pub(crate) fn solve(&self, side: &mut [f64]) {
        self.solve_each::<1>(side.as_chunks_mut().0);
    }

    /// Solves for `W` right sides at once: each waits for fewer of its own results.
    pub(crate) fn solve_each<const W: usize>(&self, sides: &mut [[f64; W]]) {
        let size = self.rows.len();
        for column in 0..size {
            let value = sides[column];
            for k in 1..K.min(size - column) {
                for (side, value) in sides[column + k].iter_mut().zip(value) {
                    *side -= self.rows[column][k] * value;
                }
            }
        }
        for column in (0..size).rev() {
            let mut value = sides[column].map(|side| side / self.rows[column][0]);
            for k in (1..K.min(size - column)).rev() {
                for (value, side) in value.iter_mut().zip(sides[column + k]) {
                    *value -= self.rows[column][k] * side;
                }
            }
            sides[column] = value;
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
