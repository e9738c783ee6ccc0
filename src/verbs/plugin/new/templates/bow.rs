//! A bow of known peak, as a rotary axis makes it.

use post_NAME::Parabolic;
use post_plugin::{Deviation, ErrorModel, Tolerance};

/// Of the tip, mm.
const PEAK: f64 = 0.02;

#[test]
fn the_peak_of_a_bow_is_found() {
    let mut model = Parabolic::open(&[]).unwrap();
    let bow = |t: f64| Deviation { tip: [PEAK * 4.0 * t * (1.0 - t), 0.0, 0.0], axis: [0.0; 3] };
    let tolerance = Tolerance { tip: 0.005, axis: 0.05 };
    let curve = model.fit(&tolerance, &mut |ts, out| {
        for (t, out) in ts.iter().zip(out) {
            *out = bow(*t);
        }
    });
    let curve = curve.unwrap();
    assert!((curve.tip_peak - PEAK).abs() < 1e-9, "{} mm", curve.tip_peak);
    assert!((curve.tip_at - 0.5).abs() < 1e-3, "at t = {}", curve.tip_at);
}
