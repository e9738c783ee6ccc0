//! Random paths and problems from a seed.

use post_feed::limits::{AxisAcceleration, AxisVelocity, Collocation, Feed, Limit};
use post_feed::problem::Row;
use post_feed::{Ends, Problem, Samples};

/// A generator of the xorshift family: the same numbers everywhere.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// Of `low..high`.
    pub fn of(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// A smooth path of `axes` axes, each a straight part and three waves; the first three are the tip too.
/// Axes stand still for an instant here and there: zero-inertia points.
pub fn samples(random: &mut Random, axes: usize, count: usize, length: f64) -> Samples {
    let waves: Vec<[[f64; 3]; 3]> = (0..axes)
        .map(|_| {
            std::array::from_fn(|_| {
                [
                    random.of(0.5, 6.0),
                    random.of(0.05, 0.8),
                    random.of(0.0, 6.3),
                ]
            })
        })
        .collect();
    let straight: Vec<f64> = (0..axes).map(|_| random.of(-0.6, 0.6)).collect();
    let mut samples = Samples::default();
    for index in 0..count {
        let s = length * index as f64 / (count - 1) as f64;
        let each: Vec<[f64; 3]> = waves
            .iter()
            .zip(&straight)
            .map(|(waves, straight)| {
                waves
                    .iter()
                    .fold([*straight, 0.0, 0.0], |sum, [size, rate, phase]| {
                        let (sin, cos) = libm::sincos(rate * s + phase);
                        [
                            sum[0] + size * rate * cos,
                            sum[1] - size * rate * rate * sin,
                            sum[2] - size * rate * rate * rate * cos,
                        ]
                    })
            })
            .collect();
        let tip = std::array::from_fn(|order| {
            std::array::from_fn(|axis| each.get(axis).map_or(0.0, |axis| axis[order]))
        });
        samples.push(s, tip, &each);
    }
    samples
}

/// Limits of the size of small machines.
pub struct Limits {
    feed: Feed,
    velocity: AxisVelocity,
    acceleration: AxisAcceleration,
}

impl Limits {
    pub fn new(random: &mut Random, axes: usize, collocation: Collocation) -> Self {
        let limits = (0..axes).map(|_| random.of(20.0, 120.0)).collect();
        let velocity = AxisVelocity {
            limits,
            collocation,
        };
        let limits = (0..axes).map(|_| random.of(50.0, 2000.0)).collect();
        Self {
            velocity,
            acceleration: AxisAcceleration {
                limits,
                collocation,
            },
            feed: Feed {
                most: random.of(30.0, 200.0),
                collocation,
            },
        }
    }

    pub fn all(&self) -> [&dyn Limit; 3] {
        [&self.feed, &self.velocity, &self.acceleration]
    }
}

/// Such a path of 100 mm under such limits.
pub fn problem(seed: u64, axes: usize, count: usize, collocation: Collocation) -> Problem {
    let mut random = Random::new(seed);
    let samples = samples(&mut random, axes, count, 100.0);
    let limits = Limits::new(&mut random, axes, collocation);
    Problem::new(&samples, &limits.all(), Ends::default()).unwrap()
}

/// A problem all of whose rows are monotone, with bounds that jump and steep rows, not from any path.
pub fn monotone(seed: u64, count: usize) -> Problem {
    let mut random = Random::new(seed);
    let upper = (0..count).map(|_| random.of(0.1, 100.0)).collect();
    let stride = 3;
    let rows = (0..stride * (count - 1))
        .map(|_| {
            let sign = if random.of(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
            Row {
                here: -sign * random.of(0.0, 1.0),
                next: sign * random.of(0.0, 1.0),
            }
        })
        .collect();
    Problem::from_rows(vec![1.0; count - 1], upper, stride, rows)
}

/// Rows of any signs, so that a larger feed here may forbid one next door.
pub fn any(seed: u64, count: usize) -> Problem {
    let mut random = Random::new(seed);
    let upper = (0..count).map(|_| random.of(0.1, 100.0)).collect();
    let stride = 3;
    let mut row = || {
        let size = libm::exp(random.of(-6.0, 1.0));
        Row {
            here: size * random.of(-1.0, 1.0),
            // One in ten bounds its own sample alone.
            next: if random.of(0.0, 1.0) < 0.1 {
                0.0
            } else {
                size * random.of(-1.0, 1.0)
            },
        }
    };
    let rows = (0..stride * (count - 1)).map(|_| row()).collect();
    Problem::from_rows(vec![1.0; count - 1], upper, stride, rows)
}
