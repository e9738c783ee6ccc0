//! Tasks become set-points: look-ahead over blocks, limits of the axes and of the tip, corners, and the time law.

mod account;
mod bounds;
mod corner;
mod law;
mod look_ahead;
mod planner;
pub mod profile;
mod smooth;

pub use planner::Planner;

/// How long a task took, and what kept it from being faster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskTime {
    /// Number of the task, from 0.
    pub task: u64,
    /// Line of the program.
    pub line: u64,
    /// When it began, s from the beginning; while two overlap, the middle of that time.
    pub begins: f64,
    /// How long, s.
    pub seconds: f64,
    /// How long it would have been at the programmed feed alone, s; of a rapid or a wait the same as `seconds`.
    pub asked: f64,
    /// What took most of the time that it needed beyond that.
    pub limit: TimeLimit,
}

/// What keeps a task from being faster.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeLimit {
    /// The feed of the program: nothing else does.
    #[default]
    Feed,
    /// An axis, by its place in the chain, goes as fast as it can.
    AxisVelocity(u8),
    /// An axis, by its place in the chain, is accelerated as hard as it can be, within the task or at its ends.
    AxisAcceleration(u8),
    /// An axis, by its place in the chain, has the jerk that it may have.
    AxisJerk(u8),
    /// The tip's acceleration.
    TipAcceleration,
    /// The tip's jerk.
    TipJerk,
    /// It stops at an end, or slows down for a corner.
    Corner,
    /// The control prepares no more blocks a second.
    BlockTime,
    /// A wait.
    Wait,
}

/// What has come of a call of [`Planner::fill`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filled {
    /// The batch is full, or its chain changes: call again.
    Full,
    /// Nothing more is settled before further tasks are pushed, or the end is told.
    Wants,
    /// All tasks are carried out.
    Ended,
}
