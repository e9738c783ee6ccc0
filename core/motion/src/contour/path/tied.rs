//! Places that are equally near: the one whose tool axis is nearest counts.

use nalgebra::Vector3;
use post_machine::kinematics::Pose;

use super::{CommandedPath, Foot};

/// Places whose distances differ by less, mm, are equally near: the one with the nearer tool axis counts. Where the
/// tool turns about its tip, this alone tells them apart.
pub(super) const TIE: f64 = 1e-4;

impl CommandedPath {
    /// The tool axis that is asked for at a place: of places that are equally near, the one that is nearest to the tool's.
    pub fn axis_beside(&self, tool: &Pose, foot: Foot) -> Vector3<f64> {
        self.tied(tool, foot).1
    }

    /// The place, of those that are equally near, whose tool axis is nearest, downhill; and that axis.
    pub(super) fn tied(&self, actual: &Pose, foot: Foot) -> (Foot, Vector3<f64>) {
        let bound = (foot.distance + TIE) * (foot.distance + TIE);
        let equal = |tip: &Vector3<f64>| (tip - actual.tip).norm_squared() <= bound;
        let axis = self.axis(foot);
        let mut best = (foot, axis);
        let mut least = (axis - actual.axis).norm_squared();
        let back = match foot.share > 0.0 {
            true => Some(foot.knot),
            false => foot.knot.checked_sub(1),
        };
        for (way, end) in [(-1, back), (1, Some(foot.knot + 1))] {
            let mut knot = end;
            while let Some(place) = knot {
                let Some(here) = self.knots.get(place).filter(|here| equal(&here.tip)) else {
                    break;
                };
                let off = (here.axis - actual.axis).norm_squared();
                if off >= least {
                    break;
                }
                let tied = Foot { knot: place, share: 0.0, distance: foot.distance };
                (best, least) = ((tied, here.axis), off);
                knot = place.checked_add_signed(way);
            }
        }
        if (best.0.knot, best.0.share) == (foot.knot, foot.share) {
            return best;
        }
        // Beside the knot, on the chord of its axes.
        let knot = best.0.knot;
        for piece in [knot.checked_sub(1), Some(knot)].into_iter().flatten() {
            let Some(next) = self.knots.get(piece + 1) else {
                continue;
            };
            let last = self.knots[piece].axis;
            let chord = next.axis - last;
            let share = (actual.axis - last).dot(&chord) / chord.norm_squared();
            if !(share > 0.0 && share < 1.0) {
                continue;
            }
            let place = Foot { knot: piece, share, distance: foot.distance };
            let axis = self.axis(place);
            let off = (axis - actual.axis).norm_squared();
            if off < least && equal(&self.point(place)) {
                (best, least) = ((place, axis), off);
            }
        }
        best
    }
}
