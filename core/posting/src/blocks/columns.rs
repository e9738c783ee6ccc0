//! Blocks of a run of cuts: solved together, each cleared by the cheap certificate.

use std::rc::Rc;

use post_machine::description::Tcp;
use post_machine::kinematics::TcpBlock;
use post_machine::kinematics::batch::{LANES, largest, widely};

use super::{BlockStage, LargestDeviations, STILL};
use crate::accuracy::{MoveRoom, MoveTolerances, NodeMove, Placer, RunColumns};

impl BlockStage<'_> {
    /// Solves and certifies the points of a run, which ends before a point that needs more than that. False on any doubt;
    /// nothing is changed yet.
    pub(crate) fn certifies(&self, run: &mut RunColumns) -> bool {
        let (Some(placer), Some(last)) = (&self.placer, self.last.as_deref()) else {
            return false;
        };
        let accuracy = &self.machine.accuracy;
        let plain = !self.compensating
            && !accuracy.reduce
            && !self.keeps.fits()
            && self.gathered.first_line().is_none()
            && !self.machine.indexes
            && self.machine.solution.exclusive.is_empty()
            && !self.plans;
        if !plain || !run.begin(last) || !self.stands_in_plane(run, placer) || !run.settle(placer) {
            return false;
        }
        self.steady_run(run, placer);
        let tolerances = MoveTolerances {
            tip: accuracy.tolerance - 0.0 - placer.reserve(),
            axis: accuracy.axis_tolerance,
        };
        let keeps = self.machine.control.tcp == Tcp::Control;
        run.certify(placer, tolerances, keeps);
        run.measure_ways(STILL);
        if keeps {
            return self.follows(run, placer);
        }
        run.follow = [0.0; LANES];
        true
    }

    /// The least times in which the linear axes follow where the control keeps the tip: see
    /// [`super::CompensatingMotion`]. The run ends before a block that has to be looked into.
    fn follows(&self, run: &mut RunColumns, placer: &Placer) -> bool {
        let mut bends = [0.0; LANES];
        let (joints, rates) = (&run.joints, &run.rates);
        let solver = placer.solver();
        if !TcpBlock::quick_all(solver, joints, rates, &run.reached_tip, run.count, &mut bends) {
            return false;
        }
        self.between.cleared_all(self.machine, placer, &bends, run);
        true
    }

    /// The largest deviations with those of a run: of a block that may be the worst the tight bound is kept.
    fn largest_of(&self, run: &mut RunColumns) -> LargestDeviations {
        let mut largest_yet = self.largest;
        let (Some(placer), Some(last)) = (&self.placer, self.last.as_deref()) else {
            return largest_yet;
        };
        let [tip, axis] = widely(
            #[inline(always)]
            || [largest(&run.tip_bound[..run.count]), largest(&run.axis_bound[..run.count])],
        );
        if tip + 0.0 <= largest_yet.cut.tip && axis <= largest_yet.cut.axis {
            return largest_yet;
        }
        for lane in 0..run.count {
            let bound = run.bound(lane);
            if bound.tip + 0.0 > largest_yet.cut.tip || bound.axis > largest_yet.cut.axis {
                let from = if lane == 0 { *last } else { run.node(placer, lane) };
                let to = run.node(placer, lane + 1);
                let ends = [&from, &to];
                let whole = NodeMove::planned(self.machine, placer, 0.0, MoveRoom::Part, ends);
                let bound = whole.measured().least(bound);
                (run.tip_bound[lane], run.axis_bound[lane]) = (bound.tip, bound.axis);
            }
            largest_yet.cut = largest_yet.cut.and(run.bound(lane));
        }
        largest_yet
    }

    /// The blocks of the run are handed on.
    pub(crate) fn certify(&mut self, run: &mut RunColumns) {
        self.largest = self.largest_of(run);
        let Some(placer) = self.placer.as_ref().map(Rc::clone) else {
            return;
        };
        let mut node = self.spare.take().unwrap_or_default();
        *node = run.node(&placer, run.count);
        self.spare = self.last.replace(node);
        self.on_part = true;
        self.compensation_due = false;
    }
}
