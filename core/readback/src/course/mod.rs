//! The path of the tool against the part, piece by piece, whoever asked for it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::Pose;

use crate::Told;
use crate::motion::SplineWay;

/// A path that is handed out in order.
pub trait Course {
    /// The next item; none at its end.
    ///
    /// # Errors
    /// What its source says that cannot be understood, with its place.
    fn next(&mut self) -> Result<Option<Item>, Box<Diagnostic>>;
}

/// What a course says.
#[derive(Clone, Debug)]
pub enum Item {
    /// The tool goes.
    Piece(Piece),
    /// Something else.
    Told {
        /// Line of the source.
        line: u64,
        /// What.
        told: Told,
    },
}

/// A piece of the path.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Line of the source that asks for it.
    pub line: u64,
    /// At rapid, at feed, or along a thread.
    pub kind: crate::MotionKind,
    /// How the tip goes.
    pub curve: Curve,
    /// Where it begins: mm, part frame.
    pub from: Pose,
    /// Where it ends.
    pub to: Pose,
    /// Feed of the tip, mm/min; none where the source states none, or states it otherwise.
    pub feed: Option<f64>,
    /// It is part of a cycle's hole: approach, feed, dwell and return of it.
    pub hole: bool,
}

/// How the tip goes; the tool axis goes on the great circle from one end to the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// Straight.
    Straight,
    /// On an arc or helix.
    Arc {
        /// A point of its axis, mm.
        centre: Vector3<f64>,
        /// Its axis, unit vector.
        normal: Vector3<f64>,
        /// Turn about it, right-handed, radians.
        sweep: f64,
    },
    /// On a spline.
    Spline(Arc<SplineWay>),
}
