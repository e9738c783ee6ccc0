//! The largest values of each axis.

use post_machine::kinematics::{Joints, MAX_AXES};

use super::spread::ContourPeak;
use crate::VelocityJump;

/// The largest values of one axis; mm, s, radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisPeaks {
    /// Commanded minus actual position at one time.
    pub following: ContourPeak,
    /// Velocity that is commanded: differences of set-points, as are the two below.
    pub velocity: ContourPeak,
    /// Acceleration that is commanded, jumps of the velocity left out.
    pub acceleration: ContourPeak,
    /// Jerk that is commanded, jumps of the velocity and what the acceleration jumps there left out.
    pub jerk: ContourPeak,
    /// Jump of the velocity that is commanded where one move passes into the next.
    pub jump: ContourPeak,
}

/// What may be a peak at a set-point, by axis.
#[derive(Clone, Copy, Debug, Default)]
struct PeakValues {
    following: Joints,
    velocity: Joints,
    acceleration: Joints,
    jerk: Joints,
}

/// Gathers the largest values of all axes.
#[derive(Clone, Debug, Default)]
pub(super) struct AxesPeaks {
    pub peaks: [AxisPeaks; MAX_AXES],
    /// The values of the peaks that each set-point may raise, side by side: most raise none, which is found at once.
    highest: PeakValues,
    last: Joints,
    velocity: Joints,
    acceleration: Joints,
    /// What the jumps between the last two set-points have yet to add to the mean velocity between two.
    rest: Joints,
    /// What the acceleration jumps there has yet to add to the mean acceleration, from the next two set-points on.
    bends: [Joints; 2],
    /// Set-points so far; no difference is taken of what was not there.
    count: u32,
}

impl AxesPeaks {
    /// Takes the next set-point of `axes` axes and where they are, and the `jumps` since the last one.
    ///
    /// A jump at a share of the time from one set-point to the next changes the mean velocity by the rest of that time
    /// there and by that share behind it: so much is no acceleration. What the acceleration jumps there comes in three
    /// parts into that over two periods.
    pub fn take(
        &mut self,
        axes: usize,
        time: f64,
        line: u64,
        period: f64,
        joints: [&Joints; 2],
        jumps: &[VelocityJump],
    ) {
        let rate = 1.0 / period;
        let [commanded, actual] = joints;
        let mut jumped = std::mem::take(&mut self.rest);
        let [mut bent, next] = self.bends;
        self.bends = [next, Joints::default()];
        for jump in jumps {
            let behind = ((time - jump.time) * rate).clamp(0.0, 1.0);
            for (axis, change) in jump.change.iter().enumerate() {
                jumped[axis] += change * behind;
                self.rest[axis] += change * (1.0 - behind);
                raise(&mut self.peaks[axis].jump, *change, time, line);
            }
            let before = 1.0 - behind;
            for (axis, bend) in jump.bend.iter().enumerate() {
                bent[axis] += bend * 0.5 * behind * behind;
                self.bends[0][axis] += bend * (0.5 + behind * before);
                self.bends[1][axis] += bend * 0.5 * before * before;
            }
        }
        let mut found = PeakValues::default();
        let mut raised = false;
        let highest = &self.highest;
        for axis in 0..MAX_AXES {
            let velocity = (commanded[axis] - self.last[axis]) * rate;
            let acceleration = (velocity - self.velocity[axis] - jumped[axis]) * rate;
            let jerk = (acceleration - self.acceleration[axis] - bent[axis]) * rate;
            let following = commanded[axis] - actual[axis];
            raised |= following.abs() > highest.following[axis];
            raised |= velocity.abs() > highest.velocity[axis];
            raised |= acceleration.abs() > highest.acceleration[axis];
            raised |= jerk.abs() > highest.jerk[axis];
            found.following[axis] = following;
            found.velocity[axis] = velocity;
            found.acceleration[axis] = acceleration;
            found.jerk[axis] = jerk;
        }
        if raised {
            self.raise(axes, &found, time, line);
        }
        (self.velocity, self.acceleration) = (found.velocity, found.acceleration);
        self.last = *commanded;
        self.count = (self.count + 1).min(3);
    }

    /// Raises the peaks of `axes` axes to what has been found at a set-point.
    fn raise(&mut self, axes: usize, found: &PeakValues, time: f64, line: u64) {
        for axis in 0..axes.min(MAX_AXES) {
            let peaks = &mut self.peaks[axis];
            raise(&mut peaks.following, found.following[axis], time, line);
            if self.count > 0 {
                raise(&mut peaks.velocity, found.velocity[axis], time, line);
            }
            if self.count > 1 {
                raise(&mut peaks.acceleration, found.acceleration[axis], time, line);
            }
            if self.count > 2 {
                raise(&mut peaks.jerk, found.jerk[axis], time, line);
            }
            self.highest.following[axis] = peaks.following.value;
            self.highest.velocity[axis] = peaks.velocity.value;
            self.highest.acceleration[axis] = peaks.acceleration.value;
            self.highest.jerk[axis] = peaks.jerk.value;
        }
    }
}

#[inline]
fn raise(peak: &mut ContourPeak, value: f64, time: f64, line: u64) {
    let value = value.abs();
    if value > peak.value {
        *peak = ContourPeak { value, time, line, ..ContourPeak::default() };
    }
}

#[cfg(test)]
mod tests {
    use post_testkit::randomised;

    use super::*;

    /// Peaks are those of a search that takes each set-point to raise some.
    #[test]
    fn no_peak_is_passed_over() {
        let (rounds, mut rng) = randomised(100u64, 33);
        for _ in rounds {
            let axes = 1 + rng.pick(MAX_AXES);
            let [mut quick, mut plain] = [AxesPeaks::default(), AxesPeaks::default()];
            let mut joints = Joints::default();
            for step in 0..100u32 {
                let time = 0.01 * f64::from(step);
                let size = rng.order(-3.0, 0.0);
                for joint in joints.iter_mut().take(axes) {
                    *joint += rng.range(-size, size);
                }
                let actual = joints.map(|joint| joint + rng.range(-size, size));
                let jumps: Vec<_> = (0..rng.pick(8) / 6)
                    .map(|_| VelocityJump {
                        time: time - 0.01 * rng.range(0.0, 1.0),
                        change: [(); MAX_AXES].map(|()| rng.range(-size, size)),
                        bend: [(); MAX_AXES].map(|()| rng.range(-size, size)),
                    })
                    .collect();
                plain.highest = PeakValues::default();
                for peaks in [&mut quick, &mut plain] {
                    peaks.take(axes, time, u64::from(step), 0.01, [&joints, &actual], &jumps);
                }
                assert_eq!(quick.peaks, plain.peaks);
            }
        }
    }
}
