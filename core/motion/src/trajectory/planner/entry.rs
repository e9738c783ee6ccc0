//! A move as the planner keeps it until its corner is known.

use post_machine::description::BlendRule;
use post_machine::kinematics::Joints;

use super::Planner;
use crate::limits::MoveLimits;
use crate::path::{Curve, turns};
use crate::trajectory::TimeLimit;
use crate::trajectory::bounds::{DerivativeBounds, MoveBounds, MoveDemand, PlaceLimits};
use crate::trajectory::side::CornerSide;
use crate::{Move, ProgramPlace};

/// A move whose end is open.
#[derive(Clone, Debug)]
pub(super) struct OpenMove {
    /// Number in the law.
    pub number: u64,
    pub found: MoveLimits,
    pub whole: MoveBounds,
    /// Bounds with half of the accelerations; the whole ones where no moves overlap, as nobody asks for them.
    pub half: MoveBounds,
    /// The length that its parameter from 0 to 1 has in the coordinate of the law.
    pub scale: f64,
    /// The share of it that the corner before has taken.
    pub taken: f64,
    /// Whether the move begins a run.
    pub begins: bool,
    /// Overlapped by the move before: the change of its rate that it begins with, 1/s², and for how long, s.
    pub entrance: Option<[f64; 2]>,
    /// Joined to the move before: how the axes' derivatives change over the coordinate of the law.
    pub kink: Option<[Joints; 2]>,
    pub at: ProgramPlace,
}

impl OpenMove {
    /// What a corner has to know of it.
    pub fn side<'a>(&'a self, task: &'a Move) -> CornerSide<'a> {
        CornerSide {
            task,
            found: &self.found,
            whole: &self.whole,
            half: &self.half,
            overlapped: self.entrance.is_some(),
        }
    }
}

impl Planner {
    /// The entry of a move; `asked`: its time at the programmed feed, s.
    pub(super) fn entry(
        &self,
        task: &Move,
        found: MoveLimits,
        asked: Option<f64>,
        at: ProgramPlace,
    ) -> OpenMove {
        let standing = !turns(task.solver.chain(), [&task.from, &task.to]);
        let is_arc = matches!(task.way.curve(), Curve::Arc { .. });
        let sweep = (is_arc && standing).then(|| task.way.curve().turn());
        let feed = asked.unwrap_or(0.0);
        let derivatives = DerivativeBounds::of(&found);
        let limits = PlaceLimits::of(&self.limits);
        let bounds = |share: f64| {
            let seconds = feed.max(self.block_time);
            let demand = MoveDemand { seconds, share, sweep };
            let mut bounds = MoveBounds::new(&derivatives, &limits, &demand);
            if bounds.by[0] == TimeLimit::Feed && feed < seconds {
                bounds.by[0] = TimeLimit::BlockTime;
            }
            bounds
        };
        let whole = bounds(1.0);
        OpenMove {
            number: 0,
            half: match self.blend {
                BlendRule::Overlap => bounds(0.5),
                BlendRule::Round => whole,
            },
            scale: 1.0 / whole.rate,
            whole,
            found,
            taken: 0.0,
            begins: true,
            entrance: None,
            kink: None,
            at,
        }
    }
}
