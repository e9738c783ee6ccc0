//! What the tests of the core share: a generator of random machines, and a forward product of their own,
//! which multiplies isometries (unit quaternions) and takes no line from the crate.
#![allow(
    missing_docs,
    clippy::should_implement_trait,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "tests alone use it"
)]

mod data;
pub mod posted;
pub mod walk;

use std::f64::consts::{PI, TAU};
use std::fs;

use nalgebra::{Isometry3, Matrix3, Point3, Translation3, Unit, UnitQuaternion, Vector3};
use post_machine::kinematics::{Chain, Joint, Joints, MAX_AXES, Pose};

pub use data::{repository, shared};

/// SplitMix64: the same numbers on every system and in every run.
pub struct Rng(pub u64);

impl Rng {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Even in `from` to `to`.
    pub fn range(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Below `count`.
    pub fn pick(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// Ten to an even exponent: sizes of every order.
    pub fn order(&mut self, from: f64, to: f64) -> f64 {
        libm::pow(10.0, self.range(from, to))
    }

    /// Even over the sphere (Archimedes' cylinder).
    pub fn direction(&mut self) -> Vector3<f64> {
        let z = self.range(-1.0, 1.0);
        let (sine, cosine) = libm::sincos(self.range(-PI, PI));
        let r = libm::sqrt(1.0 - z * z);
        Vector3::new(r * cosine, r * sine, z)
    }

    /// Even over the cube of half the edge `size`.
    pub fn point(&mut self, size: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.range(-size, size))
    }
}

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
        self.joints[..count]
            .iter()
            .zip(q)
            .fold(Isometry3::identity(), step)
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
        (0..self.joints.len())
            .filter(|index| !self.joints[*index].rotary)
            .collect()
    }

    /// A direction of the tool with all axes at zero, seen from the part at `q`.
    pub fn taken(&self, q: &[f64], direction: Vector3<f64>) -> Vector3<f64> {
        self.rotation(q) * direction
    }

    /// The volume that the linear directions span at `q`, part frame.
    pub fn volume(&self, q: &[f64]) -> f64 {
        let columns: Vec<Vector3<f64>> = self
            .linear()
            .into_iter()
            .map(|index| self.direction(q, index))
            .collect();
        Matrix3::from_columns(&columns).determinant().abs()
    }

    /// The chain under test.
    pub fn chain(&self) -> Chain {
        Chain::new(self.joints.clone(), self.mount, self.tip, self.axis)
    }
}

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
                free: (0..kinds.len())
                    .filter(|index| kinds[*index] == 1)
                    .collect(),
                held: std::array::from_fn(|index| {
                    if kinds.get(index) == Some(&2) {
                        rng.range(-PI, PI)
                    } else {
                        0.0
                    }
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
            free: (0..kinds.len())
                .filter(|index| kinds[*index] == Kind::Free)
                .collect(),
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

/// The angle between two unit vectors by its half chord (Kahan), exact for small and large angles alike.
pub fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    2.0 * libm::atan2((a - b).norm(), (a + b).norm())
}

/// The angle from a to b on the turn nearest to zero.
pub fn turned(a: f64, b: f64) -> f64 {
    let difference = b - a;
    difference - TAU * libm::rint(difference / TAU)
}

/// The unit vector at `t` on the great circle from `a` to `b`, by turning `a` about their normal.
pub fn slerp(a: Vector3<f64>, b: Vector3<f64>, t: f64) -> Vector3<f64> {
    match Unit::try_new(a.cross(&b), 1e-14) {
        Some(normal) => UnitQuaternion::from_axis_angle(&normal, t * angle(a, b)) * a,
        None => a,
    }
}

/// The distance of a point from a piece of a straight line.
pub fn distance(point: Vector3<f64>, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    let along = to - from;
    let square = along.norm_squared();
    let t = if square > 0.0 {
        ((point - from).dot(&along) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (point - from - along * t).norm()
}

/// Values between two sets of axis values.
pub fn between(from: &Joints, to: &Joints, t: f64) -> Joints {
    std::array::from_fn::<f64, MAX_AXES, _>(|index| from[index] * (1.0 - t) + to[index] * t)
}

/// Table 3.2 of Li 2024 (nonlinear error of a dual rotary table AC machine): 20 points of a blade, from the
/// paper's text.
pub fn blade() -> Option<Vec<Pose>> {
    let path = shared("papers/000_d91ffc0ea4534a10.txt")?;
    let text = fs::read_to_string(path).expect("a readable file");
    let points = text
        .lines()
        .skip_while(|line| !line.starts_with("Table 3.2"))
        .map(|line| {
            line.split_whitespace()
                .filter_map(|field| field.parse().ok())
                .collect::<Vec<f64>>()
        })
        .filter(|numbers| numbers.len() == 7)
        .take(20)
        .map(|numbers| Pose {
            tip: Vector3::new(numbers[1], numbers[2], numbers[3]),
            axis: Vector3::new(numbers[4], numbers[5], numbers[6]).normalize(),
            ..Pose::default()
        })
        .collect::<Vec<_>>();
    assert_eq!(points.len(), 20);
    Some(points)
}
