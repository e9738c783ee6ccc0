//! One interval: which `q[i]` have a `q[i + 1]` that keeps the rows, and which `q[i + 1]` a `q[i]` allows.
//!
//! For a given `q[i] = x` each row leaves an interval of `q[i + 1] = y` between two parallel lines, so that the allowed
//! `y` lie between a convex function of `x`, `low`, and a concave one, `high`. The largest `x` that allows any `y` is
//! the largest root of the concave `high - low`: Newton's method from the right finds it in finitely many steps, one
//! for each pair of lines that it meets, and meets two or three.

use crate::problem::LimitRow;

/// A coefficient of `q[i + 1]` that counts as 0: its row bounds `q[i]` alone. So it is where an axis stands still for
/// an instant (a zero-inertia point).
const FLAT: f64 = 1e-200;

/// Amount by which a root is drawn into the allowed side, so that rounding does not put it outside.
const INSIDE: f64 = 1e-15;

/// Newton's method meets each pair of lines once; rounding may make it meet one again.
const MEETINGS: usize = 64;

/// What one `q[i]` leaves for `q[i + 1]`, and how the ends move with `q[i]`.
#[derive(Clone, Copy)]
struct ReachableRange {
    low: f64,
    low_slope: f64,
    high: f64,
    high_slope: f64,
}

#[inline]
fn span(rows: &[LimitRow], x: f64, low: f64, high: f64) -> ReachableRange {
    let mut span = ReachableRange { low, low_slope: 0.0, high, high_slope: 0.0 };
    for &row in rows {
        let [slope, half] = lines(row);
        let middle = slope * x;
        if middle + half < span.high {
            span.high = middle + half;
            span.high_slope = slope;
        }
        if middle - half > span.low {
            span.low = middle - half;
            span.low_slope = slope;
        }
    }
    span
}

/// A row leaves `y` between `slope * x - half` and `slope * x + half`. Without branches, so that rows can be done
/// several at a time.
#[inline]
fn lines(row: LimitRow) -> [f64; 2] {
    let flat = row.next.abs() <= FLAT;
    let inverse = 1.0 / row.next;
    [if flat { 0.0 } else { -row.here * inverse }, if flat { f64::INFINITY } else { inverse.abs() }]
}

/// The largest `x` by the rows that bound it alone.
#[inline]
fn alone(rows: &[LimitRow], upper: f64) -> f64 {
    rows.iter()
        .filter(|row| row.next.abs() <= FLAT)
        .fold(upper, |upper, row| upper.min(1.0 / row.here.abs()))
}

/// The largest `x` of `0..=upper` for which the rows allow some `y` of `low..=high`.
#[inline]
pub(super) fn highest_before(rows: &[LimitRow], upper: f64, low: f64, high: f64) -> Option<f64> {
    let mut x = alone(rows, upper);
    for _ in 0..MEETINGS {
        let span = span(rows, x, low, high);
        let gap = span.high - span.low;
        if gap >= 0.0 {
            return Some(x);
        }
        let slope = span.high_slope - span.low_slope;
        // Farther left there is even less.
        if slope >= 0.0 || slope.is_nan() {
            return None;
        }
        x = (x - gap / slope) * (1.0 - INSIDE);
        if x <= 0.0 {
            // At rest both before and after, every row is kept.
            return (low <= 0.0).then_some(0.0);
        }
    }
    Some(x)
}

/// The smallest such `x`.
#[inline]
pub(super) fn lowest_before(rows: &[LimitRow], upper: f64, low: f64, high: f64) -> Option<f64> {
    if low <= 0.0 {
        return Some(0.0);
    }
    let upper = alone(rows, upper);
    let mut x = 0.0;
    for _ in 0..MEETINGS {
        let span = span(rows, x, low, high);
        let gap = span.high - span.low;
        if gap >= 0.0 {
            break;
        }
        let slope = span.high_slope - span.low_slope;
        if slope <= 0.0 || slope.is_nan() {
            return None;
        }
        x = (x - gap / slope) * (1.0 + INSIDE);
        if x > upper {
            // By rounding alone, or truly.
            return (x <= upper * (1.0 + 1e-12)).then_some(upper);
        }
    }
    Some(x)
}

/// The largest `y` of `low..=high` that `x` allows.
#[inline]
pub(super) fn highest_after(rows: &[LimitRow], x: f64, low: f64, high: f64) -> f64 {
    let reach = rows.iter().fold(high, |reach, &row| {
        let [slope, half] = lines(row);
        let most = slope * x + half;
        if most < reach { most } else { reach }
    });
    // Only rounding can have put it below: `x` was chosen so that some `y` is allowed.
    reach.max(low)
}

/// The smallest `y` that `x` allows, and the row that allows no less.
pub(super) fn lowest_after(rows: &[LimitRow], x: f64) -> (f64, Option<usize>) {
    let mut least = (0.0, None);
    for (index, &row) in rows.iter().enumerate() {
        let [slope, half] = lines(row);
        let low = slope * x - half;
        if low > least.0 {
            least = (low, Some(index));
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `|(y - x)| <= 2`, and `|x - 3| <= 1` through a row without `y` (scaled).
    #[test]
    fn the_root_is_found_with_a_row_that_bounds_x_alone() {
        let rows = [LimitRow { here: -0.5, next: 0.5 }, LimitRow { here: 0.25, next: 0.0 }];
        assert_eq!(highest_before(&rows, 10.0, 0.0, 1.0), Some(3.0 * (1.0 - INSIDE)));
        assert_eq!(highest_before(&rows, 10.0, 0.0, 8.0), Some(4.0));
        assert_eq!(lowest_before(&rows, 10.0, 5.0, 8.0), Some(3.0 * (1.0 + INSIDE)));
        assert_eq!(lowest_before(&rows, 10.0, 7.0, 8.0), None);
        assert_eq!(highest_after(&rows, 4.0, 0.0, 8.0), 6.0);
        assert_eq!(lowest_after(&rows, 4.0), (2.0, Some(0)));
    }
}
