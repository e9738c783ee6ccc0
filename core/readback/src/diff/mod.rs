//! Two programs: what they make the machine do differently.
//!
//! | file | does |
//! |---|---|
//! | `steps` | what a program does, cut into steps so short that each may be taken for straight |
//! | `outline` | the operations of a program, and which of one belongs to which of the other |
//! | `walk` | goes along both paths of an operation at once, never back |
//! | `meet` | where paths that part come together again |
//! | `tally` | what was found on the way, by operation |
//! | `events` | waits, stops and tool changes without a counterpart |
//!
//! Both are read twice: once for their operations, once along their paths. The paths are compared in the part frame, so
//! that remarks, numbers of blocks, modal words that are repeated, where blocks end, whether the control or the words keep
//! the tip, and, between two machines, the axes make no difference. Memory grows with the number of operations alone.

mod events;
mod meet;
mod outline;
mod steps;
mod tally;
mod walk;

use post_machine::diagnostic::Diagnostic;

use crate::{BlockRunner, ProgramRun};
pub use events::EventDifference;
use outline::Outline;
use steps::PathSteps;
pub use tally::{
    Difference, LoneWay, OperationDifference, PathPair, ProgramSums, StateDifference,
    WorstDifference, WorstFeedDifference,
};

/// What makes a difference.
#[derive(Clone, Debug, PartialEq)]
pub struct DiffRules {
    /// Positions of the tip that differ by no more are the same, mm.
    pub tip: f64,
    /// Tool axes, and rotary axes of one machine, radians.
    pub axis: f64,
    /// Feeds that differ by no more than this share are the same.
    pub feed: f64,
    /// Paths farther apart than this go different ways, mm: it is looked for where they meet again.
    pub apart: f64,
    /// Both programs are for one machine: rotary axes and positions of the machine count.
    pub one_machine: bool,
    /// And for one control: registers and work offsets count too.
    pub one_control: bool,
    /// Coolants are compared.
    pub coolants: bool,
    /// Numbers and names of tools, and their registers, are compared.
    pub tools: bool,
    /// Differences of cuts alone are told: of others, and of waits, stops, tool changes and time, how many.
    pub cuts: bool,
    /// Names of the axes in chain order, for one machine.
    pub axes: Vec<String>,
    /// Which axes are rotary, in chain order.
    pub rotary: Vec<bool>,
}

impl DiffRules {
    /// Whether it counts that this, which holds while the tool moves, is another.
    fn compares(&self, what: &str) -> bool {
        match what {
            "coolant" => self.coolants,
            "tool" | "radius register" | "length register" => self.tools,
            _ => true,
        }
    }
}

/// Differences below this, mm and degrees, come of the last digit that is printed.
pub const SAME: f64 = 0.001;

/// Feeds are printed with few digits, above all those by time.
pub const SAME_FEED: f64 = 0.001;

/// How far paths lie apart that go different ways, mm.
pub const APART: f64 = 0.2;

/// Which of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WhichProgram {
    Old,
    New,
}

/// What was found wrong with each program while it was read.
#[derive(Clone, Debug, Default)]
pub struct UnreadBlocks {
    /// Blocks of the old one.
    pub old: Vec<Diagnostic>,
    /// Blocks of the new one.
    pub new: Vec<Diagnostic>,
}

/// Compares what two programs do. `open` opens one of them at its beginning, each of them twice; `listen` hears of places
/// along the paths.
///
/// # Errors
/// A program that cannot be opened.
pub fn compare<P: BlockRunner, E>(
    rules: &DiffRules,
    mut open: impl FnMut(bool) -> Result<P, E>,
    listen: &mut dyn FnMut(&PathPair),
) -> Result<(Difference, UnreadBlocks), E> {
    let mut unread = UnreadBlocks::default();
    let old = Outline::of(ProgramRun::new(open(false)?), &mut unread.old);
    let new = Outline::of(ProgramRun::new(open(true)?), &mut unread.new);
    let pairs = outline::align(old, new);
    let old = PathSteps::new(ProgramRun::new(open(false)?), pairs.by_name);
    let new = PathSteps::new(ProgramRun::new(open(true)?), pairs.by_name);
    let difference = walk::all(rules, pairs, old, new, listen);
    Ok((difference, unread))
}
