//! The fastest feed that axes, tip and servos can follow, planned over the blocks as they come (Chen, Ren and Sun 2016).
//!
//! Blocks are chords of a path that was smooth. Between corners a curve is laid through their ends, within a share of the
//! tolerance ([`post_feed::fit`]); the axes follow it by the chain's own derivatives; the limits make bounds and rows of
//! its samples, and reachability analysis finds the fastest feed along it. Each block then has the least feed that is
//! planned anywhere on it; where that changes too much inside a block, the block is cut.
//!
//! It streams: a block waits until the look-ahead has settled its samples, commands among the blocks wait with it. The
//! path is planned from standstill to standstill: at rapids, at words that the control stands still for, around holes,
//! and, where the control stops at every corner, from block to block.

mod account;
mod contour;
mod corner;
mod cut;
mod graded;
mod limits;
mod line;
mod pieces;
mod queue;
mod rest;
mod samples;
mod solver;
mod watch;

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;

use post_feed::fit::{self, PathFit};
use post_machine::description::{CornerRule, FeedMode, InverseTime, Machine, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_plugin::Format;

use crate::accuracy::Placer;
use crate::blocks::{BlockNote, BlockSink, MotionBlock};
use crate::findings::Findings;
use crate::program::Command;
use crate::stream::{HoleMoves, StreamItem};
use crate::tightening::Tightening;
pub use account::{LimitShare, PlanReport, axis_name};
pub use limits::{SampledAxes, limits};
use line::{BlockDemand, PlannerRun};
use queue::{BlockQueue, BlockStart};
pub use watch::{PlanWatch, PlannedPoint};

/// The name under which corners stand among the limits.
const CORNER: &str = "corner";

/// How the parameter of the curve, a length, counts turns: mm a radian.
const TURN_WEIGHT: f64 = 10.0;

/// Rotary axes are smoothed by no more than this, radians: 0.02°.
const TURN: f64 = 3.5e-4;

/// Largest distance of samples along a straight line, mm.
const SPACING: f64 = 2.0;

/// What the fit takes for no way at all, in tolerances.
const STANDS: f64 = 1.001e-3;

/// The observer of a plan, shared by what plans.
type SharedWatch<'a> = Rc<RefCell<&'a mut dyn PlanWatch>>;

/// The stage that plans feeds.
pub(crate) struct PlanStage<'a> {
    base: &'a Machine,
    machine: &'a Machine,
    /// Where the contour error may use less than its limit.
    tightening: Option<Arc<Tightening>>,
    watch: Option<SharedWatch<'a>>,
    /// What blocks are made with.
    placer: Option<Rc<Placer>>,
    run: Option<CurvePlanner<'a>>,
    queue: BlockQueue,
    /// Where the axes stand; none where it is not known.
    stands: Option<BlockStart>,
    /// Where the last leg of the curve ends.
    point: fit::FitPoint,
    /// A path has begun.
    moves: bool,
    refused: bool,
    /// Whether what the machine cannot keep was reported.
    warned: bool,
    /// The control takes no block for shorter than this, s.
    least_block: f64,
    findings: Findings,
}

/// What plans with one placer.
struct CurvePlanner<'a> {
    fit: PathFit,
    line: PlannerRun<'a>,
}

impl<'a> PlanStage<'a> {
    pub(crate) fn new(
        machine: &'a Machine,
        format: &Format,
        tightening: Option<Arc<Tightening>>,
        findings: &Findings,
    ) -> Self {
        Self {
            base: machine,
            machine,
            tightening,
            watch: None,
            placer: None,
            run: None,
            queue: BlockQueue::default(),
            stands: None,
            point: [0.0; fit::MOST],
            moves: false,
            refused: false,
            warned: false,
            least_block: least_block(machine, format),
            findings: findings.clone(),
        }
    }

    /// Shows what is planned to `watch`.
    pub(crate) fn watch(&mut self, watch: &'a mut dyn PlanWatch) {
        self.queue.watched = true;
        self.watch = Some(Rc::new(RefCell::new(watch)));
    }

    /// Line of the CL file of the first block that waits.
    pub(crate) fn first_line(&self) -> Option<u64> {
        self.queue.first_line()
    }

    /// What was planned so far.
    pub(crate) fn report(&self) -> PlanReport {
        self.queue.account.report(self.machine)
    }

    /// Takes a batch, which is empty then.
    pub(crate) fn take(
        &mut self,
        batch: &mut Vec<StreamItem<MotionBlock>>,
        out: &mut BlockSink<'_>,
    ) {
        // Another head may have come since.
        self.take_placer(out);
        for next in batch.drain(..) {
            match next {
                StreamItem::Point(_) | StreamItem::Curve { .. } => self.block(next, out),
                StreamItem::Hole(hole) => self.hole(hole, out),
                StreamItem::Command { ref command, .. } => {
                    self.command(command, out);
                    self.queue.push(next);
                }
                StreamItem::Note { note: BlockNote::Plane(_) | BlockNote::Across(_), .. } => {
                    self.stop(out);
                    self.queue.push(next);
                }
                StreamItem::Note { note: BlockNote::Placer(placer), .. } => {
                    self.placer = Some(placer);
                    self.take_placer(out);
                }
            }
        }
        if !self.moves {
            self.queue.ready(out);
        }
    }

    /// The program ends.
    pub(crate) fn finish(&mut self, out: &mut BlockSink<'_>) {
        self.stop(out);
        if let Some(warning) = self.queue.account.slower_than_none() {
            self.findings.add(warning);
        }
    }

    /// Blocks are made with another placer.
    fn take_placer(&mut self, out: &mut BlockSink<'_>) {
        let known = self.run.as_ref().map(|run| Rc::as_ptr(run.line.placer()));
        if self.placer.as_ref().map(Rc::as_ptr) == known {
            return;
        }
        self.stop(out);
        self.run = None;
        let (Some(placer), false) = (self.placer.clone(), self.refused) else {
            return;
        };
        if !placer.solver().closed_form() {
            self.refused = true;
            self.findings.add(no_closed_form(self.machine));
            return;
        }
        let watch = self.watch.clone();
        let tightening = self.tightening.clone();
        let line = PlannerRun::new(self.machine, placer, tightening, watch, self.least_block);
        if !std::mem::replace(&mut self.warned, true) {
            for warning in limits::warnings(self.machine) {
                self.findings.add(warning);
            }
        }
        let accuracy = &self.machine.accuracy;
        self.run = Some(CurvePlanner {
            fit: PathFit::new(fit::FitRules {
                dimensions: line.dimensions(),
                tolerance: self.machine.plan.smoothing,
                turn_tolerance: (0.5 * accuracy.axis_tolerance).min(TURN),
                corner: accuracy.corner,
                turn_weight: TURN_WEIGHT,
                spacing: Some(SPACING),
                ..fit::FitRules::default()
            }),
            line,
        });
    }

    fn command(&mut self, command: &Command, out: &mut BlockSink<'_>) {
        match command {
            Command::Head(name) => {
                self.stop(out);
                if let Some(machine) = self.base.changed_to(name) {
                    self.machine = machine;
                    self.run = None;
                }
            }
            // Where the tool stands after it is not known.
            Command::Subprogram(_) => {
                self.stop(out);
                self.stands = None;
            }
            _ if stands_still(command) => self.stop(out),
            _ => {}
        }
    }

    fn block(&mut self, next: StreamItem<MotionBlock>, out: &mut BlockSink<'_>) {
        let Some(block) = next.block().filter(|block| !block.still) else {
            return self.queue.push(next);
        };
        let end = BlockStart::after(block);
        let start = self.stands.replace(end);
        let cuts = block.kind.cuts();
        match start.filter(|_| cuts && self.run.is_some()) {
            Some(start) => self.plan(next, &start, &end, out),
            None => {
                self.stop(out);
                self.queue.push(next);
            }
        }
        if self.machine.motion.corner == CornerRule::Stop {
            self.stop(out);
        }
    }

    /// A hole may become a cycle: no feed is planned in it.
    fn hole(&mut self, mut hole: Box<HoleMoves<MotionBlock>>, out: &mut BlockSink<'_>) {
        self.stop(out);
        let mut keeps = |next: &StreamItem<MotionBlock>| {
            if let StreamItem::Note { note: BlockNote::Placer(placer), .. } = next {
                self.placer = Some(Rc::clone(placer));
                self.take_placer(out);
                return false;
            }
            if let Some(block) = next.block().filter(|block| !block.still) {
                self.stands = Some(BlockStart::after(block));
            }
            true
        };
        hole.above.retain(&mut keeps);
        hole.into.retain(&mut keeps);
        self.queue.push(StreamItem::Hole(hole));
    }

    /// The feed of a block is planned.
    fn plan(
        &mut self,
        next: StreamItem<MotionBlock>,
        start: &BlockStart,
        end: &BlockStart,
        out: &mut BlockSink<'_>,
    ) {
        let Some(run) = &mut self.run else {
            return;
        };
        let along = self.machine.control_point.along;
        let point = |run: &CurvePlanner<'_>, at: &BlockStart| {
            run.line.point(at.tip + at.axis * along, &at.joints)
        };
        let last = point(run, end);
        if !self.moves {
            self.point = point(run, start);
        }
        let tolerance = STANDS * self.machine.plan.smoothing;
        if distance(&self.point, &last) < tolerance {
            // Too short for the curve: it keeps the feed of the CL file, whatever comes before and after it.
            self.queue.push(next);
            self.queue.account.give_up(1);
            return;
        }
        if !self.moves {
            run.fit.clear();
            run.fit.push(&self.point, &mut |_| {});
            run.line.begin(&start.joints);
            self.moves = true;
        }
        let Some(block) = next.block() else {
            return;
        };
        let mut due = BlockDemand::of(block, along != 0.0);
        if let (Some(tightening), true) = (&self.tightening, along != 0.0) {
            // The curve goes beside the tip, whose places are known.
            due.share = tightening.least(block.line, &start.tip, &end.tip);
        }
        let mut places = Vec::new();
        if let StreamItem::Curve { curve, .. } = &next {
            for place in &curve.printed.way {
                let mut point = last;
                point[..3].copy_from_slice(place.as_slice());
                let before = places.last().unwrap_or(&self.point);
                if distance(before, &point) > tolerance && distance(&last, &point) > tolerance {
                    places.push(point);
                }
            }
        }
        places.push(last);
        self.queue.open(next, *start);
        run.line.due(due, places.len());
        let mut failed = false;
        let (queue, line) = (&mut self.queue, &mut run.line);
        let mut take = |leg: &fit::FittedLeg<'_>| {
            failed = failed || line.leg(leg, queue, out).is_err();
        };
        for point in &places {
            run.fit.push(point, &mut take);
        }
        self.point = last;
        if failed {
            self.fail(out);
        }
    }

    /// The tool comes to a standstill: what waits is planned to its end.
    fn stop(&mut self, out: &mut BlockSink<'_>) {
        if let (true, Some(run)) = (self.moves, &mut self.run) {
            let (queue, line) = (&mut self.queue, &mut run.line);
            let mut failed = false;
            run.fit.cut(&mut |leg| {
                failed = failed || line.leg(leg, queue, out).is_err();
            });
            failed = failed || line.finish(queue, out).is_err();
            self.moves = false;
            if failed {
                self.fail(out);
            }
        }
        self.queue.ready(out);
    }

    /// What waits goes on without a plan.
    #[cold]
    fn fail(&mut self, out: &mut BlockSink<'_>) {
        self.moves = false;
        if let Some(run) = &mut self.run {
            run.fit.clear();
            if let Some(fault) = run.line.give_up() {
                self.findings.at(self.queue.first_line().unwrap_or_default(), fault);
            }
        }
        self.queue.give_up();
        self.queue.ready(out);
    }
}

/// The least time that a block can have by its feed, s: that of the largest feed by time.
fn least_block(machine: &Machine, format: &Format) -> f64 {
    let control = &machine.control;
    let by_time = match control.feed {
        FeedMode::Auto => control.tcp == Tcp::Post && format.inverse_time.is_some(),
        FeedMode::PerMinute => false,
        FeedMode::InverseTime => true,
    };
    match format.most_inverse_time.filter(|_| by_time) {
        None => 0.0,
        Some(most) => match control.inverse_time {
            InverseTime::Minutes => 60.0 / most,
            InverseTime::Seconds => 1.0 / most,
        },
    }
}

/// How far two points of the curve are apart, as its parameter counts.
fn distance(from: &fit::FitPoint, to: &fit::FitPoint) -> f64 {
    let ways = from.iter().zip(to).enumerate().map(|(coordinate, (from, to))| {
        let way = to - from;
        if coordinate < 3 { way } else { way * TURN_WEIGHT }
    });
    ways.map(|way| way * way).sum::<f64>().sqrt()
}

/// The control stands still for it.
fn stands_still(command: &Command) -> bool {
    command.leaves()
        || matches!(
            command,
            Command::Spindle(_)
                | Command::SurfaceSpeed { .. }
                | Command::Compensate(_)
                | Command::Literal(_)
                | Command::Dwell(_)
                | Command::Sync(_)
                | Command::Stop
                | Command::OptionalStop
        )
}

fn no_closed_form(machine: &Machine) -> Diagnostic {
    Diagnostic::warning(
        "plan",
        format!(
            "no feed is planned: on {} the linear axes do not place the tip alone, and its feeds are those of the CL file",
            machine.name
        ),
    )
    .help("post without --plan")
}
