//! The feedrate paper (Chen, Ren and Sun 2016): its servo, and its set of limits on the butterfly curve.

use std::f64::consts::TAU;

use post_feed::jerk;
use post_feed::limits::{
    AxisAcceleration, AxisJerk, AxisVelocity, ChordError, Collocation, ContourError, Limit,
    TipAcceleration, TipFeed, TipJerk, deviation,
};
use post_feed::response::DriveResponse;
use post_feed::{EndSpeeds, Problem, Samples, linear_program, profile, reach};

use crate::spline::BSpline;
use crate::support::paths::{butterfly, even, length, plane, spans};
use crate::support::servo::{Pid, Transfer};

/// Table 1.
fn servo(axis: char) -> Transfer {
    let x = axis == 'X';
    let pick = |a: f64, b: f64| if x { a } else { b };
    Pid {
        proportional: pick(10.0, 12.344),
        integral: pick(50.0, 61.718),
        derivative: pick(0.3, 0.367),
        drive: pick(6.5723, 6.2274) * 0.4769 * 1.5915,
        inertia: pick(7.0028e-3, 8.1904e-3),
        damping: pick(0.023_569, 0.043_009),
    }
    .transfer()
}

#[test]
fn the_servo_has_the_coefficients_and_the_response_of_the_paper() {
    let x = servo('X');
    // Table 2, with A4 = J where A3 is printed.
    let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 2e-4, "{got} {want}");
    for (got, want) in x.numerator.iter().zip([249.415, 49.883, 1.4965]) {
        near(*got, want);
    }
    for (got, want) in x.denominator.iter().zip([249.415, 49.883, 1.52, 0.007]) {
        assert!((got / want - 1.0).abs() < 1e-3, "{got} {want}");
    }
    for (frequency, gain) in
        [(1.0, 1.000_10), (5.0, 1.003_21), (10.0, 1.014_62), (20.0, 1.049_02), (49.8, 1.0996)]
    {
        assert!((x.at(frequency).gain() - gain).abs() < 1e-5 * 6.0, "{frequency}");
    }
    let peak = even(40.0, 60.0, 2001)
        .into_iter()
        .max_by(|a, b| x.at(*a).gain().total_cmp(&x.at(*b).gain()));
    assert!((peak.unwrap() - 49.8).abs() < 0.2);
    assert!(x.at(113.0).gain() > 1.0 && x.at(116.0).gain() < 1.0);
}

/// The drive's answer to `input`, by Runge and Kutta's scheme of fourth order on the controllable form.
fn simulated(servo: &Transfer, step: f64, count: usize, input: impl Fn(f64) -> f64) -> Vec<f64> {
    let [a0, a1, a2, a3] = servo.denominator[..] else { panic!("third order") };
    let slope = |x: [f64; 3], u: f64| [x[1], x[2], (u - a0 * x[0] - a1 * x[1] - a2 * x[2]) / a3];
    let moved = |x: [f64; 3], by: f64, d: [f64; 3]| std::array::from_fn(|k| x[k] + by * d[k]);
    // As if it had stood at the first value for ever.
    let mut x = [input(0.0) / a0, 0.0, 0.0];
    let mut output = Vec::with_capacity(count);
    for index in 0..count {
        output.push(servo.numerator.iter().zip(x).map(|(b, x)| b * x).sum());
        let t = index as f64 * step;
        let (now, half, then) = (input(t), input(t + 0.5 * step), input(t + step));
        let k1 = slope(x, now);
        let k2 = slope(moved(x, 0.5 * step, k1), half);
        let k3 = slope(moved(x, 0.5 * step, k2), half);
        let k4 = slope(moved(x, step, k3), then);
        x = std::array::from_fn(|k| {
            x[k] + step / 6.0 * (k1[k] + 2.0 * k2[k] + 2.0 * k3[k] + k4[k])
        });
    }
    output
}

/// A circle of 8 mm with 5 rad/s, 200 mm/s²: X and Y differ, and their phases add to what the worse says alone.
#[test]
fn where_axes_differ_the_contour_error_is_that_of_a_simulated_circle() {
    let (x, y) = (servo('X'), servo('Y'));
    let (radius, rate, step): (f64, f64, f64) = (8.0, 5.0, 1e-4);
    let count = 50_000;
    let horizontal = simulated(&x, step, count, |t| radius * libm::cos(rate * t));
    let vertical = simulated(&y, step, count, |t| radius * libm::sin(rate * t));
    // The last turn, when the beginning is forgotten.
    let turn = (TAU / rate / step) as usize;
    let last = horizontal.iter().zip(&vertical).skip(count - turn);
    let worst = last.map(|(x, y)| (libm::hypot(*x, *y) - radius).abs()).fold(0.0, f64::max);
    let alone = radius * deviation(&[&x], rate).max(deviation(&[&y], rate));
    let both = radius * deviation(&[&x, &y], rate);
    println!(
        "simulated {:.2} µm, the worse axis alone {:.2} µm, with the phases {:.2} µm",
        1e3 * worst,
        1e3 * alone,
        1e3 * both
    );
    assert!((1e3 * worst - 32.4).abs() < 0.05, "{worst}");
    assert!((1e3 * alone - 31.0).abs() < 0.05, "{alone}");
    // Above the simulation, and not by much: the two worst directions do not quite fall together.
    assert!(both >= worst && both < 1.06 * worst, "{both} {worst}");
}

#[test]
fn the_largest_frequency_is_where_the_contour_error_reaches_its_tolerance() {
    let (x, y) = (servo('X'), servo('Y'));
    let axes: [&dyn DriveResponse; 2] = [&x, &y];
    for tolerance in [0.002, 0.02] {
        let limit = ContourError::new(&axes, tolerance, 40.0, Collocation::Start);
        for radius in [1e4, 300.0, 20.0, 2.0, 0.5, 0.02, 0.001] {
            let frequency = limit.frequency(1.0 / radius);
            let error = radius * deviation(&axes, frequency);
            assert!(error <= tolerance, "{radius}: {error}");
            assert!(
                error > tolerance * (1.0 - 1e-4) || frequency == 40.0 || radius > 1e3,
                "{radius}: {error}"
            );
        }
        assert!(limit.feed(0.0).is_finite());
    }
}

#[test]
fn the_butterfly_has_its_length_and_its_largest_curvature() {
    let Some(curve) = butterfly(1.0) else { return };
    assert!((length(&curve, 400) - 382.859_558).abs() < 1e-5, "{}", length(&curve, 400));
    let parameters = even(0.0, 1.0, 100_001);
    let samples = plane(&curve, &parameters);
    let sharpest = (0..samples.len())
        .max_by(|&a, &b| samples.curvature[a].total_cmp(&samples.curvature[b]))
        .unwrap();
    assert!((samples.curvature[sharpest] - 43.25).abs() < 0.01);
    assert!((parameters[sharpest] - 0.2564).abs() < 1e-4);
}

/// The limits of the paper's Table 3, but for the contour error.
struct Case {
    feed: TipFeed,
    velocity: AxisVelocity,
    acceleration: AxisAcceleration,
    chord: ChordError,
}

impl Case {
    fn new(collocation: Collocation) -> Self {
        Self {
            feed: TipFeed { most: 50.0, collocation },
            velocity: AxisVelocity { limits: vec![50.0; 2], collocation },
            acceleration: AxisAcceleration { limits: vec![200.0; 2], collocation },
            chord: ChordError { tolerance: 0.0005, period: 0.004, collocation },
        }
    }

    fn limits(&self) -> Vec<&dyn Limit> {
        vec![&self.feed, &self.velocity, &self.acceleration, &self.chord]
    }
}

/// The largest contour error by the formula, at the samples, mm.
fn contour_error(samples: &Samples, plan: &[f64], axes: &[&dyn DriveResponse]) -> f64 {
    let each = plan.iter().enumerate().map(|(sample, q)| {
        let curvature = samples.curvature[sample].max(1e-9);
        deviation(axes, q.sqrt() * samples.stretch(sample) * curvature) / curvature
    });
    each.fold(0.0, f64::max)
}

/// The largest share of the limits of velocity and acceleration that a plan uses between samples, by the curve itself.
fn used(curve: &BSpline<2>, parameters: &[f64], plan: &[f64]) -> f64 {
    let mut most: f64 = 0.0;
    for (at, q) in parameters.windows(2).zip(plan.windows(2)) {
        let step = at[1] - at[0];
        let acceleration = 0.5 * (q[1] - q[0]) / step;
        for point in 0..=8 {
            let share = f64::from(point) / 8.0;
            let [_, first, second, _] = curve.derivatives(at[0] + share * step);
            let q = profile::between(q[0], q[1], share);
            for axis in 0..2 {
                most = most.max((first[axis] * q.sqrt()).abs() / 50.0);
                most = most.max((first[axis] * acceleration + second[axis] * q).abs() / 200.0);
            }
        }
    }
    most
}

#[test]
fn the_case_set_of_the_paper_on_the_butterfly() {
    let (x, y) = (servo('X'), servo('Y'));
    let axes: [&dyn DriveResponse; 2] = [&x, &y];
    // At its own size, and as long as the paper's first curve.
    for scale in [1.0, 793.0 / 382.859_558] {
        let Some(curve) = butterfly(scale) else {
            return;
        };
        let parameters = spans(&curve, 100);
        let samples = plane(&curve, &parameters);
        for collocation in [Collocation::Start, Collocation::Throughout] {
            let case = Case::new(collocation);
            let contour = ContourError::new(&axes, 0.02, 49.8, collocation);
            let weights = samples.squared_feed_weights();
            for with in [false, true] {
                let mut limits = case.limits();
                if with {
                    limits.push(&contour);
                }
                let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
                let plan = reach::solve(&problem).unwrap();
                let best = linear_program::solve(&problem, &weights).unwrap();
                let objective: f64 = plan.iter().zip(&weights).map(|(q, weight)| q * weight).sum();
                let error = 1e3 * contour_error(&samples, &plan, &axes);
                let between = used(&curve, &parameters, &plan);
                println!(
                    "{:.0} mm, {collocation:?}, contour limit {with}: {:.3} s (linear program {:.3} s, Σ f² of reach \
                     {:.6} of it), contour error {error:.2} µm, limits used {between:.5}",
                    scale * 382.859_558,
                    profile::duration(&problem.steps, &plan),
                    profile::duration(&problem.steps, &best.q),
                    objective / best.objective,
                );
                assert_eq!(error <= 20.0, with, "{error}");
                assert!(best.gap() < 1e-6 && problem.worst(&best.q).share < 1.0 + 1e-11);
                assert!(problem.worst(&plan).share < 1.0 + 1e-11);
                assert!(objective > 0.99 * best.objective);
                if collocation == Collocation::Throughout {
                    assert!(between < 1.0 + 1e-3, "{between}");
                }
            }
        }
    }
}

/// Jerk limits of our own on the same curve, of the axes and of the tip, with its acceleration.
#[test]
fn with_jerk_limits_the_butterfly_takes_longer_and_keeps_them_between_samples() {
    let Some(curve) = butterfly(1.0) else { return };
    let parameters = spans(&curve, 100);
    let samples = plane(&curve, &parameters);
    let case = Case::new(Collocation::Throughout);
    let axis = AxisJerk { limits: vec![4000.0; 2] };
    let tip = TipJerk { limit: 4000.0 };
    let push = TipAcceleration { limit: 200.0, collocation: Collocation::Throughout };
    for of_tip in [false, true] {
        let mut limits = case.limits();
        limits.push(&axis);
        if of_tip {
            limits.extend([&tip as &dyn Limit, &push]);
        }
        let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
        let plan = jerk::solve(&samples, &limits, &problem, jerk::JerkSettings::default()).unwrap();
        let mut most = [0.0_f64; 3];
        for (interval, piece) in plan.law.pieces.iter().enumerate() {
            let step = plan.law.steps[interval];
            for point in 0..=8 {
                let share = (f64::from(point) / 8.0).clamp(1e-6, 1.0 - 1e-6);
                let [q, slope, bend] = piece.at(share, step);
                let [_, first, second, third] =
                    curve.derivatives(parameters[interval] + share * step);
                let jerk = [0, 1].map(|axis| {
                    q.sqrt()
                        * (0.5 * first[axis] * bend + 1.5 * second[axis] * slope + third[axis] * q)
                        / 4000.0
                });
                let push =
                    [0, 1].map(|axis| (0.5 * first[axis] * slope + second[axis] * q) / 200.0);
                most[0] = most[0].max(jerk[0].abs()).max(jerk[1].abs());
                most[1] = most[1].max(libm::hypot(jerk[0], jerk[1]));
                most[2] = most[2].max(libm::hypot(push[0], push[1]));
            }
        }
        println!(
            "jerk of the tip too {of_tip}: {:.3} s, without jerk {:.3} s, {} rounds, {} iterations; used {most:?}",
            plan.seconds, plan.bound, plan.rounds, plan.iterations
        );
        assert!(most[0] < 1.002 && plan.seconds > plan.bound, "{most:?}");
        if of_tip {
            assert!(most[1] < 1.002 && most[2] < 1.002, "{most:?}");
        }
    }
}
