//! Random machines.

use std::f64::consts::PI;

use nalgebra::Vector3;
use post_machine::kinematics::{Joint, Joints};
use post_testkit::Rng;

use crate::Reference;

/// A machine of no meaning: any directions, any lines, any order.
pub struct Random {
    pub reference: Reference,
    /// Rotary joints that move in a cut.
    pub free: Vec<usize>,
    /// Values of the others.
    pub held: Joints,
}

/// Points on axis lines, mount and tip lie within this of the origin, mm, and so do linear values.
pub const SIZE: f64 = 500.0;

impl Random {
    /// A machine with `free` moving rotary axes and `held` that stand still. Two free axes are 3° apart at least,
    /// and the linear axes, if no rotary one stands between, span a fifth of a cube.
    pub fn new(rng: &mut Rng, free: usize, held: usize) -> Self {
        loop {
            let mut kinds = vec![0u8; 3];
            kinds.extend(vec![1; free]);
            kinds.extend(vec![2; held]);
            for index in (1..kinds.len()).rev() {
                kinds.swap(index, rng.pick(index + 1));
            }
            let joints = kinds
                .iter()
                .map(|kind| Joint {
                    rotary: *kind > 0,
                    direction: rng.direction(),
                    point: rng.point(SIZE),
                })
                .collect();
            let machine = Self {
                reference: Reference {
                    joints,
                    mount: rng.point(SIZE),
                    tip: rng.point(SIZE),
                    axis: rng.direction(),
                },
                free: (0..kinds.len()).filter(|index| kinds[*index] == 1).collect(),
                held: std::array::from_fn(|index| {
                    if kinds.get(index) == Some(&2) { rng.range(-PI, PI) } else { 0.0 }
                }),
            };
            let apart = match *machine.free.as_slice() {
                [first, second] => {
                    let direction = |index| machine.reference.direction(&machine.held, index);
                    direction(first).cross(&direction(second)).norm() > 0.05
                }
                _ => true,
            };
            if apart && machine.reference.volume(&machine.held) > 0.2 {
                return machine;
            }
        }
    }

    /// Axis values anywhere, the held ones at their place.
    pub fn values(&self, rng: &mut Rng) -> Joints {
        let mut q = self.held;
        for (index, joint) in self.reference.joints.iter().enumerate() {
            if !joint.rotary {
                q[index] = rng.range(-SIZE, SIZE);
            } else if self.free.contains(&index) {
                q[index] = rng.range(-PI, PI);
            }
        }
        q
    }
}

/// What a joint of a random chain is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Linear,
    Free,
    Held,
}

impl Random {
    /// A machine with these joints in any order, in any directions, on any lines; nothing is asked of it.
    pub fn of(rng: &mut Rng, kinds: &[Kind]) -> Self {
        let mut kinds = kinds.to_vec();
        for index in (1..kinds.len()).rev() {
            kinds.swap(index, rng.pick(index + 1));
        }
        let joints = kinds
            .iter()
            .map(|kind| Joint {
                rotary: *kind != Kind::Linear,
                direction: rng.direction(),
                point: rng.point(SIZE),
            })
            .collect();
        Self {
            reference: Reference {
                joints,
                mount: rng.point(SIZE),
                tip: rng.point(SIZE),
                axis: rng.direction(),
            },
            free: (0..kinds.len()).filter(|index| kinds[*index] == Kind::Free).collect(),
            held: std::array::from_fn(|index| match kinds.get(index) {
                Some(Kind::Held) => rng.range(-PI, PI),
                _ => 0.0,
            }),
        }
    }
}

/// A unit vector across `axis`, any of them.
pub fn across(rng: &mut Rng, axis: Vector3<f64>) -> Vector3<f64> {
    loop {
        let direction = axis.cross(&rng.direction());
        if direction.norm() > 0.1 {
            return direction.normalize();
        }
    }
}
