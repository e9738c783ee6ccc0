//! Where the cutter of a tool has been: it may go there again at rapid, through what is drawn as the stock.

use nalgebra::Vector3;
use post_machine::kinematics::Joints;
use post_readback::{Motion, MotionKind, Stance};

/// Half of the last place of a word, mm or degrees: controls have three decimals or more.
const HALF_PLACE: f64 = 0.5e-3;

/// A line along the tool axis that the tool has gone down, part frame.
#[derive(Clone, Copy, Debug)]
struct Bore {
    /// A place of the tip on it, mm.
    tip: Vector3<f64>,
    /// Tool axis.
    axis: Vector3<f64>,
    /// The lowest that the tip has been on it, mm from `tip` along the axis.
    lowest: f64,
}

/// Where a tool has been last.
#[derive(Clone, Debug, Default)]
pub(super) struct Been {
    bore: Option<Bore>,
    /// The ends of the straight cut that it made last, mm and radians, none turned on it.
    stroke: Option<[Joints; 2]>,
}

impl Been {
    /// The tool has been all along a rapid: on the way of the cut before it, or along its axis above the lowest point that it
    /// has been at, if it `widens` upwards or not at all. `independent`: the axes need not arrive together.
    pub fn covers(&self, motion: &Motion, independent: bool, widens: bool) -> bool {
        if !is_straight(motion, independent) {
            return false;
        }
        let back = [motion.to.joints, motion.from.joints];
        let ends = [&motion.from, &motion.to];
        self.stroke == Some(back)
            || widens
                && self.bore.is_some_and(|bore| {
                    ends.iter()
                        .all(|end| bore.height(end).is_some_and(|at| at >= bore.lowest - lean(0.0)))
                })
    }

    /// Takes a motion that the tool has made.
    pub fn take(&mut self, motion: &Motion, independent: bool) {
        let straight = is_straight(motion, independent);
        let cuts = straight && motion.kind != MotionKind::Rapid;
        self.stroke = cuts.then_some([motion.from.joints, motion.to.joints]);
        let goes_on = self.bore.filter(|_| straight).and_then(|bore| {
            bore.height(&motion.from)?;
            Some(Bore { lowest: bore.height(&motion.to)?.min(bore.lowest), ..bore })
        });
        let begins = |at: &Stance| Bore { tip: at.pose.tip, axis: at.pose.axis, lowest: 0.0 };
        self.bore = goes_on.or_else(|| match straight {
            true => {
                let bore = begins(&motion.from);
                let lowest = bore.height(&motion.to)?.min(0.0);
                Some(Bore { lowest, ..bore })
            }
            false => None,
        });
        self.bore = self.bore.or_else(|| Some(begins(&motion.to)));
    }
}

impl Bore {
    /// How high a tip stands on it, mm; none beside it.
    fn height(&self, at: &Stance) -> Option<f64> {
        let way = at.pose.tip - self.tip;
        let height = way.dot(&self.axis);
        let aside = (way - self.axis * height).norm();
        (aside <= lean(height)).then_some(height)
    }
}

/// How far a way of `length` mm along the tool axis may end beside it as its words are printed, mm: each of three linear words
/// at both ends, and the directions of two rotary ones.
fn lean(length: f64) -> f64 {
    6.0 * HALF_PLACE + 2.0 * HALF_PLACE.to_radians() * libm::fabs(length)
}

/// It goes straight, and nothing turns; of axes that need not arrive together one goes alone, but for rounding.
fn is_straight(motion: &Motion, independent: bool) -> bool {
    let ways = motion.from.joints.iter().zip(&motion.to.joints);
    let ways = ways.map(|(from, to)| libm::fabs(to - from));
    let (all, most) = ways.fold((0.0, 0.0f64), |(all, most), way| (all + way, most.max(way)));
    !motion.turns() && !motion.way.is_curved() && (!independent || all - most <= lean(most))
}
