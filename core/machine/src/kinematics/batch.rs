//! Many points at once, for stages that take a batch: the same operations in the same order as for a single point, so
//! the same bits, but one step for all points before the next, so that their latencies overlap. Point by
//! point there is nothing to do meanwhile.

#[cfg(target_arch = "x86_64")]
use fearless_simd::{Level, Simd};
use nalgebra::Vector3;

use super::chain::{
    AxisLine, Chain, Joint, Joints, MAX_AXES, Pose, Trace, Turns, turn_about_x, turn_about_y,
    turn_about_z, turn_askew,
};
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

/// Numbers that are compared together: as many least or largest ones are kept, and the least or largest of them is asked
/// for at the end.
const TOGETHER: usize = 8;

/// Loops over lanes go to the end of such a group. What stands in lanes after the last point is worked out too, and
/// nobody asks for it.
const GROUP: usize = 8;

/// Lanes that a loop over `count` points goes through.
#[inline(always)]
pub fn groups(count: usize) -> usize {
    count.next_multiple_of(GROUP).min(LANES)
}

/// Does `work`, compiled once more for vectors of four numbers, where the processor has them. The bits are the same: no
/// operation is put together with another. What `work` calls has to be inlined into it.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
pub fn widely<R>(work: impl FnOnce() -> R) -> R {
    match Level::new().as_avx2() {
        Some(wide) => wide.vectorize(work),
        None => work(),
    }
}

/// Does `work`.
#[cfg(not(target_arch = "x86_64"))]
#[inline(always)]
pub fn widely<R>(work: impl FnOnce() -> R) -> R {
    work()
}

/// The least of numbers of which each is one; infinite if there are none.
#[inline(always)]
pub fn least(of: &[f64]) -> f64 {
    folded(of, f64::INFINITY, |a, b| if a < b { a } else { b })
}

/// The largest of numbers of which each is one; infinitely small if there are none.
#[inline(always)]
pub fn largest(of: &[f64]) -> f64 {
    folded(of, f64::NEG_INFINITY, |a, b| if a > b { a } else { b })
}

#[inline(always)]
fn folded(of: &[f64], first: f64, choose: impl Fn(f64, f64) -> f64) -> f64 {
    let (groups, rest) = of.as_chunks::<TOGETHER>();
    let mut kept = [first; TOGETHER];
    for group in groups {
        for place in 0..TOGETHER {
            kept[place] = choose(kept[place], group[place]);
        }
    }
    kept.iter().chain(rest).fold(first, |kept, value| choose(kept, *value))
}

/// Fills in the distances from each point of a column to the next.
#[inline(always)]
pub fn steps(of: &VectorColumn, count: usize, out: &mut Lanes) {
    for (lane, step) in out[..groups(count)].iter_mut().enumerate() {
        *step = (vector(of, lane + 1) - vector(of, lane)).norm();
    }
}

/// Puts vectors in the place of others, lane by lane.
#[inline(always)]
pub(super) fn replace(
    vectors: &mut VectorLanes,
    count: usize,
    with: impl Fn(Vector3<f64>, usize) -> Vector3<f64>,
) {
    for lane in 0..groups(count) {
        set_vector(vectors, lane, with(vector(vectors, lane), lane));
    }
}

/// Turns of many points.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurnLanes<'a> {
    pub sines: &'a Lanes,
    pub cosines: &'a Lanes,
    /// Forwards with 1, back with -1.
    pub sense: f64,
}

/// Turns vectors about the unit vector `k`, as [`super::chain::turn`] does, from `point` if they begin anywhere.
#[inline(always)]
pub(super) fn turn_lanes(
    vectors: &mut VectorLanes,
    count: usize,
    k: Vector3<f64>,
    point: Option<Vector3<f64>>,
    by: TurnLanes<'_>,
) {
    let arm = |vector: Vector3<f64>| point.map_or(vector, |point| vector - point);
    let back = |arm: Vector3<f64>| point.map_or(arm, |point| point + arm);
    let sine = |lane: usize| by.sense * by.sines[lane];
    let cosine = |lane: usize| by.cosines[lane];
    match AxisLine::of(k) {
        AxisLine::X => replace(vectors, count, |vector, lane| {
            back(turn_about_x(arm(vector), k.x, sine(lane), cosine(lane)))
        }),
        AxisLine::Y => replace(vectors, count, |vector, lane| {
            back(turn_about_y(arm(vector), k.y, sine(lane), cosine(lane)))
        }),
        AxisLine::Z => replace(vectors, count, |vector, lane| {
            back(turn_about_z(arm(vector), k.z, sine(lane), cosine(lane)))
        }),
        AxisLine::Askew => replace(vectors, count, |vector, lane| {
            back(turn_askew(arm(vector), k, sine(lane), cosine(lane)))
        }),
    }
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
        if self.edge().is_some() || !self.errors().is_empty() {
            poses.extend(joints.iter().map(|joints| self.forward(joints)));
            return;
        }
        for batch in joints.chunks(LANES) {
            widely(
                #[inline(always)]
                || self.forward_lanes(batch, poses),
            );
        }
    }

    /// Puts the poses of up to [`LANES`] points behind those that there are.
    #[inline(always)]
    fn forward_lanes(&self, points: &[Joints], poses: &mut Vec<Pose>) {
        let count = points.len().min(LANES);
        let (tip, axis) = (self.tip(), self.axis());
        let mut tip: VectorLanes = [[tip.x; LANES], [tip.y; LANES], [tip.z; LANES]];
        let mut axis: VectorLanes = [[axis.x; LANES], [axis.y; LANES], [axis.z; LANES]];
        let [mut values, mut sines, mut cosines] = [[0.0; LANES]; 3];
        for (index, joint) in self.joints().iter().enumerate().rev() {
            for (value, point) in values.iter_mut().zip(points) {
                *value = point[index];
            }
            let k = joint.direction;
            if !joint.rotary {
                replace(&mut tip, count, |tip, lane| tip + k * values[lane]);
                continue;
            }
            // The last angle again to the end of its group: zeros there would be left to `libm`, and all others be
            // asked for it.
            if let Some(last) = points.get(count.wrapping_sub(1)) {
                values[count..groups(count)].fill(last[index]);
            }
            sincos_all(&values, count, &mut sines, &mut cosines);
            let by = TurnLanes { sines: &sines, cosines: &cosines, sense: 1.0 };
            turn_lanes(&mut tip, count, k, Some(joint.point), by);
            turn_lanes(&mut axis, count, k, None, by);
        }
        let mount = self.mount();
        replace(&mut tip, count, |tip, _| tip - mount);
        poses.extend((0..count).map(|lane| Pose {
            tip: vector(&tip, lane),
            axis: vector(&axis, lane),
            edge: Vector3::zeros(),
        }));
    }

    /// [`Chain::trace`] of the first `count` points of `at`; the leading edge of a tool that has one is left out.
    pub fn trace_all(&self, at: &AxisBatch, count: usize, out: &mut Traces) {
        if !self.errors().is_empty() {
            return self.trace_each(at, count, out);
        }
        widely(
            #[inline(always)]
            || self.trace_lanes(at, count, out),
        );
    }

    /// [`Chain::trace_all`] one by one.
    #[cold]
    fn trace_each(&self, at: &AxisBatch, count: usize, out: &mut Traces) {
        for lane in 0..count.min(LANES) {
            let joints = std::array::from_fn(|index| at.joints[index][lane]);
            let mut trace = Trace { joints, turns: Turns::of_lane(at, lane), ..Trace::default() };
            self.trace(&mut trace);
            set_vector(&mut out.tip, lane, trace.pose.tip);
            set_vector(&mut out.axis, lane, trace.pose.axis);
            for index in 0..MAX_AXES {
                set_vector(&mut out.tip_rates[index], lane, trace.tip_rates[index]);
                set_vector(&mut out.axes[index], lane, trace.axes[index]);
            }
        }
    }

    #[inline(always)]
    fn trace_lanes(&self, at: &AxisBatch, count: usize, out: &mut Traces) {
        let Traces { tip, axis, tip_rates, axes } = out;
        for part in 0..3 {
            tip[part] = [self.tip()[part]; LANES];
            axis[part] = [self.axis()[part]; LANES];
        }
        for (index, joint) in self.joints().iter().enumerate().rev() {
            let k = joint.direction;
            if !joint.rotary {
                let way = &at.joints[index];
                replace(tip, count, |tip, lane| tip + k * way[lane]);
                continue;
            }
            let by = TurnLanes { sines: &at.sines[index], cosines: &at.cosines[index], sense: 1.0 };
            arms(joint, count, tip, &mut tip_rates[index]);
            turn_lanes(tip, count, k, Some(joint.point), by);
            axes[index] = *axis;
            turn_lanes(axis, count, k, None, by);
        }
        let mount = self.mount();
        replace(tip, count, |tip, _| tip - mount);
    }
}

/// How tips move with a rotary joint, mm a radian.
#[inline(always)]
fn arms(joint: &Joint, count: usize, tips: &VectorLanes, rates: &mut VectorLanes) {
    for lane in 0..groups(count) {
        let arm = vector(tips, lane) - joint.point;
        set_vector(rates, lane, joint.direction.cross(&arm));
    }
}
