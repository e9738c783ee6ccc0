//! Tasks become set-points: look-ahead over blocks, limits of the axes and of the tip, corners, and the time law.
//!
//! | part | does |
//! |---|---|
//! | [`Planner`] | takes tasks, cuts their moves into *pieces* of path at the corners and joins these to *runs*, within which the machine does not stand still; fills set-points |
//! | `bounds` | what limits along a move come to: rate of its parameter, change of the rate, change of that |
//! | `side` | a move as a corner sees it: which way it goes, at its ends |
//! | `corner` | what happens between two moves: stop, join, round, overlap |
//! | `kink` | what jumps where two moves are joined |
//! | `round` | curves in the place of corners |
//! | `block` | pieces of a run as the look-ahead takes them, and the parts that it hands over |
//! | `envelope` | the blocks in sight, and what accelerations allow over them, backwards and forwards |
//! | `look_ahead` | velocities over the pieces of a run, some blocks ahead: along the envelope |
//! | `smooth` | the same with jerk limits: a double S from knot to knot of the envelope, whatever blocks it spans |
//! | [`profile`] | from one velocity to another over a length: trapezoid and double S in closed form |
//! | `law` | sections of constant jerk, and where the machine stands by them at any time |
//! | `account` | how long each task took, and what for |
//!
//! **Coordinate.** Along a run one coordinate `s` counts the way; its velocity and acceleration go on from piece to
//! piece. A move's own parameter runs from 0 to 1, and `s` is that parameter times a scale of the move: the first one's
//! is the time that it takes at full rate, and each next one's such that what is limited (axes, or programmed
//! coordinates; each weighed by its acceleration) has the same speed on both sides of the joint. So tip ways, rotary
//! ways and ways of which the program counts the feed otherwise pass into each other without a jump, and no unit has to
//! be chosen.
//!
//! **Limits.** They are split once a move (`bounds`), so that a section is a closed form; the split leaves some of an
//! acceleration unused in curves (at most a quarter goes lost, most of it where the feed is what bounds the velocity
//! anyway). Curves of a path (`q''`) that begin or end where two moves meet let the acceleration jump there: jerk
//! limits hold along the path, and inside of moves and corners.
//!
//! **Monotone.** With larger limits no program of straight axis ways takes longer (stops, joined paths, both blends).
//! It may with jerk limits, by a percent or so, as the knots then lie elsewhere; and on curves, where a velocity that
//! is allowed to be higher leaves less acceleration along the way. To keep the path takes no longer than to stop at
//! each corner. To leave it may take longer than to keep it where a ramp goes over a corner, as its curve takes some of
//! the accelerations that a kink leaves alone. With jerk limits neither is proven: a ramp over unlike blocks has the
//! least acceleration and jerk of them, unless splitting it pays.
//!
//! **Streaming.** What has been seen far enough ahead is settled and can be filled; how set-points are asked for, and
//! when, has no influence. Memory is that of the blocks in sight.

mod account;
mod block;
mod bounds;
mod corner;
mod envelope;
mod kink;
mod law;
mod look_ahead;
mod planner;
pub mod profile;
mod round;
mod side;
mod smooth;

pub use planner::Planner;

/// How long a task took, and what kept it from being faster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaskTime {
    /// Number of the task, from 0.
    pub task: u64,
    /// Line of the program.
    pub line: u64,
    /// Time at which the task began, s from the beginning; while two overlap, the middle of that time.
    pub begins: f64,
    /// Duration, s.
    pub seconds: f64,
    /// Duration at the programmed feed alone, s; of a rapid or a wait the same as `seconds`.
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
    /// The machine stops at an end, or slows down for a corner.
    Corner,
    /// The control prepares no more blocks a second.
    BlockTime,
    /// A wait.
    Wait,
}

/// So many set-points are made of one block at most: the work of some seconds.
pub const MOST_OF_BLOCK: f64 = 1e7;

/// Set-points are made of a program up to this time, s: a week, the work of some minutes.
pub const MOST_SECONDS: f64 = 7.0 * 86_400.0;

/// What has come of a call of [`Planner::fill`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FillOutcome {
    /// The batch is full, or its chain changes: call again.
    Full,
    /// Nothing more is settled before further tasks are pushed, or the end is told.
    Wants,
    /// All tasks are carried out.
    Ended,
    /// The task on this line, or the program up to it, lasts too long for set-points of it to be made.
    TooLong {
        /// Its line.
        line: u64,
        /// How long, s.
        seconds: f64,
        /// How long at most, s.
        most: f64,
    },
}
