//! A motion of the machine, as its control makes it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose};

use crate::State;

/// A motion between two stances.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Line of the program.
    pub line: u64,
    /// Number of the block.
    pub number: Option<u64>,
    /// Rapid or at feed.
    pub kind: MotionKind,
    /// How the control goes from one end to the other.
    pub way: Way,
    /// Where it begins.
    pub from: Stance,
    /// Where it ends.
    pub to: Stance,
    /// Feed of the tip against the part, mm/min, as the program states it; of a thread the pitch times the speed; zero
    /// for a rapid and where the program states none.
    pub feed: f64,
    /// How long it takes at the feed that the program states, minutes, no limit of any axis regarded; of a rapid at the
    /// axes' largest feeds, zero where the machine file names none.
    pub minutes: f64,
    /// It is part of a cycle's hole.
    pub hole: bool,
    /// What holds while it goes on.
    pub state: Arc<State>,
}

/// Rapid or at feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionKind {
    /// At rapid traverse.
    Rapid,
    /// At feed.
    Feed,
    /// At feed, the axis tied to the spindle.
    Thread,
}

/// Where the machine stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stance {
    /// Axis values, mm and radians, counted from the drawing's zero, in chain order.
    pub joints: Joints,
    /// Tip and tool axis, part frame, of the tool whose length is compensated.
    pub pose: Pose,
}

/// How the control goes from one end to the other.
#[derive(Clone, Debug, PartialEq)]
pub enum Way {
    /// All axes linearly in the same parameter.
    Axes,
    /// The tip straight, the rotary axes linearly.
    Tip,
    /// The tip straight, the tool axis on the great circle (vectors: G43.5, ORIVECT, LN).
    TipAndAxis,
    /// The tip on an arc or helix of the part frame, rotary axes linearly if they turn at all.
    Arc {
        /// A point of its axis, mm.
        centre: Vector3<f64>,
        /// Its axis, unit vector.
        normal: Vector3<f64>,
        /// Turn about it, right-handed, radians; more than a turn where the program says so.
        sweep: f64,
    },
    /// The tip on a spline of the part frame: poles and knots, as the program states them.
    Spline(Arc<SplineWay>),
}

/// A rational B-spline.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineWay {
    /// Degree.
    pub degree: usize,
    /// Knots, as many as poles + degree + 1.
    pub knots: Vec<f64>,
    /// Poles, mm, part frame, and their weights.
    pub poles: Vec<(Vector3<f64>, f64)>,
}

impl Motion {
    /// Tip and tool axis at `t` from 0 to 1 of the motion's own parameter (time, at constant feed).
    pub fn at(&self, t: f64) -> Pose {
        todo!("{t}")
    }
}
