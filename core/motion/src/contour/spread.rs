//! How large a deviation is over a program: the largest with its place, the root mean square, percentiles; memory does
//! not grow with what is counted.

use nalgebra::Vector3;

/// Parts of an octave: a percentile is no more than a sixteenth above the truth.
const PARTS: usize = 16;

/// The octave of the smallest bin: 2^-40 mm or radians and what is less counts as that.
const LEAST: i64 = -40;

/// Octaves.
const OCTAVES: usize = 56;

/// The largest of some values, and where it stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContourPeak {
    /// The value, never below zero.
    pub value: f64,
    /// When, s from the beginning.
    pub time: f64,
    /// Line of the program.
    pub line: u64,
    /// Line of the CL file, where the program is held against one.
    pub cl_line: Option<u64>,
    /// Where the tip is meant to be then, mm, part frame.
    pub tip: Vector3<f64>,
}

impl ContourPeak {
    /// Takes a value that is larger than what has been; `peak` says where it stands, which is not asked otherwise.
    #[inline]
    pub(super) fn raise(&mut self, value: f64, peak: impl FnOnce(f64) -> Self) {
        if value > self.value {
            *self = peak(value);
        }
    }
}

/// How values are spread.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueSpread {
    /// How many.
    pub count: u64,
    /// The largest.
    pub peak: ContourPeak,
    squares: f64,
    bins: Vec<u64>,
}

impl Default for ValueSpread {
    fn default() -> Self {
        Self {
            count: 0,
            peak: ContourPeak::default(),
            squares: 0.0,
            bins: vec![0; OCTAVES * PARTS],
        }
    }
}

impl ValueSpread {
    /// Takes one more; `peak` says where it stands.
    #[inline]
    pub(super) fn take(&mut self, value: f64, peak: impl FnOnce(f64) -> ContourPeak) {
        self.count += 1;
        self.squares += value * value;
        self.bins[bin(value)] += 1;
        self.peak.raise(value, peak);
    }

    /// Root mean square; zero of none.
    pub fn rms(&self) -> f64 {
        match self.count {
            0 => 0.0,
            count => (self.squares / count as f64).sqrt(),
        }
    }

    /// The value that `share` (0 to 1) of all do not pass: too large by no more than a sixteenth of it, never above the
    /// largest. Zero of none.
    pub fn percentile(&self, share: f64) -> f64 {
        let wanted = libm::ceil(self.count as f64 * share.clamp(0.0, 1.0)) as u64;
        let mut passed = 0;
        for (place, count) in self.bins.iter().enumerate() {
            passed += count;
            if passed >= wanted && passed > 0 {
                return upper(place).min(self.peak.value);
            }
        }
        self.peak.value
    }
}

/// The bin of a value: its exponent and the first four bits of its mantissa.
#[inline]
fn bin(value: f64) -> usize {
    let bits = (value.abs().to_bits() >> 48) as i64;
    let bin = bits - ((1023 + LEAST) << 4);
    bin.clamp(0, (OCTAVES * PARTS) as i64 - 1) as usize
}

/// The end of a bin.
fn upper(bin: usize) -> f64 {
    let octave = (bin / PARTS) as i32 + LEAST as i32;
    let part = (bin % PARTS + 1) as f64 / PARTS as f64;
    libm::ldexp(1.0 + part, octave)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_too_large_by_a_sixteenth_at_most() {
        let mut spread = ValueSpread::default();
        let mut values: Vec<f64> =
            (1..=5000).map(|n| 1e-6 * libm::pow(1.002, f64::from(n))).collect();
        for (place, value) in values.iter().enumerate() {
            spread.take(*value, |value| ContourPeak {
                value,
                time: place as f64,
                ..ContourPeak::default()
            });
        }
        values.sort_by(f64::total_cmp);
        for share in [0.001, 0.1, 0.5, 0.9, 0.99, 0.999, 1.0] {
            let truth = values[(libm::ceil(5000.0 * share) as usize).max(1) - 1];
            let told = spread.percentile(share);
            assert!(truth <= told && told <= truth * (1.0 + 1.0 / 16.0), "{share}: {truth} {told}");
        }
        assert_eq!(spread.peak.time, 4999.0);
        let squares: f64 = values.iter().map(|value| value * value).sum();
        assert!((spread.rms() - (squares / 5000.0).sqrt()).abs() < 1e-12 * spread.rms());
    }

    #[test]
    fn nothing_and_everything_has_a_bin() {
        assert_eq!(ValueSpread::default().percentile(0.5), 0.0);
        for value in [0.0, -0.0, f64::MIN_POSITIVE, 1e300, f64::INFINITY] {
            assert!(bin(value) < OCTAVES * PARTS);
        }
        assert_eq!(upper(bin(1.0)), 1.0625);
    }
}
