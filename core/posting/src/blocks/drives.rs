//! The drives of a parallel machine, which are no axes of the program: how long a block must take for them.

use post_machine::kinematics::{AxesWay, Joints, MAX_AXES, least_drive_minutes};

use super::{BlockStage, FollowTime, MotionBlock, PathLeg};
use crate::accuracy::PathNode;
use crate::curve::PrintedCurve;

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

    /// Likewise of a block along a curve, on which no rotary axis turns and no axis turns back between the places of
    /// `printed`: a drive goes at most so much faster than the tip as its joint on the platform makes it.
    #[cold]
    pub(super) fn drives_follow_curve(
        &self,
        block: &mut MotionBlock,
        leg: &PathLeg<'_>,
        printed: &PrintedCurve,
    ) {
        let Some(from) = &self.last else {
            return;
        };
        let mut places: Vec<&Joints> = vec![&from.trace.joints];
        places.extend(&printed.between);
        places.push(&block.joints);
        for (place, driven) in self.machine.legs().enumerate() {
            let sliding = driven.joints.iter().filter(|joint| !joint.rotary).count();
            let tip = match sliding {
                // All of them carry the platform, which goes as the tip does.
                3 => 1.0,
                count => count as f64 * leg.placer.solver().linear_reach(),
            };
            let gains = places.windows(2).map(|pair| driven.steepest([pair[0], pair[1]]));
            let speed = block.way * tip * gains.fold(0.0, f64::max);
            let minutes = speed / driven.max_feed;
            if minutes > block.follow.minutes {
                block.follow = FollowTime { minutes, joint: MAX_AXES + place };
            }
        }
    }
}
