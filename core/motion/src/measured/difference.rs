//! How far two things that go on in time are apart.

/// A difference over time, summed up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DifferenceSum {
    /// How often it was taken.
    pub count: u64,
    /// The one of the largest size, with its sign.
    pub most: f64,
    /// When that was, s.
    pub most_at: f64,
    sum: f64,
    squares: f64,
}

impl DifferenceSum {
    /// Takes the difference `value` at `time`, s.
    pub fn take(&mut self, time: f64, value: f64) {
        if self.count == 0 || value.abs() > self.most.abs() {
            (self.most, self.most_at) = (value, time);
        }
        self.count += 1;
        self.sum += value;
        self.squares += value * value;
    }

    /// Mean; 0 of none.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// Root of the mean square; 0 of none.
    pub fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }
}
