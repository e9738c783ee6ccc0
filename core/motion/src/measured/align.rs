//! How much later the clock of a log runs, and how far its axes count from other zeros.
//!
//! The shift τ and the zeros z make the mean square of `log(t) - predicted(t - τ) - z` least, each axis weighted by what it
//! moves in all. At any τ the best zeros are the mean differences, so that what is left is a variance; a zero that is no
//! larger than a few times what is left anyway is taken for none, and the shift found once more without it. It has many minima
//! where a path goes to and fro, so all shifts are tried first, on means over so long a time that few are left; the best of
//! them are followed down through means over half the time each, to the samples; the last step, between the samples, is
//! Gauss and Newton's.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::Track;

/// So few means that all shifts can be tried.
const COARSEST: usize = 2048;

/// Shifts that are followed from there.
const FOLLOWED: usize = 8;

/// An axis that moves less than this all in all, mm or radians, does not tell anything: it is noise.
const STILL: f64 = 1e-3;

/// Of the shorter of both at least this share lies over the other, and of what moves in it.
const SHORTEST_OVERLAP: f64 = 0.5;
const LEAST_MOVED: f64 = 0.1;

/// Below this correlation nothing is alike.
const ALIKE: f64 = 0.7;

/// A second shift that leaves less than this many times the variance of the best one is a rival.
const RIVAL: f64 = 2.0;

/// A zero below so many times what is left (root of the mean square) is none: the prediction being early here and late
/// there leaves such means too.
const NO_ZERO: f64 = 3.0;

/// Steps of Gauss and Newton.
const STEPS: usize = 20;

/// A change of the shift that is nothing, s.
const SETTLED: f64 = 1e-10;

/// How a log lies over a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// Time of the log minus time of the prediction, s.
    pub shift: f64,
    /// Its standard deviation, were what is left independent from sample to sample, s.
    pub shift_deviation: f64,
    /// What the log counts more, mm and radians; 0 of axes that were not asked for.
    pub zeros: Joints,
    /// Where both are known, s of the log's clock.
    pub overlap: [f64; 2],
    /// What is left, root of the mean square, mm and radians.
    pub left: Joints,
    /// 1 if nothing is left; 0 if they have nothing in common.
    pub correlation: f64,
    /// Another shift, s, that leaves hardly more: the path is much the same there.
    pub rival: Option<f64>,
}

/// Why a log cannot be laid over a prediction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unaligned {
    /// One of them has fewer than this many samples.
    Short(usize),
    /// No axis moves in both.
    Still,
    /// No shift makes them alike; the correlation of the best one.
    Unlike(f64),
}

/// Samples that are needed.
const FEWEST: usize = 8;

/// Lays `log` over `predicted` by the axes at the places `axes`. Both count an axis in the same sense and unit; a rotary
/// axis goes on over full turns.
///
/// # Errors
/// Nothing to compare, or nothing alike.
pub fn align(predicted: &Track, log: &Track, axes: &[usize]) -> Result<Alignment, Unaligned> {
    if predicted.joints.len().min(log.joints.len()) < FEWEST {
        return Err(Unaligned::Short(FEWEST));
    }
    let step = predicted.period.max(log.period);
    let axes: Vec<(usize, f64)> = axes
        .iter()
        .filter_map(|axis| Some((*axis, weight(predicted, log, *axis)?)))
        .collect();
    if axes.is_empty() {
        return Err(Unaligned::Still);
    }
    let mut levels = vec![Level {
        step,
        tracks: [predicted, log].map(|track| Means::of(track, step, &axes)),
    }];
    loop {
        let finest = &levels[levels.len() - 1];
        let [predicted, log] = &finest.tracks;
        if predicted.count().max(log.count()) <= COARSEST
            || predicted.count().min(log.count()) < 2 * FEWEST
        {
            break;
        }
        levels.push(finest.halved());
    }
    let (best, rival) = followed(&levels).ok_or(Unaligned::Still)?;
    let began = log.begins - predicted.begins;
    let shift = |score: &Score| began + score.shift as f64 * step;
    let mut free = [true; MAX_AXES];
    let mut found = settled(predicted, log, &axes, free, shift(&best), step);
    for (axis, _) in &axes {
        free[*axis] = found.zeros[*axis].abs() > NO_ZERO * found.left[*axis];
    }
    if free.contains(&false) {
        found = settled(predicted, log, &axes, free, found.shift, step);
    }
    let correlation = best.correlation.max(found.correlation);
    if correlation < ALIKE {
        return Err(Unaligned::Unlike(correlation));
    }
    Ok(Alignment {
        correlation,
        rival: rival.as_ref().map(shift),
        ..found
    })
}

/// One divided by what an axis moves, squared; none if it stands still in one of both.
fn weight(predicted: &Track, log: &Track, axis: usize) -> Option<f64> {
    let variance = |track: &Track| {
        let values = || track.joints.iter().map(|joints| joints[axis]);
        let count = track.joints.len() as f64;
        let mean = values().sum::<f64>() / count;
        let squares: f64 = values().map(|value| (value - mean) * (value - mean)).sum();
        squares / count
    };
    let [predicted, log] = [predicted, log].map(variance);
    (predicted.min(log) > STILL * STILL).then(|| 2.0 / (predicted + log))
}

/// Both at the same step.
struct Level {
    step: f64,
    tracks: [Means; 2],
}

impl Level {
    fn halved(&self) -> Self {
        Self {
            step: 2.0 * self.step,
            tracks: [0, 1].map(|which| self.tracks[which].halved()),
        }
    }
}

/// Axis values, weighted, with sums up to each place.
struct Means {
    /// By axis.
    values: Vec<Vec<f64>>,
    /// Sums of values and of their squares before each place, by axis.
    sums: Vec<Vec<[f64; 2]>>,
    /// The variance of all, summed over the axes.
    variance: f64,
}

impl Means {
    fn of(track: &Track, step: f64, axes: &[(usize, f64)]) -> Self {
        let count = libm::floor(track.seconds() / step + 1e-6) as usize + 1;
        let same = track.period == step;
        let mut values = vec![Vec::with_capacity(count); axes.len()];
        for place in 0..count {
            let joints = match same {
                true => track.joints[place],
                false => track
                    .at(track.begins + place as f64 * step)
                    .unwrap_or_else(|| track.joints[track.joints.len() - 1]),
            };
            for (values, (axis, weight)) in values.iter_mut().zip(axes) {
                values.push(joints[*axis] * weight.sqrt());
            }
        }
        Self::new(values)
    }

    fn new(mut values: Vec<Vec<f64>>) -> Self {
        let count = values.first().map_or(0, Vec::len);
        let mut variance = 0.0;
        let mut all = Vec::new();
        for values in &mut values {
            let mean = values.iter().sum::<f64>() / count.max(1) as f64;
            let mut sums = Vec::with_capacity(count + 1);
            let mut so_far = [0.0; 2];
            sums.push(so_far);
            for value in values.iter_mut() {
                *value -= mean;
                so_far = [so_far[0] + *value, so_far[1] + *value * *value];
                sums.push(so_far);
            }
            variance += so_far[1] / count.max(1) as f64;
            all.push(sums);
        }
        Self {
            values,
            sums: all,
            variance,
        }
    }

    fn count(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    fn halved(&self) -> Self {
        let pairs = |values: &Vec<f64>| {
            let pairs = values.chunks_exact(2);
            pairs.map(|pair| (pair[0] + pair[1]) / 2.0).collect()
        };
        Self::new(self.values.iter().map(pairs).collect())
    }
}

/// How well a shift does.
#[derive(Clone, Copy, Debug)]
struct Score {
    /// Place in the log minus place in the prediction.
    shift: i64,
    correlation: f64,
    /// The variance that is left.
    left: f64,
}

/// The score of a shift; none if too little lies over one another.
fn score(level: &Level, shift: i64) -> Option<Score> {
    let [predicted, log] = &level.tracks;
    let [predicted_count, log_count] = [predicted.count() as i64, log.count() as i64];
    let from = 0.max(-shift);
    let to = predicted_count.min(log_count - shift);
    let shorter = predicted_count.min(log_count) as f64;
    if to - from < FEWEST as i64 || ((to - from) as f64) < SHORTEST_OVERLAP * shorter {
        return None;
    }
    let count = (to - from) as f64;
    let [from, to] = [from as usize, to as usize];
    let [log_from, log_to] = [from, to].map(|place| (place as i64 + shift) as usize);
    let (mut variances, mut covariance) = (0.0, 0.0);
    for axis in 0..predicted.values.len() {
        let over = |means: &Means, [from, to]: [usize; 2]| {
            let [left, right] = [from, to].map(|place| means.sums[axis][place]);
            let mean = (right[0] - left[0]) / count;
            (mean, (right[1] - left[1]) / count - mean * mean)
        };
        let (mean, variance) = over(predicted, [from, to]);
        let (log_mean, log_variance) = over(log, [log_from, log_to]);
        let products: f64 = predicted.values[axis][from..to]
            .iter()
            .zip(&log.values[axis][log_from..log_to])
            .map(|(predicted, log)| predicted * log)
            .sum();
        covariance += products / count - mean * log_mean;
        variances += variance + log_variance;
    }
    let moved = LEAST_MOVED * predicted.variance.min(log.variance);
    (variances > 2.0 * moved && variances > 0.0).then(|| Score {
        shift,
        correlation: 2.0 * covariance / variances,
        left: (variances - 2.0 * covariance).max(0.0),
    })
}

/// The best shift in steps of the finest level, and a rival of it.
fn followed(levels: &[Level]) -> Option<(Score, Option<Score>)> {
    let coarsest = levels.last()?;
    let [predicted, log] = coarsest.tracks.each_ref().map(|means| means.count() as i64);
    let scores: Vec<Option<Score>> = (-predicted..=log)
        .map(|shift| score(coarsest, shift))
        .collect();
    let correlation = |place: usize| {
        let score = scores.get(place).copied().flatten();
        score.map_or(f64::NEG_INFINITY, |score| score.correlation)
    };
    let mut peaks: Vec<Score> = (0..scores.len())
        .filter(|place| {
            let before = place.checked_sub(1).map_or(f64::NEG_INFINITY, correlation);
            correlation(*place) >= before && correlation(*place) > correlation(place + 1)
        })
        .filter_map(|place| scores[place])
        .collect();
    peaks.sort_by(|one, other| other.correlation.total_cmp(&one.correlation));
    peaks.truncate(FOLLOWED);
    let mut ends: Vec<Score> = peaks
        .into_iter()
        .filter_map(|peak| {
            levels[..levels.len() - 1]
                .iter()
                .rev()
                .try_fold(peak, |peak, level| {
                    (-2..=3)
                        .filter_map(|by| score(level, 2 * peak.shift + by))
                        .max_by(|one, other| one.correlation.total_cmp(&other.correlation))
                })
        })
        .collect();
    ends.sort_by(|one, other| other.correlation.total_cmp(&one.correlation));
    let best = *ends.first()?;
    // A neighbour of the best shift is no other.
    let apart = (coarsest.step / levels[0].step) as i64 * 4;
    let rival = ends[1..].iter().find(|end| {
        (end.shift - best.shift).abs() > apart && end.left < RIVAL * best.left.max(1e-12)
    });
    Some((best, rival.copied()))
}

/// The least squares between the samples, from a shift that is right to `step`.
fn settled(
    predicted: &Track,
    log: &Track,
    axes: &[(usize, f64)],
    free: [bool; MAX_AXES],
    shift: f64,
    step: f64,
) -> Alignment {
    let mut best = normal(predicted, log, axes, free, shift);
    for _ in 0..STEPS {
        let mut by = best.change.clamp(-step, step);
        let mut next = normal(predicted, log, axes, free, best.found.shift + by);
        while next.squares > best.squares && by.abs() > SETTLED {
            by /= 2.0;
            next = normal(predicted, log, axes, free, best.found.shift + by);
        }
        if by.abs() <= SETTLED {
            break;
        }
        best = next;
    }
    best.found
}

/// The normal equation of the shift.
struct Normal {
    /// What is left, squared, weighted and summed over the axes.
    squares: f64,
    /// What Gauss and Newton would change the shift by, s.
    change: f64,
    found: Alignment,
}

/// The normal equation at a shift, and all that is told of it. Axes that are not `free` count from the same zero in both.
fn normal(
    predicted: &Track,
    log: &Track,
    axes: &[(usize, f64)],
    free: [bool; MAX_AXES],
    shift: f64,
) -> Normal {
    let mut count = 0.0;
    // Sums of difference, its square, rate, its square, and both multiplied.
    let mut sums = [[0.0; 5]; MAX_AXES];
    // From about the middle of the first differences, so that squares keep their digits.
    let mut first: Option<Joints> = None;
    let mut overlap = [f64::INFINITY, f64::NEG_INFINITY];
    for (place, joints) in log.joints.iter().enumerate() {
        let time = log.time(place);
        let Some((values, rates)) = predicted.at_with_rate(time - shift) else {
            continue;
        };
        count += 1.0;
        overlap = [overlap[0].min(time), overlap[1].max(time)];
        let differences: Joints = std::array::from_fn(|axis| joints[axis] - values[axis]);
        let first = first.get_or_insert_with(|| {
            std::array::from_fn(|axis| if free[axis] { differences[axis] } else { 0.0 })
        });
        for (axis, _) in axes {
            let (difference, rate) = (differences[*axis] - first[*axis], rates[*axis]);
            let parts = [
                difference,
                difference * difference,
                rate,
                rate * rate,
                difference * rate,
            ];
            for (sum, part) in sums[*axis].iter_mut().zip(parts) {
                *sum += part;
            }
        }
    }
    let first = first.unwrap_or_default();
    let mut found = Alignment {
        shift,
        shift_deviation: f64::INFINITY,
        zeros: Joints::default(),
        overlap,
        left: Joints::default(),
        correlation: 0.0,
        rival: None,
    };
    let (mut squares, mut slope, mut curve, mut moved) = (0.0, 0.0, 0.0, 0.0);
    for (axis, weight) in axes {
        let mut sums = sums[*axis].map(|sum| sum / f64::max(count, 1.0));
        if !free[*axis] {
            // Nothing is taken off the means.
            (sums[0], sums[2]) = (0.0, 0.0);
        }
        let [difference, square, rate, rate_square, product] = sums;
        let left = (square - difference * difference).max(0.0);
        found.zeros[*axis] = first[*axis] + difference;
        found.left[*axis] = left.sqrt();
        squares += weight * left;
        slope += weight * (product - difference * rate);
        curve += weight * (rate_square - rate * rate).max(0.0);
        moved += 1.0;
    }
    found.correlation = 1.0 - squares / 2.0 / moved;
    if count > 2.0 && curve > 0.0 {
        found.shift_deviation = (squares / curve / (count - 2.0)).sqrt();
    }
    // The difference grows by the rate times what the shift lacks: d(log - predicted(t - τ))/dτ is the rate.
    let change = if curve > 0.0 { -slope / curve } else { 0.0 };
    Normal {
        squares,
        change,
        found,
    }
}
