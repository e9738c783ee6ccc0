use post_feed::limits::{ChordError, Collocation};

#[test]
fn the_chord_of_one_period_strays_by_the_tolerance() {
    let limit = ChordError { tolerance: 0.0005, period: 0.004, collocation: Collocation::Start };
    for radius in [0.001, 0.02, 8.0, 1e6] {
        let half: f64 = limit.feed(1.0 / radius) * limit.period / 2.0;
        let error = half * half / (radius + (radius * radius - half * half).max(0.0).sqrt());
        assert!((error - 0.0005).abs() < 1e-12, "{radius}: {error}");
    }
    // As the paper approximates it in eq. 24: 2 * sqrt(2 * ρ * δ) / T.
    assert!((limit.feed(1.0 / 8.0) - 44.72).abs() < 0.01);
    assert_eq!(limit.feed(0.0), f64::INFINITY);
}
