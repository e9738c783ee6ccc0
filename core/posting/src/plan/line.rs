//! Makes feeds of blocks from legs of the curve: samples, limits, solver, pieces.

use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

use nalgebra::Vector3;
use post_feed::Infeasible;
use post_feed::fit::{self, CurveSample, FittedLeg};
use post_feed::limits::{ChordError, Collocation, Limit};
use post_machine::description::{Machine, PlanSolver};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Joints;

use super::corner::Corner;
use super::cut::BlockCutter;
use super::graded::{at_least, evenly_bent, graded};
use super::limits::{self, PlanAxes};
use super::pieces::{CutThresholds, FeedPiece, STANDING};
use super::queue::{BlockQueue, BlockStart};
use super::rest::RestToRest;
use super::samples::{PathDerivatives, SampleBlock, Sampler, WatchedSample};
use super::solver::{SampleSolver, SettledSample};
use super::watch::PlannedPoint;
use super::{CORNER, SharedWatch};
use crate::accuracy::Placer;
use crate::blocks::{BlockSink, MotionBlock, PlannedTime, STILL};
use crate::stream::StreamItem;
use crate::tightening::Tightening;

/// Samples after the first of a leg next to a stop or corner, where jerk is planned.
const LEAST_FOR_JERK: usize = 4;

/// From stop to stop the tool goes faster at one sample between them at least.
const LEAST: usize = 2;

/// No samples are closer for the sake of accelerations, mm.
const FINEST: f64 = 0.01;

/// The share of the way of a block by which its speed is that of the tip, and not that of its rotary axes too.
const MOSTLY: f64 = 0.7;

/// What a block says of its legs.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockDemand {
    /// The feed, mm/s; none where the tip stands still, and the time says it.
    feed: Option<f64>,
    /// The tip stands still.
    stands: bool,
    /// Time that the CL file leaves the block, s.
    seconds: f64,
    /// Length of the block where it has several legs, mm.
    way: f64,
    legs: usize,
    /// Line of the CL file; none where the curve is not that of the tip.
    line: Option<u64>,
    /// Share of the contour error that all of the block may have.
    pub(super) share: f64,
}

impl BlockDemand {
    /// What `block` says; `aside` if another point than the tip is guided, whose way is another.
    pub(super) fn of(block: &MotionBlock, aside: bool) -> Self {
        let seconds = block.asked() * 60.0;
        let moves = block.way > STILL && !aside;
        Self {
            feed: moves.then(|| block.way / seconds),
            stands: block.way <= STILL,
            seconds,
            way: block.way,
            legs: 1,
            line: (!aside).then_some(block.line),
            share: 1.0,
        }
    }
}

/// A run of blocks on its way through the planner.
pub(super) struct PlannerRun<'a> {
    feeds: BlockFeeds<'a>,
    axes: PlanAxes,
    sampler: Sampler,
    tightening: Option<Arc<Tightening>>,
    limits: Vec<Box<dyn Limit>>,
    corner: Corner,
    solver: SampleSolver,
    /// Jerk is planned, which needs some intervals between stops.
    jerk: bool,
    /// A limit is asked for that holds the tool in bends, beyond what its axes can.
    bends: bool,
    /// The least acceleration of a linear axis, mm/s².
    acceleration: f64,
    samples: Vec<CurveSample>,
    due: VecDeque<BlockDemand>,
    /// Legs of the first of them that have come, and their length.
    come: usize,
    way: f64,
    /// Length of the last leg.
    length: f64,
    fault: Option<Diagnostic>,
}

/// The line cannot be planned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Unplanned;

impl<'a> PlannerRun<'a> {
    pub(super) fn new(
        machine: &'a Machine,
        placer: Rc<Placer>,
        tightening: Option<Arc<Tightening>>,
        watch: Option<SharedWatch<'a>>,
        least_block: f64,
    ) -> Self {
        let rules = &machine.plan;
        let axes = PlanAxes::new(machine);
        let limits = limits::limits(machine, rules);
        let chord = rules.chord_error.map(|tolerance| ChordError {
            tolerance,
            period: machine.motion.period,
            collocation: Collocation::Throughout,
        });
        let sampler = Sampler::new(Rc::clone(&placer), axes.sampled(), &Joints::default());
        let empty = post_feed::Samples {
            axes: vec![Default::default(); sampler.count()],
            ..Default::default()
        };
        let stride = limits.iter().map(|limit| limit.rows(&empty).len()).sum();
        Self {
            feeds: BlockFeeds {
                cutting: CutThresholds {
                    saving: rules.least_saving,
                    shortest: rules.shortest_block.max(least_block),
                },
                cutter: BlockCutter { machine, placer },
                rest: RestToRest::new(&axes),
                names: limits.iter().map(|limit| limit.name()).collect(),
                pieces: Vec::new(),
                slowest: None,
                watch,
            },
            corner: Corner::new(machine, &axes, chord),
            axes,
            sampler,
            tightening,
            limits,
            solver: SampleSolver::new(rules.solver, stride),
            jerk: rules.solver == PlanSolver::Jerk,
            bends: rules.contour_error.is_some(),
            acceleration: machine
                .axes
                .iter()
                .filter(|axis| !axis.joint.rotary)
                .map(|axis| axis.max_accel)
                .fold(f64::INFINITY, f64::min),
            samples: Vec::new(),
            due: VecDeque::new(),
            come: 0,
            way: 0.0,
            length: 0.0,
            fault: None,
        }
    }

    pub(super) fn placer(&self) -> &Rc<Placer> {
        &self.feeds.cutter.placer
    }

    /// Coordinates of the curve.
    pub(super) fn dimensions(&self) -> usize {
        self.sampler.dimensions()
    }

    /// A stance as a point of the curve: its control point (mm, part frame) and axis values.
    pub(super) fn point(&self, tip: Vector3<f64>, joints: &Joints) -> fit::FitPoint {
        self.sampler.point(tip, joints)
    }

    /// A path begins with the axes there.
    pub(super) fn begin(&mut self, joints: &Joints) {
        let placer = Rc::clone(&self.feeds.cutter.placer);
        self.sampler = Sampler::new(placer, self.axes.sampled(), joints);
        self.due.clear();
        (self.come, self.way) = (0, 0.0);
    }

    /// Takes what the next block demands, which comes in `legs` legs.
    pub(super) fn due(&mut self, due: BlockDemand, legs: usize) {
        self.due.push_back(BlockDemand { legs, ..due });
    }

    /// The curve goes on by a leg.
    pub(super) fn leg(
        &mut self,
        leg: &FittedLeg<'_>,
        queue: &mut BlockQueue,
        out: &mut BlockSink<'_>,
    ) -> Result<(), Unplanned> {
        let Some(due) = self.due.front().copied() else {
            return Err(Unplanned);
        };
        let length = if due.legs == 1 { leg.length } else { due.way };
        let said = SampleBlock {
            feed: due.feed.unwrap_or(length / due.seconds),
            length,
            share: due.share,
        };
        let Some((first, rest)) = leg.samples.split_first() else {
            return Err(Unplanned);
        };
        let tightening = self.tightening.clone();
        // Most lines have no such place.
        let tightened = tightening
            .as_deref()
            .zip(due.line)
            .filter(|(tightening, line)| tightening.concerns(*line));
        let said_at = |sample: &fit::CurveSample| match tightened {
            Some((tightening, line)) => {
                let [x, y, z, ..] = sample.values[0];
                let share = tightening.share(line, &Vector3::new(x, y, z));
                SampleBlock { share, ..said }
            }
            None => said,
        };
        let said = said_at(first);
        if leg.begins {
            let place = self.place(first, due)?;
            if let Some(before) = self.sampler.last() {
                let q = self.corner.allows(before, &place, self.length.min(leg.length));
                // What servos make of a corner goes with the speed.
                let q = q * said.share * said.share;
                self.plan(queue, out)?;
                self.sampler.corner(&place, said, q);
                queue.corner(&place);
            } else {
                self.sampler.push(&place, said, 0.0);
                queue.mark(0.0, &place, false);
            }
        } else {
            self.sampler.enter(said);
        }
        self.come += 1;
        let ends = self.come == due.legs;
        let mut at = first.at;
        let mut samples = std::mem::take(&mut self.samples);
        graded(first, rest, self.finest(said.feed), &mut samples);
        self.refine(leg, first, &mut samples);
        for (index, sample) in samples.iter().enumerate() {
            let place = self.place(sample, due)?;
            self.sampler.push(&place, said_at(sample), sample.at - at);
            let last = ends && index + 1 == samples.len();
            queue.mark(self.way + sample.at, &place, last);
            at = sample.at;
            if self.sampler.is_full() {
                self.plan(queue, out)?;
            }
        }
        self.samples = samples;
        self.length = leg.length;
        self.way += leg.length;
        if ends {
            self.due.pop_front();
            (self.come, self.way) = (0, 0.0);
        }
        Ok(())
    }

    /// Adds samples of a leg after its first where the limits need them closer.
    fn refine(&self, leg: &FittedLeg<'_>, first: &CurveSample, samples: &mut Vec<CurveSample>) {
        if self.bends {
            evenly_bent(first, samples);
        }
        if self.jerk && (leg.begins || leg.ends) {
            at_least(LEAST_FOR_JERK, first, samples);
        } else if leg.begins && leg.ends {
            at_least(LEAST, first, samples);
        }
    }

    /// The path at a sample; where the tip stands still in a block, what is left of its way is rounding.
    fn place(&self, sample: &CurveSample, due: BlockDemand) -> Result<PathDerivatives, Unplanned> {
        let mut place = self.sampler.place(sample).map_err(|_| Unplanned)?;
        if due.feed.is_none() && due.stands {
            place.tip = [[0.0; 3]; 3];
        }
        Ok(place)
    }

    /// The closest samples that matter where the speed changes, mm: an eighth of the way to rest.
    fn finest(&self, feed: f64) -> f64 {
        match self.acceleration.is_finite() {
            true => (feed * feed / (2.0 * self.acceleration) / 8.0).max(FINEST),
            false => f64::INFINITY,
        }
    }

    /// The path ends at rest.
    pub(super) fn finish(
        &mut self,
        queue: &mut BlockQueue,
        out: &mut BlockSink<'_>,
    ) -> Result<(), Unplanned> {
        self.plan(queue, out)?;
        let found = self.solver.finish(&mut |step| self.feeds.settled(step, queue, out));
        found.map_err(|fault| self.refuse(&fault))?;
        queue.profile.clear();
        queue.account.uncertain(self.solver.uncertain());
        self.sampler.end();
        Ok(())
    }

    /// Gives up what is waiting: why, if that was not reported yet.
    pub(super) fn give_up(&mut self) -> Option<Diagnostic> {
        self.solver.clear();
        self.sampler.end();
        self.due.clear();
        self.feeds.slowest = None;
        self.fault.take()
    }

    /// Hands the samples gathered so far to the solver.
    fn plan(&mut self, queue: &mut BlockQueue, out: &mut BlockSink<'_>) -> Result<(), Unplanned> {
        let limits: Vec<&dyn Limit> = self.limits.iter().map(|limit| &**limit).collect();
        let found = match self.sampler.batch(&limits) {
            Ok(None) => return Ok(()),
            Ok(Some(batch)) => {
                self.solver.push(batch, &mut |step| self.feeds.settled(step, queue, out))
            }
            Err(fault) => Err(fault),
        };
        self.sampler.next();
        found.map_err(|fault| self.refuse(&fault))
    }

    #[cold]
    fn refuse(&mut self, fault: &Infeasible) -> Unplanned {
        self.fault = Some(
            Diagnostic::warning(
                "plan",
                format!("no feed is planned from here to where the tool stands still: {fault}"),
            )
            .help("the feeds of these blocks are those of the CL file"),
        );
        Unplanned
    }
}

/// What is made of samples whose speed is settled: feeds of blocks.
struct BlockFeeds<'a> {
    cutter: BlockCutter<'a>,
    cutting: CutThresholds,
    rest: RestToRest,
    /// Names of the limits, in order.
    names: Vec<&'static str>,
    pieces: Vec<FeedPiece>,
    /// Where the block in hand is slowest: squared speed, and the limit that it is at.
    slowest: Option<(f64, &'static str)>,
    watch: Option<SharedWatch<'a>>,
}

impl BlockFeeds<'_> {
    fn settled(&mut self, step: SettledSample, queue: &mut BlockQueue, out: &mut BlockSink<'_>) {
        let source = step.source;
        let name = self.names.get(usize::from(source.limit));
        let name = name.copied().unwrap_or(CORNER);
        let before = queue.left();
        let ends = queue.settle(&step);
        if step.q > 0.0 && self.slowest.is_none_or(|(least, _)| step.q < least) {
            self.slowest = Some((step.q, name));
        }
        if queue.seconds > 0.0 {
            queue.account.limited(name, source.axis, queue.seconds);
            self.watch(queue, before.as_deref(), step, name);
        }
        if !ends {
            return;
        }
        match queue.first_open(out) {
            Some((StreamItem::Point(block), start)) => {
                let mut point = |block| out.push(StreamItem::Point(block));
                self.block(&block, &start, queue, &mut point);
            }
            Some((StreamItem::Curve { line, mut curve }, start)) => {
                let block = curve.block;
                // A curve is not cut: it stays one block.
                let mut whole = |block| curve.block = block;
                self.block(&block, &start, queue, &mut whole);
                out.push(StreamItem::Curve { line, curve });
            }
            Some((other, _)) => out.push(other),
            None => {}
        }
        queue.profile.begin();
        self.slowest = None;
        queue.ready(out);
    }

    /// Shows both ends of an interval, with what the plan does inside it.
    fn watch(
        &self,
        queue: &BlockQueue,
        before: Option<&WatchedSample>,
        step: SettledSample,
        limit: &'static str,
    ) {
        let (Some(watch), Some(before), Some(behind)) =
            (&self.watch, before, queue.stand.as_deref())
        else {
            return;
        };
        let Some([from, to]) = queue.profile.ends_of_way(step.halfway.is_some()) else {
            return;
        };
        let way = to.at - from.at;
        let middle = step.halfway.unwrap_or(from.q.midpoint(to.q));
        let bend = 4.0 * (from.q - 2.0 * middle + to.q) / (way * way);
        let slope = (to.q - from.q) / way;
        let ends = [
            (before, 0.0, [from.q, slope - 0.5 * bend * way, bend]),
            (behind, way, [to.q, slope + 0.5 * bend * way, bend]),
        ];
        for (stand, step_way, q) in ends {
            watch.borrow_mut().planned(&PlannedPoint {
                machine: self.cutter.machine,
                line: queue.open_line().unwrap_or_default(),
                step: step_way,
                seconds: queue.seconds,
                tip: &stand.tip,
                course: &stand.course,
                q,
                limit,
                axis: step.source.axis,
            });
        }
    }

    /// A block whose plan is known: one, or several.
    fn block(
        &mut self,
        block: &MotionBlock,
        start: &BlockStart,
        queue: &mut BlockQueue,
        out: &mut dyn FnMut(MotionBlock),
    ) {
        let BlockQueue { profile, account, .. } = queue;
        let asked = block.asked() * 60.0;
        let planned = profile.seconds();
        let (from, to) = (&start.joints, &block.joints);
        if self.rest.is_passed(planned, asked, from, to) {
            account.too_slow();
            out(*block);
            return;
        }
        // Where the tip makes most of the way, its feed is what the block keeps.
        let by_tip = block.way >= MOSTLY * profile.length();
        let length = match by_tip {
            true => block.way,
            false => profile.length(),
        };
        profile.measure(by_tip);
        let limit = self.slowest.map(|(_, limit)| limit);
        match BlockCutter::can_cut(block) {
            true => {
                let can_end = |share: f64| self.cutter.can_end(block, start, share);
                profile.pieces(&self.cutting, length, &can_end, &mut self.pieces);
            }
            false => {
                self.pieces.clear();
                self.pieces.extend(profile.whole(length));
            }
        }
        // Where samples lie closer together than they are exact, the tool may seem to stand at all of them.
        if planned > 0.0 {
            let floor = STANDING * length / planned;
            for piece in &mut self.pieces {
                piece.speed = piece.speed.max(floor);
            }
        }
        let mut printed = 0.0;
        let count = self.cutter.cut(block, start, &self.pieces, length, |piece, seconds| {
            printed += seconds;
            let planned = PlannedTime { minutes: seconds / 60.0, limit };
            out(MotionBlock { planned, ..piece });
        });
        // What is written is never faster than the CL file asks for.
        account.block(count, asked, planned, printed.max(asked));
    }
}
