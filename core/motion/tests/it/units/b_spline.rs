use nalgebra::Vector2;
use post_motion::path::BSpline;

/// A quarter of the unit circle as a NURBS of degree 2: radius and curvature are known everywhere.
#[test]
fn a_circle_has_its_radius_and_curvature() {
    let half = 0.5f64.sqrt();
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let poles = [([1.0, 0.0], 1.0), ([1.0, 1.0], half), ([0.0, 1.0], 1.0)];
    let poles = poles.map(|(pole, weight)| (Vector2::from(pole), weight)).to_vec();
    let curve = BSpline { degree: 2, knots, poles };
    for step in 0..=20 {
        let [p, d, dd, ddd] = curve.derivatives(f64::from(step) / 20.0);
        assert!((libm::hypot(p[0], p[1]) - 1.0).abs() < 1e-14);
        let speed = libm::hypot(d[0], d[1]);
        let curvature = (d[0] * dd[1] - d[1] * dd[0]) / (speed * speed * speed);
        assert!((curvature - 1.0).abs() < 1e-12);
        // p·p = 1 differentiated three times: 3 p'·p'' + p·p''' = 0.
        assert!((3.0 * d.dot(&dd) + p.dot(&ddd)).abs() < 1e-12);
    }
}

/// A B-spline reproduces a cubic polynomial whose control values are its polar form at the knots.
#[test]
fn a_cubic_polynomial_is_reproduced_on_knots_of_any_spacing() {
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.1, 0.4, 0.4, 0.9, 1.0, 1.0, 1.0, 1.0];
    // t³ - 2 t² + 3 t - 1
    let polar = |a: f64, b: f64, c: f64| {
        a * b * c - 2.0 / 3.0 * (a * b + b * c + c * a) + (a + b + c) - 1.0
    };
    let control = |index: usize| [polar(knots[index + 1], knots[index + 2], knots[index + 3])];
    let curve = BSpline::unweighted(3, knots.clone(), (0..8).map(control));
    for step in 0..=40 {
        let t = f64::from(step) / 40.0;
        let want = [
            t * t * t - 2.0 * t * t + 3.0 * t - 1.0,
            3.0 * t * t - 4.0 * t + 3.0,
            6.0 * t - 4.0,
            6.0,
        ];
        for (got, want) in curve.derivatives(t).iter().zip(want) {
            assert!((got[0] - want).abs() < 1e-11, "{t}: {got:?} {want}");
        }
    }
    assert_eq!(curve.breaks().collect::<Vec<_>>(), [0.0, 0.1, 0.4, 0.9, 1.0]);
}
