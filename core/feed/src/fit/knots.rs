//! Where knots go inside a leg: closer to an end that needs them close, and never suddenly closer.

/// How much farther apart knots may be, a unit of distance from where they are close.
const GROWTH: f64 = 0.7;
/// Most parts of one leg.
const MOST_PARTS: f64 = 512.0;

/// Puts into `inside` where a leg of this length is cut: about `near[0]` apart at its start, `near[1]` at its end, and
/// never more than `most`.
pub(super) fn place(length: f64, near: [f64; 2], most: f64, inside: &mut Vec<f64>) {
    inside.clear();
    let near = near.map(|near| near.min(most).min(length));
    if most >= length && near.iter().all(|near| *near > 0.6 * length) {
        return;
    }
    // The distance is `near[0] + GROWTH * x`, or `most`, or `near[1] + GROWTH * (length - x)`, whichever is least.
    let meet = (0.5 * (length + (near[1] - near[0]) / GROWTH)).clamp(0.0, length);
    let left = meet.min((most - near[0]) / GROWTH);
    let right = (length - meet).min((most - near[1]) / GROWTH);
    let ramp = |near: f64, reach: f64| libm::log(1.0 + GROWTH * reach / near) / GROWTH;
    let counts = [ramp(near[0], left), ramp(near[1], right)];
    let flat = (length - left - right).max(0.0);
    let between = if flat > 0.0 { flat / most } else { 0.0 };
    let count = counts[0] + between + counts[1];
    // One part more where the count is not whole; less strictly where no largest distance is to be kept.
    let parts = (count - if between > 0.0 { 1e-9 } else { 0.3 }).ceil();
    let parts = parts.clamp(1.0, MOST_PARTS);
    let climb = |near: f64, count: f64| near * (libm::exp(GROWTH * count) - 1.0) / GROWTH;
    for index in 1..parts as usize {
        let passed = count * index as f64 / parts;
        let rest = count - passed;
        inside.push(if passed <= counts[0] {
            climb(near[0], passed)
        } else if rest <= counts[1] {
            length - climb(near[1], rest)
        } else {
            left + (passed - counts[0]) * most
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn widths(length: f64, near: [f64; 2], most: f64) -> Vec<f64> {
        let mut all = Vec::new();
        place(length, near, most, &mut all);
        all.insert(0, 0.0);
        all.push(length);
        all.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }

    #[test]
    fn a_long_leg_is_cut_in_steps_that_grow_slowly() {
        for (length, near) in
            [(50.0, [0.2, 0.2]), (50.0, [0.2, 50.0]), (3.0, [1.0, 0.01]), (1000.0, [0.001, 1.0])]
        {
            let widths = widths(length, near, f64::INFINITY);
            assert!((widths.iter().sum::<f64>() - length).abs() < 1e-9 * length);
            for pair in widths.windows(2) {
                let ratio = pair[1] / pair[0];
                assert!((0.45..2.2).contains(&ratio), "{ratio} in {widths:?}");
            }
            assert!(widths[0] < 1.7 * near[0] && widths[widths.len() - 1] < 1.7 * near[1]);
        }
    }

    #[test]
    fn the_largest_distance_is_kept_and_legs_like_their_neighbours_are_left_whole() {
        assert_eq!(widths(1.0, [1.0, 0.7], 5.0), [1.0]);
        for length in [0.9, 1.0, 7.3, 100.0] {
            for near in [[10.0, 10.0], [0.1, 10.0], [0.1, 0.3]] {
                let widths = widths(length, near, 0.5);
                assert!(widths.iter().all(|width| *width <= 0.5 * (1.0 + 1e-9)));
            }
        }
    }
}
