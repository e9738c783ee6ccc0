//! The kinematic chain: joints from the workpiece to the tool, and the forward product.
//!
//! `T(q) = exp(ξ1·q1) … exp(ξn·qn)·T0`, every joint given in the machine frame with all axes at zero.
//! Directions are those of the tool as seen from the part (ISO 841), so one product with one sign serves
//! tables and heads alike. Lengths in mm, angles in radians.

use std::sync::Arc;

use nalgebra::Vector3;

use super::errors::AxisErrors;

/// The longest chain, as that of a robot of six axes beside which its control leads six more; working values are arrays of
/// this length, so that no point allocates.
pub const MAX_AXES: usize = 12;

/// Axes of a chain, one bit each by their places.
pub type AxisBits = u16;

/// Axis values in chain order: mm for linear axes, radians for rotary ones. Unused places are zero.
pub type Joints = [f64; MAX_AXES];

/// One axis of the chain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint {
    /// Turns about a line; else slides along a direction.
    pub rotary: bool,
    /// Unit vector, machine frame, all axes at zero; already turned round for a `reversed` axis.
    pub direction: Vector3<f64>,
    /// Any point of a rotary axis' line, mm, machine frame, all axes at zero.
    pub point: Vector3<f64>,
}

/// Tip and tool axis, seen from the part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Tip, mm, part frame.
    pub tip: Vector3<f64>,
    /// Tool axis, unit vector from the tip to the holder, part frame.
    pub axis: Vector3<f64>,
    /// Leading edge of a knife or disc, unit vector, part frame; zero for a tool that turns. Of a pose that was reached
    /// it stands across the tool axis; of one that is wanted it may lean, and its part across the axis is meant:
    /// [`Pose::edge_across`].
    pub edge: Vector3<f64>,
}

impl Pose {
    /// The leading edge laid across the tool axis, unit vector, part frame; zero where the pose has none.
    #[inline]
    pub fn edge_across(&self) -> Vector3<f64> {
        if self.edge == Vector3::zeros() {
            return self.edge;
        }
        square(self.edge, self.axis)
    }
}

/// The direction across `axis` that is nearest to `edge`.
pub(super) fn square(edge: Vector3<f64>, axis: Vector3<f64>) -> Vector3<f64> {
    let across = |v: Vector3<f64>| (v - axis * axis.dot(&v)).try_normalize(1e-6);
    across(edge).or_else(|| across(Vector3::x())).or_else(|| across(Vector3::y())).unwrap_or(edge)
}

/// Sine and cosine of every rotary joint, so that a set of angles is evaluated once.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turns {
    sines: Joints,
    cosines: Joints,
}

/// The forward product with what the certificate needs of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trace {
    /// The pose reached.
    pub pose: Pose,
    /// The axis values it is reached with.
    pub joints: Joints,
    /// Sines and cosines of the angles.
    pub turns: Turns,
    /// For each rotary joint, how the tip moves with it, mm a radian, before that joint has turned: its
    /// direction × the arm from its line to the tip.
    pub tip_rates: [Vector3<f64>; MAX_AXES],
    /// For each rotary joint, the tool axis before that joint has turned.
    pub axes: [Vector3<f64>; MAX_AXES],
}

/// A chain with a tool in it: all that kinematics needs to know of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Joints from the workpiece to the tool.
    joints: Vec<Joint>,
    /// Where the part origin sits with all axes at zero, mm, machine frame.
    mount: Vector3<f64>,
    /// Tip with all axes at zero, mm, machine frame.
    tip: Vector3<f64>,
    /// Tool axis with all axes at zero, machine frame, unit vector.
    axis: Vector3<f64>,
    /// Leading edge with all axes at zero, machine frame, unit vector; none for a tool that turns.
    edge: Option<Vector3<f64>>,
    /// Errors of axes that depend on where they stand; none of most machines.
    errors: Option<Arc<[AxisErrors]>>,
}

/// `vector` turned about the unit vector `k` (Rodrigues' formula).
///
/// Most axes of most machines lie along X, Y or Z, where a sixth of the work does.
#[inline]
pub fn turn(vector: Vector3<f64>, k: Vector3<f64>, sine: f64, cosine: f64) -> Vector3<f64> {
    match AxisLine::of(k) {
        AxisLine::Z => turn_about_z(vector, k.z, sine, cosine),
        AxisLine::X => turn_about_x(vector, k.x, sine, cosine),
        AxisLine::Y => turn_about_y(vector, k.y, sine, cosine),
        AxisLine::Askew => turn_askew(vector, k, sine, cosine),
    }
}

/// Which way the line of a rotary axis lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AxisLine {
    X,
    Y,
    Z,
    Askew,
}

impl AxisLine {
    /// The line of the unit vector `k`.
    #[inline]
    pub(super) fn of(k: Vector3<f64>) -> Self {
        if k.x == 0.0 && k.y == 0.0 {
            Self::Z
        } else if k.y == 0.0 && k.z == 0.0 {
            Self::X
        } else if k.x == 0.0 && k.z == 0.0 {
            Self::Y
        } else {
            Self::Askew
        }
    }
}

/// [`turn`] about X; `k` is 1 or -1.
#[inline(always)]
pub(super) fn turn_about_x(vector: Vector3<f64>, k: f64, sine: f64, cosine: f64) -> Vector3<f64> {
    let (x, y, z) = (vector.x, vector.y, vector.z);
    let sine = sine * k;
    Vector3::new(x, y * cosine - z * sine, y * sine + z * cosine)
}

/// [`turn`] about Y; `k` is 1 or -1.
#[inline(always)]
pub(super) fn turn_about_y(vector: Vector3<f64>, k: f64, sine: f64, cosine: f64) -> Vector3<f64> {
    let (x, y, z) = (vector.x, vector.y, vector.z);
    let sine = sine * k;
    Vector3::new(z * sine + x * cosine, y, z * cosine - x * sine)
}

/// [`turn`] about Z; `k` is 1 or -1.
#[inline(always)]
pub(super) fn turn_about_z(vector: Vector3<f64>, k: f64, sine: f64, cosine: f64) -> Vector3<f64> {
    let (x, y, z) = (vector.x, vector.y, vector.z);
    let sine = sine * k;
    Vector3::new(x * cosine - y * sine, x * sine + y * cosine, z)
}

/// [`turn`] about any direction.
#[inline(always)]
pub(super) fn turn_askew(
    vector: Vector3<f64>,
    k: Vector3<f64>,
    sine: f64,
    cosine: f64,
) -> Vector3<f64> {
    vector * cosine + k.cross(&vector) * sine + k * (k.dot(&vector) * (1.0 - cosine))
}

impl Turns {
    /// Puts sine and cosine of joint `index`.
    #[inline]
    pub(super) fn set(&mut self, index: usize, sine: f64, cosine: f64) {
        self.sines[index] = sine;
        self.cosines[index] = cosine;
    }

    /// Sine and cosine of joint `index`.
    #[inline]
    pub fn of(&self, index: usize) -> (f64, f64) {
        (self.sines[index], self.cosines[index])
    }
}

impl Chain {
    /// A chain of at most [`MAX_AXES`] joints. `tip` and `axis` are those of the tool in use with all axes at zero.
    pub fn new(
        joints: Vec<Joint>,
        mount: Vector3<f64>,
        tip: Vector3<f64>,
        axis: Vector3<f64>,
    ) -> Self {
        debug_assert!(joints.len() <= MAX_AXES);
        Self { joints, mount, tip, axis: axis.normalize(), edge: None, errors: None }
    }

    /// The chain with a tool that has a leading edge: a direction across the tool axis, all axes at zero,
    /// machine frame.
    pub fn with_edge(mut self, edge: Option<Vector3<f64>>) -> Self {
        self.edge = edge.and_then(|edge| {
            let across = edge - self.axis * self.axis.dot(&edge);
            across.try_normalize(1e-9)
        });
        self
    }

    /// The chain with errors of axes that depend on where they stand.
    pub fn with_errors(mut self, errors: &Arc<[AxisErrors]>) -> Self {
        self.errors = (!errors.is_empty()).then(|| Arc::clone(errors));
        self
    }

    /// Errors of axes that depend on where they stand.
    #[inline]
    pub fn errors(&self) -> &[AxisErrors] {
        self.errors.as_deref().unwrap_or_default()
    }

    /// The chain in which the linear joints `still` are parts that do not move, where `values` has them, mm: they move nothing
    /// any more, and what they carry is drawn where it stands.
    pub(super) fn standing(&self, still: &[usize], values: &Joints) -> Self {
        let mut chain = self.clone();
        for &joint in still {
            let by = chain.joints[joint].direction * values[joint];
            chain.joints[joint].direction = Vector3::zeros();
            for carried in &mut chain.joints[joint + 1..] {
                carried.point += by;
            }
            chain.tip += by;
        }
        chain
    }

    /// The joints, from the workpiece to the tool.
    #[inline]
    pub fn joints(&self) -> &[Joint] {
        // No longer than MAX_AXES in any case: said here so that no loop over them checks it again.
        &self.joints[..self.joints.len().min(MAX_AXES)]
    }

    /// Where the part origin sits with all axes at zero, mm, machine frame.
    pub fn mount(&self) -> Vector3<f64> {
        self.mount
    }

    /// Tip with all axes at zero, mm, machine frame.
    pub fn tip(&self) -> Vector3<f64> {
        self.tip
    }

    /// Tool axis with all axes at zero, machine frame.
    pub fn axis(&self) -> Vector3<f64> {
        self.axis
    }

    /// Leading edge with all axes at zero, machine frame.
    pub fn edge(&self) -> Option<Vector3<f64>> {
        self.edge
    }

    /// Sines and cosines of the rotary values of `joints`.
    #[inline]
    pub fn turns(&self, joints: &Joints) -> Turns {
        let mut turns = Turns { sines: [0.0; MAX_AXES], cosines: [1.0; MAX_AXES] };
        for (index, joint) in self.joints().iter().enumerate() {
            if joint.rotary {
                (turns.sines[index], turns.cosines[index]) = libm::sincos(joints[index]);
            }
        }
        turns
    }

    /// Evaluates sines and cosines anew where the place of a rotary joint is a bit of `of`.
    #[inline]
    pub fn turn_anew(&self, joints: &Joints, of: u32, turns: &mut Turns) {
        for (index, joint) in self.joints().iter().enumerate() {
            if joint.rotary && of & (1 << index) != 0 {
                (turns.sines[index], turns.cosines[index]) = libm::sincos(joints[index]);
            }
        }
    }

    /// [`Chain::forward`] where the sines and cosines of the joints are known.
    #[inline]
    pub fn pose(&self, joints: &Joints, turns: &Turns) -> Pose {
        self.reach(joints, turns, |_, _, _, _| {})
    }

    /// Where the tool stands, seen from the part.
    pub fn forward(&self, joints: &Joints) -> Pose {
        self.pose(joints, &self.turns(joints))
    }

    /// The way of the tip while a linear joint goes one mm, the others as in `joints`: mm, part frame.
    pub fn way_of(&self, joint: usize, joints: &Joints) -> Vector3<f64> {
        let mut further = *joints;
        further[joint] += 1.0;
        self.forward(&further).tip - self.forward(joints).tip
    }

    /// [`Chain::forward`] from the joints and turns of `trace`; fills in the rest of it.
    #[inline]
    pub fn trace(&self, trace: &mut Trace) {
        let Trace { joints, turns, tip_rates, axes, pose } = trace;
        *pose = self.reach(joints, turns, |index, joint, arm, axis| {
            tip_rates[index] = joint.direction.cross(arm);
            axes[index] = *axis;
        });
    }

    /// [`Chain::trace`] of axis values.
    pub fn traced(&self, joints: &Joints) -> Trace {
        let mut trace = Trace { joints: *joints, turns: self.turns(joints), ..Trace::default() };
        self.trace(&mut trace);
        trace
    }

    /// Where the tool stands when every axis is halfway between two places.
    ///
    /// The middle of an angle lies along the sum of the two unit vectors at its ends, so that no sine is evaluated.
    pub fn halfway(&self, from: &Trace, to: &Trace) -> Pose {
        let mut joints = Joints::default();
        let mut turns = Turns::default();
        for (index, joint) in self.joints().iter().enumerate() {
            let (first, last) = (from.joints[index], to.joints[index]);
            let middle = first * 0.5 + last * 0.5;
            joints[index] = middle;
            if !joint.rotary {
                continue;
            }
            let (sine, cosine) = if (last - first).abs() < 2.0 {
                let sine = from.turns.sines[index] + to.turns.sines[index];
                let cosine = from.turns.cosines[index] + to.turns.cosines[index];
                let length = (sine * sine + cosine * cosine).sqrt();
                (sine / length, cosine / length)
            } else {
                libm::sincos(middle)
            };
            turns.set(index, sine, cosine);
        }
        self.reach(&joints, &turns, |_, _, _, _| {})
    }

    /// The forward product. `pass` is told of every rotary joint, from the tool on, the arm from its line to the tip
    /// and the tool axis, both before it has turned.
    #[inline]
    fn reach(
        &self,
        joints: &Joints,
        turns: &Turns,
        mut pass: impl FnMut(usize, &Joint, &Vector3<f64>, &Vector3<f64>),
    ) -> Pose {
        let mut tip = self.tip;
        let mut axis = self.axis;
        let mut edge = self.edge;
        if self.errors.is_some() {
            return self.reach_with_errors(joints, turns, pass);
        }
        for (index, joint) in self.joints().iter().enumerate().rev() {
            if joint.rotary {
                let (sine, cosine) = turns.of(index);
                let arm = tip - joint.point;
                pass(index, joint, &arm, &axis);
                tip = joint.point + turn(arm, joint.direction, sine, cosine);
                axis = turn(axis, joint.direction, sine, cosine);
                if let Some(edge) = &mut edge {
                    *edge = turn(*edge, joint.direction, sine, cosine);
                }
            } else {
                tip += joint.direction * joints[index];
            }
        }
        Pose { tip: tip - self.mount, axis, edge: edge.unwrap_or_default() }
    }

    /// [`Chain::reach`] with the errors of the axes behind or before each joint.
    #[cold]
    fn reach_with_errors(
        &self,
        joints: &Joints,
        turns: &Turns,
        mut pass: impl FnMut(usize, &Joint, &Vector3<f64>, &Vector3<f64>),
    ) -> Pose {
        let mut pose = Pose { tip: self.tip, axis: self.axis, edge: self.edge.unwrap_or_default() };
        for (index, joint) in self.joints().iter().enumerate().rev() {
            let errors = self.errors_of(index);
            if let Some(errors) = errors.filter(|errors| !errors.before) {
                errors.carry(joints[index], &mut pose);
            }
            if joint.rotary {
                let (sine, cosine) = turns.of(index);
                let arm = pose.tip - joint.point;
                pass(index, joint, &arm, &pose.axis);
                pose.tip = joint.point + turn(arm, joint.direction, sine, cosine);
                pose.axis = turn(pose.axis, joint.direction, sine, cosine);
                pose.edge = turn(pose.edge, joint.direction, sine, cosine);
            } else {
                pose.tip += joint.direction * joints[index];
            }
            if let Some(errors) = errors.filter(|errors| errors.before) {
                errors.carry(joints[index], &mut pose);
            }
        }
        Pose { tip: pose.tip - self.mount, ..pose }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_along_the_frame_turn_as_all_others_do() {
        let vector = Vector3::new(1.0, -2.0, 3.0);
        let (sine, cosine) = libm::sincos(0.7);
        for k in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for k in [k, -k] {
                let turned = turn(vector, k, sine, cosine);
                assert!((turned - turn_askew(vector, k, sine, cosine)).norm() < 1e-15 * 8.0);
            }
        }
    }

    #[test]
    fn halfway_is_the_pose_in_the_middle() {
        let joint = |direction: Vector3<f64>, point: Vector3<f64>| Joint {
            rotary: true,
            direction: direction.normalize(),
            point,
        };
        let chain = Chain::new(
            vec![
                joint(Vector3::new(0.1, -0.2, 1.0), Vector3::new(3.0, 4.0, 0.0)),
                joint(Vector3::y(), Vector3::new(0.0, 5.0, 60.0)),
            ],
            Vector3::zeros(),
            Vector3::new(0.0, 0.0, 300.0),
            Vector3::z(),
        );
        let at = |values: [f64; 2]| {
            let mut trace = Trace::default();
            trace.joints[..2].copy_from_slice(&values);
            trace.turns = chain.turns(&trace.joints);
            chain.trace(&mut trace);
            trace
        };
        for step in 0..80 {
            // Up to whole turns apart, and so to both sides of where the sum of the ends says little.
            let first = [-3.0 + 0.07 * f64::from(step), 0.4];
            let last = [first[0] + 0.1 * f64::from(step), 0.4 - 0.06 * f64::from(step)];
            let middle = chain.halfway(&at(first), &at(last));
            let wanted = at([0, 1].map(|place| (first[place] + last[place]) / 2.0)).pose;
            assert!((middle.tip - wanted.tip).norm() < 1e-11, "step {step}");
            assert!((middle.axis - wanted.axis).norm() < 1e-14, "step {step}");
        }
    }

    /// Nutating head of a published layout: B about (0, 1, 1) through the pivot; B 180 lays the tool flat.
    #[test]
    fn nutating_head_at_180_degrees() {
        let joint = |rotary, direction: [f64; 3], point: [f64; 3]| Joint {
            rotary,
            direction: Vector3::from(direction).normalize(),
            point: Vector3::from(point),
        };
        let chain = Chain::new(
            vec![
                joint(true, [0.0, 0.0, 1.0], [0.0; 3]),
                joint(false, [1.0, 0.0, 0.0], [0.0; 3]),
                joint(false, [0.0, 1.0, 0.0], [0.0; 3]),
                joint(false, [0.0, 0.0, 1.0], [0.0; 3]),
                joint(true, [0.0, 1.0, 1.0], [0.0, 0.0, 680.0]),
            ],
            Vector3::zeros(),
            Vector3::new(0.0, 0.0, 500.0),
            Vector3::z(),
        );
        let mut joints = [0.0; MAX_AXES];
        joints[4] = std::f64::consts::PI;
        let pose = chain.forward(&joints);
        assert!((pose.axis - Vector3::y()).norm() < 1e-12);
        assert!((pose.tip - Vector3::new(0.0, -180.0, 680.0)).norm() < 1e-9);
    }
}
