use post_feed::jerk::IntervalLaw;

/// Leaves rest with 60 mm/s³: after half a second 1.25 mm, 7.5 mm/s, 30 mm/s².
#[test]
fn leaving_rest_is_a_motion_of_constant_jerk() {
    let piece = IntervalLaw::Leave(7.5 * 7.5);
    let step = 1.25;
    assert!((piece.duration(step) - 0.5).abs() < 1e-15);
    assert!((piece.at(1.0, step)[1] / 2.0 - 30.0).abs() < 1e-12);
    for share in [1e-9, 0.1, 0.7, 1.0] {
        for (piece, share) in [(piece, share), (IntervalLaw::Arrive(7.5 * 7.5), 1.0 - share)] {
            let [q, _, bend] = piece.at(share, step);
            assert!((0.5 * bend * q.sqrt() - 60.0).abs() < 1e-5, "{share}");
        }
    }
}

#[test]
fn the_time_of_a_quadratic_is_that_of_its_motion() {
    // q = (3 + 2 t)² with s = 3 t + t²: constant acceleration, q = 9 + 4 s.
    let piece = IntervalLaw::Quadratic([9.0, 17.0, 25.0]);
    assert!((piece.duration(4.0) - 1.0).abs() < 1e-7);
    assert_eq!(piece.at(0.5, 4.0), [17.0, 4.0, 0.0]);
}
