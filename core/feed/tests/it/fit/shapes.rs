//! Curves whose curvature is known.

use std::f64::consts::TAU;

use post_feed::fit::{FitPoint, FitRules, MOST};

use super::course::{Leg, between, checked, curvature};

fn point(values: &[f64]) -> FitPoint {
    let mut point = [0.0; MOST];
    point[..values.len()].copy_from_slice(values);
    point
}

fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}

/// Deviations of the curvature from what it is, over the middle eight tenths of the legs: median and largest.
fn errors(legs: &[Leg], error: impl Fn(&[FitPoint; 4]) -> f64) -> [f64; 2] {
    let inside = legs.len() / 10..legs.len() - legs.len() / 10;
    let samples = legs[inside].iter().flat_map(|leg| &leg.samples);
    let mut errors: Vec<f64> = samples.map(|sample| error(&sample.values)).collect();
    errors.sort_by(f64::total_cmp);
    [errors[errors.len() / 2], errors[errors.len() - 1]]
}

#[test]
fn circles_with_rounded_points_have_their_curvature() {
    println!("   R   step  legs  off  curvature error: median largest");
    for radius in [1.0, 3.0, 10.0, 30.0, 100.0] {
        for step in [0.05, 0.1, 0.3, 1.0] {
            let sagitta = step * step / (8.0 * radius);
            if sagitta > 0.019 {
                continue;
            }
            let count = ((0.75 * TAU * radius / step) as usize).min(1500);
            let points: Vec<FitPoint> = (0..=count)
                .map(|index| {
                    let (sin, cos) = libm::sincos(index as f64 * step / radius + 0.3);
                    point(&[radius * cos, radius * sin].map(|value| rounded(value, 0.001)))
                })
                .collect();
            let rules = FitRules { corner: 1.0, ..FitRules::default() };
            let (legs, off) = checked(&rules, &points);
            let most = off.iter().copied().fold(0.0, f64::max);
            let [median, largest] =
                errors(&legs, |values| (curvature(values) * radius - 1.0).abs());
            println!("{radius:5} {step:5} {count:5} {most:5.2} {median:8.5} {largest:8.5}");
            // Chords that stray by more than the tolerance are no circle any more.
            let limits = if sagitta > 0.01 { [0.1, 0.5] } else { [0.01, 0.05] };
            assert!(median < limits[0] && largest < limits[1]);
        }
    }
}

/// An S of two waves: the curvature that it has along its length, and no more.
#[test]
fn waves_keep_their_curvature() {
    for (height, long, step) in [(0.5, 8.0, 0.1), (5.0, 40.0, 0.5), (20.0, 60.0, 0.2)] {
        let rate = TAU / long;
        let points: Vec<FitPoint> = (0..(4.0 * long / step) as usize)
            .map(|index| {
                let x = index as f64 * step;
                point(&[x, height * libm::sin(rate * x)].map(|value| rounded(value, 0.001)))
            })
            .collect();
        let (legs, _) = checked(&FitRules::default(), &points);
        let most = height * rate * rate;
        let [median, largest] = errors(&legs, |values| {
            let (sin, cos) = libm::sincos(rate * values[0][0]);
            let slope = height * rate * cos;
            let speed = (1.0 + slope * slope).sqrt();
            (curvature(values) - (most * sin).abs() / (speed * speed * speed)).abs() / most
        });
        println!("wave {height} of {long} at {step}: {median:.5} {largest:.5}");
        assert!(median < 0.02 && largest < 0.08);
    }
}

/// Two lines of 50 mm with a quarter of a circle between, in chords of 0.2 mm: straight where they are straight, and
/// round where it is round.
#[test]
fn a_line_beside_short_chords_stays_a_line() {
    let radius = 10.0;
    let mut points = vec![point(&[-50.0, 0.0])];
    let count = 78;
    for index in 0..=count {
        let (sin, cos) = libm::sincos(0.25 * TAU * f64::from(index) / f64::from(count));
        points.push(point(&[radius * sin, radius * (1.0 - cos)]));
    }
    points.push(point(&[radius, radius + 50.0]));
    let (legs, _) = checked(&FitRules::default(), &points);
    let line = &legs[0];
    assert!(line.samples.len() < 20);
    for pair in line.samples.windows(2) {
        for step in 0..=8 {
            let values = between([&pair[0], &pair[1]], 0.125 * f64::from(step));
            if values[0][0] < -5.0 {
                assert!(curvature(&values) < 1e-4, "{} at {}", curvature(&values), values[0][0]);
            }
            // It does not swing: the curvature never turns the other way by much.
            assert!(values[2][1] > -0.02, "{values:?}");
        }
    }
    let [median, largest] = errors(&legs, |values| (curvature(values) * radius - 1.0).abs());
    println!("quarter: {median:.5} {largest:.5}");
    assert!(median < 0.01 && largest < 0.1);
}

/// Points on a line, near and far: the line, with the speed of its parameter.
#[test]
fn what_is_straight_stays_straight() {
    let lengths = [1.0, 0.001, 30.0, 0.2, 0.2, 500.0, 0.05];
    for scale in [1e-3, 1.0, 1e6] {
        let mut x = 0.0;
        let mut points = vec![point(&[0.0])];
        for length in lengths {
            x += scale * length;
            points.push(point(&[0.6 * x, 0.8 * x, 0.0, 1e-5 * x]));
        }
        let rules = FitRules { dimensions: 4, tolerance: 0.01 * scale, ..FitRules::default() };
        let (legs, off) = checked(&rules, &points);
        assert!(off.iter().all(|off| *off < 1e-3));
        for sample in legs.iter().flat_map(|leg| &leg.samples) {
            let speed = libm::hypot(sample.values[1][0], sample.values[1][1]);
            assert!((speed - 1.0).abs() < 1e-6);
            assert!(sample.values[2].iter().all(|value| value.abs() * scale < 1e-5));
        }
    }
}

/// The tip stands, a rotary axis goes to and fro: its length is its own, its ends are corners.
#[test]
fn turns_alone_have_length() {
    let values = [0.0, 0.1, 0.2, 0.3, 0.2, 0.1];
    let points: Vec<FitPoint> =
        values.iter().map(|&turn| point(&[1.0, 2.0, 3.0, 0.0, turn])).collect();
    let rules = FitRules { dimensions: 5, turn_weight: 30.0, ..FitRules::default() };
    let (legs, _) = checked(&rules, &points);
    assert!(legs.iter().all(|leg| (leg.length - 3.0).abs() < 1e-12));
    let ends: Vec<usize> = (0..legs.len()).filter(|&leg| legs[leg].ends).collect();
    assert_eq!(ends, [2, 4]);
    assert!((legs[0].samples[0].values[1][4] * 30.0 - 1.0).abs() < 1e-12);
}

/// Five axes: the derivatives of rotary axes by the parameter, of angles rounded to 0.001°.
#[test]
fn rotary_axes_have_their_derivatives() {
    let degree = TAU / 360.0;
    let step = 0.2;
    let points: Vec<FitPoint> = (0..3000)
        .map(|index| {
            let s = index as f64 * step;
            let tip = [40.0 * libm::sin(s / 40.0), 40.0 * libm::cos(s / 40.0), 0.0];
            let turns = [0.4 * libm::sin(s / 15.0), s / 40.0];
            let mut values = [0.0; MOST];
            for axis in 0..3 {
                values[axis] = rounded(tip[axis], 0.001);
            }
            for (value, turn) in values[3..].iter_mut().zip(turns) {
                *value = rounded(turn / degree, 0.001) * degree;
            }
            values
        })
        .collect();
    let rules = FitRules { dimensions: 5, turn_weight: 1e-3, ..FitRules::default() };
    let (legs, _) = checked(&rules, &points);
    let second = 0.4 / 225.0;
    let [median, largest] = errors(&legs, |values| {
        let s = 40.0 * values[0][4];
        (values[2][3] + second * libm::sin(s / 15.0)).abs() / second
    });
    println!("rotary, second derivative: {median:.5} {largest:.5}");
    assert!(median < 0.02 && largest < 0.1);
}
