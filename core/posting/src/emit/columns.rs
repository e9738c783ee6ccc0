//! Events of a run of cuts.

use std::mem::discriminant;

use post_machine::kinematics::batch::vector;
use post_plugin::{Capabilities, Columns, Event, Feed, ToolPose};

use super::EmitStage;
use crate::accuracy::{DeviationBound, RunColumns};
use crate::timing::TimedRun;

impl EmitStage<'_> {
    /// Somebody looks on.
    pub(crate) fn is_watched(&self) -> bool {
        self.observers.is_some()
    }

    /// Nothing is in the way of a run of cuts: no cycle, no spindle that has to turn first, no clamp, no
    /// compensation that waits, no limit that depends on other axes, no word that holds several axes, and nobody who notes where blocks stand.
    pub(crate) fn takes_runs(&self) -> bool {
        self.cycle.is_none()
            && self.spindle.waits.is_none()
            && self.compensation.waits.is_none()
            && self.machine.limits.is_empty()
            && !self.machine.is_in_mode()
            && !self.words.is_coupled()
            && !self.clamps()
            && !self.writer.notes_places()
    }

    /// Writes the blocks of a run: [`EmitStage::take`] of each.
    pub(crate) fn take_run(&mut self, run: &RunColumns, timed: &TimedRun) {
        match self.writer.knows(Capabilities::CUTS) {
            true => self.take_columns(run, timed),
            false => self.take_lanes(run, timed),
        }
    }

    /// As few events as there can be: one ends where the feeds become of another kind, and with a block whose place in
    /// the program is told.
    fn take_columns(&mut self, run: &RunColumns, timed: &TimedRun) {
        self.extremes.reach_all(&self.last, run);
        let worst = self.extremes.mark_cuts(run);
        let words = self.writer.words();
        let mut from = 0;
        while from < run.count {
            let feed = timed.feeds[from];
            let ends = worst.iter().flatten().map(|lane| lane + 1).filter(|end| *end > from);
            let end = ends.min().unwrap_or(run.count);
            let feeds = &timed.feeds[from..end];
            let same = |next: &&Feed| discriminant(*next) == discriminant(&feed);
            let to = from + feeds.iter().take_while(same).count();
            self.cuts.clear();
            self.cuts.extend(timed.feeds[from..to].iter().map(|feed| feed.value()));
            for column in &run.words[..words] {
                self.cuts.extend_from_slice(&column[from + 1..=to]);
            }
            let columns = Columns(&self.cuts);
            let index = self.writer.next();
            self.writer.push(run.lines[from], Event::Cuts { feed, columns });
            self.extremes.marked(worst, to - 1, index);
            from = to;
        }
        self.last = run.joints_at(run.count - 1);
        self.flush();
    }

    /// An event each.
    fn take_lanes(&mut self, run: &RunColumns, timed: &TimedRun) {
        let count = self.writer.words();
        for lane in 0..run.count {
            let joints = run.joints_at(lane);
            let line = run.lines[lane];
            self.extremes.reach(&joints);
            self.extremes.note_line(line);
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
