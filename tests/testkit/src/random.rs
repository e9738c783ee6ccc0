//! Random numbers that are the same everywhere; how many rounds and which numbers a test takes.

use std::f64::consts::PI;
use std::ops::{Add, Div, Mul, Range};
use std::sync::OnceLock;
use std::time::UNIX_EPOCH;

use nalgebra::Vector3;

fn number<N: std::str::FromStr>(variable: &str) -> Option<N> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable}={text} is no count")))
}

/// How many of `count` rounds a test takes: a third of them, or `POST_ROUNDS` times as many.
pub fn rounds<N>(count: N) -> N
where
    N: From<u16> + Add<Output = N> + Mul<Output = N> + Div<Output = N>,
{
    match number("POST_ROUNDS") {
        Some(times) => count * N::from(times),
        None => (count + N::from(2)) / N::from(3),
    }
}

/// The [`rounds`] of a randomised test, and the numbers that it draws: see [`seeded`].
pub fn randomised<N>(count: N, own: u64) -> (Range<N>, Rng)
where
    N: From<u16> + Add<Output = N> + Mul<Output = N> + Div<Output = N>,
{
    (N::from(0)..rounds(count), seeded(own))
}

/// The seed of a run: `POST_SEED`, or one that is drawn anew, the same for all tests of a process.
fn run_seed() -> u64 {
    static DRAWN: OnceLock<u64> = OnceLock::new();
    let now = || UNIX_EPOCH.elapsed().map_or(0, |now| u64::from(now.subsec_nanos()));
    number("POST_SEED").unwrap_or_else(|| *DRAWN.get_or_init(now))
}

/// The numbers of a test's `own` seed and of that of the run. Where the test fails, the runner shows beside it how to
/// repeat it.
pub fn seeded(own: u64) -> Rng {
    let seed = run_seed();
    let rounds = std::env::var("POST_ROUNDS").map(|rounds| format!(" POST_ROUNDS={rounds}"));
    let rounds = rounds.unwrap_or_default();
    println!("random numbers of seed {own}; again with POST_SEED={seed}{rounds}");
    // Any odd constant but that of the generator's own step.
    Rng(own.wrapping_add(seed.wrapping_mul(0xD1B5_4A32_D192_ED03)))
}

/// How many of a kind a test meets in its [`rounds`] at least, where it meets more than `count` in all of them.
pub fn at_least<N: From<u16> + Div<Output = N>>(count: N) -> N {
    if all_drawn() { count } else { count / N::from(5) }
}

/// Whether [`drawn`] leaves no case out.
pub fn all_drawn() -> bool {
    rounds(3) >= 3
}

/// The cases that a test takes of many slow ones: all where `POST_ROUNDS` is set, else a third, drawn by the seed of the
/// run.
pub fn drawn<T>(mut cases: Vec<T>, own: u64) -> Vec<T> {
    let seed = run_seed();
    println!("a third of the cases: the same with POST_SEED={seed}, all with POST_ROUNDS=1");
    let mut rng = Rng(own.wrapping_add(seed));
    let taken = usize::from(rounds(cases.len() as u16));
    while cases.len() > taken {
        cases.remove(rng.pick(cases.len()));
    }
    cases
}

/// SplitMix64: the same numbers on every system and in every run. [`seeded`] and [`randomised`] make that of a test.
pub struct Rng(u64);

impl Rng {
    /// The numbers of a seed alone: for examples that must stay as they are, and for what is no test.
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
