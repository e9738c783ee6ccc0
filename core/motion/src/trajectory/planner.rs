//! Tasks become runs of pieces, and these a time law.

use std::collections::VecDeque;
use std::sync::Arc;

use post_machine::description::{BlendRule, Machine};
use post_machine::kinematics::{Joints, Unreachable};

use super::account::Accounts;
use super::bounds::Bounds;
use super::corner::{Junction, Side};
use super::kink;
use super::law::{Law, Piece, Section, Span};
use super::look_ahead::{Block, LookAhead, Part, Why};
use super::profile::Phase;
use super::round::Round;
use super::{Filled, TaskTime, TimeLimit};
use crate::limits::{self, AxisLimits, KINK, MoveLimits};
use crate::path::{Way, turns};
use crate::{At, Corner, Jump, Move, Pace, SetPoints, Task};

/// Makes set-points of tasks, some tasks behind.
#[derive(Debug)]
pub struct Planner {
    limits: AxisLimits,
    /// Some jerk is limited.
    jerk: bool,
    blend: BlendRule,
    /// The control looks beyond the block in progress; else it stands still at the end of each.
    sees_on: bool,
    block_time: f64,
    law: Law,
    ahead: LookAhead,
    accounts: Accounts,
    /// The last move, whose corner waits for the next one.
    last: Option<Entry>,
    /// Number of the run in progress.
    run: u64,
    /// The piece before which the last border between tasks was set.
    bordered: Option<u64>,
    /// Up to here all is settled, s: here the next section begins.
    clock: f64,
    /// When the run before the one in progress ends, s.
    before: f64,
    /// Waits before anything has moved, s, and what they are.
    early: Vec<(f64, At)>,
    /// How the axes' derivatives change in front of these pieces, over the coordinate of the law.
    kinks: VecDeque<(u64, [Joints; 2])>,
    /// Jumps that no set-point stands behind yet.
    jumps: VecDeque<Jump>,
    tasks: u64,
    ended: bool,
    /// The last set-point is made.
    finished: bool,
    /// The axis values of the last set-point.
    near: Joints,
}

/// A move whose end is open.
#[derive(Clone, Debug)]
struct Entry {
    /// Its number in the law.
    number: u64,
    found: MoveLimits,
    whole: Bounds,
    half: Bounds,
    /// The length that its parameter from 0 to 1 has in the coordinate of the law.
    scale: f64,
    /// The share of it that the corner before has taken.
    taken: f64,
    /// It begins a run.
    begins: bool,
    /// Overlapped by the move before: the change of its rate that it begins with, 1/s², and for how long, s.
    entrance: Option<[f64; 2]>,
    /// Joined to the move before: how the axes' derivatives change over the coordinate of the law.
    kink: Option<[Joints; 2]>,
    at: At,
}

impl Planner {
    /// For a machine.
    pub fn new(machine: &Machine) -> Self {
        let rules = &machine.motion;
        let limits = AxisLimits::new(machine);
        let jerk = limits.limits_jerk();
        Self {
            law: Law::new(limits.programmed.is_some()),
            limits,
            jerk,
            blend: rules.blend,
            block_time: rules.block_time,
            sees_on: rules.look_ahead > 1,
            ahead: LookAhead::new(rules.look_ahead, jerk),
            accounts: Accounts::default(),
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
        }
    }

    /// Takes the next task.
    ///
    /// # Errors
    /// The axes cannot follow the move's way: see [`Way::stance_at`].
    pub fn push(&mut self, task: Task) -> Result<(), Unreachable> {
        let number = self.tasks;
        self.tasks += 1;
        match task {
            Task::Move(task) => self.push_move(task, number)?,
            Task::Wait { line, seconds, .. } => self.push_wait(number, line, seconds.max(0.0)),
        }
        Ok(())
    }

    /// There are no more.
    pub fn end(&mut self) {
        self.stop();
        self.accounts.skip(self.clock);
        self.ended = true;
    }

    fn push_wait(&mut self, task: u64, line: u64, seconds: f64) {
        self.stop();
        self.accounts.open(task, line, None, false);
        let at = At {
            task,
            line,
            cuts: false,
        };
        match self.law.last_move() {
            Some(entry) => self.wait(entry, 1.0, seconds, at),
            None => self.early.push((seconds, at)),
        }
    }

    /// Stands at an end of a move.
    fn wait(&mut self, entry: u64, end: f64, seconds: f64, at: At) {
        self.accounts.skip(self.clock);
        let piece = self.law.push_piece(Piece {
            entry,
            span: Span::Along { from: end, to: end },
            length: 1.0,
            at,
            second: at.task,
            by: [TimeLimit::Wait; 3],
            border: None,
        });
        let phase = Phase {
            seconds,
            ..Phase::default()
        };
        self.run += 1;
        self.law.push(Section {
            run: self.run,
            piece,
            from: 0.0,
            begins: self.clock,
            phase,
        });
        self.clock += seconds;
        self.before = self.clock;
        self.accounts.spend(at.task, seconds, 0.0, TimeLimit::Wait);
        self.accounts.border(self.clock);
    }

    fn push_move(&mut self, task: Move, number: u64) -> Result<(), Unreachable> {
        let found = limits::of(&task, &self.limits)?;
        let asked = match task.pace {
            Pace::Rapid => None,
            Pace::Minutes(minutes) => Some(minutes * 60.0),
        };
        let still = found.first.iter().all(|value| *value == 0.0) && found.tip[0] == 0.0;
        self.accounts.open(number, task.line, asked, still);
        if still {
            // To stand still where nothing moves is to stand still behind the move before.
            if task.corner == Corner::Stop {
                self.stop();
            }
            if self.last.is_none() {
                self.accounts.skip(self.clock);
            }
            return Ok(());
        }
        let at = At {
            task: number,
            line: task.line,
            cuts: asked.is_some(),
        };
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

    fn entry(&self, task: &Move, found: MoveLimits, asked: Option<f64>, at: At) -> Entry {
        let sweep = match &task.way {
            Way::Arc { sweep, .. } if !turns(task.solver.chain(), [&task.from, &task.to]) => {
                Some(libm::fabs(*sweep))
            }
            _ => None,
        };
        let feed = asked.unwrap_or(0.0);
        let bounds = |share: f64| {
            let seconds = feed.max(self.block_time);
            let mut bounds = Bounds::new(&found, &self.limits, seconds, share, sweep);
            if bounds.by[0] == TimeLimit::Feed && feed < seconds {
                bounds.by[0] = TimeLimit::BlockTime;
            }
            bounds
        };
        let whole = bounds(1.0);
        Entry {
            number: 0,
            half: bounds(0.5),
            scale: 1.0 / whole.rate,
            whole,
            found,
            taken: 0.0,
            begins: true,
            entrance: None,
            kink: None,
            at,
        }
    }

    /// The last move leads to a standstill.
    fn stop(&mut self) {
        if let Some(last) = self.last.take() {
            self.along(&last, 0.0, Junction::Stop);
            self.finish();
            self.accounts.border(self.clock);
        }
    }

    /// From the last move into the next one.
    fn pass(
        &mut self,
        last: Entry,
        junction: Junction,
        next: &mut Entry,
    ) -> Result<(), Unreachable> {
        let [out, into] = match &junction {
            Junction::Round(round) => round.shares,
            _ => [0.0, 0.0],
        };
        self.along(&last, out, junction);
        match junction {
            Junction::Stop => {
                self.finish();
                self.accounts.border(self.clock);
            }
            Junction::Overlap { rate, change } => {
                let earliest = self.clock.max(self.before);
                self.finish();
                let ends = self.clock;
                let (begins, change) = match self.jerk {
                    false => (self.overlap_from(rate * last.scale), change),
                    true => {
                        // Half of either ramp: what is left of the one and what there is of the other are one at most.
                        let reached = next.half.reached();
                        let begins = self.overlap_from(0.5 * rate * last.scale);
                        let begins = begins.max(ends - 1.0 / reached).max(earliest);
                        (begins, change.min(0.5 * reached / (ends - begins)))
                    }
                };
                self.clock = begins.max(earliest);
                next.entrance = Some([change, ends - self.clock]);
                self.accounts.border(0.5 * (self.clock + ends));
            }
            Junction::Join { ratio, jumps, .. } => {
                next.begins = false;
                next.scale = last.scale / ratio;
                if jumps {
                    next.kink = Some(self.kink([&last, next], ratio)?);
                }
                self.settle(false);
            }
            Junction::Round(round) => {
                next.begins = false;
                next.scale = last.scale / round.ratio;
                next.taken = into;
                self.corner(&last, next, &round);
                self.settle(false);
            }
        }
        Ok(())
    }

    /// How the axes' derivatives change between two moves that are joined, over the coordinate of the law.
    fn kink(&self, entries: [&Entry; 2], ratio: f64) -> Result<[Joints; 2], Unreachable> {
        let moves = entries.map(|entry| self.law.task(entry.number));
        let found = entries.map(|entry| &entry.found);
        let [change, bend] = kink::of_axes(moves, found, &self.limits, ratio)?;
        let scale = entries[0].scale;
        Ok([
            change.map(|change| change / scale),
            bend.map(|bend| bend / (scale * scale)),
        ])
    }

    /// The last move up to its corner, which takes the share `out`.
    fn along(&mut self, last: &Entry, out: f64, junction: Junction) {
        let blends = matches!(self.law.task(last.number).corner, Corner::Blend { .. });
        let shared = match junction {
            Junction::Overlap { .. } => true,
            Junction::Stop => blends && self.blend == BlendRule::Overlap,
            _ => false,
        };
        let smooth = last.whole.jerk.is_finite();
        let bounds = match shared || smooth && last.entrance.is_some() {
            true => &last.half,
            false => &last.whole,
        };
        let joined = !last.begins || matches!(junction, Junction::Join { .. } | Junction::Round(_));
        let share = match joined && self.blend == BlendRule::Overlap {
            true => 1.0 - KINK,
            false => 1.0,
        };
        let scale = last.scale;
        let exit = match junction {
            Junction::Join { rate, .. } => rate * scale,
            Junction::Round(_) => f64::INFINITY,
            Junction::Stop | Junction::Overlap { .. } => 0.0,
        };
        let mut block = Block {
            length: (1.0 - out - last.taken) * scale,
            velocity: bounds.rate * scale,
            acceleration: bounds.acceleration * share * scale,
            jerk: bounds.jerk * scale,
            exit,
        };
        let joined = !last.begins && last.taken == 0.0;
        let piece = Piece {
            entry: last.number,
            span: Span::Along {
                from: last.taken,
                to: 1.0 - out,
            },
            length: block.length,
            at: last.at,
            second: last.at.task,
            by: bounds.by,
            border: joined.then_some(0.0),
        };
        let number = self.law.push_piece(piece);
        if let Some(kink) = last.kink.filter(|_| joined) {
            self.kinks.push_back((number, kink));
        }
        if last.begins {
            self.run += 1;
            let mut begun = [0.0; 2];
            if let Some([change, seconds]) = last.entrance {
                let change = change * scale;
                if self.jerk {
                    block.acceleration = block.acceleration.min(change);
                } else if change < block.acceleration * (1.0 - 1e-9) && seconds > 0.0 {
                    let phase = Phase {
                        seconds,
                        velocity: 0.0,
                        acceleration: change,
                        jerk: 0.0,
                    };
                    begun = [phase.velocity(seconds), phase.length(seconds)];
                    self.take(Part {
                        block: number,
                        from: 0.0,
                        phase,
                        why: Why::Corner,
                    });
                }
            }
            self.ahead.begin(number, begun[0], begun[1]);
        }
        self.ahead.push(block);
    }

    /// The curve that takes shares of two moves.
    fn corner(&mut self, last: &Entry, next: &Entry, round: &Round) {
        let mut bounds = round.bounds;
        let length = round.length * last.scale;
        let velocities = [last, next].map(|entry| entry.whole.rate * entry.scale);
        let slower = usize::from(velocities[1] < velocities[0]);
        if bounds.by[0] == TimeLimit::Feed {
            bounds.by[0] = [last, next][slower].whole.by[0];
        } else {
            bounds.by[0] = TimeLimit::Corner;
        }
        self.law.push_piece(Piece {
            entry: last.number,
            span: Span::Corner {
                shares: round.shares,
                curve: round.curve,
            },
            length,
            at: last.at,
            second: next.at.task,
            by: bounds.by,
            border: Some(0.5),
        });
        self.ahead.push(Block {
            length,
            velocity: bounds.rate * length,
            acceleration: bounds.acceleration * length,
            jerk: bounds.jerk * length,
            exit: f64::INFINITY,
        });
    }

    /// The run ends where the last piece does.
    fn finish(&mut self) {
        self.settle(true);
        self.before = self.clock;
    }

    fn settle(&mut self, ended: bool) {
        let mut ahead = std::mem::replace(&mut self.ahead, LookAhead::new(1, false));
        ahead.settle(ended, &mut |part| self.take(part));
        self.ahead = ahead;
    }

    /// What the look-ahead has settled goes into the law.
    fn take(&mut self, part: Part) {
        let Part { phase, from, .. } = part;
        let piece = *self.law.piece(part.block);
        let reached = |kink: &mut (u64, [Joints; 2])| kink.0 <= part.block;
        while let Some((number, [change, bend])) = self.kinks.pop_front_if(reached) {
            if number == part.block {
                let (velocity, along) = (phase.velocity, phase.acceleration);
                self.jumps.push_back(Jump {
                    time: self.clock,
                    change: change.map(|change| change * velocity),
                    bend: std::array::from_fn(|place| {
                        bend[place] * velocity * velocity + change[place] * along
                    }),
                });
            }
        }
        let covered = phase.length(phase.seconds);
        let reason = match part.why {
            Why::Velocity => piece.by[0],
            Why::Corner if piece.at.cuts => TimeLimit::Corner,
            Why::Corner | Why::Change => match phase.jerk == 0.0 {
                true => piece.by[1],
                false => piece.by[2],
            },
        };
        let share = covered / piece.length;
        let (task, whole) = match piece.span {
            Span::Along { from, to } => (piece.at.task, to - from),
            Span::Corner { shares, .. } => match from + 0.5 * covered < 0.5 * piece.length {
                true => (piece.at.task, 2.0 * shares[0]),
                false => (piece.second, 2.0 * shares[1]),
            },
        };
        self.accounts
            .spend(task, phase.seconds, share * whole, reason);
        if let Some(border) = piece.border.filter(|_| self.bordered < Some(part.block)) {
            let place = border * piece.length;
            if border == 0.0 || from + covered >= place {
                let time = self.clock + phase.time_at(place - from);
                self.accounts.border(time);
                self.bordered = Some(part.block);
            }
        }
        self.law.push(Section {
            run: self.run,
            piece: part.block,
            from,
            begins: self.clock,
            phase,
        });
        self.clock += phase.seconds;
    }

    /// When the run in progress has come down to `velocity` on its way to rest, s.
    fn overlap_from(&self, velocity: f64) -> f64 {
        let mut begins = self.clock;
        let own = self.law.sections.iter().rev();
        for section in own.take_while(|section| section.run == self.run) {
            let phase = &section.phase;
            let last = phase.acceleration(phase.seconds);
            if phase.velocity <= phase.velocity(phase.seconds) || phase.acceleration.max(last) > 0.0
            {
                break;
            }
            if phase.velocity > velocity {
                return section.begins + phase.time_of(velocity);
            }
            begins = section.begins;
        }
        begins
    }

    /// Fills `out` behind what it holds, up to `most` set-points, as far as is settled; the times of tasks that are done
    /// go to `times`. The first set-point stands at time 0, the last one where all axes stand at their end.
    ///
    /// # Errors
    /// As [`Planner::push`].
    pub fn fill(
        &mut self,
        out: &mut SetPoints,
        most: usize,
        times: &mut Vec<TaskTime>,
    ) -> Result<Filled, Unreachable> {
        loop {
            let time = out.time(out.len());
            self.accounts.done(time, times);
            if self.finished || self.ended && self.law.sections.is_empty() {
                self.accounts.done(f64::INFINITY, times);
                return Ok(Filled::Ended);
            }
            if time >= self.clock && !self.ended {
                return Ok(Filled::Wants);
            }
            if out.len() >= most {
                return Ok(Filled::Full);
            }
            self.law.advance(time);
            let Some(solver) = self.law.solver() else {
                return Ok(Filled::Wants);
            };
            if !Arc::ptr_eq(solver, &out.solver) {
                if !out.is_empty() {
                    return Ok(Filled::Full);
                }
                out.solver = Arc::clone(solver);
            }
            let (stance, at) = self.law.at(time, &self.near)?;
            self.near = stance.joints;
            out.joints.push(stance.joints);
            out.poses.push(stance.pose);
            out.at.push(at);
            while let Some(jump) = self.jumps.pop_front_if(|jump| jump.time <= time) {
                out.jumps.push(jump);
            }
            self.finished = self.ended && time >= self.clock;
        }
    }
}

impl Entry {
    fn side<'a>(&'a self, task: &'a Move) -> Side<'a> {
        Side {
            task,
            found: &self.found,
            whole: &self.whole,
            half: &self.half,
            overlapped: self.entrance.is_some(),
        }
    }
}
