//! What a program does, cut into steps so short that each may be taken for straight.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose};
use post_motion::path::arc_chords;

use super::outline::Splitter;
use crate::course::descent::{Descent, descends};
use crate::{
    BlockEffect, BlockRunner, Curve, MachineState, Motion, MotionKind, ProgramEvent, ProgramRun,
};

/// Steps stray from the way by no more: mm, radians.
const SAG: f64 = 0.000_1;
const TURN: f64 = 0.000_02;

/// Steps of one motion at most.
const MOST: u64 = 100_000;

/// A turn of the tool axis counts as the way of a point so far above the tip, mm.
const ARM: f64 = 50.0;

/// Where the tool is on one of the paths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathPosition {
    pub pose: Pose,
    pub joints: Joints,
}

impl PathPosition {
    /// How far apart the tips are, mm, and the tool axes and edges, radians.
    pub fn apart(&self, other: &Self) -> [f64; 2] {
        let angle = |a: Vector3<f64>, b: Vector3<f64>| libm::atan2(a.cross(&b).norm(), a.dot(&b));
        let axes = angle(self.pose.axis, other.pose.axis);
        let edges = match self.pose.edge == Vector3::zeros() || other.pose.edge == Vector3::zeros()
        {
            true => 0.0,
            false => angle(self.pose.edge, other.pose.edge),
        };
        [(self.pose.tip - other.pose.tip).norm(), axes.max(edges)]
    }

    /// Both in one number, mm.
    pub fn distance(&self, other: &Self) -> f64 {
        let [tip, axis] = self.apart(other);
        libm::hypot(tip, ARM * axis)
    }

    /// A share of the way to `other`.
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        let part = |a: Vector3<f64>, b: Vector3<f64>| a + (b - a) * share;
        let unit = |a, b| part(a, b).try_normalize(1e-12).unwrap_or_else(|| part(a, b));
        Self {
            pose: Pose {
                tip: part(self.pose.tip, other.pose.tip),
                axis: unit(self.pose.axis, other.pose.axis),
                edge: unit(self.pose.edge, other.pose.edge),
            },
            joints: std::array::from_fn(|place| {
                self.joints[place] + (other.joints[place] - self.joints[place]) * share
            }),
        }
    }
}

/// A step.
#[derive(Clone, Debug)]
pub(super) struct PathStep {
    pub from: PathPosition,
    pub to: PathPosition,
    pub kind: MotionKind,
    /// mm/min.
    pub feed: f64,
    pub line: u64,
    pub state: Arc<MachineState>,
    /// It is part of a hole.
    pub hole: bool,
    /// In positions of the machine.
    pub machine: bool,
    /// At feed, and as fast as a rapid that stands so.
    pub fast: bool,
    /// It comes from somewhere that is left out: only where it ends counts.
    pub arrives: bool,
    /// Way of the tip and, by an arm, of the tool axis, mm.
    pub length: f64,
}

impl PathStep {
    /// At rapid, or at feed where a rapid may stand so.
    pub fn may_be_rapid(&self) -> bool {
        self.kind == MotionKind::Rapid || self.fast
    }

    /// At feed, and not as fast as a rapid.
    pub fn cuts(&self) -> bool {
        !self.may_be_rapid()
    }

    /// Both are of one kind, or one is a rapid and the other may be.
    pub fn is_like(&self, other: &Self) -> bool {
        let rapid = |step: &Self| step.kind == MotionKind::Rapid;
        self.kind == other.kind
            || (rapid(self) || rapid(other)) && self.may_be_rapid() && other.may_be_rapid()
    }
}

/// Something that is told between steps and takes time or stops the program.
#[derive(Clone, Debug)]
pub(super) struct StepEvent {
    pub line: u64,
    pub event: ProgramEvent,
    /// Where the tip is.
    pub at: Vector3<f64>,
}

/// What is next.
#[derive(Debug)]
enum NextStep {
    Step(Box<PathStep>),
    Event(StepEvent),
    /// Minutes of a motion, for the operation at hand.
    Minutes(f64),
    /// An operation begins, its number.
    Operation(usize),
}

/// What a motion is to the way from a retract to the first position of the part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ApproachLeg {
    /// No part of it.
    None,
    /// Rapids where the tool stands clear.
    Across,
    /// Down to the first position.
    Down,
}

/// The steps of a program, operation by operation.
#[derive(Debug)]
pub(super) struct PathSteps<P> {
    /// What cannot be read of it was told when its outline was made.
    run: ProgramRun<P>,
    splitter: Splitter,
    done: Vec<BlockEffect>,
    ready: VecDeque<NextStep>,
    /// Steps of the operation at hand.
    pub steps: VecDeque<PathStep>,
    pub events: Vec<StepEvent>,
    pub minutes: f64,
    /// Axis values behind the last way in machine coordinates.
    retracted: Option<Joints>,
    /// It has not cut since, nor gone down.
    above: bool,
    /// It has come down to its own line, from above, and goes in along it perhaps.
    on_line: bool,
    /// Its rapids since.
    held: Vec<NextStep>,
    operation: usize,
    /// The operation at hand has no further steps.
    pub ended: bool,
    over: bool,
}

impl<P: BlockRunner> PathSteps<P> {
    pub fn new(run: ProgramRun<P>, by_name: bool) -> Self {
        Self {
            run,
            splitter: Splitter::new(by_name),
            done: Vec::new(),
            ready: VecDeque::new(),
            steps: VecDeque::new(),
            events: Vec::new(),
            minutes: 0.0,
            retracted: None,
            above: true,
            on_line: false,
            held: Vec::new(),
            operation: 0,
            ended: false,
            over: false,
        }
    }

    /// Goes to the beginning of an operation; what lies between is dropped.
    pub fn go_to(&mut self, operation: usize) {
        loop {
            self.steps.clear();
            self.events.clear();
            self.minutes = 0.0;
            self.ended = false;
            if self.operation >= operation || self.over && self.ready.is_empty() {
                return;
            }
            while !self.ended {
                self.steps.clear();
                self.events.clear();
                self.read();
            }
            self.begin_next();
        }
    }

    /// What has been read belongs to the next operation from here on.
    fn begin_next(&mut self) {
        if let Some(NextStep::Operation(number)) = self.ready.front() {
            self.operation = *number;
            self.ready.pop_front();
        } else {
            self.operation = usize::MAX;
        }
    }

    /// Sees to it that so many steps are ready, or all of the operation.
    pub fn fill(&mut self, count: usize) {
        while self.steps.len() < count && !self.ended {
            self.read();
        }
    }

    fn read(&mut self) {
        while let Some(next) = self.ready.front() {
            if let NextStep::Operation(_) = next {
                self.ended = true;
                return;
            }
            match self.ready.pop_front() {
                Some(NextStep::Step(step)) => {
                    self.steps.push_back(*step);
                    return;
                }
                Some(NextStep::Event(event)) => self.events.push(event),
                Some(NextStep::Minutes(minutes)) => self.minutes += minutes,
                Some(NextStep::Operation(_)) | None => {}
            }
        }
        if self.over {
            self.ended = true;
            return;
        }
        let Some(done) = self.run.block() else {
            self.over = true;
            self.release();
            return;
        };
        std::mem::swap(done, &mut self.done);
        let done = std::mem::take(&mut self.done);
        for done in &done {
            if let Some(number) = self.splitter.take(done) {
                self.release();
                self.ready.push_back(NextStep::Operation(number));
            }
            self.take(done);
        }
        self.done = done;
    }

    fn take(&mut self, done: &BlockEffect) {
        match done {
            BlockEffect::Motion(motion) => {
                self.ready.push_back(NextStep::Minutes(motion.minutes));
                self.cut(motion);
            }
            BlockEffect::Event { line, event } => {
                if let ProgramEvent::Dwell { time, revolutions: false } = event {
                    self.ready.push_back(NextStep::Minutes(time / 60.0));
                }
                if matches!(
                    event,
                    ProgramEvent::Dwell { .. }
                        | ProgramEvent::Stop
                        | ProgramEvent::OptionalStop
                        | ProgramEvent::Sync(_)
                        | ProgramEvent::ToolChange { .. }
                ) {
                    let at = self.splitter.at();
                    self.ready.push_back(NextStep::Event(StepEvent {
                        line: *line,
                        event: event.clone(),
                        at,
                    }));
                }
            }
            BlockEffect::State(_) => {}
        }
    }

    /// What a motion is to the way from a retract to the first position.
    fn leg(&mut self, motion: &Motion) -> ApproachLeg {
        let retracted = *self.retracted.get_or_insert(motion.from.joints);
        if motion.machine {
            self.retracted = Some(motion.to.joints);
            self.above = true;
            return ApproachLeg::None;
        }
        let rapid = motion.kind == MotionKind::Rapid || motion.fast;
        let on_line = std::mem::take(&mut self.on_line);
        let descent = match self.above && rapid {
            true => descends(motion, &retracted, on_line),
            false => None,
        };
        self.on_line = descent == Some(Descent::ToLine);
        let down = descent == Some(Descent::ToPoint);
        self.above &= !down && rapid;
        match (down, self.above) {
            (true, _) => ApproachLeg::Down,
            (_, true) => ApproachLeg::Across,
            _ => ApproachLeg::None,
        }
    }

    /// The tool did not come down by the ways that were held back.
    fn release(&mut self) {
        self.ready.extend(self.held.drain(..));
    }

    /// Cuts a motion into steps.
    fn cut(&mut self, motion: &Motion) {
        let leg = self.leg(motion);
        match leg {
            ApproachLeg::None => self.release(),
            ApproachLeg::Across => {}
            ApproachLeg::Down => {
                // How the tool came there says something of the machine, and not of the part.
                self.held.clear();
                let to = PathPosition { pose: motion.to.pose, joints: motion.to.joints };
                let step = PathStep { arrives: true, ..step(motion, to, to) };
                return self.ready.push_back(NextStep::Step(Box::new(step)));
            }
        }
        let count = steps_of(motion);
        let spot = |share: f64| PathPosition {
            pose: match share {
                0.0 => motion.from.pose,
                1.0 => motion.to.pose,
                _ => motion.at(share),
            },
            joints: std::array::from_fn(|place| {
                let [from, to] = [motion.from.joints[place], motion.to.joints[place]];
                from + (to - from) * share
            }),
        };
        let mut from = spot(0.0);
        for place in 1..=count {
            let to = spot(place as f64 / count as f64);
            let step = step(motion, from, to);
            if step.length > 0.0 {
                let next = NextStep::Step(Box::new(step));
                match leg {
                    ApproachLeg::Across => self.held.push(next),
                    _ => self.ready.push_back(next),
                }
            }
            from = to;
        }
    }
}

/// A step of a motion.
fn step(motion: &Motion, from: PathPosition, to: PathPosition) -> PathStep {
    PathStep {
        from,
        to,
        kind: motion.kind,
        feed: motion.feed,
        line: motion.line,
        state: Arc::clone(&motion.state),
        hole: motion.hole,
        machine: motion.machine,
        fast: motion.fast,
        arrives: false,
        length: from.distance(&to),
    }
}

/// Steps that a motion is cut into.
fn steps_of(motion: &Motion) -> u64 {
    let straight = motion.pieces(SAG, TURN);
    let curved = match motion.way.curve() {
        Curve::Straight => 1,
        Curve::Arc { centre, normal, sweep } => {
            let arm = motion.from.pose.tip - centre;
            let radius = (arm - normal * normal.dot(&arm)).norm();
            arc_chords(radius, *sweep, SAG) as u64
        }
        Curve::Spline(_) => motion.spline_chords(SAG),
    };
    straight.max(curved).clamp(1, MOST)
}
