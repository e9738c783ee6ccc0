//! Times and feeds of a run of cuts.

use post_machine::kinematics::batch::{LANES, vector};
use post_plugin::Feed;

use super::TimingStage;
use super::feed::FedWay;
use super::limits::max_feed;
use crate::accuracy::RunColumns;

/// Times and feeds of the blocks of a run.
#[derive(Debug)]
pub(crate) struct TimedRun {
    /// Feeds as written.
    pub feeds: [Feed; LANES],
    /// Times as the control takes them, minutes.
    minutes: [f64; LANES],
    /// The block is slowed down; because the control takes no larger F by time.
    limited: [bool; LANES],
    capped: [bool; LANES],
}

impl Default for TimedRun {
    fn default() -> Self {
        Self {
            feeds: [Feed::PerMinute(0.0); LANES],
            minutes: [0.0; LANES],
            limited: [false; LANES],
            capped: [false; LANES],
        }
    }
}

impl TimingStage<'_> {
    /// Times the blocks of a run, which ends before one whose feed is below the least that is printed. Nothing is
    /// changed yet.
    pub(crate) fn times(&self, run: &mut RunColumns, timed: &mut TimedRun) {
        for (column, last) in run.joints.iter_mut().zip(&self.last) {
            column[0] = *last;
        }
        let mut leasts = run.follow;
        let mut turns = [false; LANES];
        max_feed::least_minutes_all(&self.slowness, &run.joints, run.count, &mut leasts);
        self.feeds.turning_all(&run.joints, run.count, &mut turns);
        let mut ends = run.count;
        for lane in 0..run.count {
            let tip = run.way[lane];
            let feed = run.feeds[lane];
            let asked = tip / feed;
            let way = FedWay {
                tip,
                feed: Some(feed),
                minutes: asked,
                asked,
                bow: run.tip_bound[lane],
                turning: turns[lane],
                curved: false,
            };
            let least = leasts[lane];
            let measured =
                || self.feeds.measured(&run.joints_before(lane), &run.joints_at(lane), tip);
            let written = self.feeds.write_way(&way, least, measured);
            if written.raised_from.is_some() {
                ends = lane;
                break;
            }
            timed.feeds[lane] = written.feed;
            timed.minutes[lane] = written.minutes;
            timed.capped[lane] = written.capped;
            timed.limited[lane] = written.capped || least > 0.0 && least > asked * (1.0 + 1e-9);
        }
        run.count = ends;
    }

    /// The blocks of the run are handed on.
    pub(crate) fn take_run(&mut self, run: &RunColumns, timed: &TimedRun) {
        for lane in 0..run.count {
            self.statistics.capped += u64::from(timed.capped[lane]);
            self.statistics.limited += u64::from(timed.limited[lane]);
            self.statistics.cutting += timed.minutes[lane];
        }
        self.last = run.joints_at(run.count - 1);
        let axis = vector(&run.reached_axis, run.count);
        self.rapids.stand(vector(&run.reached_tip, run.count) - axis * 0.0);
    }
}
