//! Arcs and splines: what the file says of them, put together and checked.

use nalgebra::Vector3;
use post_grammar::{CircleRecord, Record, Sense, Statement};

use super::{ClInterpreter, StepSink, UnfinishedCurve};
use crate::program::arc::ArcAmbiguity;
use crate::program::limits::{MOST_SPLINE_NUMBERS, direction};
use crate::program::spline::nx_spline;
use crate::program::{ArcStep, PathArc, ProgramStep, SplineStep};
use post_machine::diagnostic::Short;

/// Ends of an arc whose distances from its centre differ by more are no arc: mm.
pub(super) const ARC_MISMATCH: f64 = 0.1;

impl ClInterpreter {
    pub(super) fn arc(
        &mut self,
        record: &Record<'_>,
        circle: &CircleRecord,
        end: Vector3<f64>,
        start_axis: Vector3<f64>,
        emit: &mut StepSink<'_>,
    ) {
        let Some(start) = self.tip else {
            self.fault(
                record,
                "arc",
                "the arc begins at the last point, and there is none".to_owned(),
                "come to a point ahead of it: GOTO ahead of CIRCLE, in a list of points a row ahead of that of the arc",
            );
            return;
        };
        let Some(pace) = self.pace(record) else {
            return;
        };
        // The axis and its right hand give the sense; a word (CAMWorks) is seen from the tip of the axis.
        let axis = match circle.sense {
            Some(Sense::Clockwise) => -Vector3::from(circle.axis),
            _ => Vector3::from(circle.axis),
        };
        let Some(centre) = self.point(record, circle.centre) else {
            return;
        };
        let arc = match PathArc::new(start, end, centre, axis, circle.turns.unwrap_or(1)) {
            Ok(arc) => arc,
            Err(message) => {
                self.fault(record, "arc", format!("no arc: {message}"), "");
                self.tip = Some(end);
                return;
            }
        };
        if self.cycles.in_force.is_some() {
            self.fault(
                record,
                "arc",
                "an arc while a cycle is on".to_owned(),
                "put a CYCLE/OFF before it",
            );
        }
        self.check_arc(record, circle, &arc, end);
        let (turn, shift) = (
            |direction| self.frame.direction_to_part(direction),
            |point| self.frame.to_part(point, Vector3::zeros()).0,
        );
        let arc = arc.placed(shift, turn);
        let start_axis = turn(start_axis);
        self.arrive(end);
        emit(ProgramStep::Arc(Box::new(ArcStep { arc, start_axis, end: self.motion(end, pace) })));
    }

    /// Says what is doubtful or wrong about an arc that is to end at `end`.
    fn check_arc(
        &mut self,
        record: &Record<'_>,
        circle: &CircleRecord,
        arc: &PathArc,
        end: Vector3<f64>,
    ) {
        if let Some(doubt) = arc.doubt(end) {
            let message = match doubt {
                ArcAmbiguity::Short(ahead) => format!(
                    "this arc ends {ahead:.4} mm ahead of its start: it is made as that short arc, not as a whole turn"
                ),
                ArcAmbiguity::Turn(ahead) => format!(
                    "this arc ends {} mm ahead of its start: it is made as a whole turn, not as so short an arc",
                    Short(ahead)
                ),
            };
            self.warn(record, "arc", message);
        }
        if arc.mismatch() > self.reading.chord_tolerance && arc.mismatch() <= ARC_MISMATCH {
            self.warn(
                record,
                "arc",
                format!(
                    "the ends of this arc lie {:.4} mm apart in their distance from its centre; it is made as a spiral",
                    arc.mismatch()
                ),
            );
        }
        if arc.mismatch() > ARC_MISMATCH {
            self.fault(
                record,
                "arc",
                format!(
                    "the ends of this arc lie {:.4} mm apart in their distance from its centre; {ARC_MISMATCH} mm is allowed",
                    arc.mismatch()
                ),
                "check the centre: CIRCLE ahead of the point, in a list of points arc_x, arc_y, arc_z",
            );
        }
        if let Some(radius) = circle.radius
            && libm::fabs(arc.radius() - radius * self.scale) > ARC_MISMATCH
        {
            self.warn(
                record,
                "arc",
                format!(
                    "the CIRCLE before this point says radius {}, its points lie at {:.4}",
                    Short(radius),
                    arc.radius() / self.scale
                ),
            );
        }
    }

    /// A curve that the next point ends.
    pub(super) fn wait_for_end(&mut self, record: &Record<'_>, curve: UnfinishedCurve) {
        if self.pending.is_some() {
            let word = record.statement.word();
            self.fault(
                record,
                "arc",
                format!("the curve before this {word} is not ended by a GOTO"),
                "",
            );
        }
        self.pending = Some(curve);
    }

    /// Takes the direction in which the tool sets out on the arc that follows (`INDIRV`).
    pub(super) fn set_out_along(&mut self, record: &Record<'_>, along: [f64; 3]) {
        match direction(Vector3::from(along)) {
            Some(along) => {
                self.set_out = Some(along);
                self.due = true;
            }
            None => self.fault(record, "arc", "INDIRV has no direction".to_owned(), ""),
        }
    }

    pub(super) fn begin_spline(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        self.end_spline(record, emit);
        match self.tip {
            Some(tip) => {
                self.pending =
                    Some(UnfinishedCurve::Spline { knots: Vec::new(), points: vec![tip] });
            }
            None => self.fault(
                record,
                "spline",
                "NURBS begins at the last point, and there is none".to_owned(),
                "put a GOTO before it",
            ),
        }
    }

    pub(super) fn spline_data(&mut self, record: &Record<'_>) {
        let point = match &record.statement {
            // One that was refused is still counted.
            Statement::Control { point, .. } => self.point(record, *point).unwrap_or_default(),
            _ => Vector3::zeros(),
        };
        let Some(UnfinishedCurve::Spline { knots, points }) = &mut self.pending else {
            self.fault(record, "spline", "there is no NURBS before it".to_owned(), "");
            return;
        };
        if knots.len().max(points.len()) > MOST_SPLINE_NUMBERS {
            self.pending = None;
            self.fault(
                record,
                "spline",
                format!("a spline of more than {MOST_SPLINE_NUMBERS} points"),
                "",
            );
            return;
        }
        match &record.statement {
            Statement::Knot(numbers) => knots.extend_from_slice(numbers),
            Statement::Control { axis: None, .. } => points.push(point),
            _ => self.fault(
                record,
                "spline",
                "splines with tool axes are not supported".to_owned(),
                "let the CAM system write GOTOs",
            ),
        }
    }

    pub(super) fn end_spline(&mut self, record: &Record<'_>, emit: &mut StepSink<'_>) {
        if !matches!(self.pending, Some(UnfinishedCurve::Spline { .. })) {
            return;
        }
        let Some(UnfinishedCurve::Spline { knots, points }) = self.pending.take() else {
            return;
        };
        self.refuse_suspects();
        // The RAPID that may stand after the spline is meant for the record that ends it.
        let rapid = std::mem::take(&mut self.rapid);
        let pace = self.pace(record);
        self.rapid = rapid;
        let Some(pace) = pace else {
            return;
        };
        match nx_spline(&knots, &points) {
            Ok(spline) => {
                let end = points[points.len() - 1];
                self.arrive(end);
                let spline = spline.placed(|point| self.frame.to_part(point, Vector3::zeros()).0);
                emit(ProgramStep::Spline(Box::new(SplineStep {
                    spline,
                    end: self.motion(end, pace),
                })));
            }
            Err(message) => {
                self.fault(record, "spline", format!("the NURBS before this: {message}"), "")
            }
        }
    }
}
