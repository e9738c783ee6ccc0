//! How near a rapid comes to what is cut.

use nalgebra::Vector3;

use super::place::ToolPlace;
use super::track::ElementKind;
use super::{Verifier, retract};
use crate::Motion;
use crate::course::Course;

/// Share of its distance at the nearer end to which a rapid comes without being told: a straight way between two places
/// that are as far off is a little nearer in its middle.
const NEARER: f64 = 0.9;

impl<C: Course> Verifier<'_, C> {
    /// A rapid must not come nearer to the cuts than its ends, unless the course's own does.
    ///
    /// Where the tool stands before it comes to its first point is not known, and how machines turn off the part is often
    /// their own: what comes near is told, and what touches is a fault.
    pub(super) fn look_how_near(&mut self, motion: &Motion, places: &[ToolPlace]) {
        if self.cut_path.keeps_off(places, self.rapid_bound.point) {
            return;
        }
        let ends = [&places[0], &places[places.len() - 1]];
        let ends = ends.map(|end| self.cut_path.distance(end.point));
        let slack = self.rapid_bound.point + self.cut_path.blur();
        let least = ends[0].min(ends[1]) - slack;
        if least <= 0.0 || !least.is_finite() {
            return;
        }
        let mut near = f64::INFINITY;
        for ends in places.windows(2) {
            near = near.min(self.cut_path.least_on(ends[0].point, ends[1].point, least));
        }
        if near >= least {
            return;
        }
        if near >= self.course_is_near() - slack {
            return;
        }
        let touches = near <= slack && !self.turns_between_holes();
        if !touches && (near > NEARER * (least + slack) || self.stays_retracted(motion)) {
            return;
        }
        let message = format!(
            "a rapid comes to {near:.1} mm of what is cut, from {:.1} mm to {:.1} mm at its ends",
            ends[0], ends[1]
        );
        if touches {
            let by = least + slack - near;
            self.fault("rapid", message, Some(motion), None, Some(by));
        } else {
            self.found.near_rapids += 1;
            self.found.nearest_rapid.get_or_insert((motion.line, message));
        }
    }

    /// A way from one place to another at which the machine file has the tool retracted.
    fn stays_retracted(&self, motion: &Motion) -> bool {
        let ends = [&motion.from.joints, &motion.to.joints];
        !self.machine.frame.retract.is_empty()
            && retract::stays_retracted(self.machine, ends, self.rapid_bound.point)
    }

    /// How near the rapids of the course that a motion has passed and the one that it is on come to its cuts between their
    /// ends, and at points of the course in the midst of the motion, mm.
    fn course_is_near(&mut self) -> f64 {
        let mut under_way = None;
        if let Some(element) = self.due()
            && matches!(element.what, ElementKind::Way)
        {
            under_way = Some((element.from.point, element.to.point));
        }
        let mut near = under_way.map_or(f64::INFINITY, |(from, to)| self.dips(from, to));
        for [from, to] in std::mem::take(&mut self.passed) {
            near = near.min(self.dips(from, to)).min(self.cut_path.distance(to));
        }
        near
    }

    /// How near a rapid of the course comes to the cuts, if between its ends it is nearer than at both, mm.
    fn dips(&mut self, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
        let ends = [from, to].map(|end| self.cut_path.distance(end));
        let least = ends[0].min(ends[1]);
        let near = self.cut_path.least_on(from, to, 0.0);
        match near < least - self.cut_path.blur() {
            true => near,
            false => f64::INFINITY,
        }
    }
}
