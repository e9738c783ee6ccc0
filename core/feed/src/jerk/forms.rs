//! Acceleration and jerk over one interval as polynomials of the parameter, linear in the Bernstein coefficients of a
//! quadratic `q`.
//!
//! With `q = ṡ²` the parameter has `s̈ = q' / 2` and `s⃛ = q'' ṡ / 2`. So the second derivative of a function `Q(s)` by
//! time is `Q' q' / 2 + Q'' q`, and the third is `sqrt(q) * (Q' q'' / 2 + 3/2 Q'' q' + Q''' q)`. Over an interval
//! acceleration takes `Q'` as quadratic and `Q''` as linear, jerk takes `Q'` as quartic, as that of a quintic spline is, so
//! that the brackets are a cubic and a quartic; a polynomial lies between its least and its largest Bernstein coefficient.

use crate::limits::{Channel, first_derivative};

/// A linear form in the three Bernstein coefficients of `q`.
pub type LinearForm = [f64; 3];

/// Bernstein coefficients of a cubic.
pub type BernsteinCubic<T> = [T; 4];

/// Bernstein coefficients of a quartic.
pub type BernsteinQuartic<T> = [T; 5];

/// `Q' q' / 2 + Q'' q`.
pub fn acceleration(channel: &Channel, step: f64) -> BernsteinCubic<LinearForm> {
    let [p0, p1, p2] = first_derivative(channel.first, channel.second, step);
    let [e0, e1] = slope(step);
    // Q' q' / 2, a quadratic times a linear function.
    let push = [
        scaled(p0, e0),
        sum(scaled(2.0 / 3.0 * p1, e0), scaled(p0 / 3.0, e1)),
        sum(scaled(p2 / 3.0, e0), scaled(2.0 / 3.0 * p1, e1)),
        scaled(p2, e1),
    ];
    let bend = times_q(channel.second);
    std::array::from_fn(|index| sum(scaled(0.5, push[index]), bend[index]))
}

/// `Q' q'' / 2 + 3/2 Q'' q' + Q''' q`.
pub fn jerk(channel: &Channel, step: f64) -> BernsteinQuartic<LinearForm> {
    let (first, second) = (channel.first(step), channel.second(step));
    let [e0, e1] = slope(step);
    let bend = 1.0 / (step * step);
    // q'' / 2.
    let half = [bend, -2.0 * bend, bend];
    let last = quadratic_times_q(channel.third);
    std::array::from_fn(|index| {
        let [here, before] = linear_parts(index);
        let mut form = sum(scaled(first[index], half), last[index]);
        if index < 4 {
            form = sum(form, scaled(1.5 * here * second[index], e0));
        }
        if index > 0 {
            form = sum(form, scaled(1.5 * before * second[index - 1], e1));
        }
        form
    })
}

/// `q` itself as a quartic.
pub const Q: BernsteinQuartic<LinearForm> = [
    [1.0, 0.0, 0.0],
    [0.5, 0.5, 0.0],
    [1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0],
    [0.0, 0.5, 0.5],
    [0.0, 0.0, 1.0],
];

/// What `q` at the far end of an interval that begins at rest is multiplied with, at most, to give the second
/// derivative: there `q = q1 * share^(4/3)`, and it is `q1 * share^(1/3) * (2/3 Q' / step + Q'' * share)`.
pub fn leaving_acceleration(channel: &Channel, step: f64) -> f64 {
    let [p0, p1, p2] = first_derivative(channel.first, channel.second, step);
    let push = 2.0 / 3.0 / step;
    let [c0, c1] = channel.second;
    largest(&[push * p0, push * p1 + 0.5 * c0, push * p2 + c1])
}

/// What `q1^(3/2)` is multiplied with, at most, to give the third derivative:
/// `2/9 Q' / step² + 2 Q'' * share / step + Q''' * share²`.
pub fn leaving_jerk(channel: &Channel, step: f64) -> f64 {
    let (first, second) = (channel.first(step), channel.second(step));
    let [t0, t1, t2] = channel.third;
    let last = [0.0, 0.0, t0 / 6.0, 0.5 * t1, t2];
    let at: BernsteinQuartic<f64> = std::array::from_fn(|index| {
        let [_, before] = linear_parts(index);
        let middle = index.checked_sub(1).map_or(0.0, |at| before * second[at]);
        2.0 / 9.0 * first[index] / (step * step) + 2.0 * middle / step + last[index]
    });
    largest(&at)
}

/// Reverses the function: its parameter runs the other way.
pub(super) fn reversed(channel: &Channel) -> Channel {
    let [f0, f1] = channel.first;
    let [c0, c1] = channel.second;
    let [t0, t1, t2] = channel.third;
    Channel { first: [-f1, -f0], second: [c1, c0], third: [-t2, -t1, -t0], ..*channel }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Bernstein coefficients of `q'`.
fn slope(step: f64) -> [LinearForm; 2] {
    let rate = 2.0 / step;
    [[-rate, rate, 0.0], [0.0, -rate, rate]]
}

/// A linear function times `q`.
fn times_q([a, b]: [f64; 2]) -> BernsteinCubic<LinearForm> {
    [[a, 0.0, 0.0], [b / 3.0, 2.0 / 3.0 * a, 0.0], [0.0, 2.0 / 3.0 * b, a / 3.0], [0.0, 0.0, b]]
}

/// A quadratic times `q`.
fn quadratic_times_q([a, b, c]: [f64; 3]) -> BernsteinQuartic<LinearForm> {
    [
        [a, 0.0, 0.0],
        [0.5 * b, 0.5 * a, 0.0],
        [c / 6.0, 2.0 / 3.0 * b, a / 6.0],
        [0.0, 0.5 * c, 0.5 * b],
        [0.0, 0.0, c],
    ]
}

/// Shares in the coefficient of this index of a cubic times a linear function: that of the cubic's own coefficient of
/// that index with the one end of the function, and that of the one before it with the other end.
fn linear_parts(index: usize) -> [f64; 2] {
    let before = 0.25 * index as f64;
    [1.0 - before, before]
}

fn scaled(factor: f64, form: LinearForm) -> LinearForm {
    form.map(|value| factor * value)
}

fn sum(a: LinearForm, b: LinearForm) -> LinearForm {
    std::array::from_fn(|index| a[index] + b[index])
}
