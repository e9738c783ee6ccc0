//! Contour error by the servo's frequency response (feedrate paper, eqs. 6 to 13).

mod across;
mod lags;

use super::{Channel, Collocation, Limit, Order, SampleRange, least_of_blocks};
use crate::response::DriveResponse;
use crate::samples::Samples;
use crate::table::{LimitRow, LimitTable};
use across::{Across, MotionBound};
use lags::Lags;

/// Steps of the table of frequencies.
const STEPS: usize = 4096;

/// The lowest frequency of the table, as a share of the highest.
const LOWEST: f64 = 1e-6;

/// Share by which deviations are rounded up, for what lies between two frequencies of the table.
const MARGIN: f64 = 4e-6;

/// A path that is straighter than this has this curvature, 1/mm: an arc of a kilometre.
const STRAIGHT: f64 = 1e-6;

/// What the drives leave between the tip and its path, where they follow a path that goes on evenly.
///
/// **Where it is known how each axis moves the tip** ([`Samples::rates`]), for any number of axes, straight or turning:
/// lags that all axes share are no contour error; differences of lags and what is missing of the accelerations are, as
/// far as they move the tip across its path. What each frequency leaves is derived in `contour_error/across.rs`:
/// `L ṡ + S q + C |s̈| <= tolerance`, which bounds `q`, and where axes answer differently is a row between neighbours
/// too. The axes are then the first of [`Samples::axes`], and what stands after them there moves no tip; one without a
/// servo answers [`Answer::EXACT`].
///
/// **Where it is not known** the axes are those that lead the tip, and a local arc of radius `ρ` is followed at
/// `ω = f / ρ`. The steady path of the axes strays from it by at most `ρ * D(ω)`, so `f <= ρ * ω0` with the largest `ω0`
/// for which `D <= tolerance / ρ` up to it. `D = |1 - |G||` where all axes have the same response `G` (eqs. 6, 7). Where
/// two differ it is the largest `|1 - |G||` of them plus half the largest difference of their phases in radians: one
/// axis late against the other makes an ellipse of the circle, to first order with half axes `1 ± difference / 2`, at 45
/// degrees to the axes.
///
/// Either way `ω` is at most the highest frequency (the natural frequency of the machine, as in eq. 11), and
/// [`Samples::contour_share`] says how much of the tolerance may be used where. It is a formula of the steady state: what
/// the drives really leave where curvature changes may be more, and a simulation of them says how much.
///
/// [`Answer::EXACT`]: crate::response::ComplexGain::EXACT
#[derive(Clone, Debug)]
pub struct ContourError {
    /// Largest contour error, mm.
    tolerance: f64,
    collocation: Collocation,
    /// Frequencies, rad/s, evenly spaced on a logarithmic scale.
    frequencies: Vec<f64>,
    /// The largest `D` up to each of them.
    deviations: Vec<f64>,
    lags: Lags,
}

impl ContourError {
    /// Makes the limit for these axes, in the order of [`Samples::axes`], and a tolerance in mm, up to `highest` rad/s.
    #[must_use]
    pub fn new(
        axes: &[&dyn DriveResponse],
        tolerance: f64,
        highest: f64,
        collocation: Collocation,
    ) -> Self {
        let mut most: f64 = 0.0;
        let ratio = libm::log(1.0 / LOWEST) / STEPS as f64;
        // From the top, so that the highest is exact.
        let at = |step: usize| highest * libm::exp(-ratio * (STEPS - step) as f64);
        let frequencies: Vec<f64> = (0..=STEPS).map(at).collect();
        let largest = |&frequency: &f64| {
            most = most.max(deviation(axes, frequency) * (1.0 + MARGIN));
            most
        };
        let deviations = frequencies.iter().map(largest).collect();
        Self { tolerance, collocation, frequencies, deviations, lags: Lags::new(axes, highest) }
    }

    /// The largest frequency up to which the contour error of an arc of this curvature in 1/mm is within the
    /// tolerance, rad/s.
    #[must_use]
    pub fn frequency(&self, curvature: f64) -> f64 {
        self.faithful_up_to(curvature * self.tolerance)
    }

    /// The fastest feed on a path of this curvature, mm/s.
    #[must_use]
    pub fn feed(&self, curvature: f64) -> f64 {
        self.feed_within(curvature, self.tolerance)
    }

    fn feed_within(&self, curvature: f64, tolerance: f64) -> f64 {
        let curvature = curvature.max(STRAIGHT);
        self.faithful_up_to(curvature * tolerance) / curvature
    }

    /// The largest frequency up to which `D` is within `allowed`, rad/s.
    fn faithful_up_to(&self, allowed: f64) -> f64 {
        let after = self.deviations.partition_point(|&most| most <= allowed);
        if after == 0 {
            // Where frequencies go to 0 a deviation falls with the frequency at least.
            return self.frequencies[0] * allowed / self.deviations[0];
        }
        let Some(&above) = self.deviations.get(after) else {
            return self.frequencies[after - 1];
        };
        // On the chord between two frequencies.
        let below = self.deviations[after - 1];
        let share = (allowed - below) / (above - below);
        let low = self.frequencies[after - 1];
        low + share * (self.frequencies[after] - low)
    }

    /// The bound at a sample where it is known how each axis moves the tip.
    fn at(&self, across: &mut Across, samples: &Samples, sample: usize) -> MotionBound {
        across.take(samples, sample, self.lags.axes());
        let share = samples.contour_share.get(sample).copied().unwrap_or(1.0);
        let tolerance = self.tolerance * share;
        if !self.lags.alike() {
            return across.bound(&self.lags, tolerance);
        }
        let turning = across.turning();
        let frequency = self.faithful_up_to(tolerance * turning * turning / across.bend());
        MotionBound {
            speed: if turning > 0.0 { frequency / turning } else { f64::INFINITY },
            rate: 0.0,
            push: 0.0,
        }
    }

    /// Bounds and rows where it is known how each axis moves the tip.
    fn through_axes(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        let mut across = Across::default();
        let mut before: Option<MotionBound> = None;
        for sample in 0..samples.len() {
            let here = self.at(&mut across, samples, sample);
            let bound = here.speed * here.speed;
            table.lower(sample, bound, None);
            if let Some(before) = before {
                if self.collocation == Collocation::Throughout {
                    table.lower(sample - 1, bound, None);
                    table.lower(sample, before.speed * before.speed, None);
                }
                if !self.lags.alike() {
                    let rows = rows(&before, &here, samples.step(sample - 1));
                    let count = self.row_count();
                    table.rows_mut(sample - 1)[..count].copy_from_slice(&rows[..count]);
                }
            }
            before = Some(here);
        }
    }

    /// Rows of each interval: none where axes answer alike, else two at its first sample, or at each of its ends.
    fn row_count(&self) -> usize {
        match self.collocation {
            _ if self.lags.alike() => 0,
            Collocation::Start => 2,
            Collocation::Ends | Collocation::Throughout => 4,
        }
    }
}

/// Channels that keep the bounds at both ends of an interval, one for each sign.
fn channels(first: &MotionBound, last: &MotionBound) -> [Channel; 2] {
    [1.0, -1.0].map(|sign| Channel {
        first: [sign * first.push, sign * last.push],
        second: [first.rate, last.rate],
        third: [0.0; 3],
        order: Order::Acceleration,
        limit: 1.0,
        axis: None,
    })
}

/// `|rate * q ± push * s̈| <= 1` at both ends of an interval, with `s̈ = (q[i + 1] - q[i]) / (2 * step)`.
fn rows(first: &MotionBound, last: &MotionBound, step: f64) -> [LimitRow; 4] {
    let row = |bound: &MotionBound, at_end: bool, sign: f64| {
        let push = sign * 0.5 * bound.push / step;
        let [here, next] = if at_end { [0.0, bound.rate] } else { [bound.rate, 0.0] };
        LimitRow { here: here - push, next: next + push }
    };
    [row(first, false, 1.0), row(first, false, -1.0), row(last, true, 1.0), row(last, true, -1.0)]
}

/// Share of its radius by which the steady path of the axes strays from a circle that is followed at `frequency` rad/s.
#[must_use]
pub fn deviation(axes: &[&dyn DriveResponse], frequency: f64) -> f64 {
    let answers: Vec<_> = axes.iter().map(|axis| axis.at(frequency)).collect();
    let mut size: f64 = 0.0;
    let mut phase: f64 = 0.0;
    for (index, answer) in answers.iter().enumerate() {
        size = size.max((1.0 - answer.gain()).abs());
        for other in &answers[..index] {
            phase = phase.max(answer.phase_from(*other).abs());
        }
    }
    size + 0.5 * phase
}

impl Limit for ContourError {
    fn name(&self) -> &'static str {
        "contour error"
    }

    fn rows(&self, _: &Samples) -> Vec<Option<u16>> {
        vec![None; self.row_count()]
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        if samples.has_rates() {
            if samples.rates.len() >= self.lags.axes() {
                return self.through_axes(samples, table);
            }
            // No bound is known for axes of which nothing is known.
            return (0..samples.len()).for_each(|sample| table.lower(sample, f64::NAN, None));
        }
        let moving = SampleRange::all(samples, self.collocation).filter(|place| !place.is_still());
        for place in moving {
            let share = least_of_blocks(&samples.contour_share, &place);
            let share = if share == f64::INFINITY { 1.0 } else { share };
            let feed = self.feed_within(place.curvature, self.tolerance * share);
            place.bound(table, feed / place.stretch);
        }
    }

    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        if self.lags.alike() || samples.rates.len() < self.lags.axes() {
            return;
        }
        let mut across = Across::default();
        let [first, last] =
            [interval, interval + 1].map(|sample| self.at(&mut across, samples, sample));
        channels(&first, &last).into_iter().for_each(sink);
    }
}
