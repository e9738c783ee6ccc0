use post_feed::FeedSpline;
use post_feed::jerk::IntervalLaw;

use crate::spline::BSpline;

fn example() -> FeedSpline {
    FeedSpline::rounded(
        &[0.0, 1.0, 2.0, 2.5, 4.0, 4.125, 5.0],
        &[0.0, 10.0, 8.0, 3.0, 9.0, 9.5, 0.0],
    )
}

#[test]
fn value_and_slope_are_continuous_and_corners_are_cut() {
    let spline = example();
    for (index, pair) in spline.pieces.windows(2).enumerate() {
        let [a, b, c] = [0, 1, 2].map(|place| spline.knots[index + place]);
        let (end, begin) = (pair[0].at(1.0, b - a), pair[1].at(0.0, c - b));
        assert!((end[0] - begin[0]).abs() < 1e-12, "{end:?} {begin:?}");
        assert!((end[1] - begin[1]).abs() < 1e-9, "{end:?} {begin:?}");
    }
    assert_eq!((spline.at(0.0)[0], spline.at(5.0)[0]), (0.0, 0.0));
    // A quarter of half a step times the change of slope below the corner.
    assert!((spline.at(1.0)[0] - (10.0 - 0.25 * 0.5 * 12.0)).abs() < 1e-12);
}

#[test]
fn the_coefficients_are_those_of_a_b_spline() {
    let spline = example();
    let (knots, points) = spline.b_spline();
    let curve = BSpline::unweighted(2, knots, points.into_iter().map(|q| [q]));
    for step in 0..=500 {
        let at = f64::from(step) / 100.0;
        let (own, other) = (spline.at(at), curve.derivatives(at));
        assert!((own[0] - other[0][0]).abs() < 1e-11, "{at}");
        assert!((own[1] - other[1][0]).abs() < 1e-10, "{at}");
    }
}

#[test]
fn times_of_parts_add_up_and_shares_are_found_by_them() {
    for piece in [
        IntervalLaw::Leave(6.0),
        IntervalLaw::Arrive(6.0),
        IntervalLaw::Quadratic([0.0, 2.0, 4.0]),
        IntervalLaw::Quadratic([2.0, 3.0, 2.5]),
    ] {
        let spline = FeedSpline { knots: vec![1.0, 3.0], pieces: vec![piece] };
        let parts = [[0.0, 0.25], [0.25, 0.5], [0.5, 1.0]];
        let sum: f64 = parts.map(|part| spline.time_within(0, part)).iter().sum();
        let whole = spline.duration();
        assert!((sum / whole - 1.0).abs() < 1e-6, "{piece:?} {sum} {whole}");
        let half = spline.time_within(0, [0.0, 0.5]);
        assert!((spline.share_after(0, 0.0, half) - 0.5).abs() < 1e-9);
        assert!(spline.share_after(0, 0.25, 100.0) > 1.0 - 1e-12);
    }
}

/// Leaves rest with constant jerk, then goes evenly: `q` and its slope meet at the inner knot.
#[test]
fn beyond_a_start_with_jerk_the_b_spline_counts_from_the_inner_knot_on() {
    let (q1, slope) = (6.0, 4.0 / 3.0 * 6.0 / 2.0);
    let spline = FeedSpline {
        knots: vec![0.0, 2.0, 3.0],
        pieces: vec![IntervalLaw::Leave(q1), IntervalLaw::Quadratic([q1, q1 + 0.5 * slope, 9.0])],
    };
    let (knots, points) = spline.b_spline();
    let curve = BSpline::unweighted(2, knots, points.into_iter().map(|q| [q]));
    for at in [2.0, 2.3, 2.9, 3.0] {
        let (own, other) = (spline.at(at), curve.derivatives(at));
        assert!((own[0] - other[0][0]).abs() < 1e-12, "{at}");
        assert!((own[1] - other[1][0]).abs() < 1e-11, "{at}");
    }
}

#[test]
fn a_line_from_rest_has_its_time_exactly() {
    // Constant acceleration of 50 over 100: 2 s to speed 100, and down again.
    let mut spline = FeedSpline::rounded(&[0.0, 50.0, 100.0], &[0.0, 5000.0, 10_000.0]);
    assert!((spline.duration() - 2.0).abs() < 1e-12, "{}", spline.duration());
    spline.slow(0.5);
    assert!((spline.duration() - 4.0).abs() < 1e-12);
}
