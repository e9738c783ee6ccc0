//! Derivatives of the rotary axes along a path whose tool axis is known as a power series.
//!
//! The tool axis in the part frame is a product of turns. Each order of the angles enters the same order of the tool axis
//! in a linear way, by how the tool axis turns with each of them; so each order follows from those before it, by the
//! least squares of three equations.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::chain::Chain;
use super::derivatives::{FACTORIALS, JointDerivatives, ORDERS, RotationSeries, VectorSeries};
use super::fault::{POLE, Unreachable};

/// The largest part of a change of the tool axis that the rotary axes may be unable to follow, beside rounding.
const MISSED: f64 = 1e-7;

/// A vector that is shorter has no direction.
const NULL: f64 = 1e-9;

/// Derivatives of the unit vector along one that goes as `along` says (value and derivatives by the same parameter); none
/// where that is null.
#[must_use]
pub fn direction(along: &[Vector3<f64>; ORDERS]) -> Option<[Vector3<f64>; ORDERS]> {
    let length = along[0].norm();
    if length < NULL {
        return None;
    }
    let vector: VectorSeries =
        std::array::from_fn(|order| along[order] / (length * FACTORIALS[order]));
    let product = |a: &VectorSeries, order: usize| -> f64 {
        (0..=order).map(|lower| a[lower].dot(&vector[order - lower])).sum()
    };
    // Of |v|² = v·v, then of u |v| = v.
    let mut size = [1.0, 0.0, 0.0, 0.0];
    let mut unit: VectorSeries = Default::default();
    unit[0] = vector[0];
    for order in 1..ORDERS {
        let known: f64 = (1..order).map(|lower| size[lower] * size[order - lower]).sum();
        size[order] = (product(&vector, order) - known) / 2.0;
        unit[order] =
            (0..order).fold(vector[order], |rest, lower| rest - unit[lower] * size[order - lower]);
    }
    Some(std::array::from_fn(|order| unit[order] * FACTORIALS[order]))
}

/// Fills in the derivatives of the joints `rotary` (one or two), whose values `course` has, so that the tool axis goes as
/// `axis` says: a unit vector and its derivatives, part frame.
///
/// # Errors
/// [`Unreachable::Axis`] where they cannot follow: on the pole, or off the way that a single axis turns the tool along.
pub(super) fn follow(
    chain: &Chain,
    rotary: &[usize],
    axis: &[Vector3<f64>; ORDERS],
    course: &mut JointDerivatives,
) -> Result<(), Unreachable> {
    let base: f64 = axis[1..].iter().map(|vector| vector.norm()).fold(1.0, f64::max);
    for order in 1..ORDERS {
        for joint in rotary {
            course.joints[order][*joint] = 0.0;
        }
        let (series, rates) = pass(chain, rotary, course);
        let wanted = axis[order] / FACTORIALS[order] - series[order];
        let found = match rates[..] {
            [] => [0.0; 2],
            [one] => [one.dot(&wanted) / one.norm_squared().max(POLE * POLE), 0.0],
            [one, other, ..] => {
                let normal = Matrix2::new(
                    one.dot(&one),
                    one.dot(&other),
                    one.dot(&other),
                    other.dot(&other),
                );
                let side = Vector2::new(one.dot(&wanted), other.dot(&wanted));
                let inverse = normal.try_inverse();
                let inverse = inverse.filter(|_| normal.determinant() > POLE * POLE);
                (inverse.ok_or(Unreachable::Axis { miss: wanted.norm() })? * side).into()
            }
        };
        let mut left = wanted;
        for ((joint, rate), value) in rotary.iter().zip(&rates).zip(found) {
            course.joints[order][*joint] = value * FACTORIALS[order];
            left -= rate * value;
        }
        if left.norm() > MISSED * base {
            return Err(Unreachable::Axis { miss: left.norm() });
        }
    }
    Ok(())
}

/// The tool axis as a power series, and how it turns with each of `rotary`, in the part frame.
fn pass(
    chain: &Chain,
    rotary: &[usize],
    course: &JointDerivatives,
) -> (VectorSeries, Vec<Vector3<f64>>) {
    let mut series: VectorSeries = Default::default();
    series[0] = chain.axis();
    let mut rates = vec![Vector3::zeros(); rotary.len()];
    for (index, joint) in chain.joints().iter().enumerate().rev() {
        if !joint.rotary {
            continue;
        }
        let angle: [f64; ORDERS] =
            std::array::from_fn(|order| course.joints[order][index] / FACTORIALS[order]);
        let turning = RotationSeries::new(joint.direction, angle);
        series = turning.of(&series);
        for (rate, behind) in rates.iter_mut().zip(rotary) {
            if *behind > index {
                *rate = turning.once(*rate);
            } else if *behind == index {
                *rate = joint.direction.cross(&series[0]);
            }
        }
    }
    (series, rates)
}
