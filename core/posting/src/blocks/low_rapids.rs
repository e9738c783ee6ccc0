//! Rapids of the CL file between two cuts of one orientation, as low as bodies leave them.
//!
//! A CAM system draws the tool back to a height of its own between any two cuts, across there, and down. Where the way across
//! is proven clear lower, the tool leaves the rapids that lead up earlier and comes to those that lead down later: no piece
//! leads elsewhere but the one across. Records that move nothing may stand between them: those of the way that is left out
//! are carried out where it is left.

use post_machine::kinematics::Joints;

use super::across::AcrossChoice;
use super::{BlockSink, BlockStage, TURN};
use crate::accuracy::PathNode;
use crate::configuration::{ChosenPoint, pose};
use crate::program::{Command, MoveFeed};
use crate::report::Unlinked;
use crate::stream::StreamItem;

/// Rapids that are held back at most; of a longer run nothing is shortened.
const MOST_HELD: usize = 64;

/// Heights that are tried at most.
const TRIALS: u32 = 8;

/// A way that is lower by less is not worth it, and heights are told apart no closer, mm.
const WORTH: f64 = 1.0;

/// Rapids that wait for the next cut, and records between them.
#[derive(Debug, Default)]
pub(super) struct WaitingRapids {
    /// The point of the cut that they begin at.
    from: Option<ChosenPoint>,
    held: Vec<StreamItem<ChosenPoint>>,
}

/// Whether the rapids before a cut wait for it.
enum Waits {
    /// They go on.
    On,
    /// They end, by a cut or what else comes.
    No,
    /// They end, and lead to no cut from which they could be lower.
    Never(Unlinked),
}

impl WaitingRapids {
    /// Line of the first of them.
    pub(super) fn first_line(&self) -> Option<u64> {
        self.held.first().map(StreamItem::line)
    }

    /// The rapids among them.
    fn points(&self) -> impl Iterator<Item = &ChosenPoint> {
        self.held.iter().filter_map(|element| match element {
            StreamItem::Point(point) => Some(point),
            _ => None,
        })
    }

    /// Whether an element goes on as the tool stands at the cut, or moves nothing.
    fn takes(&self, element: &StreamItem<ChosenPoint>) -> Waits {
        let Some(from) = &self.from else {
            return Waits::No;
        };
        let full = self.held.len() >= MOST_HELD;
        match element {
            StreamItem::Command { command, .. } if moves_nothing(command) && !full => Waits::On,
            StreamItem::Command { command, .. } if command.leaves() => Waits::No,
            StreamItem::Command { .. } if self.points().next().is_some() => {
                Waits::Never(Unlinked::Stops)
            }
            StreamItem::Point(point) if point.motion.pace == MoveFeed::Rapid => {
                let plain = point.arrives && point.rewind.is_none() && !point.changed;
                let (one, other) = (&from.motion, &point.motion);
                let turn = (one.axis - other.axis).norm() + (one.edge - other.edge).norm();
                match turn < TURN && from.setting == point.setting {
                    false => Waits::Never(Unlinked::Turns),
                    true if plain && !point.eased && !full => Waits::On,
                    true => Waits::Never(Unlinked::Stops),
                }
            }
            _ => Waits::No,
        }
    }
}

/// A record that moves nothing, and at which the tool may stand anywhere off the part.
pub(super) fn moves_nothing(command: &Command) -> bool {
    matches!(
        command,
        Command::Operation(_)
            | Command::OperationEnd
            | Command::Comment(_)
            | Command::Message(_)
            | Command::Coolant(_)
            | Command::Spindle(_)
            | Command::Preselect(_)
    )
}

/// A run of rapids from the point of the cut that they begin at to where the next cut begins: that point and theirs.
struct RapidRun<'r>(Vec<&'r ChosenPoint>);

/// A lower way of a run: what is left out of it, and what is put in there.
struct LowWay {
    /// The first and the last place that are left out.
    left_out: [usize; 2],
    /// Where the way before them is left.
    leaves: ChosenPoint,
    /// Where the way behind them is come to; none where that is the place there.
    comes: Option<ChosenPoint>,
}

impl RapidRun<'_> {
    /// How high a point is over where the cut ended, mm along the tool axis.
    fn height(&self, place: usize) -> f64 {
        let from = &self.0[0].motion;
        (self.0[place].motion.tip - from.tip).dot(&from.axis)
    }

    /// The places between which the way is as high as it gets: up to the first it goes up, and down from the second.
    fn top(&self) -> [usize; 2] {
        let last = self.0.len() - 1;
        let up = (0..last).find(|place| self.height(place + 1) < self.height(*place));
        let down = (1..=last).rev().find(|place| self.height(place - 1) < self.height(*place));
        [up.unwrap_or(last), down.unwrap_or(0)]
    }

    /// The heights between which the way across may lie, mm: no lower than the cuts, and the height of the CL file. None
    /// where it does not draw the tool back from the one and bring it down to the other.
    fn heights(&self) -> Option<[f64; 2]> {
        let [up, down] = self.top();
        let least = self.height(self.0.len() - 1).max(0.0);
        let most = self.height(up).min(self.height(down));
        (most - least > WORTH).then_some([least, most])
    }

    /// The run with the way across at `height`. Where it goes across and down at once it is left for where that ends.
    fn across(&self, height: f64) -> Option<LowWay> {
        let [up, down] = self.top();
        let last = self.0.len() - 1;
        let leaves = (1..=up).find(|place| self.height(*place) >= height)?;
        let comes = (down..last).rev().find(|place| self.height(*place) >= height)?;
        if comes < leaves {
            return None;
        }
        Some(LowWay {
            left_out: [leaves, comes],
            leaves: self.between([leaves - 1, leaves], height),
            comes: (comes > leaves).then(|| self.between([comes + 1, comes], height)),
        })
    }

    /// The points of the lower way, that of the cut the first.
    fn lower<'w>(&'w self, way: &'w LowWay) -> impl Iterator<Item = &'w ChosenPoint> {
        let [first, last] = way.left_out;
        let before = self.0[..first].iter().copied();
        let behind = self.0[last + 1..].iter().copied();
        before.chain([&way.leaves]).chain(&way.comes).chain(behind)
    }

    /// The second of two points, moved to a height between them on the way from the one to the other.
    fn between(&self, [low, high]: [usize; 2], height: f64) -> ChosenPoint {
        let [least, most] = [low, high].map(|place| self.height(place));
        let share = ((height - least) / (most - least)).clamp(0.0, 1.0);
        let [low, high] = [low, high].map(|place| self.0[place]);
        let mut at = high.clone();
        at.motion.tip = low.motion.tip + (high.motion.tip - low.motion.tip) * share;
        at
    }
}

impl LowWay {
    /// The elements of the run in their order: what stood on the way that is left out comes where that is left.
    fn among(self, held: Vec<StreamItem<ChosenPoint>>) -> Vec<StreamItem<ChosenPoint>> {
        let Self { left_out: [first, last], leaves, comes } = self;
        let (mut leaves, mut comes) = (Some(leaves), comes);
        let mut place = 0;
        let element = |element: StreamItem<ChosenPoint>| {
            if !matches!(element, StreamItem::Point(_)) {
                return Some(element);
            }
            place += 1;
            match place {
                _ if place < first || place > last => Some(element),
                _ if place == first => leaves.take().map(StreamItem::Point),
                _ if place == last => comes.take().map(StreamItem::Point),
                _ => None,
            }
        };
        held.into_iter().filter_map(element).collect()
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
            let waits = self.rapids.takes(element);
            if let Waits::On = waits {
                self.rapids.held.push(element.clone());
                continue;
            }
            let cut = end_of_cut(element);
            let WaitingRapids { from, held } = std::mem::take(&mut self.rapids);
            let mut low = None;
            let goes = held.iter().any(|element| matches!(element, StreamItem::Point(_)));
            if let (Some(from), Some(_), true) = (&from, cut, goes) {
                // What solves the points is known behind all that comes before.
                self.take_each(&std::mem::take(&mut ready), out);
                low = self.lower(from, &held);
            }
            if let (Waits::Never(why), Some(across)) = (waits, &mut self.across) {
                across.stays(why);
            }
            match low {
                Some(low) => ready.extend(low.among(held)),
                None => ready.extend(held),
            }
            self.rapids.from = cut.cloned();
            ready.push(element.clone());
        }
        self.take_each(&ready, out);
    }

    /// The file ends, and no cut comes: what waits is as the CL file has it.
    pub(super) fn end_rapids(&mut self, out: &mut BlockSink<'_>) {
        let held = std::mem::take(&mut self.rapids).held;
        self.take_each(&held, out);
    }

    /// The lower way between two cuts: none where none is proven clear, or none is quicker.
    fn lower(&mut self, from: &ChosenPoint, held: &[StreamItem<ChosenPoint>]) -> Option<LowWay> {
        let points = held.iter().filter_map(|element| match element {
            StreamItem::Point(point) => Some(point),
            _ => None,
        });
        let run = RapidRun([from].into_iter().chain(points).collect());
        let mut across = self.across.take()?;
        let found = self.lowest(&mut across, &run).map_err(|why| across.stays(why));
        self.across = Some(across);
        found.ok()
    }

    fn lowest(
        &self,
        across: &mut AcrossChoice<'_>,
        run: &RapidRun<'_>,
    ) -> Result<LowWay, Unlinked> {
        let [least, most] = run.heights().ok_or(Unlinked::Low)?;
        let placer = self.placer.clone().ok_or(Unlinked::Machine)?;
        let known = std::ptr::eq(self.machine, self.base)
            && !self.machine.is_opened()
            && self.machine.control_point.along == 0.0
            && !self.compensating;
        if !known {
            return Err(Unlinked::Machine);
        }
        let place = |point: &ChosenPoint| -> Option<Joints> {
            let placed = placer.settled(pose(&point.motion), 1.0, self.planes.standing(point));
            placed.ok().map(|node: PathNode| node.trace.joints)
        };
        let mut trials = across.trials(self.machine, placer.solver()).ok_or(Unlinked::Length)?;
        let ever: Option<Vec<Joints>> = run.0.iter().copied().map(place).collect();
        let ever = trials.seconds(&ever.ok_or(Unlinked::Slower)?);
        let (mut low, mut high) = (least, most);
        let mut best: Option<(LowWay, f64)> = None;
        let mut height = least;
        for _ in 0..TRIALS {
            let way = run.across(height).ok_or(Unlinked::Slower)?;
            let places: Option<Vec<Joints>> = run.lower(&way).map(place).collect();
            let places = places.ok_or(Unlinked::Slower)?;
            let [leaves, _] = way.left_out;
            match trials.goes(&places[leaves], &places[leaves + 1]) {
                true => {
                    let seconds = trials.seconds(&places);
                    best = Some((way, seconds));
                    high = height;
                }
                false => low = height,
            }
            if high - low <= WORTH {
                break;
            }
            height = 0.5 * (low + high);
        }
        if ever <= 0.0 {
            return Err(Unlinked::Feeds);
        }
        let best = best.filter(|(_, seconds)| *seconds < ever);
        let (way, seconds) = best.ok_or(Unlinked::Slower)?;
        across.lowered(ever - seconds);
        Ok(way)
    }
}
