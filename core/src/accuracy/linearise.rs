//! Puts points into a move until every piece is within tolerance.
//!
//! The placement is `bisect` (the parabolic paper, Sha et al. 2022): every piece that is over gets a point in
//! its middle, on the exact inverse solution. Where the tool axis hardly moves while a rotary axis turns far
//! (close to a singularity) exact solutions do not help, since the angle jumps however short the piece is:
//! there the middle is taken in the axes' own space, rotary values halfway and the tip put on its chord, as
//! long as the tool axis stays within tolerance.

use nalgebra::Vector3;
use post_plugin::{Deviation, ModelSession, Tolerance};

use super::certificate::{self, Bend, chord_angle};
use super::node::{Node, Placer, Refused};
use crate::kinematics::orientation::angle;
use crate::kinematics::{Joints, Pose};

/// What the pieces of a move must stay within.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Tip, mm; infinite where the control keeps the tip.
    pub tip: f64,
    /// Tool axis, radians; infinite in a rapid.
    pub axis: f64,
}

/// A piece of a move that is within tolerance.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// Where it ends; it begins where the one before it ends.
    pub to: Node,
    /// Bounds on its deviation.
    pub bound: Bound,
}

/// Proven bounds on the deviation along a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bound {
    /// Tip, mm.
    pub tip: f64,
    /// Tool axis, radians.
    pub axis: f64,
}

/// Why a move cannot be brought within tolerance.
#[derive(Clone, Debug, PartialEq)]
pub enum Stuck {
    /// A point put in has no node.
    Refused(Refused),
    /// The words' decimals alone are too coarse.
    Rounding {
        /// Error of the tip that rounding makes, mm.
        tip: f64,
        /// Error of the tool axis, radians.
        axis: f64,
    },
    /// The axes jump: pieces of a millionth of the move are still over.
    Jump {
        /// The joint that turns farthest.
        joint: usize,
        /// From this value, radians.
        from: f64,
        /// To this value.
        to: f64,
    },
    /// The model cannot answer.
    Model(String),
}

/// The shortest piece, as a share of its move.
const SHORTEST: f64 = 1.0 / (1u64 << 22) as f64;

/// Points put in may use so much of the tool axis' tolerance.
const ROOM: f64 = 0.9;

/// Between samples the certificate may be blind by this share of the tolerance.
const BLIND: f64 = 0.02;

/// A piece that needs more samples than this to be certified is split instead.
const MOST_SAMPLES: f64 = 64.0;

/// Puts points in.
#[derive(Debug, Default)]
pub struct Linearise {
    /// Nodes yet to be reached, the next on top.
    stack: Vec<Node>,
    pieces: Vec<Piece>,
    overruled: u64,
    trust_model: bool,
}

/// A move between two nodes, and what it must keep.
#[derive(Clone, Copy, Debug)]
pub struct Move<'a> {
    /// Solves points put in.
    pub placer: &'a Placer,
    /// Where it begins.
    pub from: &'a Node,
    /// Where it ends.
    pub to: &'a Node,
    /// What its pieces must stay within.
    pub tolerances: Tolerances,
    /// The tip follows the words in a straight line by itself.
    pub control_keeps_tip: bool,
}

impl Move<'_> {
    /// The bound of the whole move, if the cheap certificate clears it: then no point is needed, whatever a
    /// model may think, and none is asked.
    #[inline]
    pub fn whole(&self) -> Option<Bound> {
        // An upper bound on the sweep is enough here, and cheaper than the angle.
        let (from, to) = (&self.from.target, &self.to.target);
        let chain = self.placer.solver().chain();
        let mut sweep = (from.axis - to.axis).norm();
        if chain.edge().is_some() {
            sweep = sweep.max((from.edge - to.edge).norm());
        }
        let sweep = chord_angle(sweep);
        let bend = certificate::quick(chain, &self.from.trace, &self.to.trace, sweep);
        let bound = self.bound(bend);
        self.tolerances.hold(bound).then_some(bound)
    }

    /// The tightest bound that needs no samples.
    pub fn measured(&self) -> Bound {
        self.bound(self.bend())
    }

    fn bend(&self) -> Bend {
        let (from, to) = (self.from, self.to);
        let chain = self.placer.solver().chain();
        let mut sweep = angle(from.target.axis, to.target.axis);
        let edged = chain.edge().is_some();
        if edged {
            sweep = sweep.max(angle(from.target.edge, to.target.edge));
        }
        let quick = certificate::quick(chain, &from.trace, &to.trace, sweep);
        let tight = certificate::tight(
            chain,
            &from.trace,
            &to.trace,
            from.target.axis,
            to.target.axis,
            sweep,
        );
        Bend {
            tip: quick.tip.min(tight.tip),
            // The bound from norms holds for every direction of the tool, the other for its axis alone.
            axis: if edged {
                quick.axis
            } else {
                quick.axis.min(tight.axis)
            },
        }
    }

    /// The bound that a bend proves.
    #[inline]
    fn bound(&self, bend: Bend) -> Bound {
        let (from, to) = (self.from, self.to);
        let tip_bend = if self.control_keeps_tip {
            0.0
        } else {
            bend.tip
        };
        let axis_ends = from.axis_error.max(to.axis_error);
        Bound {
            tip: certificate::deviation(from.tip_error.max(to.tip_error), tip_bend),
            axis: chord_angle(certificate::deviation(axis_ends, bend.axis)),
        }
    }
}

impl Tolerances {
    #[inline]
    fn hold(&self, bound: Bound) -> bool {
        bound.tip <= self.tip && bound.axis <= self.axis
    }
}

impl Linearise {
    /// Nothing put in yet. With `trust_model` the certificate only reports.
    pub fn new(trust_model: bool) -> Self {
        Self {
            trust_model,
            ..Self::default()
        }
    }

    /// Points put in although the model was content, because the certificate was not.
    pub fn overruled(&self) -> u64 {
        self.overruled
    }

    /// The pieces of the last move that was split.
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Can the axes follow this move with the tool axis within tolerance, whatever points that takes? Nothing is
    /// sampled, no model asked.
    pub fn comes_through(&mut self, whole: &Move<'_>) -> bool {
        let whole = Move {
            tolerances: Tolerances {
                tip: f64::INFINITY,
                ..whole.tolerances
            },
            ..*whole
        };
        let judge = |_: &mut Self, piece: &Move<'_>| {
            let bound = piece.measured();
            Ok((piece.tolerances.hold(bound), bound))
        };
        self.bisect(&whole, judge).is_ok()
    }

    /// Cuts a move into pieces within tolerance, in order: see [`Linearise::pieces`].
    ///
    /// # Errors
    /// Why it cannot be done.
    pub fn split(&mut self, whole: &Move<'_>, model: &mut dyn ModelSession) -> Result<(), Stuck> {
        self.bisect(whole, |this, piece| {
            this.judge(piece, model).map_err(Stuck::Model)
        })
    }

    /// Puts points into the middle of every piece that `judge` does not find good.
    fn bisect(
        &mut self,
        whole: &Move<'_>,
        mut judge: impl FnMut(&mut Self, &Move<'_>) -> Result<(bool, Bound), Stuck>,
    ) -> Result<(), Stuck> {
        let mut from = *whole.from;
        from.t = 0.0;
        self.pieces.clear();
        self.stack.clear();
        self.stack.push(*whole.to);
        while let Some(to) = self.stack.pop() {
            let piece = Move {
                from: &from,
                to: &to,
                ..*whole
            };
            let (good, bound) = judge(self, &piece)?;
            if good {
                self.pieces.push(Piece { to, bound });
                from = to;
                continue;
            }
            if let Some(stuck) = stuck(&piece) {
                return Err(stuck);
            }
            let middle = middle(&piece, bound).map_err(Stuck::Refused)?;
            self.stack.push(to);
            self.stack.push(middle);
        }
        Ok(())
    }

    /// Is a piece within tolerance? The model proposes, the certificate disposes.
    fn judge(
        &mut self,
        piece: &Move<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(bool, Bound), String> {
        let tolerances = piece.tolerances;
        let bend = piece.bend();
        let bound = piece.bound(bend);
        if tolerances.hold(bound) {
            return Ok((true, bound));
        }
        let tolerance = Tolerance {
            tip: tolerances.tip,
            axis: tolerances.axis.to_degrees(),
        };
        let curve = model.fit(&tolerance, &mut |ts, out| {
            for (t, out) in ts.iter().zip(out) {
                *out = deviation(piece, *t);
            }
        })?;
        let content = tolerances.hold(Bound {
            tip: curve.tip_peak,
            axis: curve.axis_peak.to_radians(),
        });
        let certified = certify(piece, bend);
        let sure = tolerances.hold(certified);
        if content && !sure && !self.trust_model {
            self.overruled += 1;
        }
        // A model that sees more than the certificate proves is wrong on the safe side: points go in.
        Ok((content && (sure || self.trust_model), certified))
    }
}

/// A piece that no further point can mend.
fn stuck(piece: &Move<'_>) -> Option<Stuck> {
    let (from, to) = (piece.from, piece.to);
    let tip = from.tip_error.max(to.tip_error);
    let axis = from.axis_error.max(to.axis_error);
    if tip >= piece.tolerances.tip || axis >= piece.tolerances.axis {
        return Some(Stuck::Rounding { tip, axis });
    }
    if to.t - from.t > SHORTEST {
        return None;
    }
    let joints = piece.placer.solver().chain().joints();
    let turn = |joint: &usize| libm::fabs(to.trace.joints[*joint] - from.trace.joints[*joint]);
    let joint = (0..joints.len())
        .filter(|joint| joints[*joint].rotary)
        .max_by(|a, b| turn(a).total_cmp(&turn(b)))?;
    Some(Stuck::Jump {
        joint,
        from: from.trace.joints[joint],
        to: to.trace.joints[joint],
    })
}

/// The node in the middle of a piece whose deviation is bounded by `bound`.
fn middle(piece: &Move<'_>, bound: Bound) -> Result<Node, Refused> {
    let (from, to, placer) = (piece.from, piece.to, piece.placer);
    let t = (from.t + to.t) / 2.0;
    let (first, last) = (&from.trace.joints, &to.trace.joints);
    let tip = (from.target.tip + to.target.tip) / 2.0;
    let axis = (from.target.axis + to.target.axis)
        .try_normalize(1e-9)
        .unwrap_or(from.target.axis);
    let edge = from.target.edge + to.target.edge;
    let edge = (edge - axis * axis.dot(&edge))
        .try_normalize(1e-9)
        .unwrap_or(from.target.edge);
    let target = Pose { tip, axis, edge };
    let exact = placer.place_between(target, t, first, last);
    let mut halfway: Joints = Default::default();
    for (joint, value) in halfway.iter_mut().enumerate() {
        *value = (first[joint] + last[joint]) / 2.0;
    }
    let straight = exact.as_ref().is_ok_and(|node| {
        let joints = placer.solver().chain().joints();
        (0..joints.len())
            .filter(|joint| joints[*joint].rotary)
            .all(|joint| {
                let turn = libm::fabs(last[joint] - first[joint]);
                let off = libm::fabs(node.trace.joints[joint] - halfway[joint]);
                off <= turn / 4.0 + placer.axis_rounding()
            })
    });
    if straight || !placer.solver().closed_form() {
        return exact;
    }
    // A point that is off by all of the tolerance leaves nothing to the pieces beside it.
    let room = ROOM * piece.tolerances.axis;
    if bound.axis <= piece.tolerances.axis
        && let Ok(node) = placer.settled(target, t, &halfway)
        && node.axis_error <= room
    {
        return Ok(node);
    }
    // A pole joint is turned evenly, the others keep the tool axis as well as they can.
    match placer.place_halfway(target, t, first, last) {
        Some(node) if node.axis_error <= room => Ok(node),
        _ => exact,
    }
}

/// Pose of the interpolated axes minus the CL path at the same `t` of the piece.
fn deviation(piece: &Move<'_>, t: f64) -> Deviation {
    let (from, to) = (piece.from, piece.to);
    let mut joints: Joints = Default::default();
    for (joint, value) in joints.iter_mut().enumerate() {
        *value = from.trace.joints[joint] * (1.0 - t) + to.trace.joints[joint] * t;
    }
    let pose = piece.placer.solver().chain().forward(&joints);
    let reached = if piece.control_keeps_tip {
        from.tip * (1.0 - t) + to.tip * t
    } else {
        pose.tip
    };
    let tip = reached - (from.target.tip * (1.0 - t) + to.target.tip * t);
    let mut turn = turned(great_circle(from.target.axis, to.target.axis, t), pose.axis);
    if piece.placer.solver().chain().edge().is_some() {
        let edge = great_circle(from.target.edge, to.target.edge, t);
        let edge = turned(edge, pose.edge);
        // Whichever of axis and edge is farther off.
        if edge.norm() > turn.norm() {
            turn = edge;
        }
    }
    Deviation {
        tip: tip.into(),
        axis: turn.into(),
    }
}

/// The turn from `wanted` to `reached`, degrees, along its axis.
fn turned(wanted: Vector3<f64>, reached: Vector3<f64>) -> Vector3<f64> {
    let cross = wanted.cross(&reached);
    let sine = cross.norm();
    if sine > 0.0 {
        cross * (libm::atan2(sine, wanted.dot(&reached)).to_degrees() / sine)
    } else {
        Vector3::zeros()
    }
}

/// Samples a piece so densely that its bend can hide no more than a small share of the tolerance between them.
fn certify(piece: &Move<'_>, bend: Bend) -> Bound {
    let tolerances = piece.tolerances;
    let tip_bend = if piece.control_keeps_tip {
        0.0
    } else {
        bend.tip
    };
    let axis_bend = if tolerances.axis.is_infinite() {
        0.0
    } else {
        bend.axis
    };
    let needed = (tip_bend / (8.0 * BLIND * tolerances.tip))
        .max(axis_bend / (8.0 * BLIND * tolerances.axis));
    let count = libm::ceil(libm::sqrt(needed)).clamp(1.0, MOST_SAMPLES);
    let mut tip = piece.from.tip_error.max(piece.to.tip_error);
    let mut axis = piece.from.axis_error.max(piece.to.axis_error);
    for step in 1..count as u32 {
        let deviation = deviation(piece, f64::from(step) / count);
        tip = tip.max(Vector3::from(deviation.tip).norm());
        axis = axis.max(Vector3::from(deviation.axis).norm().to_radians());
    }
    let blind = 1.0 / (8.0 * count * count);
    Bound {
        tip: tip + tip_bend * blind,
        axis: chord_angle(axis + axis_bend * blind),
    }
}

/// The unit vector at `t` on the great circle between two.
fn great_circle(from: Vector3<f64>, to: Vector3<f64>, t: f64) -> Vector3<f64> {
    let sweep = angle(from, to);
    let sine = libm::sin(sweep);
    if sine < 1e-9 {
        return (from * (1.0 - t) + to * t)
            .try_normalize(1e-9)
            .unwrap_or(from);
    }
    (from * libm::sin((1.0 - t) * sweep) + to * libm::sin(t * sweep)) / sine
}
