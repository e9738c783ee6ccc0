//! A motion of the machine, as its control makes it.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::kinematics::{Joints, Pose, Trace};

use crate::State;
use crate::course::{between, on_arc};

/// More pieces than this are made of no motion.
const MOST_PIECES: f64 = 1e6;

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
    /// It is asked for in positions of the machine, not of the part (G53, G28, G30, M91, SUPA): where it leads says
    /// something about this machine alone.
    pub machine: bool,
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
    /// Tip and tool axis at `t` from 0 to 1 of the motion's own parameter (time, at constant feed), as the control and the
    /// chain make them.
    pub fn at(&self, t: f64) -> Pose {
        let (from, to) = (&self.from, &self.to);
        let straight = || from.pose.tip + (to.pose.tip - from.pose.tip) * t;
        let tip = match &self.way {
            Way::Axes => return self.state.solver.chain().forward(&self.joints(t)),
            Way::Tip => straight(),
            Way::TipAndAxis => {
                let axis = between(from.pose.axis, to.pose.axis, t);
                let edge = match from.pose.edge == Vector3::zeros() {
                    true => from.pose.edge,
                    false => between(from.pose.edge, to.pose.edge, t),
                };
                let tip = straight();
                return Pose { tip, axis, edge };
            }
            Way::Arc {
                centre,
                normal,
                sweep,
            } => on_arc([from.pose.tip, to.pose.tip], *centre, *normal, *sweep, t),
            Way::Spline(way) => way.at(t),
        };
        if !self.turns() {
            return Pose { tip, ..to.pose };
        }
        // Rotary axes alone say where the tool points.
        let pose = self.state.solver.chain().forward(&self.joints(t));
        Pose { tip, ..pose }
    }

    /// Some rotary axis turns on the way.
    pub fn turns(&self) -> bool {
        let axes = self.state.solver.chain().joints().iter().enumerate();
        axes.filter(|(_, axis)| axis.rotary)
            .any(|(place, _)| self.from.joints[place] != self.to.joints[place])
    }

    /// Axis values at `t`, all linearly: where the control keeps the tip ([`Way::Tip`] and below), those of the rotary axes
    /// alone hold.
    fn joints(&self, t: f64) -> Joints {
        let (from, to) = (&self.from.joints, &self.to.joints);
        std::array::from_fn(|place| from[place] + (to[place] - from[place]) * t)
    }

    /// Pieces that the motion is cut into, evenly in `t`, so that straight lines of the tip and great circles of the tool
    /// axis between their ends stay within `chord` mm and `angle` radians of it; of arcs and splines, whose tip is on no
    /// straight line, the tool axis alone counts.
    ///
    /// A chord over 1/n strays by no more than an eighth of the second derivative over n². Of the tip that derivative is
    /// bounded joint by joint from the tool to the part: a turn by w over an arm r of speed s and bend b makes the bend
    /// w²·r + 2·w·s + b and the speed w·r + s; an arm is never longer than at its ends but for an eighth of its bend. Of the
    /// tool axis it is at most the square of all turns together, and the great circle strays as much from the chord again.
    pub fn pieces(&self, chord: f64, angle: f64) -> u64 {
        let chain = self.state.solver.chain();
        let axes = chain.joints();
        let turn = |place: usize| libm::fabs(self.to.joints[place] - self.from.joints[place]);
        if self.way == Way::TipAndAxis || !self.turns() {
            return 1;
        }
        let ends = [&self.from.joints, &self.to.joints].map(|joints| {
            let mut trace = Trace {
                joints: *joints,
                turns: chain.turns(joints),
                ..Trace::default()
            };
            chain.trace(&mut trace);
            trace
        });
        let rotary = || (0..axes.len()).filter(|place| axes[*place].rotary);
        // An axis that turns about the tool leaves it pointing where it did; an edge turns all the same.
        let points = |place: usize| {
            let across = axes[place].direction.cross(&ends[0].axes[place]);
            turn(place) > 0.0 && (across.norm() > 1e-12 || chain.edge().is_some())
        };
        let all: f64 = rotary().map(turn).sum();
        let mut count: f64 = match rotary().any(points) {
            true => libm::sqrt(all * all / (4.0 * angle)),
            false => 1.0,
        };
        if self.way == Way::Axes {
            let (mut speed, mut bend) = (0.0, 0.0);
            for place in (0..axes.len()).rev() {
                if !axes[place].rotary {
                    speed += turn(place);
                    continue;
                }
                let w = turn(place);
                let arm = |trace: &Trace| trace.tip_rates[place].norm();
                let arm = arm(&ends[0]).max(arm(&ends[1])) + bend / 8.0;
                bend += w * (w * arm + 2.0 * speed);
                speed += w * arm;
            }
            count = count.max(libm::sqrt(bend / (8.0 * chord)));
        }
        // Bounded, whatever a program says: a million pieces of one block.
        libm::ceil(count).clamp(1.0, MOST_PIECES) as u64
    }

    /// Pieces whose chords stay within `chord` mm of a spline, as far as points on it tell: doubled until the middles of
    /// all agree.
    pub(crate) fn spline_chords(&self, chord: f64) -> u64 {
        let Way::Spline(way) = &self.way else {
            return 1;
        };
        let mut count = 2 * way.poles.len() as u64;
        while (count as f64) < MOST_PIECES {
            let at = |place: u64| way.at(place as f64 / (4 * count) as f64);
            let strays = (0..count).any(|piece| {
                let [first, a, b, c, last] =
                    std::array::from_fn(|part| at(4 * piece + part as u64));
                [(a, 0.25), (b, 0.5), (c, 0.75)]
                    .iter()
                    .any(|(point, share)| (first + (last - first) * *share - point).norm() > chord)
            });
            if !strays {
                break;
            }
            count *= 2;
        }
        count
    }
}
