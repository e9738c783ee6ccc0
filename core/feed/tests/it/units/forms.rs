use post_feed::internals::{LinearForm, Q, acceleration, jerk, leaving_acceleration, leaving_jerk};
use post_feed::jerk::IntervalLaw;
use post_feed::limits::{Channel, Order};

/// Evaluates by the scheme of de Casteljau.
fn bernstein(coefficients: &[f64], t: f64) -> f64 {
    match coefficients {
        [value] => *value,
        more => {
            let pairs = more.windows(2).map(|pair| pair[0] + t * (pair[1] - pair[0]));
            bernstein(&pairs.collect::<Vec<_>>(), t)
        }
    }
}

/// `Q = s³ - 2 s² + 5 s` and a multiple of `s⁵`, on `1..=1.5`.
fn channel(fifth: f64) -> (Channel, impl Fn(f64) -> [f64; 3]) {
    let at = move |s: f64| {
        let first = 3.0 * s * s - 4.0 * s + 5.0 + 5.0 * fifth * s * s * s * s;
        let second = 6.0 * s - 4.0 + 20.0 * fifth * s * s * s;
        [first, second, 6.0 + 60.0 * fifth * s * s]
    };
    let (here, next) = (at(1.0), at(1.5));
    let channel = Channel {
        first: [here[0], next[0]],
        second: [here[1], next[1]],
        // s² from 1 to 1.5 has the middle coefficient 1.5.
        third: [here[2], 6.0 + 60.0 * fifth * 1.5, next[2]],
        order: Order::Jerk,
        limit: 1.0,
        axis: None,
    };
    (channel, at)
}

#[test]
fn the_polynomials_are_the_derivatives_by_time() {
    let (cubic, of_cubic) = channel(0.0);
    let (channel, at) = channel(0.3);
    let q = [4.0, 7.0, 6.0];
    let piece = IntervalLaw::Quadratic(q);
    let value = |forms: &[LinearForm]| -> Vec<f64> {
        let each = forms.iter();
        each.map(|form| form.iter().zip(q).map(|(a, b)| a * b).sum()).collect()
    };
    let (second, third) = (value(&acceleration(&cubic, 0.5)), value(&jerk(&channel, 0.5)));
    for step in 0..=10 {
        let share = f64::from(step) / 10.0;
        let [q, slope, curve] = piece.at(share, 0.5);
        let [first, bend, _] = of_cubic(1.0 + 0.5 * share);
        let want = 0.5 * first * slope + bend * q;
        assert!((bernstein(&second, share) - want).abs() < 1e-11);
        let [first, bend, twist] = at(1.0 + 0.5 * share);
        let want = 0.5 * first * curve + 1.5 * bend * slope + twist * q;
        let used = want * q.sqrt();
        assert!((channel.used(share, 0.5, [q, slope, curve]) - used).abs() < 1e-11);
        assert!((bernstein(&third, share) - want).abs() < 1e-11);
        assert!((bernstein(&value(&Q), share) - q).abs() < 1e-12);
    }
}

#[test]
fn off_from_rest_the_bounds_hold_and_are_met() {
    let (channel, at) = channel(0.0);
    let piece = IntervalLaw::Leave(3.0);
    let (mut second, mut third): (f64, f64) = (0.0, 0.0);
    for step in 1..=1000 {
        let share = f64::from(step) / 1000.0;
        let [first, bend, twist] = at(1.0 + 0.5 * share);
        let [q, slope, curve] = piece.at(share, 0.5);
        second = second.max((0.5 * first * slope + bend * q).abs());
        third =
            third.max(((0.5 * first * curve + 1.5 * bend * slope + twist * q) * q.sqrt()).abs());
    }
    let bounds = [
        3.0 * leaving_acceleration(&channel, 0.5),
        3.0 * 3f64.sqrt() * leaving_jerk(&channel, 0.5),
    ];
    assert!(second <= bounds[0] && second > 0.9 * bounds[0], "{second} {bounds:?}");
    assert!(third <= bounds[1] && third > 0.9 * bounds[1], "{third} {bounds:?}");
}
