//! Many points at once, for stages that take a batch: the same operations in the same order as for a single point, so
//! the same bits, but one step for all points before the next, so that their latencies overlap. Point by
//! point there is nothing to do meanwhile.

use nalgebra::Vector3;

use super::chain::{Chain, Joints, MAX_AXES, Pose, Turns, turn};
use super::lane_math::sincos_all;

/// Points that are solved together.
pub const LANES: usize = 64;

/// A number of each point.
pub type Lanes = [f64; LANES];

/// A vector of each point, part by part.
pub type VectorLanes = [Lanes; 3];

/// A number of each point, that of the point before them in front.
pub type Column = [f64; LANES + 1];

/// A vector of each point, part by part, that of the point before them in front.
pub type VectorColumn = [Column; 3];

/// The vector of a lane.
#[inline(always)]
pub fn vector<const N: usize>(of: &[[f64; N]; 3], lane: usize) -> Vector3<f64> {
    Vector3::new(of[0][lane], of[1][lane], of[2][lane])
}

/// Puts the vector of a lane.
#[inline(always)]
pub fn set_vector<const N: usize>(of: &mut [[f64; N]; 3], lane: usize, vector: Vector3<f64>) {
    (of[0][lane], of[1][lane], of[2][lane]) = (vector.x, vector.y, vector.z);
}

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
    pub tip: VectorLanes,
    /// Tool axes, part frame.
    pub axis: VectorLanes,
    /// By rotary joint, how the tip moves with it, mm a radian, before that joint has turned.
    pub tip_rates: [VectorLanes; MAX_AXES],
    /// By rotary joint, the tool axis before that joint has turned.
    pub axes: [VectorLanes; MAX_AXES],
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
        const ZERO: VectorLanes = [[0.0; LANES]; 3];
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
    /// [`Chain::forward`] of each of `joints`, put behind what `poses` holds.
    pub fn forward_all(&self, joints: &[Joints], poses: &mut Vec<Pose>) {
        if self.edge().is_some() {
            poses.extend(joints.iter().map(|joints| self.forward(joints)));
            return;
        }
        for batch in joints.chunks(LANES) {
            let [tip, axis] = self.forward_lanes(batch);
            poses.extend((0..batch.len()).map(|lane| Pose {
                tip: vector(&tip, lane),
                axis: vector(&axis, lane),
                edge: Vector3::zeros(),
            }));
        }
    }

    /// Tips and tool axes of up to [`LANES`] points.
    fn forward_lanes(&self, points: &[Joints]) -> [VectorLanes; 2] {
        let count = points.len().min(LANES);
        let mut found = [[[0.0; LANES]; 3]; 2];
        let [tip, axis] = &mut found;
        for part in 0..3 {
            tip[part][..count].fill(self.tip()[part]);
            axis[part][..count].fill(self.axis()[part]);
        }
        let [mut values, mut sines, mut cosines] = [[0.0; LANES]; 3];
        for (index, joint) in self.joints().iter().enumerate().rev() {
            for (value, point) in values.iter_mut().zip(points) {
                *value = point[index];
            }
            let (k, point) = (joint.direction, joint.point);
            if !joint.rotary {
                for (lane, value) in values.iter().enumerate().take(count) {
                    set_vector(tip, lane, vector(tip, lane) + k * *value);
                }
                continue;
            }
            sincos_all(&values, count, &mut sines, &mut cosines);
            for lane in 0..count {
                let arm = vector(tip, lane) - point;
                set_vector(tip, lane, point + turn(arm, k, sines[lane], cosines[lane]));
            }
            for lane in 0..count {
                let turned = turn(vector(axis, lane), k, sines[lane], cosines[lane]);
                set_vector(axis, lane, turned);
            }
        }
        let mount = self.mount();
        for lane in 0..count {
            set_vector(tip, lane, vector(tip, lane) - mount);
        }
        found
    }

    /// [`Chain::trace`] of the first `count` points of `at`; the leading edge of a tool that has one is left out.
    pub fn trace_all(&self, at: &AxisBatch, count: usize, out: &mut Traces) {
        let count = count.min(LANES);
        let Traces { tip, axis, tip_rates, axes } = out;
        for part in 0..3 {
            tip[part][..count].fill(self.tip()[part]);
            axis[part][..count].fill(self.axis()[part]);
        }
        for (index, joint) in self.joints().iter().enumerate().rev() {
            let (k, point) = (joint.direction, joint.point);
            if !joint.rotary {
                for lane in 0..count {
                    set_vector(tip, lane, vector(tip, lane) + k * at.joints[index][lane]);
                }
                continue;
            }
            let (sines, cosines) = (&at.sines[index], &at.cosines[index]);
            let (rates, axes) = (&mut tip_rates[index], &mut axes[index]);
            for lane in 0..count {
                let arm = vector(tip, lane) - point;
                set_vector(rates, lane, k.cross(&arm));
                set_vector(tip, lane, point + turn(arm, k, sines[lane], cosines[lane]));
            }
            for lane in 0..count {
                let before = vector(axis, lane);
                set_vector(axes, lane, before);
                set_vector(axis, lane, turn(before, k, sines[lane], cosines[lane]));
            }
        }
        let mount = self.mount();
        for lane in 0..count {
            set_vector(tip, lane, vector(tip, lane) - mount);
        }
    }
}
