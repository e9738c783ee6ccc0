//! Splines by control points, gathered over blocks: with knots of their own (`G6.2`), or with even ones (`G5.2`).

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Language;

use super::block_words::{BlockWords, bit};
use super::go::MotionTarget;
use super::state::{ControlState, FeedMeaning, MotionMode};
use crate::g_code::GCode;
use crate::{BSpline, Curve, MotionKind, Stance};

/// Control points with knots K and weights R; P is the order.
const KNOTS: GCode = GCode::with_tenth(6, 2);

/// Control points in the plane with weights P; L is the order.
const EVEN: GCode = GCode::with_tenth(5, 2);

/// Ends one with even knots.
const EVEN_ENDS: GCode = GCode::with_tenth(5, 3);

/// Order where the program states none.
const ORDER_OF_KNOTS: u32 = 4;
const ORDER_OF_EVEN: u32 = 3;

/// The first control point is where the tool stands, but for rounding, mm.
const STANDS: f64 = 0.002;

/// Most control points of a spline.
const MOST_POLES: usize = 1_000_000;

/// Words of a spline so far.
#[derive(Clone, Debug, Default)]
pub(super) struct OpenSpline {
    even: bool,
    order: usize,
    /// Control points in the coordinates of the program, mm, and their weights.
    poles: Vec<(Vector3<f64>, f64)>,
    knots: Vec<f64>,
}

impl OpenSpline {
    /// Whether the spline has all its knots.
    fn complete(&self) -> bool {
        !self.even && !self.poles.is_empty() && self.knots.len() == self.poles.len() + self.order
    }

    /// The curve, in the coordinates of the program.
    fn way(self) -> BSpline {
        let Self { even, order, poles, mut knots } = self;
        if even {
            let spans = poles.len().saturating_sub(order) + 1;
            let last = poles.len().saturating_sub(1) + order;
            // As often as the order at both ends, one more for each span between.
            let even = (0..=last).map(|place| place.saturating_sub(order - 1).min(spans) as f64);
            knots = even.collect();
        }
        BSpline { degree: order.saturating_sub(1), knots, poles }
    }
}

impl ControlState {
    /// A word of splines: the block begins one, or goes on with it.
    pub(super) fn spline_word(&mut self, code: Option<GCode>) -> Result<(), Box<Diagnostic>> {
        let even = match (code, self.lexicon.language()) {
            (Some(KNOTS), Language::Macro) => false,
            (Some(EVEN), Language::Rs274) => true,
            _ => return Err(self.not_followed(code)),
        };
        if self.modal.incremental {
            return Err(self.refuse("nc-spline", "a spline under G91 is not run"));
        }
        self.motion(MotionMode::Spline);
        let spline = self
            .spline
            .get_or_insert_with(|| Box::new(OpenSpline { even, ..OpenSpline::default() }));
        match spline.even == even {
            true => Ok(()),
            false => Err(self.not_followed(code)),
        }
    }

    /// Ends the spline, or refuses the block: beside the words of a spline that is not at its end nothing else stands.
    pub(super) fn within_spline(&mut self, words: &BlockWords) -> Result<(), Box<Diagnostic>> {
        let Some(spline) = &self.spline else {
            return Ok(());
        };
        let own = match spline.even {
            true => EVEN,
            false => KNOTS,
        };
        let codes = words.g.list();
        if spline.even && codes == [EVEN_ENDS] {
            return self.end_spline();
        }
        let begins = codes.contains(&own);
        let alone = codes.iter().all(|code| *code == own) && words.m.list().is_empty();
        // The block that begins it may say what is modal too.
        if alone || begins && spline.poles.is_empty() {
            return Ok(());
        }
        self.spline = None;
        Err(self.refuse("nc-spline", "a spline is not at its end, and this is no part of it"))
    }

    /// A block of a spline.
    pub(super) fn spline_block(&mut self, words: &mut BlockWords) -> Result<(), Box<Diagnostic>> {
        let Some(mut spline) = self.spline.take() else {
            let message = "words of a spline behind its last knot, and none begins here";
            return Err(self.refuse("nc-spline", message));
        };
        if self.modal.feed_mode == FeedMeaning::Inverse {
            return Err(self.refuse("nc-feed", "a spline under inverse time is not run"));
        }
        let linear = bit(b'X') | bit(b'Y') | bit(b'Z');
        let others = words.present & self.axes.mask & !linear;
        if others != 0 || words.vector.is_some() || words.named_axes != 0 {
            return Err(self.refuse("nc-spline", "an axis besides X, Y and Z goes along a spline"));
        }
        if words.incremental != 0 {
            return Err(self.refuse("nc-spline", "a control point by ways is not run"));
        }
        let begins = spline.order == 0;
        match spline.even {
            true => self.even_point(&mut spline, begins, words)?,
            false => self.knot_point(&mut spline, begins, words)?,
        }
        if spline.poles.len() > MOST_POLES {
            return Err(self.refuse("nc-spline", "a spline of more than a million points"));
        }
        let complete = spline.complete();
        self.spline = Some(spline);
        match complete {
            true => self.end_spline(),
            false => Ok(()),
        }
    }

    /// `G6.2 P4 K0 X Y Z R1`, `K0 X Y Z`, and after the last point as many blocks with K alone as the order.
    fn knot_point(
        &mut self,
        spline: &mut OpenSpline,
        begins: bool,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        if begins {
            let order = words.take_number(b'P', self)?.unwrap_or(ORDER_OF_KNOTS);
            if !(2..=4).contains(&order) {
                let message = format!("a spline of order {order}, and those of 2 to 4 are run");
                return Err(self.refuse("nc-spline", message));
            }
            spline.order = order as usize;
        }
        let Some(knot) = words.take(b'K') else {
            return Err(self.refuse("nc-spline", "a block of a spline without its knot K"));
        };
        spline.knots.push(knot);
        let point = self.spline_point(spline, words);
        let weight = words.take(b'R');
        let points = spline.poles.len();
        match point {
            Some(_) if spline.knots.len() != points + 1 => {
                let message = "a control point of a spline behind the first of its last knots";
                Err(self.refuse("nc-spline", message))
            }
            Some(point) => self.pole(spline, point, weight.unwrap_or(1.0)),
            None if weight.is_some() => {
                Err(self.refuse("nc-spline", "a weight of a spline without its control point"))
            }
            None => Ok(()),
        }
    }

    /// `G5.2 X Y P1 L3`, `X Y P1`: the first control point is where the tool stands, and P alone its weight.
    fn even_point(
        &mut self,
        spline: &mut OpenSpline,
        begins: bool,
        words: &mut BlockWords,
    ) -> Result<(), Box<Diagnostic>> {
        let point = self.spline_point(spline, words);
        let weight = words.take(b'P');
        if begins {
            let order = words.take_number(b'L', self)?.unwrap_or(ORDER_OF_EVEN);
            if !(ORDER_OF_EVEN..=10).contains(&order) {
                let message = format!("a spline of order {order}, and those of 3 to 10 are run");
                return Err(self.refuse("nc-spline", message));
            }
            spline.order = order as usize;
            let first = match point {
                Some(_) => 1.0,
                None => weight.unwrap_or(1.0),
            };
            let from = self.point();
            self.pole(spline, from, first)?;
        }
        if words.present & bit(b'Z') != 0 {
            return Err(self.refuse("nc-spline", "G5.2 stays in the plane of X and Y"));
        }
        match (point, weight) {
            (Some(point), Some(weight)) => self.pole(spline, point, weight),
            (Some(_), None) => {
                Err(self.refuse("nc-spline", "a control point of G5.2 without its weight P"))
            }
            (None, _) if begins => Ok(()),
            (None, _) => Err(self.refuse("nc-spline", "a block of G5.2 without X and Y")),
        }
    }

    fn pole(
        &self,
        spline: &mut OpenSpline,
        point: Vector3<f64>,
        weight: f64,
    ) -> Result<(), Box<Diagnostic>> {
        if weight <= 0.0 {
            let message = format!("a control point of a spline with the weight {weight}");
            return Err(self.refuse("nc-spline", message));
        }
        spline.poles.push((point, weight));
        Ok(())
    }

    /// The control point that a block says, what it leaves out as that of the one before; none if it says nothing.
    fn spline_point(&self, spline: &OpenSpline, words: &mut BlockWords) -> Option<Vector3<f64>> {
        let unit = self.modal.unit;
        let said = [b'X', b'Y', b'Z'].map(|letter| words.take(letter));
        if said.iter().all(Option::is_none) {
            return None;
        }
        let last = spline.poles.last().map_or_else(|| self.point(), |last| last.0);
        Some(Vector3::from_fn(|row, _| said[row].map_or(last[row], |value| value * unit)))
    }

    /// Goes along the spline that was told.
    fn end_spline(&mut self) -> Result<(), Box<Diagnostic>> {
        let Some(spline) = self.spline.take() else {
            return Ok(());
        };
        self.modal.motion = MotionMode::None;
        let mut way = spline.way();
        if !way.is_sound() {
            let message = format!(
                "{} control points and {} knots are no spline of degree {}",
                way.poles.len(),
                way.knots.len(),
                way.degree
            );
            return Err(self.refuse("nc-spline", message));
        }
        let (from, last) = (self.point(), way.poles[way.poles.len() - 1].0);
        let off = (way.poles[0].0 - from).norm();
        if off > STANDS {
            let message = format!("a spline begins {off:.4} mm from where the tool stands");
            return Err(self.refuse("nc-spline", message));
        }
        way.poles[0].0 = from;
        let order = way.degree + 1;
        let ends = [&way.knots[..order], &way.knots[way.knots.len() - order..]];
        if !ends.iter().all(|knots| knots.iter().all(|knot| *knot == knots[0])) {
            let message = "a spline that does not begin and end in its first and last control point, its knots there as many as the order, is not run";
            return Err(self.refuse("nc-spline", message));
        }
        let path = Curve::Spline(Arc::new(way));
        self.go(MotionKind::Feed, &path, &MotionTarget::point(last))
    }

    /// A spline of the program's coordinates as one of the part frame. Positions of axes lie as the axes do, and the
    /// rotary ones stand still: seen from the part they are turned, and what is turned is a spline of turned points.
    pub(super) fn spline_way(&self, from: &Stance, way: &BSpline) -> Curve {
        let mut way = way.clone();
        if self.tip_words() {
            for (pole, _) in &mut way.poles {
                *pole = self.to_part.out(*pole);
            }
            return Curve::Spline(Arc::new(way));
        }
        let chain = self.state.solver.chain();
        let start = way.poles[0].0;
        let ways = self.axes.cartesian.map(|place| {
            place.map_or_else(Vector3::zeros, |place| chain.way_of(place, &from.joints))
        });
        for (pole, _) in &mut way.poles {
            let offset = self.to_work.out_direction(*pole - start);
            *pole = from.pose.tip + ways[0] * offset.x + ways[1] * offset.y + ways[2] * offset.z;
        }
        Curve::Spline(Arc::new(way))
    }
}
