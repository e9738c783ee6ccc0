//! Many points at once, for stages that take a batch: the same operations in the same order as for a single point, so
//! the same bits, but one step for all points before the next, so that their latencies overlap. A root or an arc
//! tangent takes tens of cycles to come and a few to start; point by point there is nothing to do meanwhile.

use nalgebra::Vector3;

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
            for lane in 0..count {
                first.sine[lane] *= per_square[lane];
                first.cosine[lane] *= per_square[lane];
                second.sine[lane] *= self.per_square;
                second.cosine[lane] *= self.per_square;
            }
        }
    }
}
