//! `CIRCLE` and `NURBS`.

use std::f64::consts::TAU;
use std::sync::Arc;

use nalgebra::Vector3;
use post_grammar::{ArcMove, CircleRecord, Record, Sense, Statement};
use post_machine::kinematics::Pose;

use super::modal::{ClModal, CourseItems, RecordResult};
use crate::BSpline;
use crate::course::Curve;

/// Ends of an arc nearer than this are one point, and the arc a whole turn: mm.
pub(super) const CLOSED: f64 = 1e-3;

/// Ends of an arc whose distances from its axis differ by more are no arc: mm.
pub(super) const NO_ARC: f64 = 0.1;

/// More knots or poles than this stand in no file: a spline is held in memory until it ends.
const MOST_NUMBERS: usize = 1_000_000;

/// A curve that is not complete.
#[derive(Clone, Debug)]
pub(super) enum OpenCurve {
    Arc(CircleRecord),
    Turned(ArcMove),
    Spline {
        /// Knots between the ends, and the last.
        knots: Vec<f64>,
        /// Poles, part frame; the first is where the tool stands.
        poles: Vec<Vector3<f64>>,
    },
}

impl ClModal {
    pub(super) fn curve_word(
        &mut self,
        record: &Record<'_>,
        out: &mut CourseItems,
    ) -> RecordResult {
        let faulty = |message: &str| Err(message.to_owned());
        let point = match &record.statement {
            Statement::Control { point, .. } => {
                Some(self.frames.point(self.file_point(record, *point)?))
            }
            _ => None,
        };
        let done = match (&record.statement, &mut self.pending) {
            (
                Statement::Circle(_) | Statement::ArcMove(_),
                Some(OpenCurve::Arc(_) | OpenCurve::Turned(_)),
            ) => faulty("the arc before this one is not ended by a point"),
            (Statement::ArcMove(arc), _) => {
                self.end_spline(record, out)?;
                self.pending = Some(OpenCurve::Turned(*arc));
                Ok(())
            }
            (Statement::Circle(circle), _) => {
                self.end_spline(record, out)?;
                self.pending = Some(OpenCurve::Arc(circle.clone()));
                Ok(())
            }
            (Statement::Nurbs, _) => {
                self.end_spline(record, out)?;
                match self.stands {
                    Some(from) => {
                        self.pending =
                            Some(OpenCurve::Spline { knots: Vec::new(), poles: vec![from.tip] });
                        Ok(())
                    }
                    None => faulty("NURBS begins where the tool stands, and nobody knows where"),
                }
            }
            (_, None | Some(OpenCurve::Arc(_) | OpenCurve::Turned(_))) => {
                faulty("no NURBS stands before this")
            }
            (_, Some(OpenCurve::Spline { knots, poles }))
                if knots.len().max(poles.len()) > MOST_NUMBERS =>
            {
                faulty("a spline of more than a million numbers")
            }
            (Statement::Knot(numbers), Some(OpenCurve::Spline { knots, .. })) => {
                knots.extend_from_slice(numbers);
                Ok(())
            }
            (Statement::Control { axis: None, .. }, Some(OpenCurve::Spline { poles, .. })) => {
                poles.extend(point);
                Ok(())
            }
            (_, Some(OpenCurve::Spline { .. })) => faulty("splines with tool axes are not read"),
        };
        done.map_err(|message: String| self.fault(record, message))
    }

    /// The arc that `circle` asks for, to a pose.
    pub(super) fn arc(
        &mut self,
        record: &Record<'_>,
        circle: &CircleRecord,
        to: Pose,
        out: &mut CourseItems,
    ) -> RecordResult {
        let Some(from) = self.stands else {
            let message = "the arc begins where the tool stands, and nobody knows where";
            return Err(self.fault(record, message.to_owned()));
        };
        if self.cycle.is_some() {
            return Err(self.fault(record, "an arc while a cycle is on".to_owned()));
        }
        let centre = self.frames.point(self.file_point(record, circle.centre)?);
        let normal = Vector3::from(circle.axis);
        if !(1e-6..1e9).contains(&normal.norm()) {
            return Err(self.fault(record, "the axis of the arc has no direction".to_owned()));
        }
        let mut normal = self.frames.direction(normal.normalize());
        if circle.sense == Some(Sense::Clockwise) {
            normal = -normal;
        }
        let arm = |tip: Vector3<f64>| {
            let offset = tip - centre;
            offset - normal * normal.dot(&offset)
        };
        let (first, last) = (arm(from.tip), arm(to.tip));
        if first.norm() < 1e-9 || last.norm() < 1e-9 {
            return Err(self.fault(record, "an end of the arc lies on its axis".to_owned()));
        }
        let mismatch = libm::fabs(first.norm() - last.norm());
        if mismatch > NO_ARC {
            let message = format!(
                "the ends of the arc differ by {mismatch:.4} mm in their distance from its centre; {NO_ARC} mm is allowed"
            );
            return Err(self.fault(record, message));
        }
        let angle = libm::atan2(normal.dot(&first.cross(&last)), first.dot(&last));
        let mut sweep = match (first - last).norm() < CLOSED {
            true => TAU,
            false if angle <= 0.0 => angle + TAU,
            false => angle,
        };
        sweep += TAU * f64::from(circle.turns.unwrap_or(1).max(1) - 1);
        let curve = Curve::Arc { centre, normal, sweep };
        let pace = self.pace(&curve, to);
        self.go(record.line, pace, curve, to, false, out);
        Ok(())
    }

    /// The spline that waits is complete: a record behind it that is none of it came.
    pub(super) fn end_spline(
        &mut self,
        record: &Record<'_>,
        out: &mut CourseItems,
    ) -> RecordResult {
        if !matches!(self.pending, Some(OpenCurve::Spline { .. })) {
            return Ok(());
        }
        if let Some(fault) = self.strange.between_moves() {
            return Err(fault);
        }
        let (Some(OpenCurve::Spline { knots, poles }), Some(from)) =
            (self.pending.take(), self.stands)
        else {
            return Ok(());
        };
        let way = way(&knots, poles)
            .map_err(|why| self.fault(record, format!("the NURBS that ends before this: {why}")))?;
        let to = Pose { tip: way.at(1.0), ..from };
        let curve = Curve::Spline(Arc::new(way));
        let pace = self.pace_behind(&curve, to);
        self.go(record.line, pace, curve, to, false, out);
        Ok(())
    }
}

/// NX's splines: cubic, clamped at both ends; the file has the knots between, and 1.
fn way(interior: &[f64], poles: Vec<Vector3<f64>>) -> Result<BSpline, String> {
    const DEGREE: usize = 3;
    let Some((1.0, interior)) = interior.split_last().map(|(last, all)| (*last, all)) else {
        return Err("its last knot must be 1".to_owned());
    };
    let mut knots = vec![0.0; DEGREE + 1];
    knots.extend_from_slice(interior);
    knots.extend([1.0; DEGREE + 1]);
    let way = BSpline {
        degree: DEGREE,
        knots,
        poles: poles.into_iter().map(|pole| (pole, 1.0)).collect(),
    };
    let inside = interior.iter().all(|knot| 0.0 < *knot && *knot < 1.0);
    match way.is_sound() && inside {
        true => Ok(way),
        false => Err(format!(
            "{} knots and {} poles (the place of the tool the first) are no cubic spline from 0 to 1",
            interior.len() + 1,
            way.poles.len()
        )),
    }
}
