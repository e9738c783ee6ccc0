//! A block of the program: a motion as it will be printed, with all that later stages may need.

use std::rc::Rc;

use nalgebra::Vector3;
use post_machine::axis_words::WordValues;
use post_machine::kinematics::Joints;
use post_machine::tilted_plane::TiltedPlane;
use post_plugin::Feed;

use super::across::WayAcross;
use super::compensating_motion::FollowTime;
use super::nominal::{NominalTime, STILL};
use crate::accuracy::{DeviationBound, Placer};
use crate::curve::CurveBlock;
use crate::program::MoveFeed;
use crate::stream::{StreamItem, StreamPoint};

/// A motion of the program, from where the block before it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionBlock {
    /// Line of the CL file.
    pub line: u64,
    /// How the tool comes to its end.
    pub kind: BlockKind,
    /// Why it is there.
    pub reason: BlockReason,
    /// The tolerance of a rapid was enough for it: it goes off the part.
    pub loose: bool,
    /// No word of it differs from those of the block before: nothing is printed.
    pub still: bool,
    /// The feed that the CL file asks for.
    pub pace: MoveFeed,
    /// The printed words.
    pub words: WordValues,
    /// Axis values at its end, as printed: mm, radians.
    pub joints: Joints,
    /// Where the tip stands at its end, mm, part frame.
    pub tip: Vector3<f64>,
    /// The tool axis there, unit vector, part frame.
    pub axis: Vector3<f64>,
    /// Certified: the block stays this close to the CL path, chords of arcs and splines counted in.
    pub deviation: DeviationBound,
    /// Way of the tip, mm.
    pub way: f64,
    /// The time that the CL file asks for.
    pub nominal: NominalTime,
    /// How fast the linear axes can follow where the control keeps the tip.
    pub follow: FollowTime,
    /// What a planned feed leaves it; filled in by the planning stage.
    pub planned: PlannedTime,
    /// How long it takes; filled in by the timing stage.
    pub time: BlockDuration,
    /// The line of the program that it ends on, counted from 1: zero of one that is not written, and before it is. Of a hole
    /// that the control's own cycle makes all end on that of its point. Filled in for observers.
    pub nc_line: u64,
}

impl StreamPoint for MotionBlock {
    type Curve = CurveBlock;
    type Note = BlockNote;

    fn line(&self) -> u64 {
        self.line
    }

    fn moves(_: &Self::Curve) -> usize {
        1
    }
}

impl StreamItem<MotionBlock> {
    /// The block, along a curve or not; none of what is no block.
    pub(crate) fn block(&self) -> Option<&MotionBlock> {
        match self {
            Self::Point(block) => Some(block),
            Self::Curve { curve, .. } => Some(&curve.block),
            _ => None,
        }
    }
}

/// What the stage that makes blocks says of those from there on.
#[derive(Clone, Debug)]
pub enum BlockNote {
    /// What solves their points, for the stage that plans feeds and the limits that depend on other axes.
    Placer(Rc<Placer>),
    /// Their words are those of this tilted plane, the tool having left the part; none: of no plane.
    Plane(Option<Box<TiltedPlane>>),
    /// The way across behind the next retract is this one.
    Across(Box<WayAcross>),
}

/// What a planned feed leaves a block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlannedTime {
    /// The least time, minutes; zero where nothing is planned.
    pub minutes: f64,
    /// The limit that asks for it, if it is not the feed that the CL file asks for.
    pub limit: Option<&'static str>,
}

impl MotionBlock {
    /// The time that the CL file leaves it at least, minutes.
    #[inline]
    pub fn asked(&self) -> f64 {
        match self.pace {
            MoveFeed::PerMinute(feed) if self.nominal.moves && self.way > STILL => self.way / feed,
            _ => self.nominal.minutes,
        }
    }
}

impl MotionBlock {
    /// What a share of the block is due, and how fast it can be followed. Nowhere in it the axes are faster than where
    /// the whole is fastest.
    pub(crate) fn part(&self, share: f64) -> Self {
        Self {
            nominal: self.nominal.share(share),
            follow: FollowTime { minutes: self.follow.minutes * share, ..self.follow },
            ..*self
        }
    }
}

/// How the tool comes to the end of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockKind {
    /// A position, from wherever the tool stands, clear of the part: the first one after the start or a tool change.
    Position,
    /// As [`BlockKind::Position`], the tool retracted ahead of it: an index axis turns on the way.
    Reference,
    /// A move at rapid traverse.
    Rapid,
    /// All axes linear in time.
    Linear,
    /// Along an arc or a helix that the command ahead of it describes, the rotary axes standing.
    Arc,
    /// Along a spline that the command ahead of it describes, the rotary axes standing.
    Spline,
}

impl BlockKind {
    /// The tool comes to the end at feed, from where it stands.
    #[inline]
    pub fn cuts(self) -> bool {
        matches!(self, Self::Linear | Self::Arc | Self::Spline)
    }
}

/// Why a block is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockReason {
    /// Ends on a CL point.
    Point,
    /// Ends on a CL point close to a pole, a rotary axis held or turned early within the tolerance of the tool axis.
    Eased,
    /// Error control put its end in.
    PutIn,
    /// The tool leaves the part as it stands, before its axes turn or it is retracted.
    Leave,
    /// A stop on the way of axes that cannot go in one block.
    Stage,
    /// The tool is drawn back, turned and brought back.
    Rewind,
    /// The planned feed changes there.
    Feed,
    /// A first position is reached from there, along the tool's own line, or that place along the depth axis.
    Above,
    /// Ends on a CL point, a first position with nothing above it: all words stand in one block.
    AtOnce,
}

/// How long a block takes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BlockDuration {
    /// Minutes, as the control understands what is printed.
    pub minutes: f64,
    /// The feed as written; none in a rapid, unless it is written as a feed move.
    pub feed: Option<Feed>,
    /// The limit that made it slower than asked for.
    pub limit: Option<&'static str>,
}
