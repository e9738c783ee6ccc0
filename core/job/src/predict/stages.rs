//! What is behind the set-points: servos, contour error, and what is added up.

use std::collections::VecDeque;
use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::{Joints, Solver};
use post_motion::contour::{Contour, ContourPoint, ReferencePath};
use post_motion::servo::Servos;
use post_motion::trajectory::TaskTime;
use post_motion::{ProgramPlace, SetPoints};
use post_readback::MachineState;

use super::feeds::FeedTally;
use super::found;
use super::prediction::Prediction;
use super::sample::Sample;
use super::times::{TaskKind, TimeTally};
use super::trajectory::PlannedTask;
use crate::failure::Failure;

/// What the program says of a task that is not done yet.
#[derive(Clone, Copy, Default)]
struct PendingTask {
    kind: TaskKind,
    /// Feed of the tip, mm/min.
    feed: f64,
    /// Its row in the table of operations.
    operation: usize,
}

/// The stages, and what waits between them.
pub struct Stages<'r> {
    pub servos: Servos,
    contour: Contour<'r>,
    against: Option<String>,
    period: f64,
    /// Tasks that are planned or carried out, and the number of the first of them.
    ahead: VecDeque<PendingTask>,
    first: u64,
    /// Tasks before this one have their time.
    timed: u64,
    /// What held for the task that came last, and its row in the table of operations.
    state: Option<Arc<MachineState>>,
    operation: usize,
    actual: Vec<Joints>,
    /// Set-points whose contour error is not known yet: what is carried out, and the feed that the tip has and should.
    waiting: VecDeque<(ProgramPlace, [f64; 2])>,
    /// Where the tip was commanded last in a cut, and by which chain.
    last: Option<(Vector3<f64>, Arc<Solver>)>,
    times: TimeTally,
    feed_tally: FeedTally,
    set_points: u64,
}

impl<'r> Stages<'r> {
    /// Of a machine with set-points every `period` seconds; the tool is held against `path` too, and what it is called, if
    /// one is given.
    pub fn new(
        machine: &Machine,
        period: f64,
        path: Option<(Box<dyn ReferencePath + 'r>, String)>,
    ) -> Result<Self, Failure> {
        let mut contour = Contour::new();
        let mut against = None;
        if let Some((path, name)) = path {
            contour = contour.against(path);
            against = Some(name);
        }
        Ok(Self {
            servos: Servos::new(machine, period).map_err(|fault| *fault)?,
            contour,
            against,
            period,
            ahead: VecDeque::new(),
            first: 0,
            timed: 0,
            state: None,
            operation: 0,
            actual: Vec::new(),
            waiting: VecDeque::new(),
            last: None,
            times: TimeTally::default(),
            feed_tally: FeedTally::new(period),
            set_points: 0,
        })
    }

    /// A task is planned now.
    pub fn ahead(&mut self, planned: &mut PlannedTask) {
        self.contour.ahead(planned.leg.take());
        let same = match (&self.state, &planned.state) {
            (Some(known), Some(state)) => Arc::ptr_eq(known, state),
            (None, None) => !self.ahead.is_empty(),
            _ => false,
        };
        if !same {
            self.state.clone_from(&planned.state);
            let state = self.state.as_deref();
            let operation = state.and_then(|state| state.operation.as_deref());
            let tool = state.and_then(|state| state.tool);
            self.operation = self.times.operation(tool, operation);
        }
        self.ahead.push_back(PendingTask {
            kind: planned.kind,
            feed: planned.feed,
            operation: self.operation,
        });
    }

    fn about(&self, task: u64) -> PendingTask {
        let place = task.saturating_sub(self.first) as usize;
        self.ahead.get(place).copied().unwrap_or_default()
    }

    /// Tasks have their time.
    pub fn done(&mut self, machine: &Machine, times: &mut Vec<TaskTime>) {
        for time in times.drain(..) {
            let about = self.about(time.task);
            self.times.take(machine, &time, about.kind, about.operation);
            self.timed = time.task + 1;
        }
    }

    /// Set-points are settled.
    pub fn batch(
        &mut self,
        points: &SetPoints,
        listen: &mut dyn FnMut(&Sample) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        if points.is_empty() {
            return Ok(());
        }
        self.actual.clear();
        self.servos.follow(&points.joints, &mut self.actual);
        for (at, pose) in points.at.iter().zip(&points.poses) {
            let solver = &points.solver;
            // Where another length counts from here on, the tip is elsewhere without having gone there.
            let last = self.last.as_ref();
            let last = last.filter(|(_, known)| at.cuts && Arc::ptr_eq(known, solver));
            let way = last.map(|(tip, _)| (pose.tip - tip).norm());
            let feed = 60.0 * way.unwrap_or(0.0) / self.period;
            let programmed = self.about(at.task).feed;
            if way.is_some() {
                self.feed_tally.take(feed, programmed, at.line);
            }
            match &mut self.last {
                Some((tip, known)) if at.cuts && Arc::ptr_eq(known, solver) => *tip = pose.tip,
                last => *last = at.cuts.then(|| (pose.tip, Arc::clone(solver))),
            }
            self.waiting.push_back((*at, [feed, programmed]));
        }
        self.set_points += points.len() as u64;
        let mut failed = Ok(());
        let waiting = &mut self.waiting;
        self.contour.take(points, &self.actual, &mut |point| {
            let sample = sample(point, waiting);
            if failed.is_ok() {
                failed = listen(&sample);
            }
        });
        if let Some(last) = points.at.last() {
            let passed = last.task.min(self.timed);
            while self.first < passed {
                self.ahead.pop_front();
                self.first += 1;
            }
        }
        failed
    }

    /// There is no more.
    pub fn finish(
        mut self,
        machine: &Machine,
        name: &str,
        blocks: u64,
        listen: &mut dyn FnMut(&Sample) -> Result<(), Failure>,
    ) -> Result<Prediction, Failure> {
        let mut failed = Ok(());
        let waiting = &mut self.waiting;
        let contour = self.contour.finish(&mut |point| {
            let sample = sample(point, waiting);
            if failed.is_ok() {
                failed = listen(&sample);
            }
        });
        failed?;
        let time = self.times.finish();
        let held = self.against.is_some();
        Ok(Prediction {
            program: name.to_owned(),
            machine: machine.name.clone(),
            dialect: machine.control.dialect.clone(),
            against: self.against,
            blocks,
            set_points: self.set_points,
            period_s: self.period,
            feed: self.feed_tally.finish(&time),
            time,
            axes: found::axes(machine, &contour),
            corners_with_jump: contour.jumps,
            contour: found::contour(&contour, held),
            measured: None,
            fitted: Vec::new(),
            assumed: found::assumed(machine),
        })
    }
}

/// A set-point with what is known of it by now.
fn sample(point: &ContourPoint, waiting: &mut VecDeque<(ProgramPlace, [f64; 2])>) -> Sample {
    let (at, [feed, programmed]) = waiting.pop_front().unwrap_or_default();
    Sample { at, feed, programmed, point: *point }
}
