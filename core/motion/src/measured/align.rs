//! How much later the clock of a log runs, and how far its axes count from other zeros.
//!
//! The shift τ and the zeros z make the squares of `log(t) - predicted(t - τ) - z` least, each axis in the measure of what is
//! left of it, without the rows that are far off. There are many such shifts where a path goes to and fro, so all are tried
//! first, by correlation; the best of them are settled between the samples, and the one that explains most rows is taken.
//! A zero that is no larger than a few times what is left anyway is taken for none, and the shift found once more without
//! it: the prediction being early here and late there leaves such means too.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::Track;
use super::settle::{self, AxisLevel, Off, Rows, Settled};
use super::shifts::shifts;

/// Rows by which shifts are compared with one another.
const ROWS_COMPARED: usize = 4096;

/// Rows by which the best one is settled.
const ROWS_SETTLED: usize = 1 << 18;

/// An axis that moves less than this all in all, mm or radians, does not tell anything: it is noise.
const STILL: f64 = 1e-3;

/// Below this correlation nothing is alike.
const ALIKE: f64 = 0.7;

/// At least this share of the rows lies where it is predicted; of those of another program none do.
const LEAST_INSIDE: f64 = 0.4;

/// What is left of a row counts for no more than so many standard deviations, squared, where shifts are compared.
const MOST_LEFT: f64 = 25.0;

/// A second shift that leaves less than this many times the mean square of the best one is a rival.
const RIVAL: f64 = 2.0;

/// Less than this of a standard deviation, squared, is nothing.
const NOTHING: f64 = 0.01;

/// A zero below so many times what is left is none.
const NO_ZERO: f64 = 3.0;

/// How a log lies over a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// Time of the log minus time of the prediction, s.
    pub shift: f64,
    /// Its standard deviation, were what is left independent from row to row, s.
    pub shift_deviation: f64,
    /// What the log counts more, mm and radians; 0 of axes that were not asked for.
    pub zeros: Joints,
    /// Where both are known, s of the log's clock.
    pub overlap: [f64; 2],
    /// What is left while an axis moves, standard deviation from the median of sizes, mm and radians.
    pub left: Joints,
    /// Share of the rows, 0 to 1, in which an axis is so far off that the row says nothing of shift and zeros.
    pub far_off: f64,
    /// Of each axis 1 if nothing is left, 0 if they have nothing in common, -1 if it counts the other way; none of axes
    /// that stand still.
    pub alike: [Option<f64>; MAX_AXES],
    /// The same of all axes together, without rows that are far off.
    pub correlation: f64,
    /// Another shift, s, that leaves hardly more: the path is much the same there.
    pub rival: Option<f64>,
}

/// Why a log cannot be laid over a prediction.
#[derive(Clone, Debug, PartialEq)]
pub enum Unaligned {
    /// One of them has fewer than this many samples.
    Short(usize),
    /// No axis moves in both.
    Still,
    /// No shift makes them alike; the best one.
    Unlike(Box<Alignment>),
}

/// Samples that are needed.
const FEWEST: usize = 8;

/// Lays `log` over `predicted` by the axes at the places `axes`. Both count an axis in the same sense and unit; a rotary
/// axis goes on over full turns. An axis with a zero in `zeros` counts from there; of the others zeros are found.
///
/// # Errors
/// Nothing to compare, or nothing alike.
pub fn align(
    predicted: &Track,
    log: &Track,
    axes: &[usize],
    zeros: &[Option<f64>; MAX_AXES],
) -> Result<Alignment, Unaligned> {
    if predicted.joints.len().min(log.joints.len()) < FEWEST {
        return Err(Unaligned::Short(FEWEST));
    }
    let weighted = axes.iter();
    let weighted: Vec<(usize, f64)> = weighted
        .filter_map(|axis| Some((*axis, weight(predicted, log, *axis)?)))
        .collect();
    let moving: Vec<usize> = weighted.iter().map(|(axis, _)| *axis).collect();
    let began = log.begins - predicted.begins;
    let tried = shifts(predicted, log, &weighted);
    let both = Both {
        predicted,
        axes: &moving,
        step: predicted.period.max(log.period),
    };
    let rows = Rows::of(log, ROWS_COMPARED);
    let tried: Vec<Settled> = tried
        .into_iter()
        .map(|shift| both.settled(&rows, zeros, began + shift))
        .collect();
    let (best, rival) = both.best(&rows, &tried).ok_or(Unaligned::Still)?;
    let rows = Rows::of(log, ROWS_SETTLED);
    let mut found = both.settled(&rows, zeros, best.shift);
    let off = settle::off(predicted, &rows, found.shift);
    let mut fixed = *zeros;
    for axis in axes {
        let level = settle::level(&off, *axis, zeros[*axis]);
        if level.zero.abs() <= NO_ZERO * level.spread {
            fixed[*axis] = fixed[*axis].or(Some(0.0));
        }
    }
    if fixed != *zeros {
        found = both.settled(&rows, &fixed, found.shift);
    }
    let mut told = told(&found, &both, axes, &fixed, &rows);
    told.rival = rival;
    if told.correlation < ALIKE || told.far_off > 1.0 - LEAST_INSIDE {
        return Err(Unaligned::Unlike(Box::new(told)));
    }
    Ok(told)
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

/// What shifts are settled with.
struct Both<'a> {
    predicted: &'a Track,
    /// That move in both.
    axes: &'a [usize],
    step: f64,
}

impl Both<'_> {
    fn settled(&self, rows: &Rows, zeros: &[Option<f64>; MAX_AXES], shift: f64) -> Settled {
        settle::settled(self.predicted, rows, self.axes, zeros, shift, self.step)
    }

    /// The shift that leaves least, and another one that leaves hardly more.
    fn best<'t>(&self, rows: &Rows, tried: &'t [Settled]) -> Option<(&'t Settled, Option<f64>)> {
        // All are measured by what the closest of them leaves of an axis.
        let mut spreads = [f64::INFINITY; MAX_AXES];
        for axis in self.axes {
            for one in tried {
                spreads[*axis] = spreads[*axis].min(one.levels[*axis].spread);
            }
        }
        let left = |one: &Settled| {
            let rows = settle::off(self.predicted, rows, one.shift);
            let mut sum = 0.0;
            for axis in self.axes {
                let level = one.levels[*axis];
                for row in &rows {
                    let by = (row.by[*axis] - level.zero) / spreads[*axis];
                    sum += (by * by).min(MOST_LEFT);
                }
            }
            sum / rows.len().max(1) as f64
        };
        let mut all: Vec<(&Settled, f64)> = tried.iter().map(|one| (one, left(one))).collect();
        all.sort_by(|one, other| one.1.total_cmp(&other.1));
        let (best, least) = *all.first()?;
        let apart = 4.0 * self.step;
        let mut others = all[1..].iter();
        let rival = others.find(|(one, left)| {
            (one.shift - best.shift).abs() > apart && *left < RIVAL * least.max(NOTHING)
        });
        Some((best, rival.map(|(rival, _)| rival.shift)))
    }
}

/// All that is told of a shift; of the axes that stand still their zeros too.
fn told(
    found: &Settled,
    both: &Both<'_>,
    axes: &[usize],
    zeros: &[Option<f64>; MAX_AXES],
    rows: &Rows,
) -> Alignment {
    let off = settle::off(both.predicted, rows, found.shift);
    let mut told = Alignment {
        shift: found.shift,
        shift_deviation: found.deviation,
        zeros: Joints::default(),
        overlap: [f64::INFINITY, f64::NEG_INFINITY],
        left: Joints::default(),
        far_off: 0.0,
        alike: [None; MAX_AXES],
        correlation: 0.0,
        rival: None,
    };
    for row in &off {
        let [from, to] = told.overlap;
        told.overlap = [from.min(row.time), to.max(row.time)];
    }
    let mut levels = [AxisLevel::default(); MAX_AXES];
    let mut likeness = 0.0;
    for axis in axes {
        let level = settle::level(&off, *axis, zeros[*axis]);
        levels[*axis] = level;
        told.zeros[*axis] = zeros[*axis].unwrap_or_else(|| settle::zero(&off, *axis, level));
        told.left[*axis] = level.spread;
        if both.axes.contains(axis) {
            let [shared, moved] = settle::likeness(&off, *axis, level);
            let alike = if moved > 0.0 { shared / moved } else { 0.0 };
            told.alike[*axis] = Some(alike);
            likeness += alike;
        }
    }
    told.correlation = likeness / both.axes.len().max(1) as f64;
    let far = |row: &&Off| {
        let mut axes = both.axes.iter();
        axes.any(|axis| !settle::counts(row, *axis, levels[*axis]))
    };
    told.far_off = off.iter().filter(far).count() as f64 / off.len().max(1) as f64;
    told
}
