//! Axis values over time.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::DifferenceSum;

/// Times that are off the grid by less than this share of the period lie on it.
const ON_GRID: f64 = 1e-6;

/// Axis values at equal distances in time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxisTrack {
    /// Time of the first, s.
    pub begins: f64,
    /// Time from one to the next, s.
    pub period: f64,
    /// Axis values, mm and radians, in chain order.
    pub joints: Vec<Joints>,
}

impl AxisTrack {
    /// Track of samples at `times`, which increase, at equal distances: those of `joints` where the samples lie so,
    /// else what a cubic through their neighbours has there.
    pub fn of_samples(times: &[f64], joints: &[Joints], period: f64) -> Self {
        let Some((first, last)) = times.first().zip(times.last()) else {
            return Self { period, ..Self::default() };
        };
        let count = libm::floor((last - first) / period + ON_GRID) as usize + 1;
        let time = |place: usize| first + place as f64 * period;
        let mut from = 0;
        let joints = (0..count).map(|place| {
            let time = time(place);
            if times.get(place).is_some_and(|sample| (sample - time).abs() <= ON_GRID * period) {
                return joints[place];
            }
            while from + 2 < times.len() && times[from + 1] <= time {
                from += 1;
            }
            between(times, joints, from, time)
        });
        Self { begins: *first, period, joints: joints.collect() }
    }

    /// Time of the one at `place`, s.
    pub fn time(&self, place: usize) -> f64 {
        self.begins + place as f64 * self.period
    }

    /// Time of the last, s; of none the beginning.
    pub fn ends(&self) -> f64 {
        self.time(self.joints.len().saturating_sub(1))
    }

    /// How long it is, s.
    pub fn seconds(&self) -> f64 {
        self.ends() - self.begins
    }

    /// Axis values on the way to the one at `place`: `steps` of them at even distances in time after the one before,
    /// the last is itself. Before the first the axes stand.
    pub fn towards(&self, place: usize, steps: usize) -> impl Iterator<Item = Joints> {
        let exact = self.joints[place];
        (1..=steps).map(move |step| {
            if place == 0 || step == steps {
                return exact;
            }
            let share = step as f64 / steps as f64;
            let time = self.time(place - 1) + share * self.period;
            self.at(time).unwrap_or(exact)
        })
    }

    /// About how far axis values between the samples lie beside [`AxisTrack::at`], mm and radians, by axis: a quarter of how
    /// far a sample lies beside the cubic through every second one around it.
    ///
    /// Where acceleration jumps by `a` and samples are `h` apart, the cubic is off by up to `0.041·a·h²` and this says
    /// `0.031·a·h²` to `0.035·a·h²` (straight lines: `a·h²/8`); where motion is smoother, the cubic is closer than this
    /// says. Where velocity jumps by `v`, it is off by up to `0.19·v·h`, and this says `0.03·v·h` to `0.09·v·h`, by
    /// when between two samples that is.
    pub fn between(&self) -> [DifferenceSum; MAX_AXES] {
        let mut found = [DifferenceSum::default(); MAX_AXES];
        for (first, around) in self.joints.windows(7).enumerate() {
            let time = self.time(first + 3);
            for (axis, found) in found.iter_mut().enumerate() {
                let value = |place: usize| around[place][axis];
                let through = (9.0 * (value(2) + value(4)) - value(0) - value(6)) / 16.0;
                found.take(time, (through - value(3)) / 4.0);
            }
        }
        found
    }

    /// Axis values at `time`, by a cubic through the neighbours; none before the first and after the last.
    pub fn at(&self, time: f64) -> Option<Joints> {
        self.at_with_rate(time).map(|(joints, _)| joints)
    }

    /// Axis values at `time`, and how fast they change, mm/s and radians/s.
    pub fn at_with_rate(&self, time: f64) -> Option<(Joints, Joints)> {
        let last = self.joints.len().checked_sub(1)?;
        let place = (time - self.begins) / self.period;
        if !(place >= -ON_GRID && place <= last as f64 + ON_GRID) {
            return None;
        }
        if last == 0 {
            return Some((self.joints[0], Joints::default()));
        }
        let from = (place.max(0.0) as usize).min(last - 1);
        let [before, left, right, behind] =
            [from.saturating_sub(1), from, from + 1, (from + 2).min(last)];
        let share = place - from as f64;
        // At the ends the slope is that of the one step that there is.
        let [left_steps, right_steps] = [(right - before) as f64, (behind - left) as f64];
        let mut values = Joints::default();
        let mut rates = Joints::default();
        for axis in 0..values.len() {
            let value = |place: usize| self.joints[place][axis];
            let slopes = [
                (value(right) - value(before)) / left_steps,
                (value(behind) - value(left)) / right_steps,
            ];
            let (value, rate) = cubic([value(left), value(right)], slopes, share);
            values[axis] = value;
            rates[axis] = rate / self.period;
        }
        Some((values, rates))
    }
}

/// Axis values between the samples `from` and `from + 1`, or close after them.
fn between(times: &[f64], joints: &[Joints], from: usize, time: f64) -> Joints {
    if times.len() < 2 {
        return joints[0];
    }
    let to = from + 1;
    let step = times[to] - times[from];
    let before = from.saturating_sub(1);
    let behind = (to + 1).min(times.len() - 1);
    std::array::from_fn(|axis| {
        let slope = |left: usize, right: usize| {
            (joints[right][axis] - joints[left][axis]) / (times[right] - times[left]) * step
        };
        // Of the parabola through three samples.
        let through = |left: usize, middle: usize, right: usize| {
            if left == middle || middle == right {
                return slope(left, right);
            }
            let [first, second] = [times[middle] - times[left], times[right] - times[middle]];
            (slope(left, middle) * second + slope(middle, right) * first) / (first + second)
        };
        let ends = [joints[from][axis], joints[to][axis]];
        let slopes = [through(before, from, to), through(from, to, behind)];
        cubic(ends, slopes, (time - times[from]) / step).0
    })
}

/// Value and derivative at `share`, 0 to 1, of the cubic with these values and slopes at its ends.
fn cubic([left, right]: [f64; 2], [leaves, arrives]: [f64; 2], share: f64) -> (f64, f64) {
    let rise = right - left;
    let second = 3.0 * rise - 2.0 * leaves - arrives;
    let third = leaves + arrives - 2.0 * rise;
    (
        left + share * (leaves + share * (second + share * third)),
        leaves + share * (2.0 * second + share * 3.0 * third),
    )
}
