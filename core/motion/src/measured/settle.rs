//! A shift between the samples, and zeros, by least squares that rows far off do not move.
//!
//! Where the prediction starts from another place than the machine did, or the operator stopped it for a while, rows
//! are far off and say nothing of the shift: they are left out by Tukey's biweight (A. E. Beaton, J. W. Tukey, The
//! fitting of power series, meaning polynomials, illustrated on band-spectroscopic data, 1974), each axis measured by
//! the median of what is left of it while it moves.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::AxisTrack;

/// Standard deviations beyond which a row is left out.
const OUTSIDE: f64 = 4.685;

/// The standard deviation of what is normally distributed, over the median of its size.
const OF_MEDIAN: f64 = 1.4826;

/// Standard deviations within which nine of ten normally distributed values lie.
const OF_NINETY: f64 = 1.645;

/// Nothing is known more closely, mm or radians.
const FINEST: f64 = 1e-6;

/// An axis moves where it goes at this share of its median rate, of what is above a share of the root of its mean
/// square.
const MOVES: f64 = 0.1;
const CREEPS: f64 = 1e-3;

/// Steps of Gauss and Newton.
const STEPS: usize = 40;

/// A change of the shift that is nothing, s, and as a share of its standard deviation.
const SETTLED: f64 = 1e-10;
const SETTLED_SHARE: f64 = 1e-3;

/// Rows of a log, at any times.
pub(super) struct LogRows {
    pub times: Vec<f64>,
    pub joints: Vec<Joints>,
}

impl LogRows {
    /// At most `most` rows of a log, at uneven distances, so that none of them is that of something that comes again
    /// and again.
    pub fn of(log: &AxisTrack, most: usize) -> Self {
        let count = log.joints.len();
        let golden = 0.618_033_988_749_895;
        let places: Vec<usize> = match count > most {
            false => (0..count).collect(),
            true => (0..most)
                .map(|row| {
                    let within = (row as f64 * golden).fract();
                    ((row as f64 + within) * count as f64 / most as f64) as usize
                })
                .collect(),
        };
        Self {
            times: places.iter().map(|place| log.time(*place)).collect(),
            joints: places.iter().map(|place| log.joints[*place]).collect(),
        }
    }
}

/// A row of the log minus the prediction for it.
#[derive(Clone, Copy)]
pub(super) struct Residual {
    pub time: f64,
    /// mm or radians.
    pub by: Joints,
    /// How fast the prediction goes, mm/s or radians/s.
    rate: Joints,
    predicted: Joints,
}

/// Rows of the log that the prediction has, each minus it.
pub(super) fn off(predicted: &AxisTrack, rows: &LogRows, shift: f64) -> Vec<Residual> {
    let rows = rows.times.iter().zip(&rows.joints);
    rows.filter_map(|(time, joints)| {
        let (predicted, rate) = predicted.at_with_rate(*time - shift)?;
        Some(Residual {
            time: *time,
            by: std::array::from_fn(|axis| joints[axis] - predicted[axis]),
            rate,
            predicted,
        })
    })
    .collect()
}

/// Where an axis counts from, and how far it is off when that is taken off.
#[derive(Clone, Copy, Default)]
pub(super) struct AxisLevel {
    pub zero: f64,
    /// Standard deviation while it moves.
    pub spread: f64,
}

/// A shift, with what belongs to it.
#[derive(Clone)]
pub(super) struct SettledShift {
    pub shift: f64,
    /// Standard deviation of the shift, s.
    pub deviation: f64,
    pub levels: [AxisLevel; MAX_AXES],
}

/// The least squares from `shift` on, which is right to a few `step`s. Axes with a zero in `zeros` count from there.
pub(super) fn settled(
    predicted: &AxisTrack,
    rows: &LogRows,
    axes: &[usize],
    zeros: &[Option<f64>; MAX_AXES],
    shift: f64,
    step: f64,
) -> SettledShift {
    let mut found =
        SettledShift { shift, deviation: f64::INFINITY, levels: [AxisLevel::default(); MAX_AXES] };
    for _ in 0..STEPS {
        let rows = off(predicted, rows, found.shift);
        let (mut slope, mut curve) = (0.0, 0.0);
        for axis in axes {
            let level = level(&rows, *axis, zeros[*axis]);
            found.levels[*axis] = level;
            let [axis_slope, axis_curve] = normal(&rows, *axis, level, zeros[*axis].is_none());
            slope += axis_slope;
            curve += axis_curve;
        }
        if curve <= 0.0 {
            break;
        }
        found.deviation = libm::sqrt(1.0 / curve);
        // The difference grows by the rate times what the shift lacks: d(log - predicted(t - τ))/dτ is the rate.
        let by = (-slope / curve).clamp(-4.0 * step, 4.0 * step);
        found.shift += by;
        if by.abs() <= SETTLED.max(SETTLED_SHARE * found.deviation) {
            break;
        }
    }
    found
}

/// Level of one axis.
pub(super) fn level(rows: &[Residual], axis: usize, zero: Option<f64>) -> AxisLevel {
    let rates = || rows.iter().map(|row| row.rate[axis].abs());
    let squares: f64 = rates().map(|rate| rate * rate).sum();
    let creeps = CREEPS * libm::sqrt(squares / rows.len().max(1) as f64);
    let mut moves: Vec<f64> = rates().filter(|rate| *rate > creeps).collect();
    let slowest = MOVES * median(&mut moves);
    let moving = |row: &&Residual| slowest == 0.0 || row.rate[axis].abs() > slowest;
    let mut by: Vec<f64> = rows.iter().filter(moving).map(|row| row.by[axis]).collect();
    let zero = zero.unwrap_or_else(|| median(&mut by));
    for by in &mut by {
        *by = (*by - zero).abs();
    }
    AxisLevel { zero, spread: (OF_MEDIAN * median(&mut by)).max(FINEST) }
}

/// Slope and curve of the squares over the shift, in standard deviations; a zero that is free goes along.
fn normal(rows: &[Residual], axis: usize, level: AxisLevel, free: bool) -> [f64; 2] {
    let mut sums = [0.0; 5];
    for row in rows {
        let by = (row.by[axis] - level.zero) / level.spread;
        let rate = row.rate[axis] / level.spread;
        let weight = weight(by);
        let parts = [1.0, by, rate, by * rate, rate * rate];
        for (sum, part) in sums.iter_mut().zip(parts) {
            *sum += weight * part;
        }
    }
    let [all, by, rate, product, square] = sums;
    if all <= 0.0 {
        return [0.0; 2];
    }
    match free {
        true => [product - by * rate / all, square - rate * rate / all],
        false => [product, square],
    }
}

/// The standard deviation of most rows, those that are early or late among them: by the size that nine of ten do not
/// pass.
pub(super) fn width(rows: &[Residual], axis: usize, level: AxisLevel) -> f64 {
    let by = rows.iter().map(|row| (row.by[axis] - level.zero).abs());
    let mut by: Vec<f64> = by.collect();
    (quantile(&mut by, 0.9) / OF_NINETY).max(FINEST)
}

/// Weight of a row that is off by `by` standard deviations.
fn weight(by: f64) -> f64 {
    let share = by / OUTSIDE;
    let left = (1.0 - share * share).max(0.0);
    left * left
}

/// Whether a row counts at all.
pub(super) fn counts(row: &Residual, axis: usize, level: AxisLevel) -> bool {
    (row.by[axis] - level.zero).abs() <= OUTSIDE * level.spread
}

/// The zero that makes what is left of the rows that count least.
pub(super) fn zero(rows: &[Residual], axis: usize, level: AxisLevel) -> f64 {
    let (mut all, mut sum) = (0.0, 0.0);
    for row in rows {
        let by = row.by[axis] - level.zero;
        let weight = weight(by / level.spread);
        (all, sum) = (all + weight, sum + weight * by);
    }
    level.zero + if all > 0.0 { sum / all } else { 0.0 }
}

/// What an axis moves in the log, standard deviation.
pub(super) fn moved(rows: &[Residual], axis: usize) -> f64 {
    let count = rows.len().max(1) as f64;
    let logged = || rows.iter().map(|row| row.predicted[axis] + row.by[axis]);
    let mean = logged().sum::<f64>() / count;
    let squares: f64 = logged().map(|value| (value - mean) * (value - mean)).sum();
    libm::sqrt(squares / count)
}

/// How alike both are in the rows that count: 1 if nothing is left, 0 if they have nothing in common, -1 if they count
/// in opposite senses.
pub(super) fn likeness(rows: &[Residual], axis: usize, level: AxisLevel) -> f64 {
    let inside = || rows.iter().filter(|row| counts(row, axis, level));
    let count = inside().count().max(1) as f64;
    let mean = |value: &dyn Fn(&Residual) -> f64| inside().map(value).sum::<f64>() / count;
    let predicted = |row: &Residual| row.predicted[axis];
    let logged = |row: &Residual| row.predicted[axis] + row.by[axis] - level.zero;
    let [centre, log_centre] = [mean(&predicted), mean(&logged)];
    let variance = mean(&|row| (predicted(row) - centre) * (predicted(row) - centre));
    let log_variance = mean(&|row| (logged(row) - log_centre) * (logged(row) - log_centre));
    let covariance = mean(&|row| (predicted(row) - centre) * (logged(row) - log_centre));
    let variances = variance + log_variance;
    if variances > 0.0 { 2.0 * covariance / variances } else { 0.0 }
}

fn median(values: &mut [f64]) -> f64 {
    quantile(values, 0.5)
}

/// What this share of the values does not pass, 0 of none; they end in another order.
fn quantile(values: &mut [f64], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let place = (values.len() as f64 * share) as usize;
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}
