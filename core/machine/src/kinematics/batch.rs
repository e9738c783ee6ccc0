//! Many points at once, for stages that take a batch: the same operations in the same order as for a single point, so
//! the same bits, but one step for all points before the next, so that their latencies overlap. Point by
//! point there is nothing to do meanwhile.

use nalgebra::Vector3;

use super::chain::{Chain, MAX_AXES, Turns, turn};

/// Points that are solved together.
pub const LANES: usize = 64;

/// A number of each point.
pub type Lanes = [f64; LANES];

/// Where the axes of a batch of points stand, by joint; what is not a rotary joint has the sine 0 and the cosine 1.
#[derive(Clone, Debug)]
pub struct AxisBatch {
    /// Axis values, mm or radians.
    pub joints: [Lanes; MAX_AXES],
    /// Sines of the rotary ones.
    pub sines: [Lanes; MAX_AXES],
    /// Cosines of the angles.
    pub cosines: [Lanes; MAX_AXES],
}

/// The forward product of a batch of points: see [`super::Trace`].
#[derive(Clone, Debug)]
pub struct Traces {
    /// Tips, mm, part frame.
    pub tip: [Vector3<f64>; LANES],
    /// Tool axes, part frame.
    pub axis: [Vector3<f64>; LANES],
    /// By rotary joint, how the tip moves with it, mm a radian, before that joint has turned.
    pub tip_rates: [[Vector3<f64>; LANES]; MAX_AXES],
    /// By rotary joint, the tool axis before that joint has turned.
    pub axes: [[Vector3<f64>; LANES]; MAX_AXES],
}

impl Default for AxisBatch {
    fn default() -> Self {
        Self {
            joints: [[0.0; LANES]; MAX_AXES],
            sines: [[0.0; LANES]; MAX_AXES],
            cosines: [[1.0; LANES]; MAX_AXES],
        }
    }
}

impl Default for Traces {
    fn default() -> Self {
        const ZERO: [Vector3<f64>; LANES] = [Vector3::new(0.0, 0.0, 0.0); LANES];
        Self { tip: ZERO, axis: ZERO, tip_rates: [ZERO; MAX_AXES], axes: [ZERO; MAX_AXES] }
    }
}

impl Turns {
    /// Turns of one point of a batch.
    #[inline]
    pub fn of_lane(at: &AxisBatch, lane: usize) -> Self {
        let mut turns = Self::default();
        for index in 0..MAX_AXES {
            turns.set(index, at.sines[index][lane], at.cosines[index][lane]);
        }
        turns
    }
}

impl Chain {
    /// [`Chain::trace`] of the first `count` points of `at`; the leading edge of a tool that has one is left out.
    pub fn trace_all(&self, at: &AxisBatch, count: usize, out: &mut Traces) {
        let count = count.min(LANES);
        out.tip[..count].fill(self.tip());
        out.axis[..count].fill(self.axis());
        for (index, joint) in self.joints().iter().enumerate().rev() {
            let k = joint.direction;
            if !joint.rotary {
                for (tip, value) in out.tip[..count].iter_mut().zip(&at.joints[index]) {
                    *tip += k * *value;
                }
                continue;
            }
            let (sines, cosines) = (&at.sines[index], &at.cosines[index]);
            let (rates, axes) = (&mut out.tip_rates[index], &mut out.axes[index]);
            for lane in 0..count {
                let arm = out.tip[lane] - joint.point;
                rates[lane] = k.cross(&arm);
                axes[lane] = out.axis[lane];
                out.tip[lane] = joint.point + turn(arm, k, sines[lane], cosines[lane]);
                out.axis[lane] = turn(out.axis[lane], k, sines[lane], cosines[lane]);
            }
        }
        for tip in &mut out.tip[..count] {
            *tip -= self.mount();
        }
    }
}
