//! The times of a log: rows lie at equal distances in time, but for those that are missing and for the jitter of whoever
//! wrote them.

/// So many times the period without a row are a gap.
const GAP: f64 = 4.0;

/// The usual step is the median of so many together: of single ones jitter makes two kinds.
const STEPS: usize = 4;

/// A step is one without a missing row up to so many times the usual one.
const ONE_STEP: f64 = 1.5;

/// The mean step is the period if it is this close to the usual one, as a share of it.
const SAME: f64 = 0.1;

/// Rows lie at even distances if they are beside them by no more than this share of the period.
const EVEN: f64 = 1e-4;

/// What the times of a log say.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// Time from row to row, s.
    pub period: f64,
    /// Rows that are missing between others.
    pub missing: usize,
    /// Root of the mean square of how far rows lie beside even distances, s.
    pub jitter: f64,
    /// Times are rounded, and rows are taken to lie at even distances.
    pub rounded: bool,
}

/// More than [`GAP`] periods without a row.
pub struct Gap {
    /// The row behind it.
    pub row: usize,
    /// The usual step, s.
    pub usual: f64,
}

impl Clock {
    /// Of times that increase, more than [`STEPS`], printed to `resolution` s; what is only rounded becomes even.
    ///
    /// # Errors
    /// A gap.
    pub fn of(times: &mut [f64], resolution: f64) -> Result<Self, Gap> {
        let mut steps: Vec<f64> =
            times.windows(STEPS + 1).map(|rows| (rows[STEPS] - rows[0]) / STEPS as f64).collect();
        let middle = steps.len() / 2;
        let (_, usual, _) = steps.select_nth_unstable_by(middle, f64::total_cmp);
        let usual = *usual;
        let gap = |pair: &[f64]| pair[1] - pair[0] > GAP * usual;
        if let Some(row) = times.windows(2).position(gap) {
            return Err(Gap { row: row + 1, usual });
        }
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        let missing: usize = steps
            .filter(|step| *step > ONE_STEP * usual)
            .map(|step| libm::rint(step / usual) as usize - 1)
            .sum();
        let mut places = Vec::with_capacity(times.len());
        let mut place = 0.0;
        for (row, time) in times.iter().enumerate() {
            if row > 0 {
                place += libm::rint((time - times[row - 1]) / usual).max(1.0);
            }
            places.push(place);
        }
        // Rounded times make the usual step coarse, and two rows alone that of the line through them.
        let first = times[0];
        let count = times.len() as f64;
        let middle = places.iter().sum::<f64>() / count;
        let mut sums = [0.0; 2];
        for (place, time) in places.iter().zip(times.iter()) {
            let arm = place - middle;
            sums[0] += arm * arm;
            sums[1] += arm * (time - first);
        }
        let mean = sums[1] / sums[0];
        let period = match (mean - usual).abs() < SAME * usual {
            true => mean,
            false => usual,
        };
        // What is left of that line.
        let beside = |row: usize, time: f64| time - (first + places[row] * period);
        let beside: Vec<f64> =
            times.iter().enumerate().map(|(row, time)| beside(row, *time)).collect();
        let mean = beside.iter().sum::<f64>() / count;
        let squares = beside.iter().map(|one| (one - mean) * (one - mean));
        let jitter = libm::sqrt(squares.sum::<f64>() / count);
        let rounded =
            jitter > EVEN * period && beside.iter().all(|one| one.abs() <= 1.01 * resolution);
        if rounded {
            for (time, place) in times.iter_mut().zip(&places) {
                *time = first + mean + place * period;
            }
        }
        Ok(Self { period, missing, jitter: if rounded { 0.0 } else { jitter }, rounded })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounded_times_become_even_and_missing_rows_are_counted() {
        let kept = |row: &usize| !matches!(row, 100 | 101 | 777);
        let round = |time: f64| libm::rint(time * 1e3) / 1e3;
        let mut times: Vec<f64> =
            (0..2000).filter(kept).map(|row| round(5.0 + 0.0025 * row as f64)).collect();
        let clock = Clock::of(&mut times, 1e-3).ok().unwrap();
        assert!((clock.period - 0.0025).abs() < 1e-6, "{clock:?}");
        assert_eq!((clock.missing, clock.rounded), (3, true));
        for (time, row) in times.iter().zip((0..2000).filter(kept)) {
            assert!((time - 5.0 - 0.0025 * row as f64).abs() < 6e-4, "{row}");
        }
        let steps = times.windows(2).map(|pair| pair[1] - pair[0]);
        assert!(steps.skip(1).take(90).all(|step| (step - clock.period).abs() < 1e-12));
    }

    #[test]
    fn jitter_is_told_and_a_gap_is_none() {
        let mut times: Vec<f64> = (0..1000)
            .map(|row| 0.01 * f64::from(row) + if row % 2 == 0 { 1e-3 } else { -1e-3 })
            .collect();
        let clock = Clock::of(&mut times, 1e-6).ok().unwrap();
        assert!((clock.jitter - 1e-3).abs() < 1e-5 && !clock.rounded, "{clock:?}");
        assert_eq!(clock.missing, 0);
        for time in &mut times[500..] {
            *time += 0.1;
        }
        let gap = Clock::of(&mut times, 1e-6).err().unwrap();
        assert_eq!(gap.row, 500);
    }
}
