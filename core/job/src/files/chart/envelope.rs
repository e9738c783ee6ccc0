//! What is largest and least on even shares of a way, in a room that does not grow with it.

/// Shares that are told apart.
const MOST_BINS: usize = 1400;

/// Nothing yet.
const NONE: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// Least and largest values of some channels on even shares of a way.
#[derive(Clone, Debug)]
pub struct Envelope {
    channels: usize,
    /// Way of a share: seconds, or mm.
    width: f64,
    /// Share by share, each with all its channels.
    ranges: Vec<[f64; 2]>,
}

impl Envelope {
    /// Of so many channels; a share is `width` at first, and doubles as the way grows.
    pub fn new(channels: usize, width: f64) -> Self {
        Self { channels, width, ranges: Vec::new() }
    }

    /// Way of a share.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// Takes a value of each channel; those that are NaN are none.
    pub fn take(&mut self, way: f64, values: impl Iterator<Item = f64>) {
        let mut place = (way / self.width) as usize;
        while place >= MOST_BINS {
            self.double();
            place = (way / self.width) as usize;
        }
        let first = place * self.channels;
        if self.ranges.len() < first + self.channels {
            self.ranges.resize(first + self.channels, NONE);
        }
        for (range, value) in self.ranges[first..].iter_mut().zip(values) {
            // A NaN is neither less nor more.
            *range = [range[0].min(value), range[1].max(value)];
        }
    }

    fn double(&mut self) {
        let channels = self.channels;
        let pairs = self.ranges.chunks(2 * channels);
        let merged = pairs.flat_map(|pair| {
            (0..channels).map(|channel| {
                let [a, b] = [pair[channel], *pair.get(channels + channel).unwrap_or(&NONE)];
                [a[0].min(b[0]), a[1].max(b[1])]
            })
        });
        self.ranges = merged.collect();
        self.width *= 2.0;
    }

    /// Runs of shares that hold a value of the channel: middle of the share, least and largest, multiplied by `unit`.
    pub fn runs(&self, channel: usize, unit: f64) -> Vec<Vec<[f64; 3]>> {
        let mut runs: Vec<Vec<[f64; 3]>> = Vec::new();
        let mut open = false;
        for (place, share) in self.ranges.chunks(self.channels).enumerate() {
            let [low, high] = share[channel];
            let at = (place as f64 + 0.5) * self.width;
            match (low <= high, open) {
                (false, _) => open = false,
                (true, false) => {
                    runs.push(vec![[at, low * unit, high * unit]]);
                    open = true;
                }
                (true, true) => {
                    if let Some(run) = runs.last_mut() {
                        run.push([at, low * unit, high * unit]);
                    }
                }
            }
        }
        runs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_is_largest_is_lost_as_shares_double() {
        let mut envelope = Envelope::new(2, 1e-3);
        let mut most = f64::NEG_INFINITY;
        for step in 0..1_000_000_u64 {
            let value = libm::sin(step as f64 * 0.37) * (step % 977) as f64;
            most = most.max(value);
            let second = if step < 500_000 { 1.0 } else { f64::NAN };
            envelope.take(step as f64 * 1e-3, [value, second].into_iter());
        }
        assert!(envelope.ranges.len() <= 2 * MOST_BINS);
        let drawn = envelope.runs(0, 1.0);
        assert_eq!(drawn.len(), 1);
        let high = drawn[0].iter().fold(f64::NEG_INFINITY, |most, bin| most.max(bin[2]));
        assert_eq!(high, most);
        let half = envelope.runs(1, 3.0);
        let last = half[0].last().unwrap();
        assert!(last[0] < 501.0 && last[2] == 3.0, "{last:?}");
    }
}
