//! Rapids of the CL file between two cuts of one orientation, as low as bodies leave them.
//!
//! A CAM system draws the tool back to a height of its own between any two cuts, across there, and down. Where the way across
//! is proven clear lower, the tool leaves the first piece of these rapids earlier and comes to the last one later: no piece
//! leads elsewhere but the one across.

use post_machine::kinematics::Joints;

use super::across::AcrossChoice;
use super::{BlockSink, BlockStage, TURN};
use crate::accuracy::{PathNode, Placer};
use crate::configuration::{ChosenPoint, pose};
use crate::program::MoveFeed;
use crate::stream::StreamItem;

/// Rapids that are held back at most; of a longer run nothing is shortened.
const MOST_HELD: usize = 64;

/// The fewest of a run whose way across can be lower: up, and across and down at once.
const LEAST_HELD: usize = 2;

/// Heights that are tried at most.
const TRIALS: u32 = 8;

/// A way that is lower by less is not worth it, and heights are told apart no closer, mm.
const WORTH: f64 = 1.0;

/// Rapids that wait for the next cut.
#[derive(Debug, Default)]
pub(super) struct WaitingRapids {
    /// The point of the cut that they begin at.
    from: Option<ChosenPoint>,
    held: Vec<ChosenPoint>,
}

impl WaitingRapids {
    /// Line of the first of them.
    pub(super) fn first_line(&self) -> Option<u64> {
        self.held.first().map(|point| point.line)
    }

    /// A rapid goes on as the tool stands at the cut.
    fn takes(&self, point: &ChosenPoint) -> bool {
        let plain = point.arrives && point.rewind.is_none() && !point.changed && !point.eased;
        let alike = |from: &ChosenPoint| {
            let (from, to) = (&from.motion, &point.motion);
            (from.axis - to.axis).norm() + (from.edge - to.edge).norm() < TURN
        };
        point.motion.pace == MoveFeed::Rapid
            && plain
            && self.held.len() < MOST_HELD
            && self.from.as_ref().is_some_and(|from| from.setting == point.setting && alike(from))
    }
}

/// A run of rapids, from the point of the cut that they begin at to where the next cut begins.
struct RapidRun<'r> {
    from: &'r ChosenPoint,
    points: &'r [ChosenPoint],
}

impl RapidRun<'_> {
    /// How high a point is over where the cut ended, mm along the tool axis.
    fn height(&self, point: &ChosenPoint) -> f64 {
        (point.motion.tip - self.from.motion.tip).dot(&self.from.motion.axis)
    }

    /// The heights between which the way across may lie, mm: no lower than the cuts, and the height of the CL file. None
    /// where it does not draw the tool back from the one and bring it down to the other.
    fn heights(&self) -> Option<[f64; 2]> {
        let [first, .., last] = self.points else {
            return None;
        };
        let over = self.comes_over().map_or(f64::INFINITY, |over| self.height(over));
        let (least, most) = (self.height(last).max(0.0), self.height(first).min(over));
        (most - least > WORTH).then_some([least, most])
    }

    /// From where the last piece comes down; none where it leads across as well.
    fn comes_over(&self) -> Option<&ChosenPoint> {
        match self.points {
            [_, .., over, _] => Some(over),
            _ => None,
        }
    }

    /// The points of the run with the way across at `height`: at which the first piece is left, at which the last one is
    /// come to, and where it ends.
    fn across(&self, height: f64) -> Option<Vec<ChosenPoint>> {
        let [first, .., last] = self.points else {
            return None;
        };
        let mut points = vec![self.between([self.from, first], height)];
        points.extend(self.comes_over().map(|over| self.between([last, over], height)));
        points.push(last.clone());
        Some(points)
    }

    /// The second of two points, moved to a height between them on the way from the one to the other.
    fn between(&self, [low, high]: [&ChosenPoint; 2], height: f64) -> ChosenPoint {
        let [least, most] = [low, high].map(|point| self.height(point));
        let share = ((height - least) / (most - least)).clamp(0.0, 1.0);
        let mut at = high.clone();
        at.motion.tip = low.motion.tip + (high.motion.tip - low.motion.tip) * share;
        at
    }
}

/// The last point of a cut; none of what is none.
fn end_of_cut(element: &StreamItem<ChosenPoint>) -> Option<&ChosenPoint> {
    let last = match element {
        StreamItem::Curve { curve, .. } => curve.moves.last()?,
        element => element,
    };
    let StreamItem::Point(point) = last else {
        return None;
    };
    let cuts = point.motion.pace != MoveFeed::Rapid && point.arrives && point.rewind.is_none();
    cuts.then_some(point)
}

impl BlockStage<'_> {
    /// Takes elements in order, the rapids between cuts as low as bodies leave them.
    pub(super) fn take_low(
        &mut self,
        elements: &[StreamItem<ChosenPoint>],
        out: &mut BlockSink<'_>,
    ) {
        let mut ready = Vec::with_capacity(elements.len());
        for element in elements {
            let point = match element {
                StreamItem::Point(point) => Some(point),
                _ => None,
            };
            if let Some(point) = point.filter(|point| self.rapids.takes(point)) {
                self.rapids.held.push(point.clone());
                continue;
            }
            let cut = end_of_cut(element);
            let WaitingRapids { from, held } = std::mem::take(&mut self.rapids);
            let shortened = match (&from, cut) {
                (Some(from), Some(_)) if held.len() >= LEAST_HELD => {
                    // What solves the points is known behind all that comes before.
                    self.take_each(&std::mem::take(&mut ready), out);
                    self.lower(&RapidRun { from, points: &held })
                }
                _ => None,
            };
            ready.extend(shortened.unwrap_or(held).into_iter().map(StreamItem::Point));
            self.rapids.from = cut.cloned();
            ready.push(element.clone());
        }
        self.take_each(&ready, out);
    }

    /// The file ends, and no cut comes: what waits is as the CL file has it.
    pub(super) fn end_rapids(&mut self, out: &mut BlockSink<'_>) {
        let held = std::mem::take(&mut self.rapids).held;
        let held: Vec<_> = held.into_iter().map(StreamItem::Point).collect();
        self.take_each(&held, out);
    }

    /// The points of a run whose way across is lower: none where none is proven clear, or none is quicker.
    fn lower(&mut self, run: &RapidRun<'_>) -> Option<Vec<ChosenPoint>> {
        let heights = run.heights()?;
        let placer = self.placer.clone()?;
        let known = std::ptr::eq(self.machine, self.base)
            && !self.machine.is_opened()
            && self.machine.control_point.along == 0.0
            && !self.compensating;
        if !known {
            return None;
        }
        let mut across = self.across.take()?;
        let found = self.lowest(&mut across, &placer, run, heights);
        self.across = Some(across);
        found
    }

    fn lowest(
        &self,
        across: &mut AcrossChoice<'_>,
        placer: &Placer,
        run: &RapidRun<'_>,
        [least, most]: [f64; 2],
    ) -> Option<Vec<ChosenPoint>> {
        let place = |point: &ChosenPoint| -> Option<Joints> {
            let placed = placer.settled(pose(&point.motion), 1.0, self.planes.standing(point));
            placed.ok().map(|node: PathNode| node.trace.joints)
        };
        let way = |points: &[ChosenPoint]| -> Option<Vec<Joints>> {
            [run.from].into_iter().chain(points).map(place).collect()
        };
        let mut trials = across.trials(self.machine, placer.solver())?;
        let ever = trials.seconds(&way(run.points)?);
        let (mut low, mut high) = (least, most);
        let mut best: Option<(Vec<ChosenPoint>, f64)> = None;
        let mut height = least;
        for _ in 0..TRIALS {
            let points = run.across(height)?;
            let places = way(&points)?;
            match trials.goes(&places[1], &places[2]) {
                true => {
                    let seconds = trials.seconds(&places);
                    best = Some((points, seconds));
                    high = height;
                }
                false => low = height,
            }
            if high - low <= WORTH {
                break;
            }
            height = 0.5 * (low + high);
        }
        let (points, seconds) = best.filter(|(_, seconds)| *seconds < ever)?;
        across.lowered(ever - seconds);
        Some(points)
    }
}
