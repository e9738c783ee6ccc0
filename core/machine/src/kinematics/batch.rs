//! Many points at once, for stages that take a batch: the same operations in the same order as for a single point, so
//! the same bits, but one step for all points before the next, so that their latencies overlap. A root or an arc
//! tangent takes tens of cycles to come and a few to start; point by point there is nothing to do meanwhile.

use nalgebra::Vector3;

use super::chain::{Chain, MAX_AXES, Turns, turn};
use super::fault::POLE;
use super::inverse::Solver;
use super::orientation::Two;

/// Points that are solved together.
pub const LANES: usize = 64;

/// A number of each point.
pub type Lanes = [f64; LANES];

/// Angles of one of two rotary axes, with their sines and cosines, as [`super::orientation::RotarySet`] has them.
#[derive(Clone, Debug)]
pub struct Angles {
    /// Radians, in -π to π.
    pub angle: Lanes,
    /// Sines of the angles.
    pub sine: Lanes,
    /// Cosines of the angles.
    pub cosine: Lanes,
}

/// The rotary inverse of a batch of points, for two free rotary axes.
#[derive(Clone, Debug)]
pub struct Rotaries {
    /// The point has two branches and no free angle, and is solved. All others (on a pole, at the edge of reach or
    /// beyond it) are left to [`Solver::orient`].
    pub regular: [bool; LANES],
    /// Sine of the angle between the wanted axis and the first free joint.
    pub sine: Lanes,
    /// Its cosine.
    pub cosine: Lanes,
    /// Of each branch the first and the second free joint.
    pub branches: [[Angles; 2]; 2],
}

/// Where the axes of a batch of points stand, by joint; what is not a rotary joint has the sine 0 and the cosine 1.
#[derive(Clone, Debug)]
pub struct Axes {
    /// Axis values, mm or radians.
    pub joints: [Lanes; MAX_AXES],
    /// Sines of the rotary ones.
    pub sines: [Lanes; MAX_AXES],
    /// Their cosines.
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

impl Default for Axes {
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
        Self {
            tip: ZERO,
            axis: ZERO,
            tip_rates: [ZERO; MAX_AXES],
            axes: [ZERO; MAX_AXES],
        }
    }
}

impl Turns {
    /// Of one point of a batch.
    #[inline]
    pub fn of_lane(at: &Axes, lane: usize) -> Self {
        let mut turns = Self::default();
        for index in 0..MAX_AXES {
            turns.set(index, at.sines[index][lane], at.cosines[index][lane]);
        }
        turns
    }
}

impl Chain {
    /// [`Chain::trace`] of the first `count` points of `at`; the leading edge of a tool that has one is left out.
    pub fn trace_all(&self, at: &Axes, count: usize, out: &mut Traces) {
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

impl Angles {
    const ZERO: Self = Self {
        angle: [0.0; LANES],
        sine: [0.0; LANES],
        cosine: [1.0; LANES],
    };
}

impl Default for Rotaries {
    fn default() -> Self {
        Self {
            regular: [false; LANES],
            sine: [0.0; LANES],
            cosine: [0.0; LANES],
            branches: [const { [Angles::ZERO; 2] }; 2],
        }
    }
}

impl Solver {
    /// Points the tool along each of `axes` (unit vectors, part frame; at most [`LANES`]): [`Solver::orient`] and
    /// [`Solver::angles`] of all of them. Gives the two free joints, the one nearer the workpiece first; none, and
    /// nothing is solved, where the machine has not just two of them in closed form.
    pub fn orient_all(&self, axes: &[Vector3<f64>], out: &mut Rotaries) -> Option<[usize; 2]> {
        let two = self.two()?;
        two.orient_all(axes, out);
        Some(two.joints)
    }
}

impl Two {
    fn orient_all(&self, axes: &[Vector3<f64>], out: &mut Rotaries) {
        let count = axes.len().min(LANES);
        let mut u = [Vector3::zeros(); LANES];
        let (mut x, mut y, mut per_square) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        out.regular = [false; LANES];
        for (lane, axis) in axes.iter().take(LANES).enumerate() {
            let between = self.between(self.behind_held(*axis));
            u[lane] = between.u;
            x[lane] = between.x;
            y[lane] = between.square.max(0.0);
            out.cosine[lane] = between.u.x;
            out.sine[lane] = between.sine_squared;
            out.regular[lane] = between.square > 0.0 && between.sine_squared >= POLE * POLE;
        }
        for root in [&mut y, &mut out.sine] {
            root[..count]
                .iter_mut()
                .for_each(|value| *value = value.sqrt());
        }
        for lane in 0..count {
            per_square[lane] = 1.0 / (x[lane] * x[lane] + y[lane] * y[lane]);
        }
        for (branch, sign) in out.branches.iter_mut().zip([1.0, -1.0]) {
            let [first, second] = branch;
            for lane in 0..count {
                [
                    (first.sine[lane], first.cosine[lane]),
                    (second.sine[lane], second.cosine[lane]),
                ] = self.turned(&u[lane], x[lane], sign * y[lane]);
            }
            for angles in [&mut *first, &mut *second] {
                for lane in 0..count {
                    angles.angle[lane] = libm::atan2(angles.sine[lane], angles.cosine[lane]);
                }
            }
            for (lane, per_square) in per_square[..count].iter().enumerate() {
                first.sine[lane] *= per_square;
                first.cosine[lane] *= per_square;
                second.sine[lane] *= self.per_square;
                second.cosine[lane] *= self.per_square;
            }
        }
    }
}
