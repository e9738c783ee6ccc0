//! `GOTO` records of one layout as cuts, many at once: what [`ClModal::record`] makes of each, by the same operations.

use nalgebra::Vector3;
use post_grammar::GotoRun;
use post_machine::kinematics::Pose;
use post_machine::kinematics::batch::{Lanes, groups, largest, least, set_vector, vector, widely};

use super::feed::FeedWord;
use super::modal::{ClModal, DIRECTIONS, FARTHEST};
use crate::course::CutRun;

impl ClModal {
    /// The feed of the cut that a `GOTO` alone would be, mm/min, if the file states one; none where it might be more than a
    /// straight cut, or its feed hangs on its way.
    pub(super) fn goes_on(&self) -> Option<Option<f64>> {
        let cuts = !self.rapid && !self.rapid_feed && self.cycle.is_none() && !self.finished;
        let straight = self.pending.is_none() && self.set_out.is_none();
        let known = self.stands.is_some() && !self.only_said && self.edge == Vector3::zeros();
        let quiet = self.strange.is_quiet() && self.is_ready() && !self.indexed;
        if !cuts || !straight || !known || !quiet {
            return None;
        }
        match self.feed {
            Some(FeedWord::InverseTime(_)) => None,
            Some(FeedWord::PerRevolution(_)) if self.tools.rpm().is_none() => None,
            Some(word) => Some(self.per_minute(word, || None)),
            None => Some(self.settings.feed),
        }
    }

    /// Takes the records of a run as cuts at `feed`, where [`ClModal::goes_on`]. False, and nothing is taken, where there is
    /// none, or one of them is in doubt.
    pub(super) fn cuts(&mut self, run: &GotoRun, feed: Option<f64>, cuts: &mut CutRun) -> bool {
        let (count, Some(stands)) = (run.count(), self.stands) else {
            return false;
        };
        let mut tips = [[0.0; GotoRun::MOST]; 3];
        let mut axes = [[0.0; GotoRun::MOST]; 3];
        if count == 0 || !self.put_points(run, &mut tips, &mut axes) {
            return false;
        }
        (cuts.line, cuts.lines, cuts.feed) = (run.line(0), run.lines(), feed);
        cuts.poses.clear();
        cuts.poses.push(stands);
        let edge = self.frames.direction(self.edge);
        let of_part = self.frames.is_of_part();
        cuts.poses.extend((0..count).map(|lane| {
            let (tip, axis) = (vector(&tips, lane), vector(&axes, lane));
            match of_part {
                true => Pose { tip, axis, edge },
                false => {
                    let (tip, axis) = (self.frames.point(tip), self.frames.direction(axis));
                    Pose { tip, axis, edge }
                }
            }
        }));
        if run.has_axis() {
            self.axis = vector(&axes, count - 1);
        }
        self.measured = true;
        self.strange.moved = true;
        self.stands = cuts.poses.last().copied();
        true
    }

    /// Fills in tips, mm, and tool axes, unit vectors, both in the frame of the file; false where one of them is none.
    fn put_points(&self, run: &GotoRun, tips: &mut [Lanes; 3], axes: &mut [Lanes; 3]) -> bool {
        let (count, scale) = (run.count(), self.scale);
        let [x, y, z, i, j, k] = run.columns();
        let mut lengths = [1.0; GotoRun::MOST];
        let [nearest, farthest] = widely(
            #[inline(always)]
            || {
                let mut sides = [0.0_f64; 2];
                for (tips, column) in tips.iter_mut().zip([x, y, z]) {
                    for lane in 0..groups(count) {
                        tips[lane] = column[lane] * scale;
                    }
                    sides[0] = sides[0].min(least(&tips[..count]));
                    sides[1] = sides[1].max(largest(&tips[..count]));
                }
                if run.has_axis() {
                    for lane in 0..groups(count) {
                        let axis = Vector3::new(i[lane], j[lane], k[lane]);
                        lengths[lane] = axis.norm();
                        set_vector(axes, lane, axis / lengths[lane]);
                    }
                }
                sides
            },
        );
        if !run.has_axis() {
            for (column, part) in axes.iter_mut().zip(&self.axis) {
                column[..count].fill(*part);
            }
        }
        let lengths = &lengths[..count];
        -nearest <= FARTHEST
            && farthest <= FARTHEST
            && DIRECTIONS.contains(&least(lengths))
            && DIRECTIONS.contains(&largest(lengths))
    }
}
