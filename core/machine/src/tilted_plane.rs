//! Tilted planes of the control: a frame in the part, and the angles that a control is told it by.

use nalgebra::{Matrix3, Vector3};
use post_plugin::Format;

use crate::kinematics::{Chain, Joints};

/// Sine below which two of three angles turn about one axis, radians: no control prints it.
const POLE: f64 = 1e-7;

/// Sine below which the machine's X axis runs along the tool.
const ALONG: f64 = 1e-6;

/// What three angles of a plane with three decimals of a degree, and those of two rotary axes, turn it by at most, radians.
pub const ROUNDED: f64 = 3e-5;

/// A frame whose third axis is the tool axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltedPlane {
    /// Origin, mm, part frame.
    pub origin: Vector3<f64>,
    /// Axes as columns, unit vectors of the part frame, right-handed.
    pub axes: Matrix3<f64>,
    /// The angles of the control's convention, degrees, as they are printed; zero where it has none.
    pub angles: [f64; 3],
}

impl TiltedPlane {
    /// The plane that the tool stands upright on with the axes at `joints`, its first direction that of the linear axis
    /// `x` (its place in the chain) against the part, laid across the tool; as a dialect's `format` prints it.
    pub fn of(
        chain: &Chain,
        joints: &Joints,
        x: usize,
        origin: Vector3<f64>,
        format: &Format,
    ) -> Self {
        let z = chain.forward(joints).axis;
        let way = chain.way_of(x, joints);
        let across = way - z * way.dot(&z);
        let x = across.try_normalize(ALONG).unwrap_or_else(|| {
            // The machine's X lies along the tool: any direction across it, and always the same.
            let other = match libm::fabs(z.x) < 0.9 {
                true => Vector3::x(),
                false => Vector3::y(),
            };
            (other - z * other.dot(&z)).normalize()
        });
        let exact = Matrix3::from_columns(&[x, z.cross(&x), z]);
        let Some(order) = format.plane_angles.order() else {
            return Self { origin, axes: exact, angles: [0.0; 3] };
        };
        let scale = (0..format.plane_decimals).fold(1.0, |scale, _| scale * 10.0);
        let angles =
            angles(order, &exact).map(|angle| libm::rint(angle.to_degrees() * scale) / scale + 0.0);
        Self { origin, axes: rotation(order, angles.map(f64::to_radians)), angles }
    }

    /// A point of the part frame in the plane's, mm.
    #[inline]
    pub fn into_plane(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.axes.transpose() * (point - self.origin)
    }

    /// A point of the plane's frame in that of the part, mm.
    #[inline]
    pub fn into_part(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.origin + self.axes * point
    }

    /// Normal, unit vector, part frame.
    pub fn normal(&self) -> Vector3<f64> {
        self.axes.column(2).into_owned()
    }
}

/// The frame, its axes as columns, that three turns about axes of the frame before them make; radians.
pub fn rotation(order: [usize; 3], angles: [f64; 3]) -> Matrix3<f64> {
    let turns = [0, 1, 2].map(|turn| turned(order[turn], angles[turn]));
    turns[0] * turns[1] * turns[2]
}

/// A turn about an axis.
fn turned(axis: usize, angle: f64) -> Matrix3<f64> {
    let (sine, cosine) = libm::sincos(angle);
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut turned = Matrix3::identity();
    turned[(first, first)] = cosine;
    turned[(first, second)] = -sine;
    turned[(second, first)] = sine;
    turned[(second, second)] = cosine;
    turned
}

/// The angles that make a frame, radians: the second from 0 to π if the first axis comes twice, else from -π/2 to π/2;
/// the third is zero where it turns about the axis of the first.
pub fn angles([i, j, k]: [usize; 3], frame: &Matrix3<f64>) -> [f64; 3] {
    let at = |row: usize, column: usize| frame[(row, column)];
    if i == k {
        // The axis that is left over.
        let other = 3 - i - j;
        let sign = parity(i, j);
        let sine = libm::hypot(at(i, j), at(i, other));
        let second = libm::atan2(sine, at(i, i));
        if sine < POLE {
            return [libm::atan2(sign * at(other, j), at(j, j)), second, 0.0];
        }
        return [
            libm::atan2(at(j, i), -sign * at(other, i)),
            second,
            libm::atan2(at(i, j), sign * at(i, other)),
        ];
    }
    let sign = parity(i, j);
    let cosine = libm::hypot(at(i, i), at(i, j));
    let second = libm::atan2(sign * at(i, k), cosine);
    if cosine < POLE {
        return [libm::atan2(sign * at(k, j), at(j, j)), second, 0.0];
    }
    [libm::atan2(-sign * at(j, k), at(k, k)), second, libm::atan2(-sign * at(i, j), at(i, i))]
}

/// 1 if the second axis follows the first in the order X, Y, Z, X, else -1.
fn parity(first: usize, second: usize) -> f64 {
    if (first + 1) % 3 == second { 1.0 } else { -1.0 }
}
