//! The models on the moves of the two papers, the kinematics written out from their formulas: figures that
//! owe nothing to the chain in post-machine.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use post_host::{GivenValue, Plugin};
use post_plugin::{Deviation, ModelSession, Tolerance, length};

type Vector = [f64; 3];

/// Places of a move that are compared, ends included.
const PLACES: u32 = 101;

/// Li 2024, table 3.2: points (mm) and tool axes of an impeller's blade.
const BLADE: [(Vector, Vector); 20] = [
    ([51.4984, 4.8320, -37.8134], [0.8259, -0.0720, 0.5592]),
    ([50.6826, 4.2881, -37.3166], [0.8315, -0.0748, 0.5505]),
    ([49.8963, 3.7208, -36.7989], [0.8370, -0.0776, 0.5418]),
    ([49.1479, 3.1214, -36.2629], [0.8423, -0.0804, 0.5330]),
    ([48.4270, 2.5096, -35.7040], [0.8476, -0.0832, 0.5241]),
    ([47.7376, 1.9901, -35.1263], [0.8527, -0.0860, 0.5152]),
    ([47.0816, 1.2247, -34.5395], [0.8578, -0.0889, 0.5062]),
    ([46.4617, 0.5413, -33.9464], [0.8628, -0.0918, 0.4972]),
    ([45.8699, -0.1495, -33.3338], [0.8676, -0.0947, 0.4882]),
    ([45.3113, -0.8505, -32.7022], [0.8724, -0.0976, 0.4790]),
    ([44.7915, -1.5774, -32.0679], [0.8770, -0.1005, 0.4699]),
    ([44.3058, -2.3069, -31.4100], [0.8815, -0.1035, 0.4606]),
    ([43.8511, -3.0438, -30.7382], [0.8860, -0.1064, 0.4514]),
    ([43.4218, -3.8037, -30.0768], [0.8903, -0.1094, 0.4420]),
    ([43.0247, -4.5475, -29.3775], [0.8945, -0.1124, 0.4327]),
    ([42.6480, -5.3006, -28.6769], [0.8986, -0.1154, 0.4232]),
    ([42.2853, -6.0689, -27.9865], [0.9027, -0.1184, 0.4138]),
    ([41.9514, -6.8326, -27.2762], [0.9066, -0.1214, 0.4043]),
    ([41.6252, -7.6173, -26.5869], [0.9103, -0.1244, 0.3947]),
    ([41.3061, -8.4195, -25.9157], [0.9140, -0.1274, 0.3851]),
];

fn between(a: Vector, b: Vector, t: f64) -> Vector {
    [0, 1, 2].map(|i| a[i] + t * (b[i] - a[i]))
}

fn minus(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn about_x([x, y, z]: Vector, angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    [x, cos * y - sin * z, sin * y + cos * z]
}

fn about_z([x, y, z]: Vector, angle: f64) -> Vector {
    let (sin, cos) = libm::sincos(angle);
    [cos * x - sin * y, sin * x + cos * y, z]
}

/// Deviation of the tip on move `index` of the blade on the dual table (eq. 3.1), whose rotary axes meet
/// `below` mm under the part origin: S = Rx(A)·Rz(C)·(P - m) + m, linear in A, C and S.
fn blade(index: usize, below: f64) -> impl Fn(f64) -> Vector {
    let m = [0.0, 0.0, -below];
    let words = |(p, u): (Vector, Vector)| {
        let a = libm::acos(u[2] / length(&u));
        let c = libm::atan2(u[0], u[1]);
        (about_x(about_z(minus(p, m), c), a), a, c)
    };
    let (from, to) = (BLADE[index], BLADE[index + 1]);
    let ((s0, a0, c0), (s1, a1, c1)) = (words(from), words(to));
    move |t| {
        let (a, c) = (a0 + t * (a1 - a0), c0 + t * (c1 - c0));
        let part = about_z(about_x(between(s0, s1, t), -a), -c);
        minus(part, minus(between(from.0, to.0, t), m))
    }
}

/// Deviation of the tip in the move of the swing head (Sha 2022, section 2.2) whose pivot is `lm` mm above
/// the tip, linear in A and the pivot; C stands at 90 degrees. P_m1's x is 33.3881 (printed with a 1 before).
fn swing(lm: f64) -> impl Fn(f64) -> Vector {
    let [a0, a1] = [-3.3528_f64, -2.1501].map(f64::to_radians);
    let (p0, p1) = ([33.3881, 0.0, 8.1205], [36.2549, 0.0, 8.2580]);
    let arm = move |a: f64| {
        let (sin, cos) = libm::sincos(a);
        [lm * sin, 0.0, lm * cos]
    };
    let pivot = move |p: Vector, a: f64| minus(p, arm(a).map(|part| -part));
    move |t| {
        let tip = minus(between(pivot(p0, a0), pivot(p1, a1), t), arm(a0 + t * (a1 - a0)));
        minus(tip, between(p0, p1, t))
    }
}

/// What a model makes of a move.
struct Fit {
    /// Its peak, mm.
    peak: f64,
    /// Where.
    at: f64,
    /// The largest deviation at the places, mm.
    actual: f64,
    /// The largest that its curve leaves of it, mm.
    left: f64,
    /// R² of the length of the deviation.
    explained: f64,
}

fn fit(model: &str, options: &[(&str, i64)], deviation: impl Fn(f64) -> Vector) -> Fit {
    let options: Vec<(String, GivenValue)> = options
        .iter()
        .map(|(key, value)| ((*key).to_owned(), GivenValue::Integer(*value)))
        .collect();
    let plugin = Plugin::linked(post_stock::plugin(model).unwrap()).unwrap();
    let mut session = plugin.error_model(&options).unwrap();
    let tolerance = Tolerance { tip: 1e-4, axis: 0.05 };
    let curve = session
        .fit(&tolerance, &mut |ts, out| {
            for (t, out) in ts.iter().zip(out) {
                *out = Deviation { tip: deviation(*t), axis: [0.0; 3] };
            }
        })
        .unwrap();
    let places: Vec<(Vector, Vector)> = (0..PLACES)
        .map(|place| f64::from(place) / f64::from(PLACES - 1))
        .map(|t| (deviation(t), session.value(&curve, t).tip))
        .collect();
    let mean = places.iter().map(|(a, _)| length(a)).sum::<f64>() / f64::from(PLACES);
    let square = |x: f64| x * x;
    let spread: f64 = places.iter().map(|(a, _)| square(length(a) - mean)).sum();
    let rest: f64 = places.iter().map(|(a, b)| square(length(a) - length(b))).sum();
    let largest = |sizes: &mut dyn Iterator<Item = f64>| sizes.fold(0.0, f64::max);
    Fit {
        peak: curve.tip_peak,
        at: curve.tip_at,
        actual: largest(&mut places.iter().map(|(a, _)| length(a))),
        left: largest(&mut places.iter().map(|(a, b)| length(&minus(*a, *b)))),
        explained: 1.0 - rest / spread,
    }
}

/// The largest peak over the moves of the blade, and the largest rest, mm.
fn over_the_blade(model: &str, options: &[(&str, i64)], below: f64) -> [f64; 3] {
    let fits = (0..BLADE.len() - 1).map(|index| fit(model, options, blade(index, below)));
    fits.fold([0.0; 3], |[peak, actual, left], fit| {
        [peak.max(fit.peak), actual.max(fit.actual), left.max(fit.left)]
    })
}

fn near(value: f64, wanted: f64, by: f64) -> bool {
    (value - wanted).abs() < by
}

#[test]
fn table_3_2_of_the_harmonic_paper() {
    let [peak, actual, left] = over_the_blade("harmonic", &[], 200.0);
    assert!(near(actual, 4.62e-3, 5e-6), "{actual}");
    assert!(near(peak, actual, 1e-6), "{peak}");
    assert!(near(left, 0.26e-3, 5e-6) && near(left / actual, 0.056, 6e-4), "{left}");

    let [peak, _, left] = over_the_blade("parabolic", &[], 200.0);
    assert!(near(peak, actual, 1e-6), "{peak}");
    assert!(near(left / actual, 0.0012, 1e-4), "{}", left / actual);

    let [peak, _, left] = over_the_blade("sampled", &[], 200.0);
    assert!(near(peak, actual, 0.01 * actual), "{peak}");
    assert!(left < 1e-9, "{left}");

    // Three waves fitted to 15 places leave a fifth of what one leaves.
    let third = [("order", 3), ("samples", 15)];
    let [_, _, left] = over_the_blade("harmonic", &third, 200.0);
    assert!(near(left / actual, 0.0118, 5e-4), "{}", left / actual);

    let [peak, ..] = over_the_blade("harmonic", &[], 0.0);
    assert!(near(peak, 2.30e-3, 5e-6), "{peak}");
}

#[test]
fn the_swing_head_of_the_parabolic_paper() {
    for (lm, peak) in [
        (100.0, 5.508e-3),
        (200.0, 11.016e-3),
        (300.0, 16.523e-3),
        (312.0, 17.184e-3),
        (400.0, 22.031e-3),
    ] {
        let parabola = fit("parabolic", &[], swing(lm));
        assert!(near(parabola.peak, peak, 1e-6), "{lm}: {}", parabola.peak);
        assert!(near(parabola.at, 0.5, 1e-6));
        assert!(parabola.explained > 0.999_999, "{}", parabola.explained);
        let sine = fit("harmonic", &[], swing(lm));
        assert!(near(sine.peak, peak, 1e-6), "{lm}: {}", sine.peak);
        assert!(near(sine.explained, 0.9862, 5e-5), "{}", sine.explained);
        let sampled = fit("sampled", &[], swing(lm));
        assert!(near(sampled.peak, peak, 0.01 * peak));
    }
}
