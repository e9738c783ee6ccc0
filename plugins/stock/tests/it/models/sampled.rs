use post_plugin::{Curve, Deviation, ErrorModel, Tolerance, Value};
use post_sampled::Sampled;

const TOLERANCE: Tolerance = Tolerance { tip: 0.01, axis: 0.1 };

/// Fits `shape`, the tip's deviation along one direction, and counts the places asked for.
fn fit(samples: i64, shape: impl Fn(f64) -> f64) -> (Sampled, Curve, usize) {
    let mut model = Sampled::open(&[("samples", Value::Integer(samples))]).unwrap();
    let mut asked = 0;
    let curve = model.fit(&TOLERANCE, &mut |ts, out| {
        asked += ts.len();
        for (t, out) in ts.iter().zip(out) {
            *out = Deviation {
                tip: [0.0, 0.6 * shape(*t), 0.8 * shape(*t)],
                axis: [-2.0 * shape(*t), 0.0, 0.0],
            };
        }
    });
    (model, curve.unwrap(), asked)
}

/// The peak is right to one percent, and is found with few questions.
fn check(name: &str, most: usize, peak: f64, shape: impl Fn(f64) -> f64) {
    let (_, curve, asked) = fit(1, &shape);
    assert!(
        (0.99 * peak..=1.000_001 * peak).contains(&curve.tip_peak),
        "{name}: {} instead of {peak}",
        curve.tip_peak
    );
    assert!((curve.axis_peak - 2.0 * curve.tip_peak).abs() < 1e-12);
    assert!((shape(curve.tip_at).abs() - curve.tip_peak).abs() < 1e-12, "{name}");
    assert!(asked <= most, "{name}: asked {asked} times");
}

/// One period of a sine without the library: Bhaskara's parabolas are shape enough for a test.
fn wave(turns: f64) -> f64 {
    let t = turns - turns.floor();
    let half = |t: f64| 16.0 * t * (0.5 - t);
    if t < 0.5 { half(t) } else { -half(t - 0.5) }
}

#[test]
fn finds_the_peaks_of_plain_shapes() {
    check("parabola", 24, 0.25, |t| t * (1.0 - t));
    check("negative parabola", 24, 0.25, |t| t * (t - 1.0));
    check("half a wave", 24, 1.0, |t| wave(t / 2.0));
    check("skewed to the end", 40, 0.139_541, |t| {
        let t4 = t * t * t * t;
        t4 * t * (1.0 - t) * 2.083_3
    });
    check("largest at an end", 40, 0.3, |t| 0.3 - 0.25 * t);
}

#[test]
fn finds_the_larger_of_two_peaks() {
    let two = |t: f64| wave(t) * (1.0 - 0.1 * t);
    check("two peaks", 60, 0.975_3, two);
    check("two peaks, mirrored", 60, 0.975_3, |t| two(1.0 - t));
}

#[test]
fn finds_a_narrow_peak_once_it_has_seen_it() {
    let bump = |centre: f64, width: f64| {
        move |t: f64| {
            let x = (t - centre) / width;
            1.0 / (1.0 + x * x)
        }
    };
    check("narrow", 200, 1.0, bump(0.377, 0.02));
    let (_, curve, _) = fit(400, bump(0.377, 0.001));
    assert!((curve.tip_peak - 1.0).abs() < 0.01);
    assert!((curve.tip_at - 0.377).abs() < 0.001);
}

#[test]
fn a_straight_move_costs_one_look_at_every_piece() {
    let (_, curve, asked) = fit(1, |_| 0.0);
    assert_eq!((curve.tip_peak, asked), (0.0, 19));
}

#[test]
fn what_is_not_smooth_ends_with_the_bound() {
    // A jump: no piece over it ever settles.
    let (_, curve, asked) = fit(1, |t| if t < 0.3 { 0.0 } else { 1.0 });
    assert!(asked < 2 * 4096);
    assert!((1.0..1.6).contains(&curve.tip_peak));
}

#[test]
fn the_curve_goes_through_the_deviations() {
    let shape = |t: f64| t * (1.0 - t) * (t - 0.3) * (1.0 + t);
    let (model, curve, _) = fit(1, shape);
    for step in 0..=100 {
        let t = f64::from(step) / 100.0;
        let value = model.value(&curve, t);
        assert!((value.tip[1] - 0.6 * shape(t)).abs() < 1e-14);
        assert!((value.axis[0] + 2.0 * shape(t)).abs() < 1e-14);
    }
}

#[test]
fn a_deviation_that_is_no_number_is_refused() {
    let mut model = Sampled::open(&[]).unwrap();
    let refused = model.fit(&TOLERANCE, &mut |_, out| out[3].tip[1] = f64::NAN);
    assert_eq!(refused.unwrap_err(), "the deviation at 0.25 of the move is not a finite number");
}
