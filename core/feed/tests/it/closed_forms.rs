//! Motions whose least time is known.

use post_feed::jerk::{self, JerkSettings};
use post_feed::limits::{
    AxisAcceleration, AxisJerk, AxisVelocity, Collocation, Limit, TipAcceleration,
};
use post_feed::{EndSpeeds, Problem, Samples, profile, reach};

use crate::support::paths::even;

const VELOCITY: f64 = 100.0;
const ACCELERATION: f64 = 500.0;

/// A straight line of one axis.
fn line(parameters: &[f64]) -> Samples {
    let mut samples = Samples::default();
    for &s in parameters {
        let x = [1.0, 0.0, 0.0];
        samples.push(s, [x, [0.0; 3], [0.0; 3]], &[x]);
    }
    samples
}

/// Least time of a line from rest to rest with a limit of jerk that lets acceleration and velocity reach theirs.
#[test]
fn on_a_line_the_plan_with_jerk_limits_is_the_s_curve() {
    let jerk_limit = 3000.0;
    let length = 100.0;
    let collocation = Collocation::Throughout;
    let velocity = AxisVelocity { limits: vec![VELOCITY], collocation };
    let acceleration = AxisAcceleration { limits: vec![ACCELERATION], collocation };
    let jerk = AxisJerk { limits: vec![jerk_limit] };
    let limits: [&dyn Limit; 3] = [&velocity, &acceleration, &jerk];
    let trapezoid = length / VELOCITY + VELOCITY / ACCELERATION;
    let s_curve = trapezoid + ACCELERATION / jerk_limit;
    let cases = [
        (even(0.0, length, 251), 6e-3),
        (even(0.0, length, 1001), 6e-3),
        (jerk::graded(0.0, length, 0.1), 3e-3),
    ];
    for (parameters, most) in cases {
        let samples = line(&parameters);
        let problem = Problem::new(&samples, &limits, EndSpeeds::default()).unwrap();
        let plan = jerk::solve(&samples, &limits, &problem, JerkSettings::default()).unwrap();
        let over = plan.seconds / s_curve - 1.0;
        println!(
            "{} samples: {:.5} s of {s_curve:.5} s, {over:.1e}; without jerk {:.5} s of {trapezoid:.5} s",
            parameters.len(),
            plan.seconds,
            plan.bound
        );
        assert!((plan.bound / trapezoid - 1.0).abs() < 1e-3);
        // Never below what physics allows.
        assert!(over > -1e-9 && over < most, "{} samples: {over}", parameters.len());
    }
}

/// A circle at the speed where the acceleration of the tip is all centripetal, and off from rest on it: the speed
/// follows from `dv/dt = sqrt(a² - v⁴/ρ²)`, which the polygon may miss by 1.9 % of the acceleration.
#[test]
fn on_a_circle_the_tip_accelerates_with_what_the_curvature_leaves() {
    let (radius, limit) = (20.0, 300.0);
    let mut samples = Samples::default();
    for index in 0..=4000 {
        // Arc length; the axes do not matter.
        let s = 40.0 * f64::from(index) / 4000.0;
        let (sin, cos) = libm::sincos(s / radius);
        let first = [-sin, cos, 0.0];
        let second = [-cos / radius, -sin / radius, 0.0];
        samples.push(s, [first, second, [0.0; 3]], &[]);
    }
    let tip = TipAcceleration { limit, collocation: Collocation::Throughout };
    let feed = post_feed::limits::TipFeed { most: 200.0, collocation: Collocation::Throughout };
    let problem = Problem::new(&samples, &[&tip, &feed], EndSpeeds::default()).unwrap();
    let plan = reach::solve(&problem).unwrap();
    let fastest = plan.iter().copied().fold(0.0, f64::max).sqrt();
    // All across: v² = a ρ, at a corner of the polygon.
    assert!((fastest / (limit * radius).sqrt() - 1.0).abs() < 1e-3, "{fastest}");
    // dq/ds = 2 sqrt(a² - q²/ρ²) has q = a ρ sin(2 s / ρ) up to a quarter of the sine.
    for sample in [200, 500, 1000, 1400] {
        let s = samples.parameter[sample];
        let exact = limit * radius * libm::sin(2.0 * s / radius);
        let share = plan[sample] / exact;
        assert!(share < 1.0 + 1e-9 && share > 0.975, "{s}: {share}");
    }
    assert!(profile::duration(&problem.steps, &plan) > 0.0);
}
