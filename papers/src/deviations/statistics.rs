//! What is told of many values.

/// How values are spread. All in the unit of the values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distribution {
    /// How many.
    pub count: usize,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation of these values about their mean (divided by their number, not by one less).
    pub deviation: f64,
    /// The largest.
    pub max: f64,
    /// The values that 50, 90, 95 and 99 % of all do not exceed, linear between neighbours in rank.
    pub percentiles: [f64; 4],
}

impl Distribution {
    /// Which percentiles.
    pub const PERCENTS: [u8; 4] = [50, 90, 95, 99];

    /// Of values, which are sorted; all zero if there are none.
    pub fn of(values: &mut [f64]) -> Self {
        values.sort_by(f64::total_cmp);
        let [.., max] = *values else {
            return Self::default();
        };
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean) * (value - mean)).sum();
        let rank = |percent: u8| {
            let place = f64::from(percent) / 100.0 * (count - 1) as f64;
            let below = place as usize;
            let above = (below + 1).min(count - 1);
            values[below] + (values[above] - values[below]) * (place - below as f64)
        };
        Self {
            count,
            mean,
            deviation: libm::sqrt(squares / count as f64),
            max,
            percentiles: Self::PERCENTS.map(rank),
        }
    }
}

/// How many values fall into each of `bins` even bins over 0 to `end`; what lies beyond counts to the last.
pub fn histogram(values: &[f64], end: f64, bins: usize) -> Vec<u64> {
    let mut counts = vec![0; bins];
    for value in values {
        let bin = (value / end * bins as f64) as usize;
        if let Some(count) = counts.get_mut(bin.min(bins.saturating_sub(1))) {
            *count += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: mean 5, squares 9+1+1+1+0+0+4+16 = 32 over 8.
    #[test]
    fn the_distribution_of_eight_values() {
        let mut values = [9.0, 2.0, 4.0, 5.0, 4.0, 4.0, 5.0, 7.0];
        let told = Distribution::of(&mut values);
        assert_eq!((told.count, told.mean, told.deviation, told.max), (8, 5.0, 2.0, 9.0));
        // Ranks 3.5, 6.3, 6.65 and 6.93 of 2 4 4 4 5 5 7 9.
        let wanted = [4.5, 7.6, 8.3, 8.86];
        for (percentile, wanted) in told.percentiles.iter().zip(wanted) {
            assert!((percentile - wanted).abs() < 1e-12, "{percentile} {wanted}");
        }
    }

    #[test]
    fn none_and_one() {
        assert_eq!(Distribution::of(&mut []), Distribution::default());
        let one = Distribution::of(&mut [3.0]);
        assert_eq!((one.mean, one.deviation), (3.0, 0.0));
        assert_eq!(one.percentiles, [3.0; 4]);
    }

    #[test]
    fn values_at_the_end_count_to_the_last_bin() {
        assert_eq!(histogram(&[0.0, 0.4, 1.0, 1.9, 2.0, 7.0], 2.0, 2), [2, 4]);
    }
}
