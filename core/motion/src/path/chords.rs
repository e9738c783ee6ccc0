//! Straight pieces of a way: how many stay near enough to it, where they end, and what of one is nearest to a place.

use nalgebra::Vector3;

/// Even pieces of a way whose chords stay within `chord` mm of it, as far as their quarters tell: as many as `first`, doubled
/// until all agree or there are `most`.
pub fn chords(first: u64, most: u64, chord: f64, at: impl Fn(f64) -> Vector3<f64>) -> u64 {
    let mut count = first;
    while count < most {
        let at = |place: u64| at(place as f64 / (4 * count) as f64);
        let strays = (0..count).any(|piece| {
            let [first, a, b, c, last] = std::array::from_fn(|part| at(4 * piece + part as u64));
            [(a, 0.25), (b, 0.5), (c, 0.75)]
                .iter()
                .any(|(point, share)| (first + (last - first) * *share - point).norm() > chord)
        });
        if !strays {
            break;
        }
        count *= 2;
    }
    count
}

/// Number of chords of a turn by `sweep` radians at `radius` mm that stay within `chord` mm of it: over the angle a one
/// strays by r·a²/8.
pub fn arc_chords(radius: f64, sweep: f64, chord: f64) -> f64 {
    let angle = libm::sqrt(8.0 * chord / radius.max(chord));
    libm::ceil(libm::fabs(sweep) / angle)
}

/// The ends of `count` even pieces of a way, in order, the last of them `end`.
pub fn piece_ends<P: Clone>(count: u64, end: P, at: impl Fn(f64) -> P) -> impl Iterator<Item = P> {
    (1..=count).map(move |piece| match piece == count {
        true => end.clone(),
        false => at(piece as f64 / count as f64),
    })
}

/// The share of the straight way from one point to another, 0 to 1, that is nearest to `place`; 0 where they are the same.
pub fn nearest_share([from, to]: [&Vector3<f64>; 2], place: &Vector3<f64>) -> f64 {
    let way = to - from;
    let square = way.norm_squared();
    match square > 0.0 {
        true => ((place - from).dot(&way) / square).clamp(0.0, 1.0),
        false => 0.0,
    }
}
