//! The drives of a parallel machine, which are no axes of the program: how long a block must take for them.

use post_machine::kinematics::{AxesWay, Joints, MAX_AXES, least_drive_minutes};

use super::{BlockStage, FollowTime, MotionBlock, PathLeg};
use crate::accuracy::{PathNode, PrintedArc, WordFrame};

impl BlockStage<'_> {
    /// The least time of a block, of its drives too; `kept`: the control keeps the tip.
    #[cold]
    pub(super) fn drives_follow(
        &self,
        block: &mut MotionBlock,
        leg: &PathLeg<'_>,
        [from, node]: [&PathNode; 2],
        kept: bool,
    ) {
        let along = leg.placer.control_point().along;
        let way = match kept {
            true => AxesWay::KeepingTip { solver: leg.placer.solver(), along },
            false => AxesWay::Straight,
        };
        let ends = [&from.trace.joints, &node.trace.joints];
        let found = least_drive_minutes(self.machine.legs(), way, ends, block.asked());
        let slower = found.filter(|(minutes, _)| *minutes > block.follow.minutes);
        if let Some((minutes, place)) = slower {
            block.follow = FollowTime { minutes, joint: MAX_AXES + place };
        }
    }

    /// Likewise of an arc, on which no rotary axis turns: the least time is put into `follow`.
    #[cold]
    pub(super) fn drives_follow_arc(
        &self,
        frame: &WordFrame<'_>,
        printed: &PrintedArc,
        follow: &mut FollowTime,
    ) {
        let ends = [frame.joints(printed.at(0.0)), frame.joints(printed.at(1.0))];
        let between = |share: f64| Some(frame.joints(printed.at(share)));
        let mut bends = Joints::default();
        for (joint, slide) in frame.slides() {
            bends[*joint] = slide.norm() * printed.bend();
        }
        for (place, leg) in self.machine.legs().enumerate() {
            let speed = leg.fastest([&ends[0], &ends[1]], &between, &bends, 0.0);
            let minutes = speed / leg.max_feed;
            if minutes > follow.minutes {
                *follow = FollowTime { minutes, joint: MAX_AXES + place };
            }
        }
    }
}
