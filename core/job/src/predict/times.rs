//! Where the time goes: by what limits it, by tool and operation.

use post_machine::description::Machine;
use post_motion::WaitReason;
use post_motion::trajectory::{TaskTime, TimeLimit};
use post_posting::program::limits::MOST_WAITS;

use super::prediction::{LimitTime, OperationTime, Times};

/// So many operations are told apart; the time of further ones is that of the last.
const MOST_OPERATIONS: usize = 1000;

/// Kinds of tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TaskKind {
    /// A move at feed.
    Cut,
    /// A rapid.
    Rapid,
    /// The machine waits.
    Wait(WaitReason),
}

impl Default for TaskKind {
    fn default() -> Self {
        Self::Wait(WaitReason::Dwell)
    }
}

impl TaskKind {
    fn name(self) -> &'static str {
        match self {
            Self::Cut => "cut",
            Self::Rapid => "rapid",
            Self::Wait(_) => "wait",
        }
    }
}

/// Adds times up.
#[derive(Clone, Debug, Default)]
pub struct TimeTally {
    times: Times,
    limits: Vec<(TaskKind, TimeLimit, LimitTime)>,
}

impl TimeTally {
    /// The row of a tool and an operation.
    pub fn operation(&mut self, tool: Option<u32>, operation: Option<&str>) -> usize {
        let rows = &mut self.times.operations;
        let known =
            rows.iter().rposition(|row| row.tool == tool && row.operation.as_deref() == operation);
        if let Some(known) = known {
            return known;
        }
        if rows.len() < MOST_OPERATIONS {
            rows.push(OperationTime {
                tool,
                operation: operation.map(str::to_owned),
                seconds: 0.0,
                cutting_s: 0.0,
            });
        }
        rows.len() - 1
    }

    /// A task is done; `operation` is the row of what it belongs to.
    pub fn take(&mut self, machine: &Machine, time: &TaskTime, kind: TaskKind, operation: usize) {
        let times = &mut self.times;
        times.cycle_s = times.cycle_s.max(time.begins + time.seconds);
        match kind {
            TaskKind::Cut => {
                times.cutting_s += time.seconds;
                times.cutting_at_feed_s += time.asked;
            }
            TaskKind::Rapid => times.rapid_s += time.seconds,
            TaskKind::Wait(WaitReason::Channels) => {
                if times.channel_waits_s.len() < MOST_WAITS {
                    times.channel_waits_s.push(time.begins);
                }
                return;
            }
            TaskKind::Wait(_) => times.waiting_s += time.seconds,
        }
        if let Some(row) = times.operations.get_mut(operation) {
            row.seconds += time.seconds;
            if kind == TaskKind::Cut {
                row.cutting_s += time.seconds;
            }
        }
        let now = match kind {
            TaskKind::Wait(_) => TimeLimit::Wait,
            _ => time.limit,
        };
        let known =
            self.limits.iter().position(|(known, limit, _)| (*known, *limit) == (kind, now));
        let place = known.unwrap_or_else(|| {
            let (called, axis) = match kind {
                TaskKind::Wait(why) => (reason(why), None),
                _ => name(machine, now),
            };
            let row = LimitTime {
                kind: kind.name(),
                limit: called,
                axis,
                moves: 0,
                seconds: 0.0,
                share: 0.0,
                beyond_feed_s: 0.0,
            };
            self.limits.push((kind, now, row));
            self.limits.len() - 1
        });
        let row = &mut self.limits[place].2;
        row.moves += 1;
        row.seconds += time.seconds;
        row.beyond_feed_s += (time.seconds - time.asked).max(0.0);
    }

    /// All of it.
    pub fn finish(self) -> Times {
        let Self { mut times, limits } = self;
        let all: f64 = limits.iter().map(|(.., row)| row.seconds).sum();
        times.limits = limits.into_iter().map(|(.., row)| row).collect();
        for row in &mut times.limits {
            row.share = if all > 0.0 { row.seconds / all } else { 0.0 };
        }
        times.limits.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        times.operations.retain(|row| row.seconds > 0.0);
        times
    }
}

/// What is waited for.
fn reason(why: WaitReason) -> &'static str {
    match why {
        WaitReason::Dwell => "dwell",
        WaitReason::ToolChange => "tool change",
        WaitReason::Spindle => "spindle",
        WaitReason::Word | WaitReason::Channels => "standstill",
    }
}

/// What a limit is called, and its axis.
fn name(machine: &Machine, limit: TimeLimit) -> (&'static str, Option<String>) {
    let axis = |place: u8| {
        let axis = machine.axes.get(usize::from(place));
        axis.map(|axis| axis.name.clone())
    };
    match limit {
        TimeLimit::Feed => ("feed", None),
        TimeLimit::AxisVelocity(place) => ("axis velocity", axis(place)),
        TimeLimit::AxisAcceleration(place) => ("axis acceleration", axis(place)),
        TimeLimit::AxisJerk(place) => ("axis jerk", axis(place)),
        TimeLimit::TipAcceleration => ("tip acceleration", None),
        TimeLimit::TipJerk => ("tip jerk", None),
        TimeLimit::Corner => ("corner", None),
        TimeLimit::BlockTime => ("block time", None),
        TimeLimit::Wait => ("standstill", None),
    }
}
