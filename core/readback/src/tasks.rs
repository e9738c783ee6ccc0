//! What a program did becomes what its control carries out: moves with their pace and corners, and waits.
//!
//! Where the control stands still is settled here, as far as it does not follow from the path: at waits (of no time at
//! words for the coolant and the like), at the ends of rapids where the machine file says so, at G9, and at the turning
//! points of a cycle's hole.

use std::sync::Arc;

use post_machine::description::{CornerRule, Machine, RapidRule};
use post_machine::diagnostic::Diagnostic;
use post_motion::{CornerMode, Move, MovePace, Task, WaitReason};

use crate::{BlockEffect, Corners, MachineState, Motion, MotionKind, ProgramEvent, SpindleState};

/// A task, and what the program says of it.
#[derive(Clone, Debug)]
pub struct ProgramTask {
    /// The task.
    pub task: Task,
    /// Feed of the tip against the part, mm/min, as the program states it; zero for rapids and waits, and where it states
    /// none.
    pub feed: f64,
    /// It is a rapid.
    pub rapid: bool,
    /// What holds meanwhile; none before the program says anything.
    pub state: Option<Arc<MachineState>>,
}

/// Turns what a program did into tasks, one motion behind.
#[derive(Clone, Debug)]
pub struct ProgramTasks {
    /// Where the program says nothing of it.
    usual: CornerMode,
    /// By how much a corner may be left where the program names no tolerance, mm.
    tolerance: Option<f64>,
    rapids: RapidRule,
    tool_change: f64,
    spindle_seconds: f64,
    /// The motion that waits for the one behind it.
    pending: Option<ProgramTask>,
    state: Option<Arc<MachineState>>,
    /// Lines of the first that is taken for granted, by its kind.
    own_corners: Option<u64>,
    no_feed: Option<u64>,
    stop: Option<u64>,
    no_speed: Option<u64>,
    subprogram: Option<u64>,
}

impl ProgramTasks {
    /// For the control of a machine.
    pub fn new(machine: &Machine) -> Self {
        let rules = &machine.motion;
        Self {
            usual: match rules.corner {
                CornerRule::Stop => CornerMode::Stop,
                CornerRule::Path => CornerMode::Path,
                CornerRule::Blend => CornerMode::Blend { tolerance: None },
            },
            tolerance: rules.corner_tolerance,
            rapids: rules.rapids,
            tool_change: rules.tool_change,
            spindle_seconds: rules.spindle,
            pending: None,
            state: None,
            own_corners: None,
            no_feed: None,
            stop: None,
            no_speed: None,
            subprogram: None,
        }
    }

    /// Takes what a block did, which it draws out of `done`; tasks that are settled by it go behind what `out` holds.
    pub fn take(&mut self, done: &mut Vec<BlockEffect>, out: &mut Vec<ProgramTask>) {
        for done in done.drain(..) {
            match done {
                BlockEffect::Motion(motion) => self.motion(motion, out),
                BlockEffect::Event { line, event } => self.take_event(line, &event, out),
                BlockEffect::State(state) => self.state = Some(state),
            }
        }
    }

    /// The program has ended: the last motion is settled.
    pub fn end(&mut self, out: &mut Vec<ProgramTask>) {
        out.extend(self.pending.take());
    }

    /// What was taken for granted so far.
    pub fn notes(&self) -> Vec<Diagnostic> {
        let told = [
            (
                self.own_corners,
                "what the control does at corners from here on lies in its parameters: [motion] corner of the machine file holds",
            ),
            (
                self.no_feed,
                "a motion at feed has no feed: it is taken to go as fast as the axes do",
            ),
            (self.stop, "the program stops: this is counted as no time"),
            (
                self.no_speed,
                "turns of a spindle that stands are waited for: this is counted as no time",
            ),
            (
                self.subprogram,
                "a subprogram of the control runs: its time is not known and not counted",
            ),
        ];
        let told = told.into_iter().filter_map(|(line, says)| {
            let message = format!("line {} of the program: {says}", line?);
            Some(Diagnostic::warning("motion-assumed", message))
        });
        told.collect()
    }

    fn motion(&mut self, motion: Motion, out: &mut Vec<ProgramTask>) {
        let rapid = motion.kind == MotionKind::Rapid;
        if let Some(pending) = &mut self.pending
            && let Task::Move(last) = &mut pending.task
            && self.rapids != RapidRule::Blend
            && pending.rapid != rapid
        {
            last.corner = CornerMode::Stop;
        }
        let corner = self.corner(&motion);
        let pace = match motion.kind {
            MotionKind::Rapid => MovePace::Rapid,
            _ if motion.minutes > 0.0 => MovePace::Minutes(motion.minutes),
            _ => {
                self.no_feed.get_or_insert(motion.line);
                MovePace::Rapid
            }
        };
        let next = ProgramTask {
            task: Task::Move(Move {
                line: motion.line,
                way: motion.way,
                from: motion.from,
                to: motion.to,
                solver: Arc::clone(&motion.state.solver),
                keeps_tip: motion.state.tcp,
                pace,
                corner,
            }),
            feed: motion.feed,
            rapid,
            state: Some(motion.state),
        };
        out.extend(self.pending.replace(next));
    }

    /// How the control passes into whatever comes behind a motion.
    fn corner(&mut self, motion: &Motion) -> CornerMode {
        let rapid = motion.kind == MotionKind::Rapid;
        if motion.stops || rapid && self.rapids == RapidRule::Stop {
            return CornerMode::Stop;
        }
        let said = match motion.state.corners {
            Corners::Said(corner) => corner,
            Corners::Unsaid => self.usual,
            Corners::Own => {
                self.own_corners.get_or_insert(motion.line);
                self.usual
            }
        };
        match said {
            // A hole has its depth, and a thread turns back at its end.
            CornerMode::Blend { .. } | CornerMode::Within { .. }
                if motion.hole || motion.kind == MotionKind::Thread =>
            {
                CornerMode::Path
            }
            // ADIS is for cuts.
            CornerMode::Within { .. } if rapid => self.usual,
            CornerMode::Blend { tolerance } => {
                CornerMode::Blend { tolerance: tolerance.or(self.tolerance) }
            }
            corner => corner,
        }
    }

    fn take_event(&mut self, line: u64, event: &ProgramEvent, out: &mut Vec<ProgramTask>) {
        let (seconds, why) = match event {
            ProgramEvent::Dwell { time, revolutions } => {
                let seconds = match revolutions {
                    true => self.turns(line, *time),
                    false => *time,
                };
                (seconds, WaitReason::Dwell)
            }
            ProgramEvent::ToolChange { .. } => (self.tool_change, WaitReason::ToolChange),
            ProgramEvent::Spindle(_) => (self.spindle_seconds, WaitReason::Spindle),
            ProgramEvent::Stop | ProgramEvent::OptionalStop => {
                self.stop.get_or_insert(line);
                (0.0, WaitReason::Word)
            }
            ProgramEvent::Subprogram(_) => {
                self.subprogram.get_or_insert(line);
                (0.0, WaitReason::Word)
            }
            ProgramEvent::Sync(_) => (0.0, WaitReason::Channels),
            ProgramEvent::Coolant(_) | ProgramEvent::Head(_) => (0.0, WaitReason::Word),
            _ => return,
        };
        // Where it stands already, a wait that takes no time is none.
        let moved = self.pending.is_some();
        out.extend(self.pending.take());
        if seconds > 0.0 || moved || why == WaitReason::Channels {
            out.push(ProgramTask {
                task: Task::Wait { line, seconds, why },
                feed: 0.0,
                rapid: false,
                state: self.state.clone(),
            });
        }
    }

    /// Seconds of so many turns of the spindle.
    fn turns(&mut self, line: u64, turns: f64) -> f64 {
        let spindle = self.state.as_ref().map(|state| state.spindle);
        match spindle {
            Some(SpindleState::Clockwise(speed) | SpindleState::CounterClockwise(speed))
                if speed > 0.0 =>
            {
                60.0 * turns / speed
            }
            _ => {
                self.no_speed.get_or_insert(line);
                0.0
            }
        }
    }
}
