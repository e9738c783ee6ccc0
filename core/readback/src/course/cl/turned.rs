//! `MOVARC` and CATIA's `TLON`: arcs whose way round follows from an angle or from where the tool sets out.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;
use post_grammar::{AlongArc, ArcMove, CircleRecord, Record, Sense};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;

use super::curves::NO_ARC;
use super::modal::{ClModal, CourseItems, RecordResult};

/// Where the stated angle leads may lie so far from the end: mm, and radians.
const OFF: [f64; 2] = [5e-3, 2e-4];

/// However small the arc, its end does not lie further round: radians.
const MOST_ROUND: f64 = 0.17;

/// Which way an arc goes whose angle leads to its end either way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum ArcTurnRule {
    /// Nothing read so far tells.
    #[default]
    Unknown,
    /// Right-handed about its axis.
    Right,
    /// The axis does not tell.
    None,
}

impl ClModal {
    /// The arc of a `MOVARC` as a circle that ends at a pose.
    pub(super) fn turned(
        &mut self,
        record: &Record<'_>,
        arc: &ArcMove,
        to: Pose,
    ) -> Result<CircleRecord, Box<Diagnostic>> {
        let no = |why: String| Err(self.fault(record, format!("no arc: {why}")));
        let Some(from) = self.stands else {
            return no("nobody knows where it begins".to_owned());
        };
        let Some(axis) = Vector3::from(arc.axis).try_normalize(1e-9) else {
            return no("its axis has no direction".to_owned());
        };
        let axis = self.frames.direction(axis);
        let centre = self.frames.point(self.file_point(record, arc.centre)?);
        let radius = arc.radius * self.scale;
        let across = |tip: Vector3<f64>| (tip - centre) - axis * axis.dot(&(tip - centre));
        let (first, last) = (across(from.tip), across(to.tip));
        let off = [first, last].map(|arm| libm::fabs(arm.norm() - radius));
        if radius <= 0.0 || off[0].max(off[1]) > NO_ARC {
            return no(format!(
                "its ends lie {:.4} and {:.4} mm from its centre, and its radius is {radius} mm",
                first.norm(),
                last.norm()
            ));
        }
        // Each way is tried: the start is turned by the angle and held against the end.
        let angle = arc.degrees.to_radians();
        let round = OFF[1].max(OFF[0] / radius).min(MOST_ROUND);
        let leads = |sense: f64| {
            let (sine, cosine) = libm::sincos(sense * angle);
            let turned = first * cosine + axis.cross(&first) * sine;
            let apart = libm::atan2(turned.cross(&last).norm(), turned.dot(&last));
            angle > 0.0 && apart <= round
        };
        let closed = (first - last).norm() < super::curves::CLOSED;
        if closed && angle < PI {
            return no(format!("{}° from a point to itself", arc.degrees));
        }
        let opposed = axis.dot(&to.axis) < 0.0;
        let clockwise = match (leads(1.0), leads(-1.0)) {
            (true, false) => {
                if opposed && self.arc_rule == ArcTurnRule::Unknown {
                    self.arc_rule = ArcTurnRule::Right;
                }
                false
            }
            (false, true) => {
                self.arc_rule = ArcTurnRule::None;
                true
            }
            (true, true)
                if self.arc_rule == ArcTurnRule::Right || self.settings.allows("MOVARC") =>
            {
                false
            }
            (true, true) => {
                return no(format!(
                    "{}° lead to its end either way, and its axis does not tell which",
                    arc.degrees
                ));
            }
            (false, false) => {
                return no(format!("{}° do not lead from its start to its end", arc.degrees));
            }
        };
        // Whole turns beyond the one that ends at the pose.
        let beyond = libm::round((angle - round) / TAU - 0.5).max(0.0);
        Ok(CircleRecord {
            centre: arc.centre,
            axis: arc.axis,
            radius: Some(arc.radius),
            sense: clockwise.then_some(Sense::Clockwise),
            turns: Some(beyond as u32 + 1),
        })
    }

    /// CATIA's arc to its end.
    pub(super) fn along_arc(
        &mut self,
        record: &Record<'_>,
        along: &AlongArc,
        out: &mut CourseItems,
    ) -> RecordResult {
        let set_out = self.set_out.take();
        self.end_spline(record, out)?;
        self.before_move(record, out)?;
        let no = |why: &str| Err(self.fault(record, format!("no arc: {why}")));
        let (Some(set_out), Some(from)) = (set_out, self.stands) else {
            return no("where it begins, or where the tool sets out, is not said");
        };
        let axis = Vector3::from(along.axis.unwrap_or([0.0, 0.0, 1.0]));
        let Some(axis) = axis.try_normalize(1e-9) else {
            return no("its axis has no direction");
        };
        if self.surface.is_some_and(|normal| libm::fabs(normal.dot(&axis)) < 0.999_999) {
            return no("it does not lie in the plane that AUTOPS or PSIS names");
        }
        let to = self.pose(record, along.end)?;
        let centre = self.frames.point(self.file_point(record, along.centre)?);
        let (normal, ahead) = (self.frames.direction(axis), self.frames.direction(set_out));
        let radius = along.radius * self.scale;
        let arms = [from.tip - centre, to.tip - centre];
        let heights = arms.map(|arm| normal.dot(&arm));
        let off = arms.map(|arm| libm::fabs(arm.cross(&normal).norm() - radius));
        if radius <= 0.0
            || off[0].max(off[1]) > NO_ARC
            || libm::fabs(heights[1] - heights[0]) > NO_ARC
        {
            return no("start, end and radius do not agree");
        }
        // The moment of the way out about the axis.
        let moment = normal.dot(&arms[0].cross(&ahead)) / radius;
        if libm::fabs(moment) < 0.98 {
            return no("INDIRV does not set out along its tangent");
        }
        let circle = CircleRecord {
            centre: along.centre,
            axis: axis.into(),
            radius: Some(along.radius),
            sense: (moment < 0.0).then_some(Sense::Clockwise),
            turns: None,
        };
        self.arc(record, &circle, to, out)
    }
}
