//! How late and how short axes answer, by frequency.

use crate::response::DriveResponse;

/// Steps of the table of frequencies.
const STEPS: usize = 96;

/// The lowest frequency of the table, as a share of the highest. Below it late and short are what they are there.
const LOWEST: f64 = 1e-3;

/// Answers that differ by no more than this, as a share of what was asked, are the same.
const ALIKE: f64 = 1e-9;

/// How an axis strays from where it was commanded when all axes together are as late as the reference: by
/// `-late * Q̇ + short * Q̈`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lag {
    /// How much later than the reference, s.
    pub(super) late: f64,
    /// What is missing of the acceleration, s².
    pub(super) short: f64,
}

/// The lags of all axes, by frequency.
#[derive(Clone, Debug)]
pub(super) struct Lags {
    /// rad/s, evenly spaced on a logarithmic scale.
    frequencies: Vec<f64>,
    /// Frequency by frequency, of each axis.
    each: Vec<Lag>,
    axes: usize,
    alike: bool,
}

impl Lags {
    /// Works out the lags of these axes, up to `highest` rad/s.
    pub(super) fn new(axes: &[&dyn DriveResponse], highest: f64) -> Self {
        let ratio = libm::log(1.0 / LOWEST) / STEPS as f64;
        // From the top, so that the highest is exact.
        let at = |step: usize| highest * libm::exp(-ratio * (STEPS - step) as f64);
        let frequencies: Vec<f64> = (0..=STEPS).map(at).collect();
        let mut each = Vec::with_capacity(frequencies.len() * axes.len());
        let mut alike = true;
        for &frequency in &frequencies {
            let answers: Vec<_> = axes.iter().map(|axis| axis.at(frequency)).collect();
            let Some(&first) = answers.first() else {
                continue;
            };
            let phases: Vec<f64> = answers.iter().map(|it| it.phase_from(first)).collect();
            let most = phases.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let least = phases.iter().copied().fold(f64::INFINITY, f64::min);
            // Any common lag serves as the reference; halfway between, what each is off by is least.
            let reference = 0.5 * (most + least);
            for (answer, phase) in answers.iter().zip(phases) {
                let (size, ahead) = (answer.gain(), phase - reference);
                alike &= libm::hypot(answer.real - first.real, answer.imaginary - first.imaginary)
                    <= ALIKE;
                each.push(Lag {
                    late: -size * libm::sin(ahead) / frequency,
                    short: (1.0 - size * libm::cos(ahead)) / (frequency * frequency),
                });
            }
        }
        Self { frequencies, each, axes: axes.len(), alike }
    }

    /// Number of axes.
    pub(super) fn axes(&self) -> usize {
        self.axes
    }

    /// Whether all axes answer alike at every frequency.
    pub(super) fn alike(&self) -> bool {
        self.alike
    }

    /// Frequencies, growing, with the lags of all axes there.
    pub(super) fn by_frequency(&self) -> impl Iterator<Item = (f64, &[Lag])> {
        let lags = self.each.chunks_exact(self.axes.max(1));
        self.frequencies.iter().copied().zip(lags)
    }
}
