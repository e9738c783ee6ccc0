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

/// Gathers the largest values of all axes.
#[derive(Clone, Debug, Default)]
pub(super) struct AxesPeaks {
    pub peaks: [AxisPeaks; MAX_AXES],
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
        for axis in 0..axes.min(MAX_AXES) {
            let velocity = (commanded[axis] - self.last[axis]) * rate;
            let acceleration = (velocity - self.velocity[axis] - jumped[axis]) * rate;
            let jerk = (acceleration - self.acceleration[axis] - bent[axis]) * rate;
            let peaks = &mut self.peaks[axis];
            raise(&mut peaks.following, commanded[axis] - actual[axis], time, line);
            if self.count > 0 {
                raise(&mut peaks.velocity, velocity, time, line);
            }
            if self.count > 1 {
                raise(&mut peaks.acceleration, acceleration, time, line);
            }
            if self.count > 2 {
                raise(&mut peaks.jerk, jerk, time, line);
            }
            self.velocity[axis] = velocity;
            self.acceleration[axis] = acceleration;
        }
        self.last = *commanded;
        self.count = (self.count + 1).min(3);
    }
}

#[inline]
fn raise(peak: &mut ContourPeak, value: f64, time: f64, line: u64) {
    let value = value.abs();
    if value > peak.value {
        *peak = ContourPeak { value, time, line, ..ContourPeak::default() };
    }
}
