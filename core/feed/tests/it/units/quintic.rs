use post_feed::quintic::{Jet, between};

#[test]
fn a_quintic_is_found_again() {
    let at = |s: f64| -> Jet<2> {
        let [square, cube, fourth] = [s * s, s * s * s, s * s * s * s];
        let third = 60.0 * square - 24.0 * s + 6.0;
        [
            [s * fourth - fourth + cube + 2.0, 3.0 - s],
            [5.0 * fourth - 4.0 * cube + 3.0 * square, -1.0],
            [20.0 * cube - 12.0 * square + 6.0 * s, 0.0],
            [third, 0.0],
        ]
    };
    for part in 0..=8 {
        let share = f64::from(part) / 8.0;
        let found = between(&at(-0.4), &at(1.1), 1.5, share);
        let wanted = at(-0.4 + 1.5 * share);
        for (found, wanted) in found.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
        }
    }
}
