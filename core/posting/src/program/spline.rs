//! NX's `NURBS`: a cubic B-spline with clamped ends, written as its interior knots (the last is 1) and its
//! control points but for the first, which is where the tool stands.

use nalgebra::Vector3;

/// Degree of the splines that NX writes.
const DEGREE: usize = 3;

/// A clamped cubic B-spline.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    knots: Vec<f64>,
    points: Vec<Vector3<f64>>,
}

impl BSpline {
    /// A spline over 0 to 1 from the knots of the file (interior ones and the last) and all control points.
    ///
    /// # Errors
    /// What does not fit.
    pub fn new(knots: &[f64], points: Vec<Vector3<f64>>) -> Result<Self, String> {
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
        Ok(Self { knots: all, points })
    }

    /// Places the spline elsewhere: `shift` takes points, by a rotation and a shift.
    pub fn placed(mut self, shift: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Self {
        for point in &mut self.points {
            *point = shift(*point);
        }
        self
    }

    /// Makes a spline with the same knots and other control points.
    pub(crate) fn about(&self, points: Vec<Vector3<f64>>) -> Self {
        debug_assert_eq!(points.len(), self.points.len());
        Self { knots: self.knots.clone(), points }
    }

    /// All of its knots.
    pub(crate) fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Makes a spline with the same control points and other knots; none where these do not follow one another as its
    /// own do.
    pub(crate) fn over(&self, knots: Vec<f64>) -> Option<Self> {
        let rises = |knots: &[f64]| -> Vec<bool> {
            knots.windows(2).map(|pair| pair[0] < pair[1]).collect()
        };
        (rises(&knots) == rises(&self.knots)).then(|| Self { knots, points: self.points.clone() })
    }

    /// Control points of the spline.
    pub(crate) fn points(&self) -> &[Vector3<f64>] {
        &self.points
    }

    /// Splits it into cubics, each over one knot span from its start to its end: their control points (Bézier), in
    /// order. In the hull of its four points each of them lies.
    pub(crate) fn cubics(&self) -> impl Iterator<Item = [Vector3<f64>; DEGREE + 1]> {
        (DEGREE..self.points.len()).filter(|span| self.knots[span + 1] > self.knots[*span]).map(
            |span| {
                let (from, to) = (self.knots[span], self.knots[span + 1]);
                // The blossom at the start so often, and at the end else.
                [0, 1, 2, 3].map(|count| {
                    self.blossom(
                        span,
                        std::array::from_fn(|level| if level < count { to } else { from }),
                    )
                })
            },
        )
    }

    /// Where it begins.
    pub fn start(&self) -> Vector3<f64> {
        self.points.first().copied().unwrap_or_default()
    }

    /// Where it ends.
    pub fn end(&self) -> Vector3<f64> {
        self.points.last().copied().unwrap_or_default()
    }

    /// How many chords [`BSpline::flatten`] makes; none if they cannot be counted.
    pub fn chords(&self, tolerance: f64) -> Option<u64> {
        let mut chords = 0.0;
        for span in DEGREE..self.points.len() {
            if self.knots[span + 1] > self.knots[span] {
                chords += self.count(span, tolerance).0;
            }
        }
        (chords < 1e15).then_some(chords as u64)
    }

    /// Chords of one knot span, and the bound on its second derivative times the square of its width, mm. No number
    /// if the knots lie so close that there is none.
    fn count(&self, span: usize, tolerance: f64) -> (f64, f64) {
        let (from, to) = (self.knots[span], self.knots[span + 1]);
        let width = to - from;
        let ends = [from, to].map(|end| self.second(span, end).norm());
        // `max` would take what is no number for the other.
        let bend = match ends.iter().any(|bend| bend.is_nan()) {
            true => f64::NAN,
            false => ends[0].max(ends[1]) * width * width,
        };
        let count = libm::ceil(libm::sqrt(bend / (8.0 * tolerance)));
        (if count < 1.0 { 1.0 } else { count }, bend)
    }

    /// Calls `emit` with the ends of chords that stay within `tolerance` mm, and how far each strays.
    ///
    /// In one knot span the second derivative is linear, so it is largest at an end of the span, and a chord
    /// over `h` of the parameter strays by at most `h²/8` times that.
    pub fn flatten(&self, tolerance: f64, emit: &mut dyn FnMut(Vector3<f64>, f64)) {
        for span in DEGREE..self.points.len() {
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if to <= from {
                continue;
            }
            let width = to - from;
            let (count, bend) = self.count(span, tolerance);
            let stray = bend / (8.0 * count * count);
            for piece in 1..=count as u64 {
                emit(self.at(span, from + width * piece as f64 / count), stray);
            }
        }
    }

    /// The point at `u` in the knot span `span`.
    fn at(&self, span: usize, u: f64) -> Vector3<f64> {
        self.blossom(span, [u; DEGREE])
    }

    /// Blossom in the knot span `span` (de Boor, each level with a place of its own).
    fn blossom(&self, span: usize, places: [f64; DEGREE]) -> Vector3<f64> {
        let mut work = [Vector3::zeros(); DEGREE + 1];
        work.copy_from_slice(&self.points[span - DEGREE..=span]);
        for level in 1..=DEGREE {
            for index in (level..=DEGREE).rev() {
                let knot = span - DEGREE + index;
                let low = self.knots[knot];
                let high = self.knots[knot + DEGREE + 1 - level];
                let alpha = (places[level - 1] - low) / (high - low);
                work[index] = work[index - 1] * (1.0 - alpha) + work[index] * alpha;
            }
        }
        work[DEGREE]
    }

    /// The second derivative at `u` in the knot span `span`.
    fn second(&self, span: usize, u: f64) -> Vector3<f64> {
        let first = |index: usize| {
            let width = self.knots[index + DEGREE + 1] - self.knots[index + 1];
            (self.points[index + 1] - self.points[index]) * (DEGREE as f64 / width)
        };
        let second = |index: usize| {
            let width = self.knots[index + DEGREE + 1] - self.knots[index + 2];
            (first(index + 1) - first(index)) * ((DEGREE - 1) as f64 / width)
        };
        let (a, b) = (second(span - DEGREE), second(span - DEGREE + 1));
        let alpha = (u - self.knots[span]) / (self.knots[span + 1] - self.knots[span]);
        a * (1.0 - alpha) + b * alpha
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave() -> BSpline {
        let points = [0.0, 3.0, -2.0, 5.0, 1.0, 4.0, 2.0]
            .iter()
            .enumerate()
            .map(|(index, y)| Vector3::new(index as f64 * 5.0, *y * 4.0, 0.3 * index as f64))
            .collect();
        BSpline::new(&[0.2, 0.5, 0.6, 1.0], points).unwrap()
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
        let spline = BSpline::new(&[1.0], points.clone()).unwrap();
        for step in 0..=10 {
            let t = f64::from(step) / 10.0;
            let s = 1.0 - t;
            let bezier = points[0] * (s * s * s)
                + points[1] * (3.0 * s * s * t)
                + points[2] * (3.0 * s * t * t)
                + points[3] * (t * t * t);
            assert!((spline.at(DEGREE, t) - bezier).norm() < 1e-12);
        }
    }

    #[test]
    fn chords_stay_within_what_they_promise_and_end_on_the_last_point() {
        let spline = wave();
        for tolerance in [1.0, 0.01, 0.001] {
            let mut ends = vec![(spline.points[0], 0.0)];
            spline.flatten(tolerance, &mut |point, stray| ends.push((point, stray)));
            assert!(ends.iter().all(|(_, stray)| *stray <= tolerance));
            assert!((ends[ends.len() - 1].0 - spline.points[6]).norm() < 1e-12);
            // Every point of a fine sampling lies within the tolerance of some chord.
            for step in 0..1000 {
                let u = f64::from(step) / 1000.0;
                let span =
                    (DEGREE..spline.points.len()).find(|span| u < spline.knots[span + 1]).unwrap();
                let point = spline.at(span, u);
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
            wave().flatten(tolerance, &mut |_, _| made += 1);
            assert_eq!(wave().chords(tolerance), Some(made));
        }
        let points = vec![Vector3::zeros(), Vector3::x(), Vector3::y(), Vector3::z(), Vector3::x()];
        for knot in [1e-300, 1e-320, 1e-200] {
            let spline = BSpline::new(&[knot, 1.0], points.clone()).unwrap();
            assert_eq!(spline.chords(0.001), None, "{knot}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert!(BSpline::new(&[0.5], vec![]).is_err());
        assert!(BSpline::new(&[0.6, 0.4, 1.0], vec![Vector3::zeros(); 6]).is_err());
        let fault = BSpline::new(&[0.5, 1.0], vec![Vector3::zeros(); 4]).unwrap_err();
        assert!(fault.contains("need 5 control points"), "{fault}");
    }
}
