//! Random numbers that are the same everywhere, and random machines; how many rounds and which numbers a test takes.

use std::f64::consts::PI;
use std::ops::{Mul, Range};

use nalgebra::Vector3;
use post_machine::kinematics::{Joint, Joints};

use crate::Reference;

/// How many times as many rounds the randomised tests take: `POST_ROUNDS`, 1 if it is not set.
pub fn rounds() -> u16 {
    number("POST_ROUNDS", 1)
}

/// Which numbers the randomised tests draw: `POST_SEED`. 0, as if it is not set, are those of every day.
pub fn seed() -> u64 {
    number("POST_SEED", 0)
}

fn number<N: std::str::FromStr>(variable: &str, otherwise: N) -> N {
    match std::env::var(variable) {
        Ok(text) => text
            .parse()
            .unwrap_or_else(|_| panic!("{variable}={text} is no count")),
        Err(_) => otherwise,
    }
}

/// The rounds of a randomised test, `count` times `POST_ROUNDS`, and its numbers: those of its `own` seed and of
/// `POST_SEED`.
pub fn randomised<N: From<u16> + Mul<Output = N>>(count: N, own: u64) -> (Range<N>, Rng) {
    (N::from(0)..count * N::from(rounds()), seeded(own))
}

/// The numbers of a test's `own` seed and of `POST_SEED`. Where the test fails, the runner shows both beside it.
pub fn seeded(own: u64) -> Rng {
    let (rounds, seed) = (rounds(), seed());
    println!("random numbers of seed {own}; again with POST_SEED={seed} POST_ROUNDS={rounds}");
    // Any odd constant but that of the generator's own step.
    Rng(own.wrapping_add(seed.wrapping_mul(0xD1B5_4A32_D192_ED03)))
}

/// SplitMix64: the same numbers on every system and in every run. [`seeded`] and [`randomised`] make that of a test.
pub struct Rng(u64);

impl Rng {
    /// The numbers of a seed alone: for generators of cases that have a seed each, and for what is no test.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

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

    /// Of the standard normal distribution (Box, Muller 1958).
    pub fn normal(&mut self) -> f64 {
        // Above 0, whose logarithm is none.
        let share = 1.0 - self.range(0.0, 1.0);
        libm::sqrt(-2.0 * libm::log(share)) * libm::cos(self.range(-PI, PI))
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
