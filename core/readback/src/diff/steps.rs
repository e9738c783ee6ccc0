//! What a program does, cut into steps so short that each may be taken for straight.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose};

use super::Program;
use super::outline::Splitter;
use crate::{Done, Motion, MotionKind, State, Told, Way};

/// Steps stray from the way by no more: mm, radians.
const SAG: f64 = 0.000_1;
const TURN: f64 = 0.000_02;

/// Steps of one motion at most.
const MOST: u64 = 100_000;

/// A turn of the tool axis counts as the way of a point so far above the tip, mm.
const ARM: f64 = 50.0;

/// Where the tool is on one of the paths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Spot {
    pub pose: Pose,
    pub joints: Joints,
}

impl Spot {
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
        let unit = |a, b| {
            part(a, b)
                .try_normalize(1e-12)
                .unwrap_or_else(|| part(a, b))
        };
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
pub(super) struct Step {
    pub from: Spot,
    pub to: Spot,
    pub kind: MotionKind,
    /// mm/min.
    pub feed: f64,
    pub line: u64,
    pub state: Arc<State>,
    /// It is part of a hole.
    pub hole: bool,
    /// In positions of the machine.
    pub machine: bool,
    /// It comes from somewhere that is left out: only where it ends counts.
    pub arrives: bool,
    /// Way of the tip and, by an arm, of the tool axis, mm.
    pub length: f64,
}

/// Something that is told between steps and takes time or stops the program.
#[derive(Clone, Debug)]
pub(super) struct Event {
    pub line: u64,
    pub told: Told,
    /// Where the tip is.
    pub at: Vector3<f64>,
}

/// What is next.
#[derive(Debug)]
enum Next {
    Step(Box<Step>),
    Event(Event),
    /// Minutes of a motion, for the operation at hand.
    Minutes(f64),
    /// An operation begins, its number.
    Operation(usize),
}

/// The steps of a program, operation by operation.
#[derive(Debug)]
pub(super) struct Steps<P> {
    program: P,
    faults: usize,
    most_faults: usize,
    splitter: Splitter,
    done: Vec<Done>,
    ready: VecDeque<Next>,
    /// Steps of the operation at hand.
    pub steps: VecDeque<Step>,
    pub events: Vec<Event>,
    pub minutes: f64,
    operation: usize,
    /// The operation at hand has no further steps.
    pub ended: bool,
    over: bool,
}

impl<P: Program> Steps<P> {
    pub fn new(program: P, most_faults: usize, by_name: bool) -> Self {
        Self {
            program,
            faults: 0,
            most_faults,
            splitter: Splitter::new(by_name),
            done: Vec::new(),
            ready: VecDeque::new(),
            steps: VecDeque::new(),
            events: Vec::new(),
            minutes: 0.0,
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
        if let Some(Next::Operation(number)) = self.ready.front() {
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
            if let Next::Operation(_) = next {
                self.ended = true;
                return;
            }
            match self.ready.pop_front() {
                Some(Next::Step(step)) => {
                    self.steps.push_back(*step);
                    return;
                }
                Some(Next::Event(event)) => self.events.push(event),
                Some(Next::Minutes(minutes)) => self.minutes += minutes,
                Some(Next::Operation(_)) | None => {}
            }
        }
        if self.over {
            self.ended = true;
            return;
        }
        self.done.clear();
        match self.program.next(&mut self.done) {
            Ok(true) => {}
            Ok(false) => self.over = true,
            Err(_) => {
                // Told when its outline was made.
                self.faults += 1;
                self.over = self.faults >= self.most_faults;
            }
        }
        let done = std::mem::take(&mut self.done);
        for done in &done {
            if let Some(number) = self.splitter.take(done) {
                self.ready.push_back(Next::Operation(number));
            }
            self.take(done);
        }
        self.done = done;
    }

    fn take(&mut self, done: &Done) {
        match done {
            Done::Motion(motion) => {
                self.ready.push_back(Next::Minutes(motion.minutes));
                self.cut(motion);
            }
            Done::Told { line, told } => {
                if let Told::Dwell {
                    time,
                    revolutions: false,
                } = told
                {
                    self.ready.push_back(Next::Minutes(time / 60.0));
                }
                if matches!(
                    told,
                    Told::Dwell { .. } | Told::Stop | Told::OptionalStop | Told::ToolChange { .. }
                ) {
                    let at = self.splitter.at();
                    self.ready.push_back(Next::Event(Event {
                        line: *line,
                        told: told.clone(),
                        at,
                    }));
                }
            }
            Done::State(_) => {}
        }
    }

    /// Cuts a motion into steps.
    fn cut(&mut self, motion: &Motion) {
        let count = steps_of(motion);
        let spot = |share: f64| Spot {
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
        for step in 1..=count {
            let to = spot(step as f64 / count as f64);
            let length = from.distance(&to);
            if length > 0.0 {
                self.ready.push_back(Next::Step(Box::new(Step {
                    from,
                    to,
                    kind: motion.kind,
                    feed: motion.feed,
                    line: motion.line,
                    state: Arc::clone(&motion.state),
                    hole: motion.hole,
                    machine: motion.machine,
                    arrives: false,
                    length,
                })));
            }
            from = to;
        }
    }
}

/// Steps that a motion is cut into.
fn steps_of(motion: &Motion) -> u64 {
    let straight = motion.pieces(SAG, TURN);
    let curved = match &motion.way {
        Way::Axes | Way::Tip | Way::TipAndAxis => 1,
        Way::Arc {
            centre,
            normal,
            sweep,
        } => {
            let arm = motion.from.pose.tip - centre;
            let radius = (arm - normal * normal.dot(&arm)).norm();
            // A chord over the angle a strays by r·a²/8.
            let angle = libm::sqrt(8.0 * SAG / radius.max(SAG));
            libm::ceil(libm::fabs(*sweep) / angle) as u64
        }
        Way::Spline(_) => motion.spline_chords(SAG),
    };
    straight.max(curved).clamp(1, MOST)
}
