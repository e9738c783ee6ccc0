//! Acceleration of the tip, along its path and across it together.

use std::f64::consts::PI;

use super::axis_acceleration::acceleration;
use super::channel::tip_channels;
use super::{Channel, Collocation, Limit, Order};
use crate::samples::{Samples, dot, norm};
use crate::table::{LimitRow, LimitTable};

/// Pairs of parallel sides of the polygon that stands for the disc.
const PAIRS: usize = 8;

/// `|P' * s̈ + P'' * q| <= a`, a disc in the plane of `P'` and `P''`.
///
/// It is quadratic, and convex: for linear solvers a regular polygon with 16 sides is put *into* the disc, so that what
/// keeps the polygon keeps the disc. Its corners lie where all of the acceleration goes along the path, and where all
/// of it goes across: nothing is lost there, and at most 1.9 % (`1 - cos(π/16)`) in between.
#[derive(Clone, Copy, Debug)]
pub struct TipAcceleration {
    /// Largest acceleration of the tip, mm/s².
    pub limit: f64,
    /// Where along an interval the limit is kept.
    pub collocation: Collocation,
}

impl Limit for TipAcceleration {
    fn name(&self) -> &'static str {
        "tip acceleration"
    }

    fn rows(&self, _: &Samples) -> Vec<Option<u16>> {
        vec![None; PAIRS * self.collocation.rows()]
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        let normals: [[f64; 2]; PAIRS] = std::array::from_fn(|pair| {
            let angle = (pair as f64 + 0.5) * PI / PAIRS as f64;
            [libm::cos(angle), libm::sin(angle)]
        });
        // The sides are as far from the middle as those of the polygon whose corners lie on the circle.
        let scale = 1.0 / (self.limit * libm::cos(0.5 * PI / PAIRS as f64));
        let [first, second, _] = &samples.tip;
        for interval in 0..samples.intervals() {
            let step = samples.step(interval);
            let pair = |all: &[[f64; 3]], axis| [all[interval][axis], all[interval + 1][axis]];
            let each: [[LimitRow; 3]; 3] = std::array::from_fn(|axis| {
                acceleration(pair(first, axis), pair(second, axis), step, scale)
            });
            let places: &[usize] = match self.collocation {
                Collocation::Start => &[0],
                Collocation::Ends => &[0, 2],
                Collocation::Throughout => &[0, 1, 2],
            };
            let rows = table.rows_mut(interval);
            for (number, &place) in places.iter().enumerate() {
                let here = [each[0][place].here, each[1][place].here, each[2][place].here];
                let next = [each[0][place].next, each[1][place].next, each[2][place].next];
                let [along, across] = frame(here, next);
                for (row, normal) in rows[number * PAIRS..].iter_mut().zip(&normals) {
                    let [x, y] = *normal;
                    *row = LimitRow {
                        here: x * dot(along, here) + y * dot(across, here),
                        next: x * dot(along, next) + y * dot(across, next),
                    };
                }
            }
        }
    }

    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        tip_channels(samples, interval, Order::Acceleration, self.limit, sink);
    }
}

/// Two unit vectors of the plane of `here` and `next`, the first along what `s̈` is multiplied with.
fn frame(here: [f64; 3], next: [f64; 3]) -> [[f64; 3]; 2] {
    let unit = |vector: [f64; 3]| {
        let length = norm(vector);
        if length > 0.0 { vector.map(|value| value / length) } else { vector }
    };
    let along = unit(std::array::from_fn(|axis| next[axis] - here[axis]));
    // Their sum is what `q` is multiplied with.
    let bend: [f64; 3] = std::array::from_fn(|axis| next[axis] + here[axis]);
    let part = dot(bend, along);
    let across = unit(std::array::from_fn(|axis| bend[axis] - part * along[axis]));
    [along, across]
}
