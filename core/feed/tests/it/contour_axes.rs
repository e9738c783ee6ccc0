//! The contour error through the axes: where closed forms are known.

use std::f64::consts::{FRAC_PI_4, TAU};

use post_feed::limits::{Collocation, ContourError, Limit, TipFeed};
use post_feed::response::{ComplexGain, DriveResponse};
use post_feed::{EndSpeeds, Infeasible, Problem, Samples, reach};

/// The PID servo of the feedrate paper (eq. 2), X or Y of its Table 1, by complex division.
fn servo(x: bool) -> impl DriveResponse {
    let pick = |a: f64, b: f64| if x { a } else { b };
    let drive = pick(6.5723, 6.2274) * 0.4769 * 1.5915;
    let (kp, ki, kd) =
        (drive * pick(10.0, 12.344), drive * pick(50.0, 61.718), drive * pick(0.3, 0.367));
    let (inertia, damping) = (pick(7.0028e-3, 8.1904e-3), pick(0.023_569, 0.043_009));
    move |w: f64| {
        let (a, b) = (ki - kd * w * w, kp * w);
        let (c, d) = (ki - (damping + kd) * w * w, kp * w - inertia * w * w * w);
        let square = c * c + d * d;
        ComplexGain { real: (a * c + b * d) / square, imaginary: (b * c - a * d) / square }
    }
}

const UNIT: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A circle of this radius in XY by its arc length, with the rates of three straight axes.
fn circle(radius: f64, count: usize) -> Samples {
    let mut samples = Samples::default();
    for index in 0..=count {
        let angle = TAU * index as f64 / count as f64;
        let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
        let bend = 1.0 / radius;
        let first = [-sine, cosine, 0.0];
        let second = [-cosine * bend, -sine * bend, 0.0];
        let third = first.map(|value| -value * bend * bend);
        let axes = [0, 1, 2].map(|axis| [first[axis], second[axis], third[axis]]);
        samples.push(angle * radius, [first, second, third], &axes);
        samples.push_rates(&UNIT);
    }
    samples
}

fn speeds(samples: &Samples, limit: &ContourError) -> Vec<f64> {
    let feed = TipFeed { most: 1e6, collocation: Collocation::Start };
    let problem = Problem::new(samples, &[&feed, limit], EndSpeeds::default()).unwrap();
    problem.upper.iter().map(|q| q.sqrt()).collect()
}

#[test]
fn three_axes_that_answer_alike_are_the_papers_rule() {
    let x = servo(true);
    let axes: [&dyn DriveResponse; 3] = [&x, &x, &x];
    for radius in [0.001, 0.05, 2.0, 8.0, 300.0] {
        let limit = ContourError::new(&axes, 0.02, 49.8, Collocation::Start);
        let want = limit.feed(1.0 / radius);
        for speed in speeds(&circle(radius, 16), &limit) {
            assert!((speed / want - 1.0).abs() < 1e-9, "{radius}: {speed} {want}");
        }
        // And without rates.
        let mut samples = circle(radius, 16);
        samples.rates.clear();
        for speed in speeds(&samples, &limit) {
            assert!((speed / want - 1.0).abs() < 1e-9, "{radius}: {speed} {want}");
        }
    }
}

/// A circle of 8 mm with 5 rad/s strays 32.4 µm when it is simulated (see `paper.rs`): so that tolerance allows 40 mm/s
/// where the error is largest, and more elsewhere.
#[test]
fn two_axes_that_differ_stray_on_a_circle_as_they_do_when_simulated() {
    let (x, y) = (servo(true), servo(false));
    let axes: [&dyn DriveResponse; 3] = [&x, &y, &x];
    let limit = ContourError::new(&axes, 0.0324, 49.8, Collocation::Start);
    let each = speeds(&circle(8.0, 720), &limit);
    let least = each.iter().copied().fold(f64::INFINITY, f64::min);
    let most = each.iter().copied().fold(0.0, f64::max);
    println!("{least:.3} to {most:.3} mm/s");
    // Rounded down by what lies between two frequencies of the table.
    assert!((0.994..1.0005).contains(&(least / 40.0)), "{least}");
    assert!(most > 1.05 * least, "{most}");
    // By the rule for all directions together, which knows no rates, it is slower.
    assert!(limit.feed(1.0 / 8.0) < least);
}

/// A table turns evenly under a tip that stands 50 mm beside its axis: its servo is late, and nothing else.
#[test]
fn a_rotary_axis_that_goes_evenly_leaves_no_contour_error() {
    let (x, y) = (servo(true), servo(false));
    let mut samples = Samples::default();
    for index in 0..50 {
        let angle = 0.02 * f64::from(index);
        let [sine, cosine] = [libm::sin(angle), libm::cos(angle)].map(|value| 50.0 * value);
        let tip = [[-sine, cosine, 0.0], [-cosine, -sine, 0.0], [sine, -cosine, 0.0]];
        samples.push(angle, tip, &[[0.0; 3], [1.0, 0.0, 0.0]]);
        samples.push_rates(&[[1.0, 0.0, 0.0], [-sine, cosine, 0.0]]);
    }
    for axes in [[&x as &dyn DriveResponse, &y], [&x, &x]] {
        let limit = ContourError::new(&axes, 0.01, 49.8, Collocation::Throughout);
        for speed in speeds(&samples, &limit) {
            assert!(speed > 1e3, "{speed}");
        }
    }
    // By the tip's path alone it would be taken for a circle of a straight machine.
    samples.rates.clear();
    let limit = ContourError::new(&[&x], 0.01, 49.8, Collocation::Start);
    assert!(speeds(&samples, &limit).iter().all(|speed| *speed < 1.5));
}

/// Straight on under 45 degrees, one axis `late` seconds behind the other: the tip goes beside its line by
/// `f * late / 2`.
#[test]
fn a_line_under_45_degrees_shows_how_late_one_axis_is_against_the_other() {
    let late = 0.001;
    let first = |_: f64| ComplexGain::EXACT;
    let second = move |frequency: f64| ComplexGain {
        real: libm::cos(frequency * late),
        imaginary: -libm::sin(frequency * late),
    };
    let mut samples = Samples::default();
    let along = libm::cos(FRAC_PI_4);
    for index in 0..20 {
        let tip = [along, along, 0.0];
        let axis = [along, 0.0, 0.0];
        samples.push(f64::from(index), [tip, [0.0; 3], [0.0; 3]], &[axis, axis]);
        samples.push_rates(&UNIT[..2]);
    }
    for share in [1.0, 0.5] {
        samples.contour_share = vec![share; samples.len()];
        let limit = ContourError::new(&[&first, &second], 0.01, 500.0, Collocation::Start);
        for speed in speeds(&samples, &limit) {
            let want = share * 2.0 * 0.01 / late;
            assert!((speed / want - 1.0).abs() < 1e-3, "{speed} {want}");
        }
    }
}

/// The share of one sample bounds it, and between samples its neighbours too.
#[test]
fn a_share_tightens_where_it_stands() {
    let (x, y) = (servo(true), servo(false));
    for rates in [true, false] {
        for other in [&x as &dyn DriveResponse, &y] {
            for collocation in [Collocation::Start, Collocation::Throughout] {
                let limit = ContourError::new(&[&x, other, &x], 0.02, 49.8, collocation);
                let mut samples = circle(8.0, 40);
                if !rates {
                    samples.rates.clear();
                }
                let before = speeds(&samples, &limit);
                samples.contour_share = vec![1.0; samples.len()];
                assert_eq!(speeds(&samples, &limit), before);
                samples.contour_share[10] = 0.25;
                let after = speeds(&samples, &limit);
                let changed: Vec<usize> =
                    (0..after.len()).filter(|&at| after[at] < before[at]).collect();
                let want: &[usize] = match collocation {
                    Collocation::Throughout => &[9, 10, 11],
                    _ => &[10],
                };
                assert_eq!(changed, want);
                // The error goes with the square of the feed, and with the feed where axes differ.
                let ratio = after[10] / before[10];
                assert!((0.24..0.6).contains(&ratio), "{ratio}");
            }
        }
    }
}

#[test]
fn the_formula_holds_along_a_plan_that_accelerates() {
    let (x, y) = (servo(true), servo(false));
    let axes: [&dyn DriveResponse; 3] = [&x, &y, &x];
    let samples = circle(8.0, 2000);
    let limit = ContourError::new(&axes, 0.01, 49.8, Collocation::Ends);
    let feed = TipFeed { most: 50.0, collocation: Collocation::Ends };
    let limits: [&dyn Limit; 2] = [&feed, &limit];
    let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
    let plan = reach::solve(&problem).unwrap();
    assert!(problem.worst(&plan).share < 1.0 + 1e-9);
    // Its rows alone bound the acceleration from rest: what X and Y miss differs.
    assert!(plan[1] > 0.0 && plan[1].is_finite() && plan[1] < plan[100]);
    let speed = plan[1000].sqrt();
    assert!(speed > 10.0 && speed < 40.0, "{speed}");
}

#[test]
fn axes_that_the_limit_does_not_know_are_refused_by_its_name() {
    let x = servo(true);
    let limit = ContourError::new(&[&x as &dyn DriveResponse; 4], 0.01, 49.8, Collocation::Start);
    let fault = Problem::new(&circle(8.0, 4), &[&limit], EndSpeeds::default()).unwrap_err();
    assert!(matches!(fault, Infeasible::NotANumber { .. }), "{fault:?}");
    let mut samples = circle(8.0, 4);
    samples.rates[1].pop();
    let fault = Problem::new(&samples, &[&limit], EndSpeeds::default()).unwrap_err();
    assert_eq!(fault, Infeasible::Shape);
}
