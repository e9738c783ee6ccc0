//! The kinematic chain: joints from the workpiece to the tool, and the forward product.
//!
//! `T(q) = exp(ξ1·q1) … exp(ξn·qn)·T0`, every joint given in the machine frame with all axes at zero.
//! Directions are those of the tool as seen from the part (ISO 841), so one product with one sign serves
//! tables and heads alike. Lengths in mm, angles in radians.

use nalgebra::Vector3;

/// The longest chain; working values are arrays of this length, so that no point allocates.
pub const MAX_AXES: usize = 8;

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
    /// Leading edge of a knife or disc, unit vector across the tool axis, part frame; zero for a tool that turns.
    pub edge: Vector3<f64>,
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
    /// Their sines and cosines.
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
    /// From the workpiece to the tool.
    joints: Vec<Joint>,
    /// Where the part origin sits with all axes at zero, mm, machine frame.
    mount: Vector3<f64>,
    /// Tip with all axes at zero, mm, machine frame.
    tip: Vector3<f64>,
    /// Tool axis with all axes at zero, machine frame, unit vector.
    axis: Vector3<f64>,
    /// Leading edge with all axes at zero, machine frame, unit vector; none for a tool that turns.
    edge: Option<Vector3<f64>>,
}

/// `vector` turned about the unit vector `k` (Rodrigues' formula).
///
/// Most axes of most machines lie along X, Y or Z, where a sixth of the work does.
#[inline]
pub fn turn(vector: Vector3<f64>, k: Vector3<f64>, sine: f64, cosine: f64) -> Vector3<f64> {
    let (x, y, z) = (vector.x, vector.y, vector.z);
    if k.x == 0.0 && k.y == 0.0 {
        let sine = sine * k.z;
        return Vector3::new(x * cosine - y * sine, x * sine + y * cosine, z);
    }
    if k.y == 0.0 && k.z == 0.0 {
        let sine = sine * k.x;
        return Vector3::new(x, y * cosine - z * sine, y * sine + z * cosine);
    }
    if k.x == 0.0 && k.z == 0.0 {
        let sine = sine * k.y;
        return Vector3::new(z * sine + x * cosine, y, z * cosine - x * sine);
    }
    turn_askew(vector, k, sine, cosine)
}

#[inline]
fn turn_askew(vector: Vector3<f64>, k: Vector3<f64>, sine: f64, cosine: f64) -> Vector3<f64> {
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
        Self {
            joints,
            mount,
            tip,
            axis: axis.normalize(),
            edge: None,
        }
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
        let mut turns = Turns {
            sines: [0.0; MAX_AXES],
            cosines: [1.0; MAX_AXES],
        };
        for (index, joint) in self.joints().iter().enumerate() {
            if joint.rotary {
                (turns.sines[index], turns.cosines[index]) = libm::sincos(joints[index]);
            }
        }
        turns
    }

    /// Where the tool stands, seen from the part.
    pub fn forward(&self, joints: &Joints) -> Pose {
        let mut trace = Trace {
            joints: *joints,
            turns: self.turns(joints),
            ..Trace::default()
        };
        self.trace(&mut trace);
        trace.pose
    }

    /// [`Chain::forward`] from the joints and turns of `trace`; fills in the rest of it.
    #[inline]
    pub fn trace(&self, trace: &mut Trace) {
        let mut tip = self.tip;
        let mut axis = self.axis;
        let mut edge = self.edge;
        for (index, joint) in self.joints().iter().enumerate().rev() {
            if joint.rotary {
                let (sine, cosine) = trace.turns.of(index);
                let arm = tip - joint.point;
                trace.tip_rates[index] = joint.direction.cross(&arm);
                trace.axes[index] = axis;
                tip = joint.point + turn(arm, joint.direction, sine, cosine);
                axis = turn(axis, joint.direction, sine, cosine);
                if let Some(edge) = &mut edge {
                    *edge = turn(*edge, joint.direction, sine, cosine);
                }
            } else {
                tip += joint.direction * trace.joints[index];
            }
        }
        trace.pose = Pose {
            tip: tip - self.mount,
            axis,
            edge: edge.unwrap_or_default(),
        };
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
