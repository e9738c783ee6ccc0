//! An arc as a spline: on the circle, even, and as long.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_motion::path::{BSpline, on_arc};
use post_testkit::randomised;

#[test]
fn a_spline_of_an_arc_goes_where_the_arc_goes() {
    let (rounds, mut rng) = randomised(300, 4141);
    for _ in rounds {
        let mut vector = |far: f64| Vector3::from_fn(|_, _| rng.range(-far, far));
        let (centre, normal, arm) = (vector(100.0), vector(1.0), vector(50.0));
        let Some(normal) = normal.try_normalize(1e-3) else { continue };
        let from = centre + arm;
        let sweep = rng.range(-3.0, 3.0) * TAU;
        let (rise, wider) = (rng.range(-30.0, 30.0), rng.range(0.99, 1.01));
        let out = arm - normal * normal.dot(&arm);
        let turned = nalgebra::Rotation3::new(normal * sweep) * out;
        let to = centre + turned * wider + normal * (normal.dot(&arm) + rise);
        let spline = BSpline::of_arc([from, to], centre, normal, sweep);
        assert!(spline.is_sound());
        assert!((spline.at(0.0) - from).norm() < 1e-12 && (spline.at(1.0) - to).norm() < 1e-12);
        for _ in 0..20 {
            let share = rng.range(0.0, 1.0);
            let off = spline.at(share) - on_arc([from, to], centre, normal, sweep, share);
            // By how uneven the parameter is; in height by 0.096 (1 - cos 2.5°) of what that changes in a piece of 5°, 8e-6 of
            // what a radian does; along a spiral by what a quarter of the change of a piece is aside at 2.5°.
            let [higher, wider] = [rise, (wider - 1.0) * out.norm()].map(|all| (all / sweep).abs());
            let bound = 2e-5 * out.norm() + 1e-5 * higher + 1e-3 * wider + 1e-9;
            assert!(off.norm() < bound, "{} of {bound}", off.norm());
        }
        if wider == 1.0 {
            let arm = spline.at(0.3) - centre;
            assert!(((arm - normal * normal.dot(&arm)).norm() - out.norm()).abs() < 1e-11);
        }
    }
}

/// Without height and spiral the circle is exact.
#[test]
fn a_circle_is_exact() {
    let from = Vector3::new(20.0, 0.0, 3.0);
    let spline = BSpline::of_arc([from, from], Vector3::zeros(), Vector3::z(), TAU);
    for step in 0..=1000 {
        let at = spline.at(f64::from(step) / 1000.0);
        assert!((at.xy().norm() - 20.0).abs() < 1e-12 && (at.z - 3.0).abs() < 1e-12, "{at}");
    }
}
