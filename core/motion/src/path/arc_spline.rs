//! An arc as a spline, for axes that do not stand across one another: their positions on a circle are no arc of the tip.

use nalgebra::Vector3;

use super::round::{arm_and_height, on_arc};
use super::spline::BSpline;

/// Turn of a piece, radians: a helix is off in height by less than a hundred-thousandth of what that changes in a radian, a
/// spiral along its way by less than a thousandth of what its radius changes.
const PIECE: f64 = std::f64::consts::TAU / 72.0;

impl BSpline {
    /// The arc from one point to another about an axis through `centre` along `normal`, a unit vector, by `sweep` radians:
    /// a circle is exact, its parameter even to a hundred-thousandth of the turn of a piece.
    pub fn of_arc(
        ends: [Vector3<f64>; 2],
        centre: Vector3<f64>,
        normal: Vector3<f64>,
        sweep: f64,
    ) -> Self {
        let count = libm::ceil(libm::fabs(sweep) / PIECE).max(1.0) as usize;
        let at = |share: f64| on_arc(ends, centre, normal, sweep, share);
        let cosine = libm::cos(0.5 * sweep / count as f64);
        let mut poles = vec![(ends[0], 1.0)];
        for piece in 0..count {
            let middle = at((piece as f64 + 0.5) / count as f64);
            let (arm, _) = arm_and_height(middle, centre, normal);
            let last = piece + 1 == count;
            let end = if last { ends[1] } else { at((piece + 1) as f64 / count as f64) };
            // Tangents at both ends meet there.
            poles.extend([(middle + arm * (1.0 / cosine - 1.0), cosine), (end, 1.0)]);
        }
        let inner = (0..=count).flat_map(|knot| [knot as f64; 2]);
        let knots = std::iter::once(0.0).chain(inner).chain([count as f64]).collect();
        Self { degree: 2, knots, poles }
    }
}
