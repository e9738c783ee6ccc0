//! Splines by control points.

use post_plugin::{Feed, Group, quantise};

use crate::motion::MotionWriter;
use crate::table::SplineForm;

/// A spline, as [`Event::Spline`](post_plugin::Event::Spline) has it.
#[derive(Clone, Copy, Debug)]
pub struct SplineWords<'a> {
    /// Degree.
    pub degree: u32,
    /// Knots, as many as control points and degree and one more.
    pub knots: &'a [f64],
    /// A weight for each control point.
    pub weights: &'a [f64],
    /// All axis words of each control point.
    pub points: &'a [f64],
}

impl MotionWriter {
    /// A spline from where the tool stands, its first control point.
    ///
    /// # Errors
    /// If the control cannot be told it.
    pub fn spline(
        &mut self,
        words: SplineForm,
        spline: &SplineWords<'_>,
        feed: Feed,
        out: &mut String,
    ) -> Result<(), String> {
        let width = self.axes.decimals().len();
        let points: Vec<&[f64]> = spline.points.chunks(width.max(1)).collect();
        let (order, count) = (spline.degree as usize + 1, points.len());
        if count < order || spline.weights.len() != count || spline.knots.len() != count + order {
            return Err("a spline whose control points, weights and knots do not fit".to_owned());
        }
        let from = points.first().copied().unwrap_or_default();
        if !self.stands_at(from) {
            return Err("a spline that does not begin where the tool stands".to_owned());
        }
        if self.is_compensating() {
            return Err("a spline under cutter compensation".to_owned());
        }
        match words {
            SplineForm::None => return Err("this control has no splines".to_owned()),
            SplineForm::Knots { code, begin, end } => {
                self.knots_spline([code, begin, end], spline, &points, feed, out)?;
            }
            SplineForm::Even { code, end } => {
                self.even_spline([code, end], spline, &points, feed, out)?;
            }
        }
        self.forget_motion();
        self.forget_linear();
        if let Some(last) = points.last() {
            self.stands(last);
        }
        Ok(())
    }

    /// Writes a spline by control points with knots (K) and weights (R).
    fn knots_spline(
        &mut self,
        [code, begin, end]: [&'static str; 3],
        spline: &SplineWords<'_>,
        points: &[&[f64]],
        feed: Feed,
        out: &mut String,
    ) -> Result<(), String> {
        let (order, count) = (spline.degree as usize + 1, points.len());
        if !(2..=4).contains(&order) {
            return Err(format!(
                "a spline of degree {}, and this control has degrees 1 to 3",
                spline.degree
            ));
        }
        let places = self.linear_decimals(0);
        let numbers = spline.knots.iter().chain(spline.weights);
        if let Some(number) =
            numbers.into_iter().find(|number| (quantise(**number, places) - **number).abs() > 1e-9)
        {
            return Err(format!(
                "the knot or weight {number} of a spline has more than {places} decimals, as many as this control reads"
            ));
        }
        self.plane_xy();
        self.block.end(out);
        self.line(begin, out);
        self.feed_mode(feed);
        self.motion(code);
        self.block.integer("P", order as u32);
        for ((point, weight), knot) in points.iter().zip(spline.weights).zip(spline.knots) {
            self.block.number("K", *knot, places, self.style);
            self.write_point(point);
            self.block.number("R", *weight, places, self.style);
            self.feed(feed);
            self.block.end(out);
        }
        for knot in spline.knots.iter().skip(count) {
            self.block.number("K", *knot, places, self.style);
            self.block.end(out);
        }
        self.line(end, out);
        Ok(())
    }

    /// Writes a spline by control points in X and Y with weights (P), of even knots.
    fn even_spline(
        &mut self,
        [code, end]: [&'static str; 2],
        spline: &SplineWords<'_>,
        points: &[&[f64]],
        feed: Feed,
        out: &mut String,
    ) -> Result<(), String> {
        let order = spline.degree as usize + 1;
        let from = points.first().copied().unwrap_or_default();
        if !is_even(spline.knots, order) {
            return Err("a spline with uneven knots, which this control has not".to_owned());
        }
        let plane = self.linear[2].map(|z| from[z]);
        let level = |point: &&[f64]| self.linear[2].map(|z| point[z]) == plane;
        if !points.iter().all(level) {
            return Err("a spline that leaves the plane of X and Y".to_owned());
        }
        self.plane_xy();
        self.feed_mode(feed);
        self.motion(code);
        let (first, rest) = spline.weights.split_at(1);
        for ((point, weight), line) in points.iter().skip(1).zip(rest).zip(0..) {
            self.axes.forget();
            self.axes.write_group(&mut self.block, point, Group::Plane);
            if line == 0 {
                self.block.integer("L", order as u32);
                if first != [1.0] {
                    return Err("a spline whose first weight is not 1, which this control has not"
                        .to_owned());
                }
            }
            self.block.number("P", *weight, 6, self.style);
            self.feed(feed);
            self.block.end(out);
        }
        self.line(end, out);
        Ok(())
    }

    /// The linear words of a control point, each of them.
    fn write_point(&mut self, point: &[f64]) {
        self.forget_linear();
        for group in [Group::Plane, Group::Depth] {
            self.axes.write_group(&mut self.block, point, group);
        }
    }
}

/// Knots as often as the order at both ends, and the same step between all others.
fn is_even(knots: &[f64], order: usize) -> bool {
    let inner = &knots[order - 1..=knots.len() - order];
    let [first, last] = [knots[0], knots[knots.len() - 1]];
    let ends = knots[..order].iter().all(|knot| *knot == first)
        && knots[knots.len() - order..].iter().all(|knot| *knot == last);
    let step = (last - first) / (inner.len() - 1) as f64;
    let mut pairs = inner.windows(2);
    ends && step > 0.0 && pairs.all(|pair| (pair[1] - pair[0] - step).abs() < 1e-9 * step)
}
