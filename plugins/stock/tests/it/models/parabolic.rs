use post_parabolic::Parabolic;
use post_plugin::{Curve, Deviation, ErrorModel, Tolerance};

const TOLERANCE: Tolerance = Tolerance { tip: 0.005, axis: 0.05 };

/// Li 2024, table 3.1: deviations at 23 even places of a move. The last printed 0 breaks the second
/// difference of -0.0163 that all others keep.
const TABLE: [f64; 23] = [
    0.0, 0.1699, 0.3235, 0.4608, 0.5819, 0.6867, 0.7752, 0.8473, 0.9032, 0.9428, 0.9660, 0.9729,
    0.9635, 0.9378, 0.8957, 0.8373, 0.7626, 0.6716, 0.5643, 0.4407, 0.3009, 0.1447, 0.0,
];

fn fit(shape: impl Fn(f64) -> Deviation) -> (Parabolic, Curve) {
    let mut model = Parabolic::open(&[]).unwrap();
    let curve = model.fit(&TOLERANCE, &mut |ts, out| {
        assert_eq!(ts, [0.0, 0.5, 1.0]);
        out.iter_mut().zip(ts).for_each(|(out, t)| *out = shape(*t));
    });
    (model, curve.unwrap())
}

fn tip(x: f64) -> Deviation {
    Deviation { tip: [x, 0.0, 0.0], axis: [0.0; 3] }
}

/// The share of what the places vary by that the curve explains (R²), and the largest rest.
fn compare(values: &[f64], curve: impl Fn(f64) -> f64) -> (f64, f64) {
    let last = (values.len() - 1) as f64;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let (mut rest, mut whole, mut largest) = (0.0, 0.0, 0.0_f64);
    for (index, value) in values.iter().enumerate() {
        let off = value - curve(index as f64 / last);
        rest += off * off;
        whole += (value - mean) * (value - mean);
        largest = largest.max(off.abs());
    }
    (1.0 - rest / whole, largest)
}

#[test]
fn a_vector_parabola_between_rounded_ends_is_met_exactly() {
    let start = Deviation { tip: [4e-4, -3e-4, 0.0], axis: [0.0, 2e-4, 1e-4] };
    let bow = Deviation { tip: [0.002, 0.003, -0.006], axis: [0.01, 0.0, -0.02] };
    let shape = |t: f64| start.lerp(start * -2.0, t) + bow * (4.0 * t * (1.0 - t));
    let (model, curve) = fit(shape);
    let mut longest = [0.0_f64; 2];
    for step in 0..=10_000 {
        let t = f64::from(step) / 10_000.0;
        let off = model.value(&curve, t) - shape(t);
        assert!(off.to_terms().iter().all(|off| off.abs() < 1e-17), "{t}");
        longest[0] = longest[0].max(post_plugin::length(&shape(t).tip));
        longest[1] = longest[1].max(post_plugin::length(&shape(t).axis));
    }
    assert!((curve.tip_peak / longest[0] - 1.0).abs() < 1e-7);
    assert!((curve.axis_peak / longest[1] - 1.0).abs() < 1e-7);
    let there = model.value(&curve, curve.tip_at);
    assert_eq!(post_plugin::length(&there.tip), curve.tip_peak);
}

#[test]
fn the_peak_of_a_plain_bow_is_at_the_middle() {
    let (_, curve) = fit(|t| tip(-0.02 * t * (1.0 - t)));
    assert_eq!((curve.tip_peak, curve.tip_at), (0.005, 0.5));
    assert_eq!(curve.axis_peak, 0.0);
}

#[test]
fn table_3_1_is_a_parabola_to_its_rounding() {
    let at = |t: f64| tip(TABLE[(t * 22.0) as usize]);
    let (model, curve) = fit(at);
    let (explained, _) = compare(&TABLE, |t| model.value(&curve, t).tip[0]);
    println!("parabola: R² {explained:.5}");
    assert!((explained - 0.999_18).abs() < 5e-6, "{explained}");

    // With the last place as the second difference has it, the rest is the rounding of four decimals.
    let mut table = TABLE;
    table[22] = 2.0 * table[21] - table[20] - 0.0163;
    let (model, curve) = fit(|t| tip(table[(t * 22.0) as usize]));
    let (explained, largest) = compare(&table, |t| model.value(&curve, t).tip[0]);
    println!("parabola, the last row put right: R² {explained:.7}, off by {largest:.1e} at most");
    assert!(explained > 0.999_999 && largest < 3e-4, "{explained} {largest}");
    assert!((curve.tip_peak - 0.9729).abs() < 3e-4);
}

#[test]
fn what_is_no_parabola_is_met_at_three_places() {
    // A whole wave looks like nothing at all from there: the certificate must find it.
    let (_, curve) = fit(|t| tip(t * (1.0 - t) * (t - 0.5)));
    assert_eq!(curve.tip_peak, 0.0);
}

#[test]
fn a_deviation_that_is_no_number_is_refused() {
    let mut model = Parabolic::open(&[]).unwrap();
    let refused = model.fit(&TOLERANCE, &mut |_, out| out[2].axis[0] = f64::NAN);
    assert_eq!(refused.unwrap_err(), "the deviation at 1 of the move is not a finite number");
}
