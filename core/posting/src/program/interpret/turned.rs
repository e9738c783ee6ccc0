//! Arcs whose way round is not said by their axis alone: `MOVARC`, which gives an angle, and CATIA's `TLON`, which gives the
//! direction in which the tool sets out.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_grammar::{AlongArc, ArcMove, CircleRecord, Record, Sense};
use post_machine::diagnostic::Short;

use super::curves::ARC_MISMATCH;
use super::{ClInterpreter, StepSink};
use crate::program::limits::direction;

/// Ends nearer than this are one point: mm.
const CLOSED: f64 = 1e-3;

/// What an angle of a file may be off by its last digit, radians.
const ANGLE_STEP: f64 = 2e-4;

/// What an end of a file may be off by its last digit, mm.
const POINT_STEP: f64 = 5e-3;

/// No angle is off by more, however small the arc: radians.
const MOST_OFF: f64 = 0.17;

/// The cosine between the tangent and the direction in which the tool sets out is larger: 11°.
const SETS_OUT: f64 = 0.98;

/// What the arcs read so far say of their axes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ArcAxisConvention {
    /// Nothing: each of them would be the same either way.
    #[default]
    Open,
    /// Axes are turned over for arcs that go clockwise: each arc goes right-handed about its own.
    TurnedOver,
    /// Axes are those of the plane: they do not tell which way an arc goes.
    OfThePlane,
}

/// The ways round by which a stated angle leads from start to end, each as its turns for [`PathArc::new`](crate::program::PathArc::new).
struct ArcTurnCounts {
    forth: Option<u32>,
    back: Option<u32>,
}

impl ArcTurnCounts {
    /// `swept` is the angle from start to end about the axis, from 0 up; `closed`: they are one point.
    fn new(swept: f64, closed: bool, stated: f64, radius: f64) -> Self {
        let most = (POINT_STEP / radius).clamp(ANGLE_STEP, MOST_OFF);
        let turns = |once: f64| {
            let more = libm::round((stated - once) / TAU).max(0.0);
            let off = libm::fabs(stated - once - more * TAU);
            let turns = more as u32 + u32::from(!closed);
            (off <= most && turns > 0).then_some(turns)
        };
        match closed {
            true => Self { forth: turns(0.0), back: turns(0.0) },
            false => Self { forth: turns(swept), back: turns(TAU - swept) },
        }
    }
}

impl ClInterpreter {
    /// The arc of a `MOVARC` to `end`, mm; none if its numbers do not agree or do not say which way it goes.
    pub(super) fn turned(
        &mut self,
        record: &Record<'_>,
        arc: &ArcMove,
        end: Vector3<f64>,
    ) -> Option<CircleRecord> {
        let Some(start) = self.tip else {
            self.no_arc(record, "it begins at the last point, and there is none");
            return None;
        };
        let centre = self.point(record, arc.centre)?;
        let Some(axis) = direction(Vector3::from(arc.axis)) else {
            self.no_arc(record, "its axis has no direction");
            return None;
        };
        let radius = arc.radius * self.scale;
        let [from, to] = [start, end].map(|point| {
            let arm = point - centre;
            arm - axis * axis.dot(&arm)
        });
        for (arm, what) in [(from, "starts"), (to, "ends")] {
            if radius <= 0.0 || libm::fabs(arm.norm() - radius) > ARC_MISMATCH {
                let message = format!(
                    "it {what} {} mm from its centre and says radius {}: {ARC_MISMATCH} mm is allowed",
                    Short(arm.norm()),
                    Short(radius)
                );
                self.no_arc(record, &message);
                return None;
            }
        }
        let swept = libm::atan2(axis.dot(&from.cross(&to)), from.dot(&to));
        let swept = if swept < 0.0 { swept + TAU } else { swept };
        let closed = (to - from).norm() < CLOSED;
        let ways = ArcTurnCounts::new(swept, closed, arc.degrees.to_radians(), radius);
        let (sense, turns) = self.way_round(record, arc, axis, &ways, swept)?;
        Some(CircleRecord {
            centre: arc.centre,
            axis: arc.axis,
            radius: Some(arc.radius),
            sense,
            turns: Some(turns),
        })
    }

    /// Decides which of the ways round an arc about `axis` goes: its sense, and its turns.
    fn way_round(
        &mut self,
        record: &Record<'_>,
        arc: &ArcMove,
        axis: Vector3<f64>,
        ways: &ArcTurnCounts,
        swept: f64,
    ) -> Option<(Option<Sense>, u32)> {
        let turned_over = axis.dot(&self.axis) < 0.0;
        match (ways.forth, ways.back) {
            (Some(turns), None) => {
                if turned_over && self.arc_axes == ArcAxisConvention::Open {
                    self.arc_axes = ArcAxisConvention::TurnedOver;
                }
                Some((None, turns))
            }
            (None, Some(turns)) => {
                self.arc_axes = ArcAxisConvention::OfThePlane;
                Some((Some(Sense::Clockwise), turns))
            }
            (Some(turns), Some(_)) if self.arc_axes == ArcAxisConvention::TurnedOver => {
                Some((None, turns))
            }
            (Some(turns), Some(_)) if self.reading.allows("MOVARC") => {
                self.allow(
                    "MOVARC",
                    "goes right-handed about its axis where its angle fits both ways",
                    record,
                );
                Some((None, turns))
            }
            (Some(_), Some(_)) => {
                self.fault(
                    record,
                    "arc",
                    format!(
                        "no arc: {}° fit both ways round, and nothing in the file so far says whether its axis tells which",
                        Short(arc.degrees)
                    ),
                    "newer posts of Autodesk turn the axis over for arcs that go clockwise, older ones do not: where it is one of the \
                     newer, --allow MOVARC takes such arcs right-handed about their axis; or let the CAM system write arcs of less than a half turn",
                );
                None
            }
            (None, None) => {
                let message = format!(
                    "it says {}°, and from its start to its end it is {}° one way and {}° the other",
                    Short(arc.degrees),
                    Short(swept.to_degrees()),
                    Short(360.0 - swept.to_degrees())
                );
                self.no_arc(record, &message);
                None
            }
        }
    }

    /// CATIA's arc, to its end.
    pub(super) fn along_arc(
        &mut self,
        record: &Record<'_>,
        along: &AlongArc,
        emit: &mut StepSink<'_>,
    ) {
        self.end_spline(record, emit);
        let set_out = self.set_out.take();
        if self.cycles.lost {
            return;
        }
        self.before_move(record, emit);
        let Some(set_out) = set_out else {
            self.no_arc(record, "no INDIRV before it says where the tool sets out");
            return;
        };
        let Some(start) = self.tip else {
            self.no_arc(record, "it begins at the last point, and there is none");
            return;
        };
        let (Some(centre), Some(end)) =
            (self.point(record, along.centre), self.point(record, along.end))
        else {
            return;
        };
        let Some(axis) = direction(Vector3::from(along.axis.unwrap_or([0.0, 0.0, 1.0]))) else {
            self.no_arc(record, "its axis has no direction");
            return;
        };
        if let Some(normal) = self.part_surface
            && axis.cross(&normal).norm() > 1e-3
        {
            self.no_arc(
                record,
                "its axis does not stand across the plane that AUTOPS or PSIS names",
            );
            return;
        }
        let radius = along.radius * self.scale;
        let [from, to] = [start, end].map(|point| {
            let height = axis.dot(&(point - centre));
            (point - centre - axis * height, height)
        });
        let off = [from, to].map(|(arm, _)| libm::fabs(arm.norm() - radius));
        let rise = libm::fabs(to.1 - from.1);
        if radius <= 0.0 || off[0].max(off[1]).max(rise) > ARC_MISMATCH {
            let message = format!(
                "of radius {}, its start lies at {} and its end at {} mm from its axis, and one {} mm above the other: {ARC_MISMATCH} mm is allowed",
                Short(radius),
                Short(from.0.norm()),
                Short(to.0.norm()),
                Short(rise)
            );
            self.no_arc(record, &message);
            return;
        }
        let tangent = axis.cross(&from.0).normalize();
        let cosine = tangent.dot(&set_out);
        if libm::fabs(cosine) < SETS_OUT {
            let message = format!(
                "INDIRV sets out {}° off its tangent",
                Short(libm::acos(libm::fabs(cosine)).to_degrees())
            );
            self.no_arc(record, &message);
            return;
        }
        let circle = CircleRecord {
            centre: along.centre,
            axis: axis.into(),
            radius: Some(along.radius),
            sense: (cosine < 0.0).then_some(Sense::Clockwise),
            turns: None,
        };
        self.arc(record, &circle, end, self.axis, emit);
    }

    #[cold]
    fn no_arc(&mut self, record: &Record<'_>, why: &str) {
        self.fault(record, "arc", format!("no arc: {why}"), "");
    }
}
