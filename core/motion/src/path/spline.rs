//! Points of rational B-splines.

use nalgebra::{Vector3, Vector4};

/// The highest degree that is evaluated.
const MOST_DEGREE: usize = 9;

/// Pieces whose chords are added up, for each span of the knots.
const CHORDS: u32 = 64;

/// A rational B-spline.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as poles + degree + 1.
    pub knots: Vec<f64>,
    /// Poles, mm, part frame, and their weights.
    pub poles: Vec<(Vector3<f64>, f64)>,
}

impl BSpline {
    /// Whether it can be evaluated: the degree is from 1 to 9, the knots never fall and are as many as poles + degree +
    /// 1, and its weights lie above zero.
    pub fn is_sound(&self) -> bool {
        let rises = self.knots.windows(2).all(|pair| pair[0] <= pair[1]);
        let [first, last] = self.range();
        (1..=MOST_DEGREE).contains(&self.degree)
            && self.poles.len() > self.degree
            && self.knots.len() == self.poles.len() + self.degree + 1
            && rises
            && first < last
            && self.poles.iter().all(|(_, weight)| *weight > 0.0)
    }

    /// The parameters that it begins and ends with.
    pub fn range(&self) -> [f64; 2] {
        let knot = |place: usize| self.knots.get(place).copied().unwrap_or_default();
        [knot(self.degree), knot(self.poles.len())]
    }

    /// The spans of its knots that are not empty, in order: place of the first knot.
    pub fn spans(&self) -> impl Iterator<Item = usize> + '_ {
        (self.degree..self.poles.len()).filter(|place| self.knots[*place] < self.knots[place + 1])
    }

    /// Length, mm, by chords of each span: too short by less than a thousandth.
    pub fn length(&self) -> f64 {
        let mut length = 0.0;
        for span in self.spans() {
            let (low, high) = (self.knots[span], self.knots[span + 1]);
            let mut last = self.point(low);
            for piece in 1..=CHORDS {
                let u = low + (high - low) * f64::from(piece) / f64::from(CHORDS);
                let next = self.point(u);
                length += (next - last).norm();
                last = next;
            }
        }
        length
    }

    /// The point at a share of its range, from 0 to 1.
    pub fn at(&self, share: f64) -> Vector3<f64> {
        let [first, last] = self.range();
        self.point(first + (last - first) * share.clamp(0.0, 1.0))
    }

    /// The point at the parameter `u`, by de Boor's rule on poles times weights.
    pub fn point(&self, u: f64) -> Vector3<f64> {
        let degree = self.degree;
        // The last span that begins at or before u, and is not empty.
        let span = self.knots[degree..self.poles.len()].partition_point(|knot| *knot <= u);
        let span = (degree + span).saturating_sub(1).max(degree);
        let mut work = [Vector4::zeros(); MOST_DEGREE + 1];
        for (place, (pole, weight)) in self.poles[span - degree..=span].iter().enumerate() {
            work[place] = (pole * *weight).push(*weight);
        }
        for level in 1..=degree {
            for place in (level..=degree).rev() {
                let knot = span - degree + place;
                let (low, high) = (self.knots[knot], self.knots[knot + degree + 1 - level]);
                let share = match high > low {
                    true => (u - low) / (high - low),
                    false => 0.0,
                };
                work[place] = work[place - 1] * (1.0 - share) + work[place] * share;
            }
        }
        let end = work[degree];
        end.xyz() / end.w
    }
}
