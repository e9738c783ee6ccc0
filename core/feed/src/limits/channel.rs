//! What limits of acceleration and jerk have in common: a function of the path whose second or third derivative by
//! time is limited.

use std::f64::consts::PI;
use std::sync::LazyLock;

use super::first_derivative;
use crate::quintic::{self, bernstein};
use crate::samples::{Samples, dot};

/// Which derivative by time is limited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The second.
    Acceleration,
    /// The third.
    Jerk,
}

/// A function of the path parameter between two samples, with a limit on a derivative by time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// First derivative by the parameter, at both samples.
    pub first: [f64; 2],
    /// The second.
    pub second: [f64; 2],
    /// The third, from inside, as Bernstein coefficients of a quadratic.
    pub third: [f64; 3],
    /// Which derivative by time is limited.
    pub order: Order,
    /// Largest value of that derivative, in both directions.
    pub limit: f64,
    /// The axis it is, if it is one.
    pub axis: Option<u16>,
}

impl Channel {
    /// The limited derivative by time at a share of the interval, 0 to 1, as a share of the limit and with its sign:
    /// where `q`, its slope and its second derivative by the parameter are these.
    #[must_use]
    pub fn used(&self, share: f64, step: f64, [q, slope, bend]: [f64; 3]) -> f64 {
        let value = match self.order {
            Order::Acceleration => {
                let hull = first_derivative(self.first, self.second, step);
                0.5 * bernstein(hull, share) * slope + bernstein(self.second, share) * q
            }
            Order::Jerk => {
                let first = bernstein(self.first(step), share);
                let second = bernstein(self.second(step), share);
                let third = bernstein(self.third, share);
                q.sqrt() * (0.5 * first * bend + 1.5 * second * slope + third * q)
            }
        };
        value / self.limit
    }

    /// Bernstein coefficients of the second derivative, whose derivative is the third.
    pub(crate) fn second(&self, step: f64) -> [f64; 4] {
        quintic::second(self.second, self.third, step)
    }

    /// Bernstein coefficients of the first derivative, whose derivative is the second.
    pub(crate) fn first(&self, step: f64) -> [f64; 5] {
        quintic::first(self.first, self.second(step), step)
    }

    /// Makes a channel from the derivatives at two samples, the second `step` after the first, on a path whose third
    /// derivative is `smooth` or jumps at samples. In between it is on the whole what the second one gains.
    fn between(
        first: [f64; 2],
        second: [f64; 2],
        third: [f64; 2],
        smooth: bool,
        step: f64,
        order: Order,
        limit: f64,
    ) -> Self {
        let third = match smooth {
            true => quintic::third(second, third, step),
            // The second sample has the one after it: what it is ahead of it follows.
            false => {
                let mean = (second[1] - second[0]) / step;
                [third[0], mean, 2.0 * mean - third[0]]
            }
        };
        Self { first, second, third, order, limit, axis: None }
    }
}

/// The channels of each axis.
pub(super) fn axis_channels(
    samples: &Samples,
    interval: usize,
    order: Order,
    limits: &[f64],
    sink: &mut dyn FnMut(Channel),
) {
    let step = samples.step(interval);
    for (index, (axis, &limit)) in samples.axes.iter().zip(limits).enumerate() {
        let pair = |all: &[f64]| [all[interval], all[interval + 1]];
        let (first, second, third) = (pair(&axis.first), pair(&axis.second), pair(&axis.third));
        let channel = Channel::between(first, second, third, samples.smooth, step, order, limit);
        sink(Channel { axis: Some(index as u16), ..channel });
    }
}

/// Directions so dense that a vector whose component along each is small enough is short enough itself.
pub struct Directions {
    /// Of length 1; of a direction and its opposite one.
    pub units: Vec<[f64; 3]>,
    /// Cosine of the largest angle that a vector can have with the nearest of them, or with its opposite.
    pub share: f64,
}

static PLANE: LazyLock<Directions> = LazyLock::new(|| Directions::plane(8));
static SPACE: LazyLock<Directions> = LazyLock::new(Directions::icosahedron);

impl Directions {
    /// Directions that an interval needs: eight if it stays in a plane parallel to XY, else the 31 axes of an
    /// icosahedron.
    fn of(samples: &Samples, interval: usize) -> &'static Self {
        let ends = [interval, interval + 1];
        let flat = |vectors: &Vec<[f64; 3]>| ends.iter().all(|&at| vectors[at][2] == 0.0);
        if samples.tip.iter().all(flat) { &PLANE } else { &SPACE }
    }

    fn plane(pairs: usize) -> Self {
        let unit = |pair: usize| {
            let angle = pair as f64 * PI / pairs as f64;
            [libm::cos(angle), libm::sin(angle), 0.0]
        };
        Self { units: (0..pairs).map(unit).collect(), share: libm::cos(0.5 * PI / pairs as f64) }
    }

    /// Through 12 corners, 20 faces and 30 edges.
    pub fn icosahedron() -> Self {
        let golden = 0.5 * (1.0 + 5f64.sqrt());
        let mut units: Vec<[f64; 3]> = Vec::with_capacity(31);
        let mut push = |x: f64, y: f64, z: f64| {
            let length = (x * x + y * y + z * z).sqrt();
            let unit = [x / length, y / length, z / length];
            // Of a direction and its opposite the first is enough.
            if units.iter().all(|other| dot(*other, unit).abs() < 1.0 - 1e-9) {
                units.push(unit);
            }
        };
        let signs = [1.0, -1.0];
        for a in signs {
            for b in signs {
                for c in signs {
                    let corner = [0.0, a, b * golden];
                    let face = [0.0, b * golden, a / golden];
                    let edge = [a, b * golden * golden, c * golden];
                    for turn in 0..3 {
                        let at = |vector: [f64; 3], axis: usize| vector[(axis + turn) % 3];
                        push(at(corner, 0), at(corner, 1), at(corner, 2));
                        push(at(face, 0), at(face, 1), at(face, 2));
                        push(at(edge, 0), at(edge, 1), at(edge, 2));
                        let axis: [f64; 3] = [1.0, 0.0, 0.0];
                        push(at(axis, 0), at(axis, 1), at(axis, 2));
                    }
                    push(a, b, c);
                }
            }
        }
        // The circle around a triangle of neighbours: a corner, a face and an edge, with a right angle at the edge.
        Self { units, share: ICOSAHEDRON }
    }
}

/// Cosine of the angle from the middle of the triangle between an axis through a corner, one through a face and one
/// through an edge to each of the three; the test below measures it.
const ICOSAHEDRON: f64 = 0.946;

/// The channels of the tip along each direction.
pub(super) fn tip_channels(
    samples: &Samples,
    interval: usize,
    order: Order,
    limit: f64,
    sink: &mut dyn FnMut(Channel),
) {
    let directions = Directions::of(samples, interval);
    let step = samples.step(interval);
    for &unit in &directions.units {
        let pair = |all: &[[f64; 3]]| [dot(unit, all[interval]), dot(unit, all[interval + 1])];
        let [first, second, third] = samples.tip.each_ref().map(|all| pair(all));
        let limit = limit * directions.share;
        let channel = Channel::between(first, second, third, samples.smooth, step, order, limit);
        sink(channel);
    }
}
