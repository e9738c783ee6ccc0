//! Which frequencies the errors of the axes have: amplitudes by Welch's method, averaged over windows that overlap by
//! half (P. D. Welch, The use of fast Fourier transform for the estimation of power spectra, 1967), Hann's window. What the
//! axes do between cuts does not count: a window lies in one run of cuts.

use std::f64::consts::TAU;

use post_motion::fourier;

/// A window is about so long, s: frequencies are told apart by a hertz or two.
const SECONDS: f64 = 1.0;

/// Set-points in a window, as powers of two.
const POWERS: [i32; 2] = [7, 13];

/// The amplitudes of one signal.
#[derive(Clone, Debug)]
pub struct Spectrum {
    /// The last set-points, as many as half a window more than were worked on.
    waiting: Vec<f64>,
    /// Sums of the squares of the amplitudes, by frequency.
    squares: Vec<f64>,
    windows: u64,
    tables: Tables,
}

/// What does not change from window to window.
#[derive(Clone, Debug)]
struct Tables {
    /// Hann's window.
    hann: Vec<f64>,
    /// Cosine and sine of the turns of the transform.
    turns: Vec<[f64; 2]>,
}

impl Spectrum {
    /// For set-points every `period` seconds.
    pub fn new(period: f64) -> Self {
        let power = libm::rint(libm::log2(SECONDS / period)) as i32;
        let window = 1 << power.clamp(POWERS[0], POWERS[1]);
        let angle = |place: usize| TAU * place as f64 / window as f64;
        Self {
            waiting: Vec::with_capacity(window),
            squares: vec![0.0; window / 2],
            windows: 0,
            tables: Tables {
                hann: (0..window).map(|place| 0.5 - 0.5 * libm::cos(angle(place))).collect(),
                turns: fourier::turns(window),
            },
        }
    }

    /// Takes the next value.
    pub fn take(&mut self, value: f64) {
        self.waiting.push(value);
        let window = self.tables.hann.len();
        if self.waiting.len() == window {
            self.window();
            self.waiting.drain(..window / 2);
        }
    }

    /// A run of values ends.
    pub fn pause(&mut self) {
        self.waiting.clear();
    }

    fn window(&mut self) {
        // A constant error would hide the lowest frequencies behind it.
        let mean = self.waiting.iter().sum::<f64>() / self.waiting.len() as f64;
        let values = self
            .waiting
            .iter()
            .zip(&self.tables.hann)
            .map(|(value, weight)| [(value - mean) * weight, 0.0]);
        let mut values: Vec<[f64; 2]> = values.collect();
        fourier::transform(&mut values, &self.tables.turns);
        // The mean of Hann's window is a half, and each frequency stands twice in the transform.
        let scale = 4.0 / self.waiting.len() as f64;
        for (square, [re, im]) in self.squares.iter_mut().zip(&values) {
            *square += (re * re + im * im) * scale * scale;
        }
        self.windows += 1;
    }

    /// Amplitudes by frequency, Hz, from the second of the transform on; of signals shorter than a window nothing.
    pub fn amplitudes(&self, period: f64, unit: f64) -> Vec<[f64; 2]> {
        if self.windows == 0 {
            return Vec::new();
        }
        let window = self.tables.hann.len() as f64;
        let places = self.squares.iter().enumerate().skip(1);
        places
            .map(|(place, square)| {
                let amplitude = libm::sqrt(square / self.windows as f64);
                [place as f64 / (window * period), amplitude * unit]
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_seen_at_its_frequency_with_its_amplitude() {
        let period = 1e-3;
        let mut spectrum = Spectrum::new(period);
        // In the middle of a frequency of the transform.
        let frequency = 100.0 / (1024.0 * period);
        for step in 0..20_000_u32 {
            let time = f64::from(step) * period;
            spectrum.take(0.5 + 0.003 * libm::sin(TAU * frequency * time + 0.4));
        }
        let amplitudes = spectrum.amplitudes(period, 1e3);
        let peak = amplitudes.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
        assert!((peak[0] - frequency).abs() < 1e-9, "{peak:?}");
        assert!((peak[1] - 3.0).abs() < 1e-6, "{peak:?}");
    }
}
