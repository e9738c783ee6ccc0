//! Rapids of a cutter where it has been at feed, all of the way or a part of it.

use post_clearance::piece::Way;
use post_clearance::proof::Body;
use post_machine::kinematics::Pose;
use post_motion::path::{Stance, joints_between};
use post_removal::been::{Been, Turn};
use post_removal::profile::ToolPose;

/// Why a cutter is not held against a stock at rapid: it has been there at feed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spared {
    /// It goes back along the cut that it has just made.
    pub back: bool,
    /// Where it has been is known in the frame of the part: of a stock that hangs elsewhere nothing follows from it.
    on_part: bool,
}

impl Spared {
    /// Of a way between two poses, if it is straight and does not turn; none where the tool has not been.
    pub fn of(been: &Been, poses: Option<[ToolPose; 2]>, way: &Way<'_>) -> Option<Self> {
        let Some(poses) = poses else {
            let again = Turn::of(way).is_some_and(|turn| been.covers_turn(&turn));
            return again.then_some(Self { back: true, on_part: false });
        };
        let covered = been.covers(None, poses);
        covered.then(|| Self { back: been.is_along(poses), on_part: true })
    }

    /// It holds of a stock.
    pub fn holds(self, stock: &Body) -> bool {
        !self.on_part || stock.link == 0
    }
}

/// The parts of a way, by their ends: ahead of the first share and behind the other the tool goes where it has been.
pub(super) fn parts(
    way: &Way<'_>,
    [first, last]: [f64; 2],
    spared: Option<Spared>,
) -> impl Iterator<Item = ([Stance; 2], Option<Spared>)> {
    let [from, to] = way.ends.map(|end| *end);
    let at = move |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => {
            let tip = from.pose.tip + (to.pose.tip - from.pose.tip) * share;
            let joints = joints_between([&from, &to], share);
            Stance { joints, pose: Pose { tip, ..from.pose } }
        }
    };
    let again = Some(Spared { back: false, on_part: true });
    [([0.0, first], again), ([first, last], spared), ([last, 1.0], again)]
        .into_iter()
        .filter(|([begins, ends], _)| begins < ends)
        .map(move |(shares, spared)| (shares.map(at), spared))
}
