//! Tasks become runs of pieces, and these a time law.
//!
//! | part | does |
//! |---|---|
//! | `planner` | takes tasks, and fills set-points as far as all is settled |
//! | `entry` | a move whose corner waits for the next one |
//! | `runs` | from move to move: pieces of path, joined to runs |
//! | `settled` | what the look-ahead hands over goes into the law |

mod entry;
mod runs;
mod settled;

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::description::{BlendRule, Machine};
use post_machine::kinematics::{Joints, Pose, Unreachable};

use super::account::TaskAccounts;
use super::corner::Junction;
use super::law::{LawPiece, LawSection, PieceSpan, TimeLaw};
use super::look_ahead::LookAhead;
use super::profile::Phase;
use super::{FillOutcome, MOST_OF_BLOCK, MOST_SECONDS, TaskTime, TimeLimit};
use crate::limits::{self, AxisLimits};
use crate::{CornerMode, Move, MovePace, ProgramPlace, SetPoints, Task, VelocityJump};
use entry::OpenMove;

/// Makes set-points of tasks, and lags some tasks behind.
#[derive(Debug)]
pub struct Planner {
    limits: AxisLimits,
    /// Some jerk is limited.
    jerk: bool,
    blend: BlendRule,
    /// The control looks beyond the block in progress; else it stands still at the end of each.
    sees_on: bool,
    /// How long it waits where it stands still between moves, s.
    in_position: f64,
    block_time: f64,
    law: TimeLaw,
    ahead: LookAhead,
    accounts: TaskAccounts,
    /// The last move, whose corner waits for the next one.
    last: Option<OpenMove>,
    /// Number of the run in progress.
    run: u64,
    /// The piece before which the last border between tasks was set.
    bordered: Option<u64>,
    /// Time up to which all is settled, s: the next section begins there.
    clock: f64,
    /// When the run before the one in progress ends, s.
    before: f64,
    /// Waits before anything has moved, s, and what they are.
    early: Vec<(f64, ProgramPlace)>,
    /// How the axes' derivatives change in front of these pieces, over the coordinate of the law.
    kinks: VecDeque<(u64, [Joints; 2])>,
    /// Jumps that no set-point follows yet.
    jumps: VecDeque<VelocityJump>,
    tasks: u64,
    ended: bool,
    /// The last set-point is made.
    finished: bool,
    /// The axis values of the last set-point.
    near: Joints,
    /// Poses of the batch in work that are led by vectors, with the places of their set-points.
    led: Vec<(usize, Pose)>,
}

impl Planner {
    /// A planner for a machine.
    pub fn new(machine: &Machine) -> Self {
        let rules = &machine.motion;
        let limits = AxisLimits::new(machine);
        let jerk = limits.limits_jerk();
        Self {
            law: TimeLaw::new(limits.programmed.is_some()),
            limits,
            jerk,
            blend: rules.blend,
            block_time: rules.block_time,
            sees_on: rules.look_ahead > 1,
            in_position: rules.in_position,
            ahead: LookAhead::new(rules.look_ahead, jerk),
            accounts: TaskAccounts::default(),
            last: None,
            run: 0,
            bordered: None,
            clock: 0.0,
            before: 0.0,
            early: Vec::new(),
            kinks: VecDeque::new(),
            jumps: VecDeque::new(),
            tasks: 0,
            ended: false,
            finished: false,
            near: Joints::default(),
            led: Vec::new(),
        }
    }

    /// Takes the next task.
    ///
    /// # Errors
    /// The axes cannot follow the move's way: see [`Interpolation::stance_at`](crate::path::Interpolation::stance_at).
    pub fn push(&mut self, task: Task) -> Result<(), Unreachable> {
        let number = self.tasks;
        self.tasks += 1;
        match task {
            Task::Move(task) => self.push_move(task, number)?,
            Task::Wait { line, seconds, .. } => self.push_wait(number, line, seconds.max(0.0)),
        }
        Ok(())
    }

    /// Ends the tasks: no more are pushed.
    pub fn end(&mut self) {
        self.stop();
        self.accounts.skip(self.clock);
        self.ended = true;
    }

    fn push_wait(&mut self, task: u64, line: u64, seconds: f64) {
        self.stop();
        self.accounts.open(task, line, None, false);
        let at = ProgramPlace { task, line, cuts: false };
        match self.law.last_move() {
            Some(entry) => self.wait(entry, 1.0, seconds, at),
            None => self.early.push((seconds, at)),
        }
    }

    /// Stands at an end of a move.
    fn wait(&mut self, entry: u64, end: f64, seconds: f64, at: ProgramPlace) {
        self.accounts.skip(self.clock);
        self.rest(entry, end, seconds, at, TimeLimit::Wait);
        self.accounts.border(self.clock);
    }

    /// The machine stands at a place of a move.
    fn rest(&mut self, entry: u64, end: f64, seconds: f64, at: ProgramPlace, why: TimeLimit) {
        let piece = self.law.push_piece(LawPiece {
            entry,
            span: PieceSpan::Along { from: end, to: end },
            length: 1.0,
            at,
            second: at.task,
            by: [why; 3],
            border: None,
        });
        let phase = Phase { seconds, ..Phase::default() };
        self.run += 1;
        self.law.push(LawSection { run: self.run, piece, from: 0.0, begins: self.clock, phase });
        self.clock += seconds;
        self.before = self.clock;
        self.accounts.spend(at.task, seconds, 0.0, why);
    }

    fn push_move(&mut self, task: Move, number: u64) -> Result<(), Unreachable> {
        let found = limits::of(&task, &self.limits)?;
        let asked = match task.pace {
            MovePace::Rapid => None,
            MovePace::Minutes(minutes) => Some(minutes * 60.0),
        };
        let still = found.first.iter().all(|value| *value == 0.0) && found.tip[0] == 0.0;
        self.accounts.open(number, task.line, asked, still);
        if still {
            // To stand still where nothing moves is to stand still after the move before.
            if task.corner == CornerMode::Stop {
                self.stop();
            }
            if self.last.is_none() {
                self.accounts.skip(self.clock);
            }
            return Ok(());
        }
        let at = ProgramPlace { task: number, line: task.line, cuts: asked.is_some() };
        let mut entry = self.entry(&task, found, asked, at);
        let junction = self.last.as_ref().map_or(Junction::Stop, |last| {
            let first = self.law.task(last.number);
            match self.sees_on && Arc::ptr_eq(&first.solver, &task.solver) {
                false => Junction::Stop,
                true => Junction::between(
                    [last.side(first), entry.side(&task)],
                    &self.limits,
                    self.blend,
                ),
            }
        });
        if self.law.last_move().is_none() {
            self.near = task.from.joints;
        }
        entry.number = self.law.push_move(task);
        for (seconds, at) in std::mem::take(&mut self.early) {
            self.wait(entry.number, 0.0, seconds, at);
        }
        match self.last.take() {
            Some(last) => self.pass(last, junction, &mut entry)?,
            None => self.accounts.skip(self.clock),
        }
        self.last = Some(entry);
        Ok(())
    }

    /// Fills `out` after what it holds, up to `most` set-points, as far as is settled; the times of tasks that are done
    /// go to `times`. The first set-point stands at time 0, the last one where all axes stand at their end.
    ///
    /// # Errors
    /// As [`Planner::push`].
    pub fn fill(
        &mut self,
        out: &mut SetPoints,
        most: usize,
        times: &mut Vec<TaskTime>,
    ) -> Result<FillOutcome, Unreachable> {
        let filled = self.fill_joints(out, most, times);
        // All that are new at once: sines and products of many points overlap.
        let new = out.poses.len();
        out.solver.chain().forward_all(&out.joints[new..], &mut out.poses);
        for (place, pose) in self.led.drain(..) {
            out.poses[place] = pose;
        }
        filled
    }

    /// Goes on to where all is settled, and makes no set-points: the times of tasks that are done go to `times`, as
    /// [`Planner::fill`] hands them over.
    pub fn skip(&mut self, times: &mut Vec<TaskTime>) -> FillOutcome {
        self.jumps.clear();
        if self.ended {
            self.accounts.done(f64::INFINITY, times);
            return FillOutcome::Ended;
        }
        self.accounts.done(self.clock, times);
        self.law.advance(self.clock);
        FillOutcome::Wants
    }

    /// What lasts too long for set-points every `period` seconds, if that at `time` does.
    fn too_long(&self, time: f64, period: f64) -> Option<FillOutcome> {
        let section = self.law.sections.front()?;
        let (seconds, most) = match section.phase.seconds > MOST_OF_BLOCK * period {
            true => (section.phase.seconds, MOST_OF_BLOCK * period),
            false if time > MOST_SECONDS => (time, MOST_SECONDS),
            false => return None,
        };
        let line = self.law.piece(section.piece).at.line;
        Some(FillOutcome::TooLong { line, seconds, most })
    }

    /// [`Planner::fill`] without poses but those that are led.
    fn fill_joints(
        &mut self,
        out: &mut SetPoints,
        most: usize,
        times: &mut Vec<TaskTime>,
    ) -> Result<FillOutcome, Unreachable> {
        loop {
            let time = out.time(out.len());
            self.accounts.done(time, times);
            if self.finished || self.ended && self.law.sections.is_empty() {
                self.accounts.done(f64::INFINITY, times);
                return Ok(FillOutcome::Ended);
            }
            if time >= self.clock && !self.ended {
                return Ok(FillOutcome::Wants);
            }
            if out.len() >= most {
                return Ok(FillOutcome::Full);
            }
            self.law.advance(time);
            let Some(solver) = self.law.solver() else {
                return Ok(FillOutcome::Wants);
            };
            if let Some(long) = self.too_long(time, out.period) {
                return Ok(long);
            }
            if !Arc::ptr_eq(solver, &out.solver) {
                if !out.is_empty() {
                    return Ok(FillOutcome::Full);
                }
                out.solver = Arc::clone(solver);
            }
            let (stance, at) = self.law.at(time, &self.near)?;
            self.near = stance.joints;
            if let Some(pose) = stance.pose {
                self.led.push((out.len(), pose));
            }
            out.joints.push(stance.joints);
            out.at.push(at);
            while let Some(jump) = self.jumps.pop_front_if(|jump| jump.time <= time) {
                out.jumps.push(jump);
            }
            self.finished = self.ended && time >= self.clock;
        }
    }
}
