use std::f64::consts::PI;

use post_feed::internals::Directions;

/// The largest angle to the nearest direction, over a dense spiral on the sphere.
#[test]
fn every_vector_is_near_a_direction() {
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let directions = Directions::icosahedron();
    assert_eq!(directions.units.len(), 31);
    let count = 200_000;
    let mut least: f64 = 1.0;
    for index in 0..count {
        let z = 1.0 - 2.0 * (index as f64 + 0.5) / count as f64;
        let radius = (1.0 - z * z).sqrt();
        let angle = index as f64 * PI * (3.0 - 5f64.sqrt());
        let vector = [radius * libm::cos(angle), radius * libm::sin(angle), z];
        let nearest =
            directions.units.iter().fold(0.0, |most: f64, unit| most.max(dot(*unit, vector).abs()));
        least = least.min(nearest);
    }
    assert!(least >= directions.share, "{least}");
    assert!(least < directions.share + 0.003, "{least}");
}
