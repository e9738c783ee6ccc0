//! Curves on their way through the stages: as the CL file has them, and as they are printed.
//!
//! A curve that may stay one goes from `expand` to `blocks` together with the moves that it would be otherwise
//! ([`CurveMoves`]). So the choice of axis values sees all of its way, and what cannot be kept is made of those moves, as
//! if it had not been tried. What `blocks` keeps is one block or several, each with what is printed of it
//! ([`CurveBlock`]).

use nalgebra::Vector3;
use post_machine::description::{Arcs, Machine, Tcp};
use post_machine::kinematics::Joints;
use post_motion::path::BSpline;
use post_plugin::Capabilities;

use crate::blocks::MotionBlock;
use crate::program::{MoveFeed, PathArc, StraightMove};
use crate::stream::{StreamItem, StreamPoint};

/// A curve of the CL file that may stay one: the tool axis stands along it, and it is cut at a feed.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveMove {
    /// Shape of the curve in the part frame; the tip goes along it.
    pub course: CurveShape,
    /// The move to its end, whose pace is that of the whole curve.
    pub end: StraightMove,
}

/// A curve that may stay one, and the moves that it would be otherwise, no more than 16,384 of them.
#[derive(Clone, Debug)]
pub struct CurveMoves<P: StreamPoint> {
    /// The curve.
    pub curve: CurveMove,
    /// The moves, and what came between them on the way: then the curve goes by them.
    pub moves: Vec<StreamItem<P>>,
}

/// The course of a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveShape {
    /// Along an arc or a helix of a turn at most.
    Arc(PathArc),
    /// Along a spline.
    Spline(BSpline),
}

/// A block along a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveBlock {
    /// The block.
    pub block: MotionBlock,
    /// What is printed of it.
    pub printed: PrintedCurve,
}

/// What is printed of a block that goes along a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedCurve {
    /// Words of the block.
    pub words: CurveWords,
    /// Axis values where some axis turns back on the way, in order.
    pub between: Vec<Joints>,
    /// Places of the control point between its ends, mm, part frame, by which its feed is planned; none where no feed is.
    pub way: Vec<Vector3<f64>>,
}

/// The words of a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveWords {
    /// An arc or a helix.
    Arc {
        /// Centre in the frame of the linear words, program units, on the level of the start.
        centre: [f64; 3],
        /// The axis of that frame about which it turns.
        normal: [f64; 3],
        /// Degrees from start to end, counter-clockwise seen against the normal; negative: clockwise.
        turn: f64,
        /// The radius, program units, to be written in the place of the centre.
        radius: Option<f64>,
    },
    /// A spline.
    Spline {
        /// Degree.
        degree: u32,
        /// Knots.
        knots: Vec<f64>,
        /// A weight for each control point.
        weights: Vec<f64>,
        /// All axis words of each control point, one after the other.
        points: Vec<f64>,
    },
}

/// More chords than this do not wait for their curve to be kept or not.
const MOST_CHORDS: u64 = 16_384;

/// Which curves dialect and machine keep.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurvePolicy {
    /// What the machine file says.
    pub arcs: Arcs,
    writes: Capabilities,
    /// The control keeps the tip.
    tcp: bool,
    /// A word goes with the way, of which the points of a spline say nothing.
    along: bool,
}

impl CurvePolicy {
    pub(crate) fn new(machine: &Machine, writes: Capabilities) -> Self {
        Self {
            arcs: machine.control.arcs,
            writes,
            tcp: machine.control.tcp == Tcp::Control,
            along: machine.along.is_some(),
        }
    }

    /// Arcs about that axis of the words (0 is X), which end off the plane of their start or not, in a tilted plane or
    /// not.
    pub(crate) fn about(&self, axis: usize, helix: bool, in_plane: bool) -> bool {
        let planes = [Capabilities::ARC_YZ, Capabilities::ARC_ZX, Capabilities::ARC_XY];
        let helix = match helix {
            true => Capabilities::HELIX,
            false => Capabilities::NONE,
        };
        let needs = match (in_plane, self.tcp) {
            (true, _) => Capabilities::CYCLE_IN_PLANE,
            (false, true) => Capabilities::ARC_TCP,
            (false, false) => Capabilities::NONE,
        };
        self.writes.has(planes[axis] | helix | needs)
    }

    /// A radius that is written as an arc.
    pub(crate) fn radius(&self, radius: f64) -> bool {
        let [least, largest] = self.arcs.radii;
        (least..=largest).contains(&radius)
    }

    /// An arc is written by its radius.
    pub(crate) fn by_radius(&self) -> bool {
        self.arcs.form == post_machine::description::ArcForm::Radius
            && self.writes.has(Capabilities::ARC_RADIUS)
    }

    /// A helix is given by its turn alone.
    pub(crate) fn by_turn(&self) -> bool {
        self.writes.has(Capabilities::HELIX_BY_TURN)
    }

    /// Whether a spline of the CL file may be kept that would be this many chords.
    pub(crate) fn spline(&self, end: &StraightMove, chords: u64) -> bool {
        let needs = match self.tcp {
            true => Capabilities::SPLINE | Capabilities::ARC_TCP,
            false => Capabilities::SPLINE,
        };
        self.arcs.keep
            && !self.along
            && self.writes.has(needs)
            && end.pace != MoveFeed::Rapid
            && (2..=MOST_CHORDS).contains(&chords)
    }

    /// Whether some arc may be written; `planes` if the control may have a tilted plane.
    fn writes(&self, planes: bool) -> bool {
        let possible =
            |axis| self.about(axis, false, false) || planes && self.about(axis, false, true);
        (0..3).any(possible)
    }

    /// Runs of points become arcs and lines.
    pub(crate) fn fits(&self) -> bool {
        self.arcs.fit && self.writes(true)
    }

    /// Whether an arc of the CL file may be kept that would be this many chords; `planes` if the control may have a tilted
    /// plane.
    pub(crate) fn arc(&self, arc: &PathArc, end: &StraightMove, chords: u64, planes: bool) -> bool {
        self.arcs.keep
            && self.writes(planes)
            && end.pace != MoveFeed::Rapid
            && self.radius(arc.radius())
            && (2..=MOST_CHORDS).contains(&chords)
    }
}
