//! How much later the clock of a log runs, and how far its axes count from other zeros.
//!
//! The shift τ and the zeros z make the squares of `log(t) - predicted(t - τ) - z` least, each axis in the measure of
//! what is left of it, without the rows that are far off. There are many such shifts where a path goes to and fro, so
//! all are tried first, by correlation; the best of them are settled between the samples, and the one that explains
//! most rows is taken. A zero that explains hardly more than none is taken for none, and the shift found without it:
//! the prediction being early here and late there looks like one too.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::AxisTrack;
use super::settle::{self, AxisLevel, LogRows, Residual, SettledShift};
use super::shifts::{WeightedAxis, shifts};

/// Rows by which shifts are compared with one another.
const ROWS_COMPARED: usize = 4096;

/// Rows by which the best one is settled.
const ROWS_SETTLED: usize = 1 << 18;

/// An axis that moves less than this all in all, mm or radians, does not tell anything: it is noise.
const STILL: f64 = 1e-3;

/// Below this correlation nothing is alike.
const ALIKE: f64 = 0.7;

/// Least share of the rows that lies where it is predicted; of those of another program none do.
const LEAST_INSIDE: f64 = 0.4;

/// Most that what is left of a row counts for, in standard deviations, squared, where shifts are compared.
const MOST_LEFT: f64 = 25.0;

/// A second shift that leaves less than this many times the mean square of the best one is a rival.
const RIVAL: f64 = 2.0;

/// Less than this of a standard deviation, squared, is nothing.
const NOTHING: f64 = 0.01;

/// A row is far off by no less than this share of what the axis moves, standard deviation: early and late is not
/// elsewhere.
const FAR: f64 = 0.01;

/// How a log lies over a prediction.
#[derive(Clone, Debug, PartialEq)]
pub struct Alignment {
    /// Time of the log minus time of the prediction, s.
    pub shift: f64,
    /// Standard deviation of the shift, were what is left independent from row to row, s.
    pub shift_deviation: f64,
    /// What the log counts more, mm and radians; 0 of axes that were not asked for.
    pub zeros: Joints,
    /// Where both are known, s of the log's clock.
    pub overlap: [f64; 2],
    /// What is left while an axis moves, standard deviation from the median of sizes, mm and radians.
    pub left: Joints,
    /// Share of the rows, 0 to 1, in which an axis is so far off that the row says nothing of shift and zeros.
    pub far_off: f64,
    /// Likeness of each axis: 1 if nothing is left, 0 if they have nothing in common, -1 if it counts the other way;
    /// none of axes that stand still.
    pub alike: [Option<f64>; MAX_AXES],
    /// Likeness of all axes together, without rows that are far off.
    pub correlation: f64,
    /// Another shift, s, that leaves hardly more: the path is much the same there.
    pub rival: Option<f64>,
}

/// Why a log cannot be laid over a prediction.
#[derive(Clone, Debug, PartialEq)]
pub enum AlignmentFault {
    /// Log or prediction has fewer than this many samples.
    Short(usize),
    /// No axis moves in both.
    Still,
    /// No shift makes them alike; the best one.
    Unlike(Box<Alignment>),
}

/// Samples that are needed.
const FEWEST: usize = 8;

/// Lays `log` over `predicted` by the axes at the places `axes`. Both count an axis in the same sense and unit; a
/// rotary axis goes on over full turns. An axis with a zero in `zeros` counts from there; of the others zeros are
/// found.
///
/// # Errors
/// Nothing to compare, or nothing alike.
pub fn align(
    predicted: &AxisTrack,
    log: &AxisTrack,
    axes: &[usize],
    zeros: &[Option<f64>; MAX_AXES],
) -> Result<Alignment, AlignmentFault> {
    if predicted.joints.len().min(log.joints.len()) < FEWEST {
        return Err(AlignmentFault::Short(FEWEST));
    }
    let weighted = axes.iter();
    let weighted = weighted.filter_map(|axis| {
        Some(WeightedAxis { axis: *axis, weight: weight(predicted, log, *axis)? })
    });
    let weighted: Vec<WeightedAxis> = weighted.collect();
    let moving: Vec<usize> = weighted.iter().map(|weighted| weighted.axis).collect();
    let began = log.begins - predicted.begins;
    let tried = shifts(predicted, log, &weighted);
    let both = AlignedTracks { predicted, axes: &moving, step: predicted.period.max(log.period) };
    let rows = LogRows::of(log, ROWS_COMPARED);
    let tried: Vec<SettledShift> =
        tried.into_iter().map(|shift| both.settled(&rows, zeros, began + shift)).collect();
    let (best, rival) = both.best(&rows, &tried).ok_or(AlignmentFault::Still)?;
    let fixed = both.needed(&rows, zeros, best.shift);
    let rows = LogRows::of(log, ROWS_SETTLED);
    let found = both.settled(&rows, &fixed, best.shift);
    let (mut told, alike) = told(&found, &both, axes, &fixed, &rows);
    told.rival = rival;
    let inside = told.correlation >= ALIKE && told.far_off <= 1.0 - LEAST_INSIDE;
    if inside || alike >= ALIKE {
        return Ok(told);
    }
    Err(AlignmentFault::Unlike(Box::new(told)))
}

/// One divided by what an axis moves, squared; none if it stands still in one of both.
fn weight(predicted: &AxisTrack, log: &AxisTrack, axis: usize) -> Option<f64> {
    let variance = |track: &AxisTrack| {
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
struct AlignedTracks<'a> {
    predicted: &'a AxisTrack,
    /// Axes that move in both.
    axes: &'a [usize],
    step: f64,
}

impl AlignedTracks<'_> {
    fn settled(&self, rows: &LogRows, zeros: &[Option<f64>; MAX_AXES], shift: f64) -> SettledShift {
        settle::settled(self.predicted, rows, self.axes, zeros, shift, self.step)
    }

    /// The shift that leaves least, and another one that leaves hardly more.
    fn best<'t>(
        &self,
        rows: &LogRows,
        tried: &'t [SettledShift],
    ) -> Option<(&'t SettledShift, Option<f64>)> {
        let spreads = self.spreads(tried);
        let all = tried.iter().map(|one| (one, self.left(rows, one, &spreads)));
        let mut all: Vec<(&SettledShift, f64)> = all.collect();
        all.sort_by(|one, other| one.1.total_cmp(&other.1));
        let (best, least) = *all.first()?;
        let apart = 4.0 * self.step;
        let mut others = all[1..].iter();
        let rival = others.find(|(one, left)| {
            (one.shift - best.shift).abs() > apart && *left < RIVAL * least.max(NOTHING)
        });
        Some((best, rival.map(|(rival, _)| rival.shift)))
    }

    /// The zeros, with none where one that is found explains hardly more.
    fn needed(
        &self,
        rows: &LogRows,
        zeros: &[Option<f64>; MAX_AXES],
        shift: f64,
    ) -> [Option<f64>; MAX_AXES] {
        let mut needed = *zeros;
        let free = |zeros: &[Option<f64>; MAX_AXES]| {
            let axes = self.axes.iter().copied();
            axes.filter(|axis| zeros[*axis].is_none()).collect::<Vec<usize>>()
        };
        // All of them first: a zero of one axis may stand for that of another.
        let one_by_one = free(zeros).into_iter().map(|axis| vec![axis]);
        for axes in [free(zeros)].into_iter().chain(one_by_one) {
            let mut without = needed;
            for axis in axes {
                without[axis] = without[axis].or(Some(0.0));
            }
            if without == needed {
                continue;
            }
            let both = [&needed, &without].map(|zeros| self.settled(rows, zeros, shift));
            let off = settle::off(self.predicted, rows, both[0].shift);
            let mut widths = [f64::INFINITY; MAX_AXES];
            for axis in self.axes {
                widths[*axis] = settle::width(&off, *axis, both[0].levels[*axis]);
            }
            let [with, without_it] = both.map(|one| self.left(rows, &one, &widths));
            if without_it < RIVAL * with.max(NOTHING) {
                needed = without;
            }
        }
        needed
    }

    /// The least spread that any of them leaves, by axis: all are measured by it.
    fn spreads(&self, settled: &[SettledShift]) -> Joints {
        let mut spreads = [f64::INFINITY; MAX_AXES];
        for axis in self.axes {
            for one in settled {
                spreads[*axis] = spreads[*axis].min(one.levels[*axis].spread);
            }
        }
        spreads
    }

    /// What is left of a row on average, squared, all axes added up.
    fn left(&self, rows: &LogRows, settled: &SettledShift, spreads: &Joints) -> f64 {
        let rows = settle::off(self.predicted, rows, settled.shift);
        let mut sum = 0.0;
        for axis in self.axes {
            let level = settled.levels[*axis];
            for row in &rows {
                let by = (row.by[*axis] - level.zero) / spreads[*axis];
                sum += (by * by).min(MOST_LEFT);
            }
        }
        sum / rows.len().max(1) as f64
    }
}

/// Everything that is reported of a shift, of the axes that stand still their zeros too; and how alike both are with
/// all rows.
fn told(
    found: &SettledShift,
    both: &AlignedTracks<'_>,
    axes: &[usize],
    zeros: &[Option<f64>; MAX_AXES],
    rows: &LogRows,
) -> (Alignment, f64) {
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
    let [mut inside, mut all] = [0.0; 2];
    for axis in axes {
        let level = settle::level(&off, *axis, zeros[*axis]);
        told.zeros[*axis] = zeros[*axis].unwrap_or_else(|| settle::zero(&off, *axis, level));
        told.left[*axis] = level.spread;
        let as_wide = |spread: f64| AxisLevel { spread, ..level };
        let everywhere = as_wide(f64::INFINITY);
        let moved = settle::moved(&off, *axis);
        levels[*axis] = as_wide(level.spread.max(FAR * moved));
        if both.axes.contains(axis) {
            let alike = settle::likeness(&off, *axis, levels[*axis]);
            told.alike[*axis] = Some(alike);
            inside += alike;
            all += settle::likeness(&off, *axis, everywhere);
        }
    }
    let count = both.axes.len().max(1) as f64;
    told.correlation = inside / count;
    let far = |row: &&Residual| {
        let mut axes = both.axes.iter();
        axes.any(|axis| !settle::counts(row, *axis, levels[*axis]))
    };
    told.far_off = off.iter().filter(far).count() as f64 / off.len().max(1) as f64;
    (told, all / count)
}
