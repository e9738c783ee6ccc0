//! All shifts of a log against a prediction, and those at which they are most alike.
//!
//! The products of both at every shift come from one Fourier transform forth an axis and one back for all of them; what
//! lies over one another at a shift is centred by sums up to each place, so that zeros do not matter.

use super::AxisTrack;
use crate::fourier::{transform, turns};

/// Means that are laid over one another, of both together; longer ones are taken over a longer time each.
const MOST_MEANS: usize = 1 << 18;

/// Shifts that are looked at more closely.
const MOST_PEAKS: usize = 32;

/// Depth of the valley between two peaks of the correlation, below the lower one.
const VALLEY: f64 = 1e-4;

/// Least share of the shorter of both that lies over the other, and of what moves in it.
const SHORTEST_OVERLAP: f64 = 0.5;
const LEAST_MOVED: f64 = 0.1;

/// Means that lie over one another at least.
const FEWEST: usize = 8;

/// An axis by its place in the chain, and what its values are multiplied by, squared.
#[derive(Clone, Copy, Debug)]
pub(super) struct WeightedAxis {
    pub axis: usize,
    pub weight: f64,
}

/// Shifts, s, the beginnings of both apart, at which `log` is most like `predicted`: the best one first. Each of `axes`
/// has its weight.
pub(super) fn shifts(predicted: &AxisTrack, log: &AxisTrack, axes: &[WeightedAxis]) -> Vec<f64> {
    let mut step = predicted.period.max(log.period);
    let mut both = [predicted, log].map(|track| MeanTrack::of(track, step, axes));
    while both[0].count() + both[1].count() > MOST_MEANS
        && both[0].count().min(both[1].count()) >= 4 * FEWEST
    {
        both = both.map(|means| means.halved());
        step *= 2.0;
    }
    let mut peaks = peaks(&both);
    peaks.sort_by(|one, other| other.1.total_cmp(&one.1));
    peaks.truncate(MOST_PEAKS);
    let shifts = peaks.into_iter().map(|(shift, _)| shift as f64 * step);
    shifts.collect()
}

/// Axis values, weighted, with sums up to each place.
struct MeanTrack {
    /// Values by axis.
    values: Vec<Vec<f64>>,
    /// Sums of values and of their squares before each place, by axis.
    sums: Vec<Vec<[f64; 2]>>,
    /// The variance of all, summed over the axes.
    variance: f64,
}

impl MeanTrack {
    fn of(track: &AxisTrack, step: f64, axes: &[WeightedAxis]) -> Self {
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
            for (values, WeightedAxis { axis, weight }) in values.iter_mut().zip(axes) {
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
        Self { values, sums: all, variance }
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

    /// Sum of the axes' variances between two places, and their means.
    fn between(&self, from: usize, to: usize) -> (f64, impl Iterator<Item = f64>) {
        let count = (to - from) as f64;
        let parts = move |sums: &Vec<[f64; 2]>| {
            let [first, last] = [from, to].map(|place| sums[place]);
            let mean = (last[0] - first[0]) / count;
            (mean, (last[1] - first[1]) / count - mean * mean)
        };
        let variance = self.sums.iter().map(|sums| parts(sums).1).sum();
        (variance, self.sums.iter().map(move |sums| parts(sums).0))
    }
}

/// Sums of products of both, by shift from 0 on and, from the end back, from -1 on.
fn products([predicted, log]: &[MeanTrack; 2]) -> Vec<[f64; 2]> {
    let count = (predicted.count() + log.count()).next_power_of_two();
    let turns = turns(count);
    let mut sums = vec![[0.0; 2]; count];
    let mut both = vec![[0.0; 2]; count];
    for (predicted, log) in predicted.values.iter().zip(&log.values) {
        both.fill([0.0; 2]);
        for (both, value) in both.iter_mut().zip(predicted) {
            both[0] = *value;
        }
        for (both, value) in both.iter_mut().zip(log) {
            both[1] = *value;
        }
        transform(&mut both, &turns);
        for (place, sum) in sums.iter_mut().enumerate() {
            let [[a, b], [c, d]] = [both[place], both[(count - place) % count]];
            // Of p + i·l: P = (Z[k] + Z*[-k])/2, L = (Z[k] - Z*[-k])/(2i). P*·L, conjugated, so that forth is back.
            let [p, l] = [[a + c, b - d], [b + d, c - a]].map(|[re, im]| [re / 2.0, im / 2.0]);
            *sum = [sum[0] + p[0] * l[0] + p[1] * l[1], sum[1] - (p[0] * l[1] - p[1] * l[0])];
        }
    }
    transform(&mut sums, &turns);
    let scale = 1.0 / count as f64;
    for sum in &mut sums {
        *sum = [sum[0] * scale, -sum[1] * scale];
    }
    sums
}

/// The correlation at a shift, place in the log minus place in the prediction; none if too little lies over one
/// another.
fn correlation([predicted, log]: &[MeanTrack; 2], shift: i64, product: f64) -> Option<f64> {
    let counts = [predicted.count() as i64, log.count() as i64];
    let from = 0.max(-shift);
    let to = counts[0].min(counts[1] - shift);
    let shorter = counts[0].min(counts[1]) as f64;
    if to - from < FEWEST as i64 || ((to - from) as f64) < SHORTEST_OVERLAP * shorter {
        return None;
    }
    let count = (to - from) as f64;
    let (variance, means) = predicted.between(from as usize, to as usize);
    let (log_variance, log_means) = log.between((from + shift) as usize, (to + shift) as usize);
    let of_means: f64 = means.zip(log_means).map(|(one, other)| one * other).sum();
    let covariance = product / count - of_means;
    let moved = LEAST_MOVED * predicted.variance.min(log.variance);
    let variances = variance + log_variance;
    (variances > 2.0 * moved && variances > 0.0).then(|| 2.0 * covariance / variances)
}

/// Shifts at which the correlation is larger than around them, and how large it is.
fn peaks(both: &[MeanTrack; 2]) -> Vec<(i64, f64)> {
    let products = products(both);
    let [predicted, log] = both.each_ref().map(|means| means.count() as i64);
    let mut peaks = Vec::new();
    // The highest since the last valley, and the lowest since the last peak.
    let mut top: Option<(i64, f64)> = None;
    let mut bottom = f64::NEG_INFINITY;
    for shift in -predicted..=log {
        let place = shift.rem_euclid(products.len() as i64) as usize;
        let Some(value) = correlation(both, shift, products[place][0]) else {
            peaks.extend(top.take());
            bottom = f64::NEG_INFINITY;
            continue;
        };
        match top {
            Some((_, highest)) if value < highest - VALLEY => {
                peaks.extend(top.take());
                bottom = value;
            }
            Some((_, highest)) if value > highest => top = Some((shift, value)),
            Some(_) => {}
            None if value > bottom + VALLEY => top = Some((shift, value)),
            None => bottom = bottom.min(value),
        }
    }
    peaks.extend(top);
    peaks
}
