//! Events of a run of cuts.

use post_machine::kinematics::batch::vector;
use post_plugin::{Event, ToolPose};

use super::EmitStage;
use crate::accuracy::{DeviationBound, RunColumns};
use crate::timing::TimedRun;

impl EmitStage<'_> {
    /// Somebody looks on.
    pub(crate) fn is_watched(&self) -> bool {
        self.observers.is_some()
    }

    /// Nothing is in the way of a run of cuts: no cycle, no spindle that has to turn first, no clamp, no
    /// compensation that waits, and nobody who notes where blocks stand.
    pub(crate) fn takes_runs(&self) -> bool {
        self.cycle.is_none()
            && self.spindle.waits.is_none()
            && self.compensation.waits.is_none()
            && !self.clamps()
            && !self.writer.notes_places()
    }

    /// Writes the blocks of a run: [`EmitStage::take`] of each.
    pub(crate) fn take_run(&mut self, run: &RunColumns, timed: &TimedRun) {
        let count = self.writer.words();
        for lane in 0..run.count {
            let joints = run.joints_at(lane);
            let line = run.lines[lane];
            self.extremes.reach(&joints);
            self.extremes.go(&self.last, &joints);
            let bound = run.bound(lane);
            let deviation = DeviationBound { tip: bound.tip + 0.0, ..bound };
            self.extremes.mark_cut(deviation, line, self.writer.next());
            let axis = vector(&run.reached_axis, lane + 1);
            let tip = vector(&run.reached_tip, lane + 1) - axis * 0.0;
            let tool = Some(ToolPose { tip: tip.into(), axis: axis.into() });
            let words = &run.words_at(lane)[..count];
            self.writer.push(line, Event::Linear { tool, feed: timed.feeds[lane], words });
            self.last = joints;
            if self.writer.is_full() {
                self.flush();
            }
        }
        self.flush();
    }
}
