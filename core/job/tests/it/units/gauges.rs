//! What is measured of a plan.

use post_feed::limits::{ChordError, Collocation};
use post_job::internals::chord_error;

#[test]
fn the_chord_error_of_the_fastest_feed_is_the_tolerance() {
    for (radius, tolerance) in [(8.0, 0.0005), (1000.0, 0.0005), (0.01, 0.0005)] {
        let limit = ChordError { tolerance, period: 0.004, collocation: Collocation::Start };
        let feed = limit.feed(1.0 / radius);
        let found = chord_error(feed, 1.0 / radius, 0.004);
        assert!((found / tolerance - 1.0).abs() < 1e-9, "{found}");
    }
    assert_eq!(chord_error(50.0, 0.0, 0.004), 0.0);
}
