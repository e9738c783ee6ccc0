//! Bounds and rows: what a limit leaves for `q`, and whose they are.

/// Which limit a bound or row comes from: an index into [`Problem::names`](crate::Problem::names), and the axis where there is one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LimitSource {
    /// Index into [`Problem::names`](crate::Problem::names).
    pub limit: u16,
    /// Index of the axis, in the order of [`Samples::axes`](crate::Samples::axes).
    pub axis: Option<u16>,
}

/// `-1 <= here * q[i] + next * q[i + 1] <= 1`: what is limited, as a share of its limit, on the way from one sample to
/// the next.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitRow {
    /// Coefficient of `q[i]`, in 1 / (unit of q).
    pub here: f64,
    /// Coefficient of `q[i + 1]`, in 1 / (unit of q).
    pub next: f64,
}

impl LimitRow {
    /// The limited value as a share of its limit, with its sign.
    #[must_use]
    pub fn value(self, here: f64, next: f64) -> f64 {
        self.here * here + self.next * next
    }
}

/// What a [`Limit`](crate::limits::Limit) writes its bounds and rows into.
pub struct LimitTable<'a> {
    pub(crate) limit: u16,
    /// First of its rows of an interval, of `stride` rows of all limits.
    pub(crate) first: usize,
    pub(crate) stride: usize,
    pub(crate) upper: &'a mut [f64],
    pub(crate) causes: &'a mut [LimitSource],
    pub(crate) rows: &'a mut [LimitRow],
}

impl LimitTable<'_> {
    /// Lowers the upper bound of `q` at a sample to `bound`, if it is not lower already.
    pub fn lower(&mut self, sample: usize, bound: f64, axis: Option<u16>) {
        // What is not a number must not get lost in a comparison.
        if bound < self.upper[sample] || bound.is_nan() {
            self.upper[sample] = bound;
            self.causes[sample] = LimitSource { limit: self.limit, axis };
        }
    }

    /// Sets the limit's row number `row` of an interval.
    pub fn set(&mut self, interval: usize, row: usize, value: LimitRow) {
        self.rows[interval * self.stride + self.first + row] = value;
    }

    /// The rows of an interval from the limit's first row on.
    pub fn rows_mut(&mut self, interval: usize) -> &mut [LimitRow] {
        &mut self.rows[interval * self.stride + self.first..(interval + 1) * self.stride]
    }
}
