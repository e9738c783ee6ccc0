//! Acceleration of each axis (feedrate paper, eqs. 19, 21, 23).

use super::channel::axis_channels;
use super::{Channel, Collocation, Limit, Order, first_derivative};
use crate::samples::Samples;
use crate::table::{LimitRow, LimitTable};

/// `|Q' * s̈ + Q'' * q| <= a` of each axis, with `s̈ = (q[i + 1] - q[i]) / (2 * step)` between two samples: linear in
/// both. [`Collocation`] says where a row is kept; [`Collocation::Start`] is eq. 23 as it is printed.
#[derive(Clone, Debug)]
pub struct AxisAcceleration {
    /// Largest acceleration of each axis, in its unit per second squared.
    pub limits: Vec<f64>,
    /// Where along an interval the limit is kept.
    pub collocation: Collocation,
}

impl Limit for AxisAcceleration {
    fn name(&self) -> &'static str {
        "axis acceleration"
    }

    fn rows(&self, samples: &Samples) -> Vec<Option<u16>> {
        let each = self.collocation.rows();
        let axes = 0..samples.axes.len().min(self.limits.len());
        axes.flat_map(|axis| std::iter::repeat_n(Some(axis as u16), each)).collect()
    }

    fn apply(&self, samples: &Samples, table: &mut LimitTable<'_>) {
        let each = self.collocation.rows();
        for (index, (axis, &limit)) in samples.axes.iter().zip(&self.limits).enumerate() {
            let steps = samples.parameter.windows(2);
            let firsts = axis.first.windows(2);
            let seconds = axis.second.windows(2);
            for (interval, ((step, first), second)) in steps.zip(firsts).zip(seconds).enumerate() {
                let rows = acceleration(
                    [first[0], first[1]],
                    [second[0], second[1]],
                    step[1] - step[0],
                    1.0 / limit,
                );
                let place = &mut table.rows_mut(interval)[index * each..(index + 1) * each];
                match self.collocation {
                    Collocation::Start => place[0] = rows[0],
                    Collocation::Ends => place.copy_from_slice(&[rows[0], rows[2]]),
                    Collocation::Throughout => place.copy_from_slice(&rows),
                }
            }
        }
    }

    fn channels(&self, samples: &Samples, interval: usize, sink: &mut dyn FnMut(Channel)) {
        axis_channels(samples, interval, Order::Acceleration, &self.limits, sink);
    }
}

/// Bernstein coefficients of `Q' * s̈ + Q'' * q` over an interval, times `scale`: `Q'` is quadratic there, `Q''` and
/// `q` are linear, `s̈` is constant. The outer two are the values at the ends.
#[inline]
pub(super) fn acceleration(
    first: [f64; 2],
    second: [f64; 2],
    step: f64,
    scale: f64,
) -> [LimitRow; 3] {
    let push = 0.5 * scale / step;
    let [first, middle, last] = first_derivative(first, second, step);
    let [here, next] = [second[0] * scale, second[1] * scale];
    [
        LimitRow { here: here - first * push, next: first * push },
        LimitRow { here: 0.5 * next - middle * push, next: 0.5 * here + middle * push },
        LimitRow { here: -last * push, next: next + last * push },
    ]
}
