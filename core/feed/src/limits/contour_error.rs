//! Contour error by the servo's frequency response (feedrate paper, eqs. 6 to 13).

use super::{Collocation, Limit, bound_feed};
use crate::problem::Table;
use crate::response::Response;
use crate::samples::Samples;

/// Steps of the table of frequencies.
const STEPS: usize = 4096;

/// The lowest frequency of the table, as a share of the highest.
const LOWEST: f64 = 1e-6;

/// By how much deviations are rounded up, as a share, for what lies between two frequencies of the table.
const MARGIN: f64 = 4e-6;

/// A path that is straighter than this has this curvature, 1/mm: an arc of a kilometre.
const STRAIGHT: f64 = 1e-6;

/// A local arc of radius `ρ` is gone with `ω = f / ρ`. The steady path of the axes then strays from it by at most
/// `ρ * D(ω)`, so `f <= ρ * ω0` with the largest `ω0` for which `D <= tolerance / ρ` up to it, and at most the highest
/// frequency (the natural frequency of the machine, as in eq. 11).
///
/// `D = |1 - |G||` where all axes have the same response `G` (eqs. 6, 7). Where two differ it is the largest
/// `|1 - |G||` of them plus half the largest difference of their phases in radians: one axis late against the other
/// makes an ellipse of the circle, to first order with half axes `1 ± difference / 2`, at 45 degrees to the axes.
#[derive(Clone, Debug)]
pub struct ContourError {
    /// mm.
    tolerance: f64,
    collocation: Collocation,
    /// Frequencies, rad/s, evenly spaced on a logarithmic scale.
    frequencies: Vec<f64>,
    /// The largest `D` up to each of them.
    deviations: Vec<f64>,
}

impl ContourError {
    /// For the axes that lead the tip, up to `highest` rad/s.
    #[must_use]
    pub fn new(
        axes: &[&dyn Response],
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
        Self {
            tolerance,
            collocation,
            frequencies,
            deviations,
        }
    }

    /// The largest frequency up to which the contour error of an arc of this curvature in 1/mm is within the
    /// tolerance, rad/s.
    #[must_use]
    pub fn frequency(&self, curvature: f64) -> f64 {
        let allowed = curvature * self.tolerance;
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

    /// The fastest feed on a path of this curvature, mm/s.
    #[must_use]
    pub fn feed(&self, curvature: f64) -> f64 {
        let curvature = curvature.max(STRAIGHT);
        self.frequency(curvature) / curvature
    }
}

/// By how much of its radius the steady path of the axes strays from a circle that is gone with `frequency` rad/s.
#[must_use]
pub fn deviation(axes: &[&dyn Response], frequency: f64) -> f64 {
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
    fn name(&self) -> &str {
        "contour error"
    }

    fn apply(&self, samples: &Samples, table: &mut Table<'_>) {
        bound_feed(samples, self.collocation, table, |curvature| {
            self.feed(curvature)
        });
    }
}
