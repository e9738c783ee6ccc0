//! A forward product of the tests' own, which multiplies isometries (unit quaternions) and takes no line from the
//! crate under test.

use std::f64::consts::TAU;

use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use post_machine::kinematics::{Chain, Joint, Joints};

use crate::geometry::angle;

/// A chain with a tool in it, and its forward product by isometries.
#[derive(Clone, Debug)]
pub struct Reference {
    pub joints: Vec<Joint>,
    pub mount: Vector3<f64>,
    pub tip: Vector3<f64>,
    pub axis: Vector3<f64>,
}

impl Reference {
    /// What joints 0 to `count` do together.
    fn product(&self, q: &[f64], count: usize) -> Isometry3<f64> {
        let step = |product: Isometry3<f64>, (joint, value): (&Joint, &f64)| {
            let direction = joint.direction;
            product
                * if joint.rotary {
                    let k = Unit::new_normalize(direction);
                    let point = Translation3::from(joint.point);
                    point * UnitQuaternion::from_axis_angle(&k, *value) * point.inverse()
                } else {
                    Isometry3::translation(
                        direction.x * value,
                        direction.y * value,
                        direction.z * value,
                    )
                }
        };
        self.joints[..count].iter().zip(q).fold(Isometry3::identity(), step)
    }

    /// Tip and tool axis, part frame.
    pub fn forward(&self, q: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
        let product = self.product(q, self.joints.len());
        let tip = (product * Point3::from(self.tip)).coords - self.mount;
        (tip, product.rotation * self.axis)
    }

    /// The whole turn from the tool to the part.
    pub fn rotation(&self, q: &[f64]) -> UnitQuaternion<f64> {
        self.product(q, self.joints.len()).rotation
    }

    /// The direction of joint `index`, part frame.
    pub fn direction(&self, q: &[f64], index: usize) -> Vector3<f64> {
        self.product(q, index).rotation * self.joints[index].direction
    }

    /// How the tool axis moves with rotary joint `index`.
    pub fn axis_slope(&self, q: &[f64], index: usize) -> Vector3<f64> {
        self.direction(q, index).cross(&self.forward(q).1)
    }

    /// Places of the linear joints.
    pub fn linear(&self) -> Vec<usize> {
        (0..self.joints.len()).filter(|index| !self.joints[*index].rotary).collect()
    }

    /// A direction of the tool with all axes at zero, seen from the part at `q`.
    pub fn taken(&self, q: &[f64], direction: Vector3<f64>) -> Vector3<f64> {
        self.rotation(q) * direction
    }

    /// The volume that the linear directions span at `q`, part frame.
    pub fn volume(&self, q: &[f64]) -> f64 {
        let columns: Vec<Vector3<f64>> =
            self.linear().into_iter().map(|index| self.direction(q, index)).collect();
        Matrix3::from_columns(&columns).determinant().abs()
    }

    /// The three linear joints where they put the tip on `tip` (part frame), the rotary ones standing as they do.
    pub fn put(&self, tip: Vector3<f64>, mut joints: Joints) -> Joints {
        let linear = self.linear();
        for place in &linear {
            joints[*place] = 0.0;
        }
        let columns: Vec<Vector3<f64>> =
            linear.iter().map(|place| self.direction(&joints, *place)).collect();
        let way = tip - self.forward(&joints).0;
        let values =
            Matrix3::from_columns(&columns).try_inverse().expect("linear axes that span the space")
                * way;
        for (place, value) in linear.iter().zip(values.iter()) {
            joints[*place] = *value;
        }
        joints
    }

    /// The chain under test.
    pub fn chain(&self) -> Chain {
        Chain::new(self.joints.clone(), self.mount, self.tip, self.axis)
    }
}

/// The least angle between `wanted` and where two rotary axes (`free`, the others at `held`) can bring the
/// direction `along` of the tool: by trying every angle of the first, the second put where it is best.
pub fn nearest(
    reference: &Reference,
    held: &Joints,
    free: [usize; 2],
    along: Vector3<f64>,
    wanted: Vector3<f64>,
) -> f64 {
    let at = |first: f64| {
        let mut q = *held;
        q[free[0]] = first;
        // Where the second axis stands, and what it turns, seen from the part.
        let k = reference.direction(&q, free[1]);
        q[free[1]] = 0.0;
        let from = reference.taken(&q, along);
        let flat = |v: Vector3<f64>| v - k * k.dot(&v);
        let (a, b) = (flat(from), flat(wanted));
        let turn = libm::atan2(k.dot(&a.cross(&b)), a.dot(&b));
        q[free[1]] = turn;
        angle(reference.taken(&q, along), wanted)
    };
    const STEPS: usize = 720;
    let width = TAU / STEPS as f64;
    let tried: Vec<f64> = (0..STEPS).map(|step| at(step as f64 * width)).collect();
    let mut least = f64::INFINITY;
    for step in 0..STEPS {
        let (before, after) = ((step + STEPS - 1) % STEPS, (step + 1) % STEPS);
        if tried[step] > tried[before] || tried[step] > tried[after] {
            continue;
        }
        // A valley: closed in on by thirds.
        let (mut low, mut high) = ((step as f64 - 1.0) * width, (step as f64 + 1.0) * width);
        for _ in 0..90 {
            let third = (high - low) / 3.0;
            if at(low + third) < at(high - third) {
                high -= third;
            } else {
                low += third;
            }
        }
        least = least.min(at((low + high) / 2.0));
    }
    least
}
