//! Random numbers that are the same everywhere; how many rounds and which numbers a test takes.

use std::f64::consts::PI;
use std::ops::{Mul, Range};

use nalgebra::Vector3;

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
        Ok(text) => text.parse().unwrap_or_else(|_| panic!("{variable}={text} is no count")),
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
