//! Derivatives of the axes along a path: the tip's are known and those of the rotary axes, the linear axes follow.
//!
//! With the rotary axes where they stand, the tip is linear in the linear axes: `A·l + b = p`, the columns of `A` their
//! directions and `b` the tool's end with them at zero, both seen from the part through the rotary axes in front. Along
//! a path all of it are power series of its parameter, and so are the linear axes: each order follows from those before
//! it by the same 3×3 system. Nothing is differenced, so that nothing is as rough as the words are.

use nalgebra::{Matrix3, Vector3};

use super::chain::{Chain, Joints, MAX_AXES, turn};
use super::fault::Unreachable;
use super::linear::FLAT;

/// A value and its first three derivatives by the parameter of a path.
pub const ORDERS: usize = 4;

pub(super) const FACTORIALS: [f64; ORDERS] = [1.0, 1.0, 2.0, 6.0];

/// A vector as a power series.
pub(super) type VectorSeries = [Vector3<f64>; ORDERS];

/// Where the machine stands on a path, and how it goes on from there.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointDerivatives {
    /// Axis values and their first three derivatives by the parameter, by place in the chain: mm and radians.
    pub joints: [Joints; ORDERS],
    /// How the tip moves with each axis: mm a mm or mm a radian, part frame.
    pub rates: [Vector3<f64>; MAX_AXES],
}

/// A linear axis that follows, and with what share of a common way.
#[derive(Clone, Copy, Debug)]
pub(super) struct LinearShare {
    pub(super) joint: usize,
    pub(super) share: f64,
}

/// Fills in the linear axes among the derivatives of `course`, whose values and rotary derivatives are given, so that
/// the tip goes as `tip` says (derivatives, mm, part frame). Each of `ways` is one unknown: a linear axis, or two that
/// share a way.
///
/// # Errors
/// The linear axes span no volume here.
pub(super) fn follow(
    chain: &Chain,
    ways: &[[LinearShare; 2]; 3],
    tip: &[Vector3<f64>; ORDERS],
    course: &mut JointDerivatives,
) -> Result<(), Unreachable> {
    let (end, columns) = pass(chain, course);
    let main: [VectorSeries; 3] = std::array::from_fn(|way| {
        let [one, other] = ways[way];
        std::array::from_fn(|order| {
            columns[one.joint][order] * one.share + columns[other.joint][order] * other.share
        })
    });
    let matrix = |order: usize| Matrix3::from_columns(&main.map(|column| column[order]));
    let first = matrix(0);
    if libm::fabs(first.determinant()) < FLAT {
        return Err(Unreachable::Linear);
    }
    let inverse = first.try_inverse().ok_or(Unreachable::Linear)?;
    // With the axes where they stand the tip is `end`; what they go from there is unknown.
    let mut found = [Vector3::zeros(); ORDERS];
    for order in 1..ORDERS {
        let mut rest = tip[order] / FACTORIALS[order] - end[order];
        for (lower, known) in found.iter().enumerate().take(order).skip(1) {
            rest -= matrix(order - lower) * known;
        }
        found[order] = inverse * rest;
        for (way, value) in ways.iter().zip(found[order].iter()) {
            let derivative = value * FACTORIALS[order];
            for part in way.iter().filter(|part| part.share != 0.0) {
                course.joints[order][part.joint] = derivative * part.share;
            }
        }
    }
    Ok(())
}

/// The tip as a power series with every linear axis standing, and how it moves with each linear axis, seen from the
/// part; the rates of `course`.
fn pass(chain: &Chain, course: &mut JointDerivatives) -> (VectorSeries, [VectorSeries; MAX_AXES]) {
    let mut end: VectorSeries = Default::default();
    end[0] = chain.tip();
    let mut columns = [VectorSeries::default(); MAX_AXES];
    for (index, joint) in chain.joints().iter().enumerate().rev() {
        let k = joint.direction;
        if !joint.rotary {
            end[0] += k * course.joints[0][index];
            columns[index][0] = k;
            course.rates[index] = k;
            continue;
        }
        let angle: [f64; ORDERS] =
            std::array::from_fn(|order| course.joints[order][index] / FACTORIALS[order]);
        let turning = RotationSeries::new(k, angle);
        end[0] -= joint.point;
        end = turning.of(&end);
        course.rates[index] = k.cross(&end[0]);
        end[0] += joint.point;
        for (other, behind) in chain.joints().iter().enumerate().skip(index + 1) {
            if !behind.rotary {
                columns[other] = turning.of(&columns[other]);
            }
            course.rates[other] = turning.once(course.rates[other]);
        }
    }
    (end, columns)
}

/// A turn about an axis by an angle that is a power series.
pub(super) struct RotationSeries {
    k: Vector3<f64>,
    sine: [f64; ORDERS],
    cosine: [f64; ORDERS],
    /// The angle stays.
    stands: bool,
}

impl RotationSeries {
    pub(super) fn new(k: Vector3<f64>, angle: [f64; ORDERS]) -> Self {
        let (mut sine, mut cosine) = ([0.0; ORDERS], [0.0; ORDERS]);
        (sine[0], cosine[0]) = libm::sincos(angle[0]);
        // Of s' = a'·c and c' = -a'·s.
        for order in 1..ORDERS {
            for lower in 1..=order {
                let share = lower as f64 * angle[lower] / order as f64;
                sine[order] += share * cosine[order - lower];
                cosine[order] -= share * sine[order - lower];
            }
        }
        Self { k, sine, cosine, stands: angle[1..] == [0.0; ORDERS - 1] }
    }

    pub(super) fn once(&self, vector: Vector3<f64>) -> Vector3<f64> {
        turn(vector, self.k, self.sine[0], self.cosine[0])
    }

    pub(super) fn of(&self, series: &VectorSeries) -> VectorSeries {
        if self.stands {
            return series.map(|vector| self.once(vector));
        }
        let along = series.map(|vector| self.k * self.k.dot(&vector));
        let across = series.map(|vector| self.k.cross(&vector));
        std::array::from_fn(|order| {
            let mut sum = along[order];
            for lower in 0..=order {
                let rest = series[lower] - along[lower];
                sum += rest * self.cosine[order - lower] + across[lower] * self.sine[order - lower];
            }
            sum
        })
    }
}
