//! NX's `NURBS`: a cubic B-spline with clamped ends, written as its interior knots (the last is 1) and its
//! control points but for the first, which is where the tool stands.

use nalgebra::Vector3;
use post_motion::path::BSpline;

/// Degree of the splines that NX writes.
const DEGREE: usize = 3;

/// A clamped cubic B-spline over 0 to 1 from the knots of the file (interior ones and the last) and all control points.
///
/// # Errors
/// What does not fit.
pub(crate) fn nx_spline(knots: &[f64], points: &[Vector3<f64>]) -> Result<BSpline, String> {
    let interior = match knots {
        [interior @ .., last] if *last == 1.0 => interior,
        _ => return Err("its last knot must be 1".to_owned()),
    };
    // A knot that stands three times breaks the second derivative that bounds the chords.
    let rising = interior.windows(2).all(|pair| pair[0] <= pair[1])
        && interior.windows(3).all(|triple| triple[0] < triple[2])
        && interior.iter().all(|knot| 0.0 < *knot && *knot < 1.0);
    if !rising {
        return Err("its knots must rise from 0 to 1, none more than twice".to_owned());
    }
    let wanted = interior.len() + DEGREE + 1;
    if points.len() != wanted {
        return Err(format!(
            "{} interior knots of a cubic spline need {wanted} control points (the present position is the first); there are {}",
            interior.len(),
            points.len()
        ));
    }
    let mut all = vec![0.0; DEGREE + 1];
    all.extend_from_slice(interior);
    all.extend_from_slice(&[1.0; DEGREE + 1]);
    Ok(BSpline::unweighted(DEGREE, all, points.iter().copied()))
}

/// The spline with the same control points and other knots; none where these do not follow one another as its own do.
pub(crate) fn over(spline: BSpline, knots: Vec<f64>) -> Option<BSpline> {
    let rises =
        |knots: &[f64]| -> Vec<bool> { knots.windows(2).map(|pair| pair[0] < pair[1]).collect() };
    (rises(&knots) == rises(&spline.knots)).then_some(BSpline { knots, ..spline })
}

/// Splits a cubic spline into cubics, each over one knot span from its start to its end: their control points (Bézier), in
/// order. In the hull of its four points each of them lies.
pub(crate) fn cubics(spline: &BSpline) -> impl Iterator<Item = [Vector3<f64>; DEGREE + 1]> {
    spline.spans().map(|span| {
        let (from, to) = (spline.knots[span], spline.knots[span + 1]);
        // The blossom at the start so often, and at the end else.
        [0, 1, 2, 3]
            .map(|count| spline.blossom(span, |level| if level < count { to } else { from }))
    })
}

/// How many chords [`flatten`] makes; none if they cannot be counted.
pub(crate) fn chords(spline: &BSpline, tolerance: f64) -> Option<u64> {
    let chords: f64 = spline.spans().map(|span| count(spline, span, tolerance).0).sum();
    (chords < 1e15).then_some(chords as u64)
}

/// Chords of one knot span, and the bound on its second derivative times the square of its width, mm. No number if the
/// knots lie so close that there is none.
fn count(spline: &BSpline, span: usize, tolerance: f64) -> (f64, f64) {
    let (from, to) = (spline.knots[span], spline.knots[span + 1]);
    let width = to - from;
    let ends = [from, to].map(|end| spline.derivatives_on(span, end)[2].norm());
    // `max` would take what is no number for the other.
    let bend = match ends.iter().any(|bend| bend.is_nan()) {
        true => f64::NAN,
        false => ends[0].max(ends[1]) * width * width,
    };
    let count = libm::ceil(libm::sqrt(bend / (8.0 * tolerance)));
    (if count < 1.0 { 1.0 } else { count }, bend)
}

/// A chord of a spline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SplineChord {
    /// Where it ends: the parameter, and the span that this lies in.
    pub at: f64,
    pub span: usize,
    /// The point there, mm.
    pub end: Vector3<f64>,
    /// How far it strays from the spline at most, mm.
    pub stray: f64,
}

/// Calls `emit` with chords that stay within `tolerance` mm, in order.
///
/// In one knot span of a cubic the second derivative is linear, so it is largest at an end of the span, and a chord over
/// `h` of the parameter strays by at most `h²/8` times that.
pub(crate) fn flatten(spline: &BSpline, tolerance: f64, emit: &mut dyn FnMut(SplineChord)) {
    for span in spline.spans() {
        let (from, to) = (spline.knots[span], spline.knots[span + 1]);
        let (count, bend) = count(spline, span, tolerance);
        let stray = bend / (8.0 * count * count);
        for piece in 1..=count as u64 {
            let at = from + (to - from) * piece as f64 / count;
            let end = spline.blossom(span, |_| at);
            emit(SplineChord { span, at, end, stray });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave() -> BSpline {
        let points: Vec<_> = [0.0, 3.0, -2.0, 5.0, 1.0, 4.0, 2.0]
            .iter()
            .enumerate()
            .map(|(index, y)| Vector3::new(index as f64 * 5.0, *y * 4.0, 0.3 * index as f64))
            .collect();
        nx_spline(&[0.2, 0.5, 0.6, 1.0], &points).unwrap()
    }

    #[test]
    fn a_cubic_polynomial_is_reproduced() {
        // Without interior knots the spline is the Bézier curve of its points.
        let points = vec![
            Vector3::new(0.0, 0.0, 0.0),
            Vector3::new(1.0, 2.0, 0.0),
            Vector3::new(3.0, 2.0, 1.0),
            Vector3::new(4.0, 0.0, 1.0),
        ];
        let spline = nx_spline(&[1.0], &points).unwrap();
        for step in 0..=10 {
            let t = f64::from(step) / 10.0;
            let s = 1.0 - t;
            let bezier = points[0] * (s * s * s)
                + points[1] * (3.0 * s * s * t)
                + points[2] * (3.0 * s * t * t)
                + points[3] * (t * t * t);
            assert!((spline.point(t) - bezier).norm() < 1e-12);
        }
    }

    #[test]
    fn chords_stay_within_what_they_promise_and_end_on_the_last_point() {
        let spline = wave();
        for tolerance in [1.0, 0.01, 0.001] {
            let mut ends = vec![(spline.poles[0].0, 0.0)];
            flatten(&spline, tolerance, &mut |chord| ends.push((chord.end, chord.stray)));
            assert!(ends.iter().all(|(_, stray)| *stray <= tolerance));
            assert!((ends[ends.len() - 1].0 - spline.poles[6].0).norm() < 1e-12);
            // Every point of a fine sampling lies within the tolerance of some chord.
            for step in 0..1000 {
                let u = f64::from(step) / 1000.0;
                let point = spline.point(u);
                let nearest = ends
                    .windows(2)
                    .map(|pair| {
                        let (a, b) = (pair[0].0, pair[1].0);
                        let along =
                            ((point - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                        (point - a - (b - a) * along).norm()
                    })
                    .fold(f64::INFINITY, f64::min);
                assert!(nearest <= tolerance, "{nearest} at {u}");
            }
        }
    }

    #[test]
    fn chords_are_counted_before_they_are_made() {
        for tolerance in [1.0, 0.01, 0.001] {
            let mut made = 0;
            flatten(&wave(), tolerance, &mut |_| made += 1);
            assert_eq!(chords(&wave(), tolerance), Some(made));
        }
        let points = vec![Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z(), Vector3::x()];
        for knot in [1e-300, 1e-320, 1e-200] {
            let spline = nx_spline(&[knot, 1.0], &points).unwrap();
            assert_eq!(chords(&spline, 0.001), None, "{knot}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(nx_spline(&[0.5], &[]).is_err());
        assert!(nx_spline(&[0.6, 0.4, 1.0], &[Vector3::zeros(); 6]).is_err());
        let fault = nx_spline(&[0.5, 1.0], &[Vector3::zeros(); 4]).unwrap_err();
        assert!(fault.contains("need 5 control points"), "{fault}");
    }
}
