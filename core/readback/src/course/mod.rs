//! The path of the tool against the part, piece by piece, whoever asked for it.
//!
//! | source | what it is |
//! |---|---|
//! | [`cl::ClCourse`] | a CL file, every modal word settled here and not by the stages that post it |
//! | [`program::ProgramCourse`] | what a program did |
//!
//! Points, axes and edges are in mm in the part frame of the machine file, the part as it sits (`machine.turn` is
//! applied). A piece begins where the one before it ends; where that is not known (behind a tool change, at the beginning,
//! behind a way in machine coordinates) the tool [reaches](CourseItem::Reach) a pose, and how it comes there is nobody's
//! business.

pub mod cl;
mod cut_run;
pub(crate) mod descent;
mod facts;
mod legs;
mod piece;
pub mod program;
mod window;

use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;

use crate::{MotionKind, ProgramEvent};

pub use crate::Curve;
pub use cut_run::CutRun;
pub use facts::{CourseFacts, CourseOperation};
pub use legs::Legs;
pub use window::CourseWindow;

/// A path that is handed out in order.
pub trait Course {
    /// The next item; none at its end. It can be called again after an error, and goes on behind what was wrong.
    ///
    /// # Errors
    /// What its source says that cannot be understood, with its place.
    fn next(&mut self) -> Result<Option<CourseItem>, Box<Diagnostic>>;

    /// Puts the cuts that come next into `cuts`, as far as they are told together: [`Course::next`] goes on behind them then.
    /// False if it tells what comes next.
    fn next_cuts(&mut self, cuts: &mut CutRun) -> bool {
        let _ = cuts;
        false
    }
}

/// What a course says.
#[derive(Clone, Debug, PartialEq)]
#[allow(
    clippy::large_enum_variant,
    reason = "nearly all are pieces, and they are handed on one by one"
)]
pub enum CourseItem {
    /// The tool goes from where it stands.
    Piece(CoursePiece),
    /// The tool comes to a pose from wherever it was.
    Reach(ReachedPose),
    /// The tool leaves the part, and the axes go where the machine parks them: `GOHOME`, ways in machine coordinates.
    Away {
        /// Line of the source.
        line: u64,
    },
    /// Something else.
    Event {
        /// Line of the source.
        line: u64,
        /// What.
        event: ProgramEvent,
    },
}

/// A pose that is reached, by whatever way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReachedPose {
    /// Line of the source that asks for it.
    pub line: u64,
    /// As the source has it: a first point may come at feed, and does harm by that to nobody.
    pub kind: MotionKind,
    /// mm, part frame.
    pub to: Pose,
    /// Feed of the tip, mm/min, if the source states one.
    pub feed: Option<f64>,
    /// It is the level above a cycle's hole.
    pub hole: bool,
}

/// A piece of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct CoursePiece {
    /// Line of the source that asks for it.
    pub line: u64,
    /// At rapid, at feed, or along a thread.
    pub kind: MotionKind,
    /// How the tip goes; the tool axis goes on the great circle from one end to the other, evenly. Where the machine file
    /// names a control point above the tip, that point goes straight: [`CoursePiece::at`].
    pub curve: Curve,
    /// Where it begins: mm, part frame.
    pub from: Pose,
    /// Where it ends.
    pub to: Pose,
    /// Feed of the tip, mm/min; none for a rapid, and where the source states none.
    pub feed: Option<f64>,
    /// Feed of the tip in a revolution of the part, mm, where the source states one at a constant cutting speed: then
    /// there is no other.
    pub turned_feed: Option<f64>,
    /// It is part of a cycle's hole: approach, feed, dwell and return of it. Pecks are the control's business: a hole is
    /// one piece down at feed and one up.
    pub hole: bool,
}
