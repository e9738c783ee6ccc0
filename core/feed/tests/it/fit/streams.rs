//! A long path goes through, and little of it is kept.

use post_feed::fit::{FitPoint, FitRules, MOST, PathFit};

/// A wave in five coordinates, rounded as programs are.
fn at(index: usize) -> FitPoint {
    let s = 0.2 * index as f64;
    let rounded = |value: f64, step: f64| (value / step).round() * step;
    let mut point = [0.0; MOST];
    point[0] = rounded(30.0 * libm::sin(s / 50.0), 0.001);
    point[1] = rounded(0.7 * s, 0.001);
    point[2] = rounded(5.0 * libm::cos(s / 17.0), 0.001);
    point[3] = rounded(0.3 * libm::sin(s / 25.0), 1.7e-5);
    point[4] = rounded(0.4 * libm::cos(s / 45.0), 1.7e-5);
    point
}

#[test]
fn a_hundred_thousand_points_wait_a_few_hundred_at_most() {
    let rules = FitRules { dimensions: 5, ..FitRules::default() };
    let mut fit = PathFit::new(rules);
    let mut handed = 0;
    let mut waited = 0;
    let mut steepest: f64 = 0.0;
    let mut last = 0.0;
    let mut take = |leg: &post_feed::fit::FittedLeg<'_>, handed: &mut usize| {
        *handed += 1;
        assert_eq!(leg.begins, *handed == 1);
        for sample in leg.samples {
            let second = sample.values[2][2];
            // Ends are less sure.
            if sample.at > 0.0 && (300..99_700).contains(&*handed) {
                steepest = steepest.max((second - last).abs() / sample.at);
            }
            last = second;
        }
    };
    let count = 100_000;
    for index in 0..count {
        fit.push(&at(index), &mut |leg| take(leg, &mut handed));
        waited = waited.max(index - handed);
    }
    fit.cut(&mut |leg| take(leg, &mut handed));
    assert_eq!(handed, count - 1);
    assert!((100..400).contains(&waited), "{waited}");
    assert!(fit.worst() <= 1.0);
    // The third derivative, by differences of the second: the words are rounded, and what is smoothed of that differs from
    // window to window.
    let true_third = 5.0 / (17.0 * 17.0 * 17.0);
    println!("waits {waited}; third derivative {steepest:.6}, of the wave {true_third:.6}");
    assert!(steepest < 6.0 * true_third);
}
