//! A program becomes tasks, and tasks become set-points: what is told of both, in its order.

use std::sync::Arc;

use post_machine::description::Machine;
use post_machine::diagnostic::{Diagnostic, SourcePlace};
use post_machine::kinematics::{Joints, Unreachable};
use post_motion::contour::ContourLeg;
use post_motion::trajectory::{FillOutcome, MOST_SECONDS, Planner, TaskTime};
use post_motion::{SetPoints, Task};
use post_readback::tasks::{ProgramTask, ProgramTasks};
use post_readback::{BlockEffect, MachineState, ProgramEvent, ProgramRun};

use super::times::TaskKind;
use crate::beside::Maker;
use crate::nc_program::RunningProgram;
use crate::session::Session;
use crate::text::{clock, number};

/// Set-points of a batch.
const BATCH: usize = 256;

/// What becomes known of a program on its way to set-points.
#[derive(Debug)]
pub enum TrajectoryNews {
    /// What a block does.
    Block(Vec<BlockEffect>),
    /// The axes stand here before the first task.
    Start(Joints),
    /// A task is planned now.
    Task(PlannedTask),
    /// Tasks have their time.
    Times(Vec<TaskTime>),
    /// Set-points are settled.
    Points(SetPoints),
    /// The axes cannot follow, and nothing follows.
    Failed(Box<Diagnostic>),
}

/// What is known of a task before it is carried out.
#[derive(Debug)]
pub struct PlannedTask {
    /// Its way; none where it waits.
    pub leg: Option<ContourLeg>,
    /// What it is.
    pub kind: TaskKind,
    /// Feed of the tip, mm/min, as the program states it.
    pub feed: f64,
    /// What holds meanwhile; none before the program says anything.
    pub state: Option<Arc<MachineState>>,
}

/// A program on the way to set-points.
pub struct Trajectory<'a> {
    /// The program, as messages call it.
    name: &'a str,
    /// Time between set-points, s.
    period: f64,
    reading: TaskReader<'a>,
    planner: Planner,
    /// The batch in work; none before the first move.
    points: Option<SetPoints>,
    /// Batches that are taken, to be filled again.
    spare: Vec<SetPoints>,
    spare_times: Vec<Vec<TaskTime>>,
    times: Vec<TaskTime>,
    /// Somebody wants to know what blocks do.
    tells_blocks: bool,
    over: bool,
    /// Set-points are made.
    sampled: bool,
    /// Waits so far, s.
    waited: f64,
    /// The run that it is made for, which may end it; none: nobody does.
    session: Option<Session>,
}

impl<'a> Trajectory<'a> {
    /// At the beginning of the program `name`, with set-points every `period` seconds. Somebody may want to know what its
    /// blocks do.
    pub fn new(
        name: &'a str,
        run: ProgramRun<RunningProgram<'a>>,
        machine: &Machine,
        period: f64,
        tells_blocks: bool,
    ) -> Self {
        Self {
            name,
            period,
            reading: TaskReader {
                run,
                tasks: ProgramTasks::new(machine),
                planned: Vec::new(),
                ended: false,
                refused: false,
            },
            planner: Planner::new(machine),
            points: None,
            spare: Vec::new(),
            spare_times: Vec::new(),
            times: Vec::new(),
            tells_blocks,
            over: false,
            sampled: true,
            waited: 0.0,
            session: None,
        }
    }

    /// The same without set-points: times of tasks alone.
    pub fn timed(self) -> Self {
        Self { sampled: false, ..self }
    }

    /// The same for a run that may end it: nothing more is made then.
    pub fn stoppable(self, session: &Session) -> Self {
        Self { session: Some(session.clone()), ..self }
    }

    fn is_stopped(&self) -> bool {
        self.session.as_ref().is_some_and(|session| session.go_on().is_err())
    }

    /// The program, and what was taken for granted on the way.
    pub fn end(self) -> (ProgramRun<RunningProgram<'a>>, Vec<Diagnostic>) {
        (self.reading.run, self.reading.tasks.notes())
    }

    /// Something moves, so far.
    pub fn has_moved(&self) -> bool {
        self.points.is_some()
    }

    /// Hands on a batch of set-points, or reads on where the planner wants more.
    fn step(&mut self, news: &mut Vec<TrajectoryNews>) {
        match self.fill(news) {
            Ok(FillOutcome::Full) => {}
            Ok(FillOutcome::Ended) => self.over = true,
            Ok(FillOutcome::TooLong { line, seconds, most }) => {
                let takes = match most < MOST_SECONDS {
                    true => "this block takes",
                    false => "up to here the program takes",
                };
                let fault = too_long(self.name, line, takes, [seconds, most]);
                news.push(TrajectoryNews::Failed(fault.boxed()));
                self.over = true;
            }
            Ok(FillOutcome::Wants) => {
                if let Err(fault) = self.read_on(news) {
                    news.push(TrajectoryNews::Failed(fault));
                    self.over = true;
                }
            }
            Err(fault) => {
                news.push(TrajectoryNews::Failed(fault));
                self.over = true;
            }
        }
    }

    /// Makes set-points of what is planned.
    fn fill(&mut self, news: &mut Vec<TrajectoryNews>) -> Result<FillOutcome, Box<Diagnostic>> {
        let Some(points) = &mut self.points else {
            return Ok(FillOutcome::Wants);
        };
        let filled = match self.sampled {
            true => self.planner.fill(points, BATCH, &mut self.times),
            false => Ok(self.planner.skip(&mut self.times)),
        };
        let line = points.at.last().map_or(0, |at| at.line);
        let filled = filled.map_err(|fault| unreachable(fault, self.name, line).boxed())?;
        if !self.times.is_empty() {
            let room = self.spare_times.pop().unwrap_or_default();
            news.push(TrajectoryNews::Times(std::mem::replace(&mut self.times, room)));
        }
        if self.sampled && filled != FillOutcome::Wants {
            news.push(TrajectoryNews::Points(points.hand_over(self.spare.pop())));
        }
        Ok(filled)
    }

    /// Hands further tasks to the planner, until the program ends.
    fn read_on(&mut self, news: &mut Vec<TrajectoryNews>) -> Result<(), Box<Diagnostic>> {
        self.reading.more(self.name, self.tells_blocks.then_some(&mut *news));
        for planned in self.reading.planned.drain(..) {
            if let (None, Task::Move(first)) = (&self.points, &planned.task) {
                self.points = Some(SetPoints::new(Arc::clone(&first.solver), self.period));
                news.push(TrajectoryNews::Start(first.from.joints));
            }
            let line = match &planned.task {
                Task::Move(task) => task.line,
                Task::Wait { line, .. } => *line,
            };
            let ProgramTask { task, feed, rapid, state } = planned;
            let kind = match (&task, rapid) {
                (Task::Wait { why, seconds, .. }, _) => {
                    self.waited += seconds;
                    // A wait that is too long by itself is told as such.
                    if self.sampled && self.waited > MOST_WAITED && *seconds <= MOST_WAITED {
                        let takes = "the waits up to here take";
                        let long = [self.waited, MOST_WAITED];
                        return Err(too_long(self.name, line, takes, long).boxed());
                    }
                    TaskKind::Wait(*why)
                }
                (Task::Move(_), true) => TaskKind::Rapid,
                (Task::Move(_), false) => TaskKind::Cut,
            };
            let leg = ContourLeg::of(&task);
            news.push(TrajectoryNews::Task(PlannedTask { leg, kind, feed, state }));
            self.planner.push(task).map_err(|fault| unreachable(fault, self.name, line).boxed())?;
        }
        if self.reading.ended {
            self.over = self.points.is_none();
            self.planner.end();
        }
        Ok(())
    }
}

impl Maker for Trajectory<'_> {
    type Batch = Vec<TrajectoryNews>;

    fn make(&mut self, batch: &mut Self::Batch, most: usize) -> bool {
        for taken in batch.drain(..) {
            match taken {
                TrajectoryNews::Points(points) => self.spare.push(points),
                TrajectoryNews::Times(mut times) => {
                    times.clear();
                    self.spare_times.push(times);
                }
                _ => {}
            }
        }
        while batch.len() < most && !self.over && !self.is_stopped() {
            self.step(batch);
        }
        !batch.is_empty()
    }
}

/// A program on the way to tasks.
struct TaskReader<'a> {
    run: ProgramRun<RunningProgram<'a>>,
    tasks: ProgramTasks,
    planned: Vec<ProgramTask>,
    ended: bool,
    /// That its axes are not followed was told.
    refused: bool,
}

impl TaskReader<'_> {
    /// Runs blocks until there is a task, or the program ends; what they do goes to `news`.
    fn more(&mut self, name: &str, mut news: Option<&mut Vec<TrajectoryNews>>) {
        while self.planned.is_empty() && !self.ended {
            let Some(done) = self.run.block() else {
                self.tasks.end(&mut self.planned);
                self.ended = true;
                return;
            };
            if let Some(news) = &mut news {
                news.push(TrajectoryNews::Block(done.clone()));
            }
            let head = head(done, name);
            self.tasks.take(done, &mut self.planned);
            if let Some(head) = head.filter(|_| !std::mem::replace(&mut self.refused, true)) {
                self.run.refuse(head);
            }
        }
    }
}

/// Set-points are made of so many seconds of waits at most: a working day, more than any program waits.
const MOST_WAITED: f64 = 8.0 * 3600.0;

/// A head was swapped in, or the control goes in polar coordinates: from here on the axes are others.
fn head(done: &[BlockEffect], name: &str) -> Option<Diagnostic> {
    done.iter().find_map(|done| match done {
        BlockEffect::Event { line, event: ProgramEvent::Head(head) } => {
            let message = format!("head {head} is swapped in: other axes move from here on");
            let help = "predict the programs of its heads one by one (post --split tools)";
            let place = SourcePlace::new(name, *line, "", 0..0);
            Some(Diagnostic::error("head", message).help(help).at(Some(place)))
        }
        BlockEffect::Motion(motion) if motion.state.face.is_some() => {
            let message = "polar interpolation of the control: how its axes go is not predicted";
            let help = "predict the program that is posted without [mode.face]";
            let place = SourcePlace::new(name, motion.line, "", 0..0);
            Some(Diagnostic::error("mode", message).help(help).at(Some(place)))
        }
        _ => None,
    })
}

/// What ends on `line` takes so many seconds, more than set-points are made of at most.
fn too_long(name: &str, line: u64, takes: &str, [seconds, most]: [f64; 2]) -> Diagnostic {
    let message =
        format!("{takes} {}, and set-points are made of {} at most", clock(seconds), clock(most));
    let help = "is a decimal point missing, or a feed or a dwell in another unit? a longer period makes fewer set-points; `post lint` tells the time without any";
    let place = SourcePlace::new(name, line, "", 0..0);
    Diagnostic::error("too-long", message).help(help).at(Some(place))
}

/// The axes cannot follow a move.
fn unreachable(fault: Unreachable, name: &str, line: u64) -> Diagnostic {
    let message = match fault {
        Unreachable::Axis { miss } => format!(
            "on this way no rotary angles give the tool axis, by {}°",
            number(miss.to_degrees(), 4)
        ),
        Unreachable::Linear => "on this way the linear axes lie in a plane".to_owned(),
        Unreachable::Plane { miss } => format!(
            "on this way the two linear axes do not reach the tip, by {} mm",
            number(miss, 4)
        ),
        Unreachable::Numeric { miss } => format!(
            "on this way no axis values were found that give tip and tool axis, by {} mm",
            number(miss, 4)
        ),
    };
    let place = SourcePlace::new(name, line, "", 0..0);
    let help = "tool lengths and work offsets may be others: --tool-length, --offsets, --mount";
    Diagnostic::error("motion-unreachable", message).help(help).at(Some(place))
}
