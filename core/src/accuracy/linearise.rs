//! Puts points into a move until every piece is within tolerance.
//!
//! The placement is `bisect` (the parabolic paper, Sha et al. 2022): every piece that is over gets a point in
//! its middle, on the exact inverse solution. Where the tool axis hardly moves while a rotary axis turns far
//! (close to a singularity) exact solutions do not help, since the angle jumps however short the piece is:
//! there the middle is taken in the axes' own space, rotary values halfway and the tip put on its chord, as
//! long as the tool axis stays within tolerance.

use nalgebra::Vector3;
use post_plugin::{Deviation, ModelSession, Tolerance};

use super::certificate::{self, Bend};
use super::node::{Node, Placer, Refused};
use crate::kinematics::inverse::angle;
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
pub struct Piece<'a> {
    /// Where it begins.
    pub from: &'a Node,
    /// Where it ends.
    pub to: &'a Node,
    /// Bound on the deviation of the tip, mm.
    pub tip: f64,
    /// Bound on the deviation of the tool axis, radians.
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

/// Between samples the certificate may be blind by this share of the tolerance.
const BLIND: f64 = 0.02;

/// A piece that needs more samples than this to be certified is split instead.
const MOST_SAMPLES: f64 = 64.0;

/// Puts points in.
#[derive(Debug, Default)]
pub struct Linearise {
    stack: Vec<Node>,
    /// Points put in although the model was content, because the certificate was not.
    pub overruled: u64,
    /// Take the model's word and only report the certificate.
    trust_model: bool,
}

/// What was found out about a piece.
struct Verdict {
    good: bool,
    tip: f64,
    axis: f64,
}

impl Linearise {
    /// Nothing put in yet. With `trust_model` the certificate only reports.
    pub fn new(trust_model: bool) -> Self {
        Self {
            trust_model,
            ..Self::default()
        }
    }

    /// Cuts the move between two nodes into pieces within tolerance and gives them to `emit` in order.
    /// `control_keeps_tip` tells that the tip follows the words in a straight line by itself.
    ///
    /// # Errors
    /// Why it cannot be done; pieces before that were given.
    #[inline]
    pub fn pieces(
        &mut self,
        placer: &Placer,
        model: &mut dyn ModelSession,
        from: &Node,
        to: &Node,
        tolerances: Tolerances,
        control_keeps_tip: bool,
        emit: &mut impl FnMut(&Linearise, Piece<'_>),
    ) -> Result<(), Stuck> {
        let sweep = angle(from.target.axis, to.target.axis);
        let bound = bounds(
            from,
            to,
            certificate::quick(placer.solver().chain(), &from.trace, &to.trace, sweep),
            control_keeps_tip,
        );
        if bound.tip <= tolerances.tip && bound.axis <= tolerances.axis {
            emit(
                self,
                Piece {
                    from,
                    to,
                    tip: bound.tip,
                    axis: bound.axis,
                },
            );
            return Ok(());
        }
        self.split(placer, model, from, to, tolerances, control_keeps_tip, emit)
    }

    #[expect(clippy::too_many_arguments, reason = "the slow half of `pieces`")]
    fn split(
        &mut self,
        placer: &Placer,
        model: &mut dyn ModelSession,
        from: &Node,
        to: &Node,
        tolerances: Tolerances,
        control_keeps_tip: bool,
        emit: &mut impl FnMut(&Linearise, Piece<'_>),
    ) -> Result<(), Stuck> {
        let mut current = *from;
        current.t = 0.0;
        let mut stack = std::mem::take(&mut self.stack);
        stack.clear();
        stack.push(*to);
        let mut result = Ok(());
        while let Some(next) = stack.pop() {
            let verdict = match self.judge(
                placer,
                model,
                &current,
                &next,
                tolerances,
                control_keeps_tip,
            ) {
                Ok(verdict) => verdict,
                Err(message) => {
                    result = Err(Stuck::Model(message));
                    break;
                }
            };
            if verdict.good {
                emit(
                    self,
                    Piece {
                        from: &current,
                        to: &next,
                        tip: verdict.tip,
                        axis: verdict.axis,
                    },
                );
                current = next;
                continue;
            }
            let middle = stuck(&current, &next, tolerances)
                .map_or(Ok(()), Err)
                .and_then(|()| {
                    middle(placer, &current, &next, verdict.axis <= tolerances.axis)
                        .map_err(Stuck::Refused)
                });
            match middle {
                Ok(middle) => {
                    stack.push(next);
                    stack.push(middle);
                }
                Err(stuck) => {
                    result = Err(stuck);
                    break;
                }
            }
        }
        self.stack = stack;
        result
    }

    /// Is a piece within tolerance? The model proposes, the certificate disposes.
    fn judge(
        &mut self,
        placer: &Placer,
        model: &mut dyn ModelSession,
        from: &Node,
        to: &Node,
        tolerances: Tolerances,
        control_keeps_tip: bool,
    ) -> Result<Verdict, String> {
        let chain = placer.solver().chain();
        let sweep = angle(from.target.axis, to.target.axis);
        let quick = certificate::quick(chain, &from.trace, &to.trace, sweep);
        let tight = certificate::tight(
            chain,
            &from.trace,
            &to.trace,
            from.target.axis,
            to.target.axis,
            sweep,
        );
        let bend = Bend {
            tip: quick.tip.min(tight.tip),
            axis: quick.axis.min(tight.axis),
        };
        let bound = bounds(from, to, bend, control_keeps_tip);
        let within = |tip: f64, axis: f64| tip <= tolerances.tip && axis <= tolerances.axis;
        if within(bound.tip, bound.axis) {
            return Ok(Verdict {
                good: true,
                ..bound
            });
        }
        let path = Block {
            placer,
            from,
            to,
            control_keeps_tip,
        };
        let tolerance = Tolerance {
            tip: tolerances.tip,
            axis: tolerances.axis.to_degrees(),
        };
        let curve = model.fit(&tolerance, &mut |ts, out| {
            for (t, out) in ts.iter().zip(out) {
                *out = path.deviation(*t);
            }
        })?;
        let content = within(curve.tip_peak, curve.axis_peak.to_radians());
        let certified = path.certify(bend, tolerances);
        let sure = within(certified.tip, certified.axis);
        if content && !sure && !self.trust_model {
            self.overruled += 1;
        }
        Ok(Verdict {
            // A model that sees more than the certificate proves is wrong on the safe side: points go in.
            good: content && (sure || self.trust_model),
            ..certified
        })
    }

    /// The tightest bound of a piece, for the summary.
    pub fn measure(placer: &Placer, piece: &Piece<'_>, control_keeps_tip: bool) -> (f64, f64) {
        let (from, to) = (piece.from, piece.to);
        let sweep = angle(from.target.axis, to.target.axis);
        let tight = certificate::tight(
            placer.solver().chain(),
            &from.trace,
            &to.trace,
            from.target.axis,
            to.target.axis,
            sweep,
        );
        let bound = bounds(from, to, tight, control_keeps_tip);
        (piece.tip.min(bound.tip), piece.axis.min(bound.axis))
    }
}

/// The bound that a bend proves for a piece.
#[inline]
fn bounds(from: &Node, to: &Node, bend: Bend, control_keeps_tip: bool) -> Verdict {
    let tip_bend = if control_keeps_tip { 0.0 } else { bend.tip };
    let axis_ends = from.axis_error.max(to.axis_error);
    // Below a milliradian the chord of an angle is the angle to seven digits; the sum is an upper bound anyway.
    let axis = if bend.axis == 0.0 {
        axis_ends
    } else {
        certificate::chord_angle(certificate::deviation(axis_ends, bend.axis))
    };
    Verdict {
        good: false,
        tip: certificate::deviation(from.tip_error.max(to.tip_error), tip_bend),
        axis,
    }
}

/// A piece that no further point can mend.
fn stuck(from: &Node, to: &Node, tolerances: Tolerances) -> Option<Stuck> {
    let tip = from.tip_error.max(to.tip_error);
    let axis = from.axis_error.max(to.axis_error);
    if tip >= tolerances.tip || axis >= tolerances.axis {
        return Some(Stuck::Rounding { tip, axis });
    }
    if to.t - from.t > SHORTEST {
        return None;
    }
    let (joint, _) = (0..from.trace.joints.len())
        .map(|joint| {
            (
                joint,
                (to.trace.joints[joint] - from.trace.joints[joint]).abs(),
            )
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(Stuck::Jump {
        joint,
        from: from.trace.joints[joint],
        to: to.trace.joints[joint],
    })
}

/// The node in the middle of a piece. `axis_holds` tells that the tool axis is within tolerance already.
fn middle(placer: &Placer, from: &Node, to: &Node, axis_holds: bool) -> Result<Node, Refused> {
    let t = (from.t + to.t) / 2.0;
    let mut halfway: Joints = Default::default();
    for (joint, value) in halfway.iter_mut().enumerate() {
        *value = (from.trace.joints[joint] + to.trace.joints[joint]) / 2.0;
    }
    let tip = (from.target.tip + to.target.tip) / 2.0;
    let axis = (from.target.axis + to.target.axis)
        .try_normalize(1e-9)
        .unwrap_or(from.target.axis);
    let target = Pose { tip, axis };
    let exact = placer.place(target, t, &halfway);
    if axis_holds {
        let straight = exact.as_ref().is_ok_and(|node| {
            let joints = &node.trace.joints;
            placer
                .solver()
                .chain()
                .joints()
                .iter()
                .enumerate()
                .filter(|(_, joint)| joint.rotary)
                .all(|(index, _)| {
                    let turn = (to.trace.joints[index] - from.trace.joints[index]).abs();
                    let off = (joints[index] - halfway[index]).abs();
                    off <= turn / 4.0 + placer.axis_rounding()
                })
        });
        if !straight {
            return placer.settle(target, t, halfway);
        }
    }
    exact
}

/// A block: all axes linear in t between two nodes.
struct Block<'a> {
    placer: &'a Placer,
    from: &'a Node,
    to: &'a Node,
    control_keeps_tip: bool,
}

impl Block<'_> {
    /// Pose of the interpolated axes minus the CL path at the same t.
    fn deviation(&self, t: f64) -> Deviation {
        let (from, to) = (self.from, self.to);
        let mut joints: Joints = Default::default();
        for (joint, value) in joints.iter_mut().enumerate() {
            *value = from.trace.joints[joint] * (1.0 - t) + to.trace.joints[joint] * t;
        }
        let pose = self.placer.solver().chain().forward(&joints);
        let reached = if self.control_keeps_tip {
            from.tip * (1.0 - t) + to.tip * t
        } else {
            pose.tip
        };
        let tip = reached - (from.target.tip * (1.0 - t) + to.target.tip * t);
        let wanted = great_circle(from.target.axis, to.target.axis, t);
        let cross = wanted.cross(&pose.axis);
        let sine = cross.norm();
        let turn = if sine > 0.0 {
            cross * (libm::atan2(sine, wanted.dot(&pose.axis)).to_degrees() / sine)
        } else {
            Vector3::zeros()
        };
        Deviation {
            tip: tip.into(),
            axis: turn.into(),
        }
    }

    /// Samples so densely that the bend can hide no more than a small share of the tolerance between them.
    fn certify(&self, bend: Bend, tolerances: Tolerances) -> Verdict {
        let tip_bend = if self.control_keeps_tip || tolerances.tip.is_infinite() {
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
        let mut tip = self.from.tip_error.max(self.to.tip_error);
        let mut axis = self.from.axis_error.max(self.to.axis_error);
        for step in 1..count as u32 {
            let deviation = self.deviation(f64::from(step) / count);
            tip = tip.max(Vector3::from(deviation.tip).norm());
            axis = axis.max(Vector3::from(deviation.axis).norm().to_radians());
        }
        let blind = 1.0 / (8.0 * count * count);
        Verdict {
            good: false,
            tip: tip + tip_bend * blind,
            axis: certificate::chord_angle(axis + axis_bend * blind),
        }
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
