//! Points whose axis values are chosen become blocks: points put in or left out, every block certified.

mod across;
mod along;
mod approach;
mod block;
mod columns;
mod compensating_motion;
mod cutter;
mod drives;
mod fitted;
mod free_way;
mod low_rapids;
mod nominal;
mod off_part;
mod pending_run;
mod plane;
mod splined;
mod staged;
mod tool_alignment;
mod tool_line;

use std::rc::Rc;

use nalgebra::Vector3;
use post_machine::description::{Machine, Tcp};
use post_plugin::{Capabilities, Format, ModelSession};

use crate::accuracy::{
    DeviationBound, LineariseError, Lineariser, MoveRoom, NodeMove, NodeRun, PathNode, PlacedBatch,
    Placer, RunPosition,
};
use crate::configuration::{ChoiceNote, ChosenPoint, pose, tells_vectors};
use crate::curve::CurvePolicy;
use crate::expand::FixedAxis;
use crate::findings::Findings;
use crate::observer::Observers;
use crate::program::{Command, MoveFeed, StraightMove};
use crate::refusal;
use crate::stream::{BatchSink, HoleMoves, StreamItem, gathered};
use across::AcrossChoice;
pub use across::WayAcross;
pub use block::{BlockDuration, BlockKind, BlockNote, BlockReason, MotionBlock, PlannedTime};
pub(crate) use compensating_motion::CompensatingMotion;
pub use compensating_motion::FollowTime;
use low_rapids::WaitingRapids;
pub use nominal::NominalTime;
pub(crate) use nominal::{AxisKinds, AxisTravels, STILL};
use pending_run::PendingRun;
use plane::ActivePlane;
use tool_line::ToolLine;

/// Turns that differ by less are the same, radians.
const TURN: f64 = 1e-6;

/// Fewer points are not worth being solved together.
const LEAST_TOGETHER: usize = 4;

/// Legs with largest feeds drive a machine.
fn driven(machine: &Machine) -> bool {
    machine.legs().any(|leg| leg.max_feed.is_finite())
}

/// A straight piece of the CL path on its way to become blocks.
#[derive(Clone, Copy, Debug)]
struct PathLeg<'m> {
    /// What solves its points.
    placer: &'m Placer,
    line: u64,
    motion: &'m StraightMove,
    /// Leg off the part: the tolerance of a rapid is enough.
    loose: bool,
    /// Why it is there, if not to reach its CL point.
    reason: BlockReason,
}

/// The largest deviations certified so far.
#[derive(Clone, Copy, Debug, Default)]
struct LargestDeviations {
    cut: DeviationBound,
    rapid: f64,
}

impl LargestDeviations {
    /// Can a block with this bound be the worst one?
    #[inline]
    fn may_be_worst(&self, leg: &PathLeg<'_>, bound: DeviationBound) -> bool {
        let tip = bound.tip + leg.motion.chord;
        if leg.loose { tip > self.rapid } else { tip > self.cut.tip || bound.axis > self.cut.axis }
    }

    #[inline]
    fn keep(&mut self, leg: &PathLeg<'_>, bound: DeviationBound) {
        let tip = bound.tip + leg.motion.chord;
        if leg.loose {
            self.rapid = self.rapid.max(tip);
        } else {
            self.cut = self.cut.and(DeviationBound { tip, ..bound });
        }
    }
}

/// Where blocks go.
pub(crate) type BlockSink<'o> = BatchSink<'o, StreamItem<MotionBlock>>;

/// Counts of this stage.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct BlockCounts {
    /// Points put in.
    pub points_added: u64,
    /// CL points that no block ends on.
    pub points_dropped: u64,
    /// Times that another branch or another full turn was taken, off the part.
    pub branch_changes: u64,
    /// Times that the tool was drawn back in a cut to go on otherwise.
    pub rewinds: u64,
    /// Points at which a rotary axis was held or turned early close to a pole.
    pub eased: u64,
    /// Rapids went straight in the axes.
    pub along_axes: bool,
}

/// The stage that makes blocks.
pub(crate) struct BlockStage<'a> {
    machine: &'a Machine,
    /// The machine with the head that it starts with.
    base: &'a Machine,
    /// Its tool is swung to its places.
    arm: bool,
    model: &'a mut dyn ModelSession,
    /// Solves the points; none before the first.
    placer: Option<Rc<Placer>>,
    /// The tilted planes of the control.
    planes: ActivePlane,
    linearise: Lineariser,
    kinds: AxisKinds,
    between: CompensatingMotion,
    /// CL points that wait for those after them.
    gathered: PendingRun,
    /// Which curves are kept.
    keeps: CurvePolicy,
    /// Feeds are planned after this stage: curves tell their way.
    plans: bool,
    /// Legs with largest feeds drive the machine.
    driven: bool,
    /// What each leg of the run in hand is due.
    nominal: Vec<NominalTime>,
    /// Where the tool stands; none before the first position.
    last: Option<Box<PathNode>>,
    /// The node before that, to be filled again.
    spare: Option<Box<PathNode>>,
    /// Points that are solved together.
    placed: Box<PlacedBatch>,
    /// The last move was a cut: the tool is on the part.
    on_part: bool,
    /// The line of the tool at the end of the last cut, as long as rapids stay on it.
    tool_line: Option<ToolLine>,
    /// The CL file has turned the part (`ROTABL`) since the last move: it has no way from there to the next.
    part_turned: bool,
    /// The control begins to keep the tip in a block that moves nothing.
    tcp_still: bool,
    /// The control has cutter radius compensation, the way it keeps the tip here.
    compensates: bool,
    /// Cutter radius compensation is in force.
    compensating: bool,
    /// Cutter compensation was switched on or off, and no block has moved since: that is no block along a curve.
    compensation_due: bool,
    /// Set once the fault that compensation cannot be was given.
    told_compensation: bool,
    /// The largest deviations so far.
    largest: LargestDeviations,
    counts: BlockCounts,
    /// Moves have the tool's vector in the place of rotary words, and the control finds its own solution for it.
    by_vector: bool,
    /// Chooses ways across; none: they are those of the machine file.
    across: Option<Box<AcrossChoice<'a>>>,
    /// Rapids that wait for the next cut, where they may go lower than the CL file has them.
    rapids: WaitingRapids,
    /// Where the depth axis is retracted to ahead of the first position in hand, mm; none: as the machine file has it.
    lowered: Option<f64>,
    /// Observers of cuts; none if nobody looks on.
    observers: Option<Rc<Observers<'a>>>,
    findings: Findings,
}

impl<'a> BlockStage<'a> {
    pub(crate) fn new(
        machine: &'a Machine,
        writes: Capabilities,
        format: &Format,
        model: &'a mut dyn ModelSession,
        trust_model: bool,
        findings: &Findings,
    ) -> Self {
        let tcp = machine.control.tcp == Tcp::Control;
        Self {
            machine,
            base: machine,
            arm: machine.is_arm(),
            model,
            placer: None,
            planes: ActivePlane::new(format),
            linearise: Lineariser::new(&machine.accuracy, trust_model),
            kinds: AxisKinds::new(machine),
            between: CompensatingMotion::new(machine),
            gathered: PendingRun::default(),
            keeps: CurvePolicy::new(machine, writes),
            by_vector: tells_vectors(machine, writes),
            plans: false,
            driven: driven(machine),
            nominal: Vec::new(),
            last: None,
            spare: None,
            placed: Box::default(),
            on_part: false,
            tool_line: None,
            part_turned: false,
            tcp_still: writes.has(Capabilities::TCP_STILL),
            compensates: !tcp || writes.has(Capabilities::COMPENSATE_TCP),
            compensating: false,
            compensation_due: false,
            told_compensation: false,
            largest: LargestDeviations::default(),
            counts: BlockCounts::default(),
            across: None,
            rapids: WaitingRapids::default(),
            lowered: None,
            observers: None,
            findings: findings.clone(),
        }
    }

    /// Shows cuts from here on.
    pub(crate) fn watch(&mut self, observers: Rc<Observers<'a>>) {
        self.observers = Some(observers);
    }

    /// Feeds are planned after this stage.
    pub(crate) fn plans(&mut self) {
        self.plans = true;
    }

    /// Blocks from here on are made with another placer, which goes on to whom it serves after this stage.
    fn use_placer(&mut self, line: u64, placer: Rc<Placer>, out: &mut BlockSink<'_>) {
        // The last stage holds axes to limits that depend on other axes.
        if !self.plans && !self.machine.limits.is_empty() {
            out.note(line, BlockNote::Placer(placer.clone()));
        }
        self.placer = Some(match self.plans {
            false => placer,
            true => {
                // Blocks may be cut after this stage, at rounded points.
                let roomy = placer.leaving_room(self.machine.accuracy.tolerance);
                out.note(line, BlockNote::Placer(placer));
                Rc::new(roomy)
            }
        });
    }

    /// Counts so far.
    pub(crate) fn counts(&self) -> BlockCounts {
        self.counts
    }

    /// What the linear axes did between the words.
    pub(crate) fn between_words(&self) -> &CompensatingMotion {
        &self.between
    }

    /// How often the error model was asked.
    pub(crate) fn asked(&self) -> u64 {
        self.linearise.asked()
    }

    /// Points that the certificate asked for over the model's head.
    pub(crate) fn overruled(&self) -> u64 {
        self.linearise.overruled()
    }

    /// Line of the first point that waits for those after it.
    pub(crate) fn first_line(&self) -> Option<u64> {
        let held = self.across.as_ref().and_then(|across| across.first_line());
        let waiting = || self.gathered.first_line().or_else(|| self.rapids.first_line());
        held.or_else(waiting)
    }

    /// Takes elements in order; none of them is solved ahead.
    pub(crate) fn take(&mut self, elements: &[StreamItem<ChosenPoint>], out: &mut BlockSink<'_>) {
        match self.across.as_ref().is_some_and(|across| across.links()) {
            true => self.take_low(elements, out),
            false => self.take_each(elements, out),
        }
    }

    /// Takes elements as they are.
    fn take_each(&mut self, elements: &[StreamItem<ChosenPoint>], out: &mut BlockSink<'_>) {
        match self.across {
            None => self.each(elements, &mut |stage, next, lane| stage.next(next, lane, out)),
            Some(_) => self.each(elements, &mut |stage, next, lane| {
                let made = gathered(|out| stage.next(next, lane, out));
                if let Some(across) = &mut stage.across {
                    across.hand_on(next.line(), made, out);
                }
            }),
        }
    }

    /// Has each element taken by `take`, which is told its place among those that were solved together.
    fn each(
        &mut self,
        elements: &[StreamItem<ChosenPoint>],
        take: &mut dyn FnMut(&mut Self, &StreamItem<ChosenPoint>, usize),
    ) {
        let mut from = 0;
        while from < elements.len() {
            let count = self.settle_ahead(&elements[from..]);
            for (lane, next) in elements[from..from + count].iter().enumerate() {
                take(self, next, lane);
            }
            from += count;
        }
    }

    /// Solves the points at the front of a batch together, as far as one placer solves them; gives how many elements
    /// they are. Where there are few, or the next is something else, nothing is solved ahead.
    fn settle_ahead(&mut self, batch: &[StreamItem<ChosenPoint>]) -> usize {
        let points = || {
            batch.iter().map_while(|next| match next {
                StreamItem::Point(chosen) if chosen.arrives => {
                    Some((pose(&chosen.motion), self.planes.standing(chosen)))
                }
                _ => None,
            })
        };
        let count = points().take(PlacedBatch::MOST).count();
        match &self.placer {
            Some(placer) if count >= LEAST_TOGETHER => self.placed.settle(placer, points()),
            _ => self.placed.forget(),
        }
        count.max(1)
    }

    /// One element; `lane` is its place among those that were solved together.
    #[inline]
    fn next(&mut self, next: &StreamItem<ChosenPoint>, lane: usize, out: &mut BlockSink<'_>) {
        match next {
            StreamItem::Point(chosen) => self.point(chosen, lane, out),
            StreamItem::Curve { line, curve } => {
                self.end_run(out);
                self.go_along(*line, curve, out);
            }
            StreamItem::Hole(hole) => self.hole(hole, out),
            StreamItem::Command { line, command } => self.command(*line, command, out),
            StreamItem::Note { line, note } => {
                self.end_run(out);
                match note {
                    ChoiceNote::Placer(placer) => self.take_placer(*line, placer, out),
                    ChoiceNote::FixedAxis(FixedAxis(origin)) => self.fix_axis(*line, *origin, out),
                    // The next point is a first position again.
                    ChoiceNote::Broken => {
                        self.last = None;
                        self.on_part = false;
                    }
                }
            }
        }
    }

    /// The file ends: what waits is carried out.
    pub(crate) fn finish(&mut self, line: u64, out: &mut BlockSink<'_>) {
        self.end_rapids(out);
        self.end_run(out);
        if let Some(across) = &mut self.across {
            across.hand_on_all(line, out);
        }
        self.depart(line, out);
    }

    /// The moves of a hole as blocks; no run goes on into it or out of it.
    fn hole(&mut self, hole: &HoleMoves<ChosenPoint>, out: &mut BlockSink<'_>) {
        self.end_run(out);
        let made = hole.remade(|part| {
            gathered(|out| {
                self.each(part, &mut |stage, next, lane| stage.next(next, lane, out));
                self.end_run(out);
            })
        });
        out.element(StreamItem::Hole(Box::new(made)));
    }

    fn command(&mut self, line: u64, command: &Command, out: &mut BlockSink<'_>) {
        self.end_run(out);
        match command {
            Command::Tool(_)
            | Command::Home
            | Command::Retract { .. }
            | Command::Leave
            | Command::WorkOffset(_)
            | Command::Smoothing(_) => self.depart(line, out),
            Command::Index { .. } => self.part_turned = true,
            // Where the tool stands after it is not known.
            Command::Subprogram(_) => {
                self.last = None;
                self.on_part = false;
            }
            Command::Head(name) => {
                self.depart(line, out);
                if let Some(machine) = self.base.changed_to(name) {
                    self.machine = machine;
                    self.driven = driven(self.machine);
                    self.kinds = AxisKinds::new(self.machine);
                    self.between.set(self.machine);
                    self.linearise.set(&self.machine.accuracy);
                }
            }
            Command::Compensate(compensation) => {
                self.compensate(line, *compensation);
                self.compensation_due = true;
            }
            _ => {}
        }
        if let Some(across) = &mut self.across {
            across.command(command);
        }
        out.command(line, command.clone());
    }

    #[inline]
    fn point(&mut self, chosen: &ChosenPoint, lane: usize, out: &mut BlockSink<'_>) {
        self.enter_plane(chosen, out);
        let Some(placer) = self.placer.clone() else {
            return;
        };
        let leg = PathLeg {
            placer: &placer,
            line: chosen.line,
            motion: &chosen.motion,
            loose: chosen.motion.pace == MoveFeed::Rapid,
            reason: if chosen.eased { BlockReason::Eased } else { BlockReason::Point },
        };
        if chosen.arrives {
            let changed = chosen.changed && leg.loose;
            self.counts.branch_changes += u64::from(changed);
            if self.by_vector && self.last.is_some() && (changed || chosen.rewind.is_some()) {
                self.findings
                    .at(leg.line, refusal::no_vector_says_it(self.machine, &chosen.joints));
            }
            self.counts.eased += u64::from(chosen.eased);
            let mut node = self.spare.take().unwrap_or_default();
            let settled = if self.placed.take(lane, &mut node) {
                Ok(())
            } else {
                let standing = self.planes.entered(chosen);
                placer.settle(&mut node, pose(leg.motion), 1.0, standing)
            };
            match settled {
                Ok(()) => self.travel(&leg, node, out),
                Err(refused) => {
                    self.spare = Some(node);
                    self.findings.at(leg.line, refusal::refused(self.machine, &refused));
                }
            }
        }
        if let Some(joints) = &chosen.rewind {
            self.end_run(out);
            self.rewind(&leg, joints, out);
        }
    }

    #[inline]
    fn travel(&mut self, leg: &PathLeg<'_>, mut node: Box<PathNode>, out: &mut BlockSink<'_>) {
        if self.compensating {
            self.check_compensation(leg.placer, leg.line, &node);
        }
        if let Some(last) = &self.last {
            self.steady(leg.placer, last, &mut node);
        }
        if let Some(last) = &self.last
            && self.by_vector
            && self.points_alike(last, &node)
            && self.turn_between(last, &node) > TURN
        {
            let unsaid = refusal::no_vector_says_it(self.machine, &node.trace.joints);
            self.findings.at(leg.line, unsaid);
        }
        let gathers = self.gathers(leg, &node);
        if !gathers {
            self.end_run(out);
        }
        let part_turned = std::mem::take(&mut self.part_turned);
        match self.last.take() {
            None => self.first(leg, &node, BlockKind::Position, out),
            Some(last) if self.turns_retracted(&last, &node, part_turned) => {
                let last = self.leave_part(leg.placer, leg.line, last, out);
                self.departs_from(&last);
                self.first(leg, &node, BlockKind::Reference, out);
                self.spare = Some(last);
            }
            Some(last) => self.spare = Some(self.go(leg, last, &mut node, gathers, out)),
        }
        self.on_part = leg.motion.pace != MoveFeed::Rapid;
        self.last = Some(node);
    }

    /// A move from where the tool stands to `node`; gives the node that it left.
    #[inline]
    fn go(
        &mut self,
        leg: &PathLeg<'_>,
        mut last: Box<PathNode>,
        node: &mut PathNode,
        gathers: bool,
        out: &mut BlockSink<'_>,
    ) -> Box<PathNode> {
        if leg.loose && self.on_part {
            self.tool_line = ToolLine::of(&last);
            // The tool leaves the part as it stands, and turns when it is away: where its axis stays, nothing turns
            // (unless the tip depends on it, as it does without a closed form).
            let joints = &last.trace.joints;
            let stay = if leg.placer.solver().places_tip() && self.points_alike(&last, node) {
                leg.placer.settled(node.target, 1.0, joints)
            } else {
                leg.placer.place_on(&last, node.target)
            };
            if let Ok(stay) = stay
                && self.leaves_as(leg.placer, [&last, &stay, node])
            {
                let leaving = PathLeg { reason: BlockReason::Leave, ..*leg };
                self.cut(&leaving, &last, &stay, out);
                self.on_part = false;
                *last = stay;
            }
        }
        if !self.excluded(&last, node).is_empty() {
            self.by_stages(leg, &last, node, out);
        } else if gathers {
            self.gather(leg, &last, node, out);
        } else {
            self.cut(leg, &last, node, out);
        }
        last
    }

    /// The tool axis in the machine frame, as the head holds it.
    fn in_machine(&self, placer: &Placer, node: &PathNode) -> Vector3<f64> {
        let mut joints = node.trace.joints;
        for (value, axis) in joints.iter_mut().zip(&self.machine.axes) {
            if axis.carries_part {
                *value = 0.0;
            }
        }
        placer.solver().chain().forward(&joints).axis
    }

    /// Are tool axis and leading edge wanted alike at two nodes?
    fn points_alike(&self, from: &PathNode, to: &PathNode) -> bool {
        let (from, to) = (&from.target, &to.target);
        let apart = (from.axis - to.axis).norm() + (from.edge_across() - to.edge_across()).norm();
        apart < TURN
    }

    /// The sum of all rotary moves between two nodes, radians.
    fn turn_between(&self, from: &PathNode, to: &PathNode) -> f64 {
        let axes = self.machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.joint.rotary)
            .map(|(joint, _)| (to.trace.joints[joint] - from.trace.joints[joint]).abs())
            .sum()
    }

    /// A straight move, cut into pieces where it strays.
    #[inline]
    fn cut(
        &mut self,
        leg: &PathLeg<'_>,
        last: &PathNode,
        node: &PathNode,
        out: &mut BlockSink<'_>,
    ) {
        let chord = leg.motion.chord;
        let room = self.room(leg, [last, node]);
        let whole = NodeMove::planned(self.machine, leg.placer, chord, room, [last, node]);
        if let Some(observers) = &self.observers
            && !leg.loose
        {
            observers.cut(leg.line, &whole);
        }
        match whole.whole() {
            Some(bound) => {
                // The cheap bound decides whether the block can be the worst one; the tight one is kept.
                let bound = if self.largest.may_be_worst(leg, bound) {
                    whole.measured().least(bound)
                } else {
                    bound
                };
                let nominal = self.nominal(leg, last, node);
                self.push(leg, [last, node], nominal, bound, out);
            }
            None if self.goes_along_axes(leg) => {
                self.counts.along_axes = true;
                let nominal = self.nominal(leg, last, node);
                self.push(leg, [last, node], nominal, whole.certify(), out);
            }
            None => self.split(&[*leg], room, &[*last, *node], out),
        }
    }

    /// Legs, one after the other, that need points or can do without some of their own.
    fn split(
        &mut self,
        legs: &[PathLeg<'_>],
        room: MoveRoom,
        nodes: &[PathNode],
        out: &mut BlockSink<'_>,
    ) {
        let Some(first) = legs.first() else {
            return;
        };
        let mut linearise = std::mem::take(&mut self.linearise);
        let placer = first.placer;
        let chord = first.motion.chord;
        let planned = NodeMove::planned(self.machine, placer, chord, room, [&nodes[0], &nodes[1]]);
        let moves = nodes.windows(2).any(|pair| self.wanted_way(&pair[0], &pair[1]) > STILL);
        let run = NodeRun {
            placer,
            nodes,
            tolerances: planned.tolerances,
            control_keeps_tip: planned.control_keeps_tip,
            straight: planned.straight,
            // A rapid has no surface to be balanced about. A tip that stands still must seem to: its feed is taken
            // along the axes.
            balances: !first.loose && moves,
        };
        match linearise.split(&run, self.model) {
            Ok(()) => {
                let mut due = std::mem::take(&mut self.nominal);
                due.clear();
                for (leg, pair) in legs.iter().zip(nodes.windows(2)) {
                    due.push(self.nominal(leg, &pair[0], &pair[1]));
                }
                let mut from = nodes[0];
                let (mut at, mut kept) = (RunPosition { leg: 0, t: 0.0 }, 0);
                for piece in linearise.pieces() {
                    let on_point = piece.to.t == 1.0;
                    kept += usize::from(on_point);
                    self.counts.points_added += u64::from(!on_point);
                    let end = RunPosition { leg: piece.leg, t: piece.to.t };
                    let nominal = NominalTime::between(&due, at, end);
                    let leg = PathLeg {
                        reason: if on_point { legs[piece.leg].reason } else { BlockReason::PutIn },
                        ..legs[piece.leg]
                    };
                    let ends = [&from, &piece.to];
                    self.push(&leg, ends, nominal, piece.bound, out);
                    (from, at) = (piece.to, end);
                }
                self.nominal = due;
                self.counts.points_dropped += (legs.len() - kept.min(legs.len())) as u64;
            }
            // Off a cut that is no hole the axes may turn to another solution on the tool's line.
            Err(_) if room == MoveRoom::ToolLine => {
                self.linearise = linearise;
                self.tool_line = None;
                return self.split(legs, MoveRoom::Free, nodes, out);
            }
            Err((place, stuck)) => {
                let leg = &legs[place];
                let finding = match stuck {
                    LineariseError::Jump { .. } if self.by_vector => {
                        let joints = &nodes[place + 1].trace.joints;
                        refusal::no_vector_says_it(self.machine, joints)
                    }
                    _ => refusal::stuck(self.machine, &stuck, leg.motion),
                };
                self.findings.at(leg.line, finding);
            }
        }
        self.linearise = linearise;
    }

    /// One block.
    #[inline]
    fn push(
        &mut self,
        leg: &PathLeg<'_>,
        [from, node]: [&PathNode; 2],
        nominal: NominalTime,
        bound: DeviationBound,
        out: &mut BlockSink<'_>,
    ) {
        self.largest.keep(leg, bound);
        self.compensation_due = false;
        let mut block = MotionBlock {
            still: from.words == node.words,
            way: self.way(from, node),
            nominal,
            ..self.block(leg, node, bound)
        };
        if self.kinds.turning(&from.trace.joints, &node.trace.joints) {
            let (machine, asked) = (self.machine, block.asked());
            let way = (leg, [from, node]);
            block.follow = self.between.block(machine, way, asked, &self.findings);
        }
        if self.driven {
            let kept = self.between.keeps();
            self.drives_follow(&mut block, leg, [from, node], kept);
        }
        out.push(StreamItem::Point(block));
    }

    #[inline]
    fn block(&self, leg: &PathLeg<'_>, node: &PathNode, bound: DeviationBound) -> MotionBlock {
        MotionBlock {
            line: leg.line,
            kind: if leg.motion.pace == MoveFeed::Rapid {
                BlockKind::Rapid
            } else {
                BlockKind::Linear
            },
            reason: leg.reason,
            loose: leg.loose,
            still: false,
            pace: leg.motion.pace,
            words: node.words,
            joints: node.trace.joints,
            tip: node.tip - node.trace.pose.axis * self.machine.control_point.along,
            axis: node.trace.pose.axis,
            deviation: DeviationBound { tip: bound.tip + leg.motion.chord, ..bound },
            way: 0.0,
            nominal: NominalTime::default(),
            follow: FollowTime::default(),
            planned: PlannedTime::default(),
            time: BlockDuration::default(),
            nc_line: 0,
        }
    }
}
