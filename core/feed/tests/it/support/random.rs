//! Random paths and problems from a seed.

use post_feed::limits::{AxisAcceleration, AxisVelocity, Collocation, Limit, TipFeed};
use post_feed::problem::LimitRow;
use post_feed::{EndSpeeds, Problem, Samples};
use post_testkit::Rng;

/// A smooth path of `axes` axes, each a straight part and three waves; the first three are the tip too.
/// Axes stand still for an instant here and there: zero-inertia points.
pub fn samples(random: &mut Rng, axes: usize, count: usize, length: f64) -> Samples {
    let waves: Vec<[[f64; 3]; 3]> = (0..axes)
        .map(|_| {
            std::array::from_fn(|_| {
                [random.range(0.5, 6.0), random.range(0.05, 0.8), random.range(0.0, 6.3)]
            })
        })
        .collect();
    let straight: Vec<f64> = (0..axes).map(|_| random.range(-0.6, 0.6)).collect();
    let mut samples = Samples::default();
    for index in 0..count {
        let s = length * index as f64 / (count - 1) as f64;
        let each: Vec<[f64; 3]> = waves
            .iter()
            .zip(&straight)
            .map(|(waves, straight)| {
                waves.iter().fold([*straight, 0.0, 0.0], |sum, [size, rate, phase]| {
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

/// Samples `first..=last` alone: a batch.
pub fn part(samples: &Samples, first: usize, last: usize) -> Samples {
    let mut part = Samples::default();
    for sample in first..=last {
        let tip = [0, 1, 2].map(|order| samples.tip[order][sample]);
        let each = samples.axes.iter();
        let axes: Vec<[f64; 3]> = each
            .map(|axis| [axis.first[sample], axis.second[sample], axis.third[sample]])
            .collect();
        part.push(samples.parameter[sample], tip, &axes);
    }
    part
}

/// Limits of the size of small machines.
pub struct Limits {
    feed: TipFeed,
    velocity: AxisVelocity,
    acceleration: AxisAcceleration,
}

impl Limits {
    pub fn new(random: &mut Rng, axes: usize, collocation: Collocation) -> Self {
        let limits = (0..axes).map(|_| random.range(20.0, 120.0)).collect();
        let velocity = AxisVelocity { limits, collocation };
        let limits = (0..axes).map(|_| random.range(50.0, 2000.0)).collect();
        Self {
            velocity,
            acceleration: AxisAcceleration { limits, collocation },
            feed: TipFeed { most: random.range(30.0, 200.0), collocation },
        }
    }

    pub fn all(&self) -> [&dyn Limit; 3] {
        [&self.feed, &self.velocity, &self.acceleration]
    }
}

/// Such a path of 100 mm under such limits.
pub fn problem(seed: u64, axes: usize, count: usize, collocation: Collocation) -> Problem {
    let mut random = Rng::new(seed);
    let samples = samples(&mut random, axes, count, 100.0);
    let limits = Limits::new(&mut random, axes, collocation);
    Problem::new(&samples, &limits.all(), EndSpeeds::default()).unwrap()
}

/// A problem all of whose rows are monotone, with bounds that jump and steep rows, not from any path.
pub fn monotone(seed: u64, count: usize) -> Problem {
    let mut random = Rng::new(seed);
    let upper = (0..count).map(|_| random.range(0.1, 100.0)).collect();
    let stride = 3;
    let rows = (0..stride * (count - 1))
        .map(|_| {
            let sign = if random.range(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
            LimitRow { here: -sign * random.range(0.0, 1.0), next: sign * random.range(0.0, 1.0) }
        })
        .collect();
    Problem::from_rows(vec![1.0; count - 1], upper, stride, rows)
}

/// Rows of any signs, so that a larger feed here may forbid one next door.
pub fn any(seed: u64, count: usize) -> Problem {
    let mut random = Rng::new(seed);
    let upper = (0..count).map(|_| random.range(0.1, 100.0)).collect();
    let stride = 3;
    let mut row = || {
        let size = libm::exp(random.range(-6.0, 1.0));
        LimitRow {
            here: size * random.range(-1.0, 1.0),
            // One in ten bounds its own sample alone.
            next: if random.range(0.0, 1.0) < 0.1 { 0.0 } else { size * random.range(-1.0, 1.0) },
        }
    };
    let rows = (0..stride * (count - 1)).map(|_| row()).collect();
    Problem::from_rows(vec![1.0; count - 1], upper, stride, rows)
}
