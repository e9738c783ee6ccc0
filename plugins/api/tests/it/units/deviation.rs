use post_plugin::internals::peak;
use post_plugin::{Curve, Deviation, ask};

#[test]
fn the_peak_is_the_largest_of_several() {
    // t·(1-t)·(t-0.3)²·(1+t): two peaks, at a hundred thousand places looked at one by one.
    let shape = |t: f64| t * (1.0 - t) * (t - 0.3) * (t - 0.3) * (1.0 + t);
    let best = (0..=100_000).map(|step| shape(f64::from(step) / 100_000.0)).fold(0.0, f64::max);
    for pieces in [4, 8, 16, 33] {
        let (size, at) = peak(pieces, shape);
        assert!((size / best - 1.0).abs() < 1e-6, "{pieces}: {size}");
        assert_eq!(shape(at), size);
    }
}

#[test]
fn ends_count_and_a_middle_is_exact() {
    assert_eq!(peak(8, |t| 0.3 - 0.25 * t), (0.3, 0.0));
    assert_eq!(peak(8, |t| 0.05 + 0.25 * t), (0.3, 1.0));
    assert_eq!(peak(8, |t| t * (1.0 - t)), (0.25, 0.5));
    assert_eq!(peak(8, |_| 0.0), (0.0, 0.5));
    // A peak between an end and its neighbour.
    let (size, at) = peak(8, |t| 1.0 - (t - 0.02) * (t - 0.02));
    assert!((size - 1.0).abs() < 1e-7 && (at - 0.02).abs() < 3e-4);
}

#[test]
fn a_curve_keeps_what_it_is_given() {
    let kept = [1.0, 2.0].map(|x| Deviation { tip: [x, 0.0, -x], axis: [0.0, 4.0 * x, 3.0 * x] });
    let curve = Curve::of(&kept, 4, |t| kept[0].lerp(kept[1], t));
    assert_eq!((curve.kept(0), curve.kept(1)), (kept[0], kept[1]));
    assert_eq!(curve.kept(2), Deviation::default());
    assert_eq!((curve.axis_peak, curve.axis_at), (10.0, 1.0));
    assert_eq!(kept[1] - kept[0], kept[0]);
}

#[test]
fn what_is_no_number_is_refused() {
    let mut answers = Vec::new();
    let refused = ask(&mut |_, out| out[1].axis[2] = f64::INFINITY, &[0.0, 0.5], &mut answers);
    assert_eq!(refused.unwrap_err(), "the deviation at 0.5 of the move is not a finite number");
    ask(&mut |ts, out| out[0].tip[0] = ts[0], &[0.25], &mut answers).unwrap();
    assert_eq!(answers[0].to_terms(), [0.25, 0.0, 0.0, 0.0, 0.0, 0.0]);
}
