use post_feed::curve::{CurveFault, NurbsCurve};

/// A quarter of the unit circle as a NURBS of degree 2: radius and curvature are known everywhere.
#[test]
fn a_circle_has_its_radius_and_curvature() {
    let half = 0.5f64.sqrt();
    let knots = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let points = vec![[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let curve = NurbsCurve::new(2, knots, points, vec![1.0, half, 1.0]).unwrap();
    for step in 0..=20 {
        let [p, d, dd, ddd] = curve.derivatives(f64::from(step) / 20.0);
        assert!((libm::hypot(p[0], p[1]) - 1.0).abs() < 1e-14);
        let speed = libm::hypot(d[0], d[1]);
        let curvature = (d[0] * dd[1] - d[1] * dd[0]) / (speed * speed * speed);
        assert!((curvature - 1.0).abs() < 1e-12);
        // p·p = 1 differentiated three times: 3 p'·p'' + p·p''' = 0.
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        assert!((3.0 * dot(d, dd) + dot(p, ddd)).abs() < 1e-12);
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
    let points = (0..8).map(control).collect();
    let curve = NurbsCurve::new(3, knots.clone(), points, Vec::new()).unwrap();
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

#[test]
fn numbers_that_are_no_curve_are_refused() {
    let knots = vec![0.0, 0.0, 1.0, 1.0];
    let points = vec![[0.0], [1.0]];
    let new = |degree, knots: &[f64], weights: &[f64]| {
        NurbsCurve::new(degree, knots.to_vec(), points.clone(), weights.to_vec()).err()
    };
    assert_eq!(new(1, &knots, &[]), None);
    assert_eq!(new(0, &knots, &[]), Some(CurveFault::Degree));
    assert_eq!(new(2, &knots, &[]), Some(CurveFault::Points));
    assert_eq!(new(1, &knots[1..], &[]), Some(CurveFault::Knots));
    let order = Some(CurveFault::Order { knot: 2 });
    assert_eq!(new(1, &[0.0, 1.0, 0.5, 1.0], &[]), order);
    assert_eq!(new(1, &[0.0, 0.5, 0.5, 1.0], &[]), order);
    assert_eq!(new(1, &knots, &[1.0]), Some(CurveFault::Weight { point: 1 }));
    assert_eq!(new(1, &knots, &[1.0, 0.0]), Some(CurveFault::Weight { point: 1 }));
}
