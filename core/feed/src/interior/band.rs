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
        // Columns that reach as far as the band does, and those at the end: a loop of known length for most.
        let whole = (size + 1).saturating_sub(K);
        for column in 0..whole {
            self.factor_column(column, K);
        }
        for column in whole..size {
            self.factor_column(column, size - column);
        }
    }

    /// Takes a column that reaches over `reach` rows, its own among them, from those after it.
    #[inline(always)]
    fn factor_column(&mut self, column: usize, reach: usize) {
        let rows = &mut self.rows[column..column + reach];
        let pivot = rows[0];
        let mut factor = pivot;
        for k in 1..reach {
            factor[k] = pivot[k] / pivot[0];
            for (entry, pivot) in rows[k].iter_mut().zip(&pivot[k..]) {
                *entry -= factor[k] * pivot;
            }
        }
        rows[0] = factor;
    }

    /// Solves for a right side in place, after [`Band::factor`].
    pub(crate) fn solve(&self, side: &mut [f64]) {
        self.solve_each::<1>(side.as_chunks_mut().0);
    }

    /// Solves for `W` right sides at once: each waits for fewer of its own results.
    pub(crate) fn solve_each<const W: usize>(&self, sides: &mut [[f64; W]]) {
        let size = self.rows.len();
        let whole = (size + 1).saturating_sub(K);
        for column in 0..whole {
            self.forward(column, K, sides);
        }
        for column in whole..size {
            self.forward(column, size - column, sides);
        }
        for column in (whole..size).rev() {
            self.backward(column, size - column, sides);
        }
        for column in (0..whole).rev() {
            self.backward(column, K, sides);
        }
    }

    #[inline(always)]
    fn forward<const W: usize>(&self, column: usize, reach: usize, sides: &mut [[f64; W]]) {
        let row = &self.rows[column];
        let sides = &mut sides[column..column + reach];
        let value = sides[0];
        for k in 1..reach {
            for (side, value) in sides[k].iter_mut().zip(value) {
                *side -= row[k] * value;
            }
        }
    }

    #[inline(always)]
    fn backward<const W: usize>(&self, column: usize, reach: usize, sides: &mut [[f64; W]]) {
        let row = &self.rows[column];
        let sides = &mut sides[column..column + reach];
        let mut value = sides[0].map(|side| side / row[0]);
        for k in (1..reach).rev() {
            for (value, side) in value.iter_mut().zip(sides[k]) {
                *value -= row[k] * side;
            }
        }
        sides[0] = value;
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
