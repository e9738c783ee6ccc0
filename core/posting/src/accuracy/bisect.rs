//! `bisect` (the parabolic paper, Sha et al. 2022): every piece that is over gets a point in its middle.
//!
//! Points lie on the exact inverse solution. Where the tool axis hardly moves while a rotary axis turns far (close
//! to a singularity) exact solutions do not help, since the angle jumps however short the piece is: there the
//! middle is taken in the axes' own space, rotary values halfway and the tip put on its chord, as long as the tool
//! axis stays within tolerance.

use post_machine::kinematics::Joints;
use post_plugin::ModelSession;

use super::bound::DeviationBound;
use super::deviation::{NodeMove, between};
use super::linearise::{LineariseError, Lineariser};
use super::node::{LONGEST, PathNode, PlacementError};

/// The shortest piece, as a share of its move.
const SHORTEST: f64 = 1.0 / (1u64 << 22) as f64;

/// Points put in may use so much of the tool axis' tolerance.
const ROOM: f64 = 0.9;

/// Closer than this share of the tolerance to the centre line a rotary axis can turn on the spot.
const CLOSE: f64 = 0.125;

/// A piece whose quick bound is over by this factor is most likely over: its middle is tried first.
const LIKELY: f64 = 3.0;

/// What was found of a piece.
enum PieceVerdict {
    /// The piece needs no further point.
    Good(DeviationBound),
    /// The piece needs one; with its bound, if that was worked out.
    Over(Option<DeviationBound>),
}

impl Lineariser {
    /// Can the axes follow this move within its tolerances, whatever points that takes? Nothing is sampled, no model
    /// asked.
    pub fn comes_through(&mut self, whole: &NodeMove<'_>) -> bool {
        self.take_back(0);
        let mut from = *whole.from;
        from.t = 0.0;
        let whole = NodeMove { from: &from, ..*whole };
        let judge = |_: &mut Self, piece: &NodeMove<'_>| {
            let bound = piece.measured();
            Ok(if piece.tolerances.hold(bound) {
                PieceVerdict::Good(bound)
            } else {
                PieceVerdict::Over(Some(bound))
            })
        };
        self.bisect(&whole, judge).is_ok()
    }

    /// Cuts a move, or what is left of it, into pieces that model and certificate are content with.
    ///
    /// # Errors
    /// Why it cannot be done.
    pub(super) fn halve(
        &mut self,
        whole: &NodeMove<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(), LineariseError> {
        self.bisect(whole, |this, piece| this.verdict(piece, model))
    }

    /// Where the middle of a piece is over, no bound can clear it, and no model is asked: its word could not save the
    /// piece, unless it is trusted.
    fn verdict(
        &mut self,
        piece: &NodeMove<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<PieceVerdict, LineariseError> {
        let over = || !self.trust_model && piece.over_halfway();
        let (quick, tolerances) = (piece.quick(), piece.tolerances);
        let rough = piece.bound(quick.0);
        let likely = rough.tip > LIKELY * tolerances.tip || rough.axis > LIKELY * tolerances.axis;
        if likely && over() {
            return Ok(PieceVerdict::Over(None));
        }
        let measured = piece.course(quick);
        if !likely && !tolerances.hold(measured.0) && over() {
            return Ok(PieceVerdict::Over(None));
        }
        let judged = self.judge_measured(piece, measured, model)?;
        Ok(if judged.good {
            PieceVerdict::Good(judged.bound)
        } else {
            PieceVerdict::Over(Some(judged.bound))
        })
    }

    /// Puts points into the middle of every piece that `judge` does not find good.
    fn bisect(
        &mut self,
        whole: &NodeMove<'_>,
        mut judge: impl FnMut(&mut Self, &NodeMove<'_>) -> Result<PieceVerdict, LineariseError>,
    ) -> Result<(), LineariseError> {
        let mut from = *whole.from;
        self.stack.clear();
        self.stack.push(*whole.to);
        while let Some(to) = self.stack.pop() {
            let piece = NodeMove { from: &from, to: &to, ..*whole };
            let bound = match judge(self, &piece)? {
                PieceVerdict::Good(bound) => {
                    self.keep(to, bound);
                    from = to;
                    continue;
                }
                PieceVerdict::Over(bound) => bound,
            };
            if let Some(stuck) = stuck(&piece) {
                return Err(stuck);
            }
            if let Some(nodes) = on_the_spot(&piece) {
                self.stack.push(to);
                self.stack.extend(nodes.map_err(LineariseError::Refused)?.into_iter().rev());
                continue;
            }
            let holds = || bound.unwrap_or_else(|| piece.certify()).axis <= piece.tolerances.axis;
            let middle = put_in(&piece, 0.5, holds).map_err(LineariseError::Refused)?;
            self.stack.push(to);
            self.stack.push(middle);
        }
        Ok(())
    }
}

/// A piece that no further point can mend.
fn stuck(piece: &NodeMove<'_>) -> Option<LineariseError> {
    let (from, to) = (piece.from, piece.to);
    let tip = from.tip_error.max(to.tip_error);
    let axis = from.axis_error.max(to.axis_error);
    if tip >= piece.tolerances.tip || axis >= piece.tolerances.axis {
        return Some(LineariseError::Rounding { tip, axis, allowed: piece.tolerances });
    }
    if to.t - from.t > SHORTEST {
        return None;
    }
    let joints = piece.placer.solver().chain().joints();
    let turn = |joint: &usize| libm::fabs(to.trace.joints[*joint] - from.trace.joints[*joint]);
    let joint = (0..joints.len())
        .filter(|joint| joints[*joint].rotary)
        .max_by(|a, b| turn(a).total_cmp(&turn(b)))?;
    Some(LineariseError::Jump { joint, from: from.trace.joints[joint], to: to.trace.joints[joint] })
}

/// A rotary axis turns by no less on the spot, radians: elsewhere points on the way serve.
const TURNS: f64 = 1e-3;

/// Where a piece passes so close by the centre line that a rotary axis turns there by whatever its ends ask for, the others
/// going along with it: the nodes before and after that turn. None where the tool leans there.
fn on_the_spot(piece: &NodeMove<'_>) -> Option<Result<Vec<PathNode>, PlacementError>> {
    let (from, to, placer) = (piece.from, piece.to, piece.placer);
    let (first, last) = (&from.trace.joints, &to.trace.joints);
    let meeting = placer.solver().meeting([from.target.tip, to.target.tip], first)?;
    let turn = libm::fabs(last[meeting.joint] - first[meeting.joint]);
    let off = meeting.gap.max(meeting.miss);
    if turn < TURNS || off > CLOSE * piece.tolerances.tip || from.t == to.t {
        return None;
    }
    let t = from.t * (1.0 - meeting.share) + to.t * meeting.share;
    let target = piece.target(meeting.share);
    // A control that goes the shorter way is led through points of the turn.
    let steps = if placer.turns_too_far(first, last) { libm::ceil(turn / LONGEST) } else { 1.0 };
    let shares = std::iter::successors(Some(0.0), |step| Some(step + 1.0));
    let shares = shares.take_while(|step| *step <= steps).map(|step| step / steps);
    let inside = shares.filter(|share| {
        (*share > 0.0 || meeting.share > 0.0) && (*share < 1.0 || meeting.share < 1.0)
    });
    let turned = |joints: Joints| placer.solver().turned_on_the_spot(&target, &joints);
    let nodes: Result<Vec<PathNode>, _> = inside
        .map(|share| placer.settled(target, t, &turned(between(first, last, share))))
        .collect();
    // A tool that leans there does not stay where it is.
    let leans = |node: &PathNode| node.axis_error >= piece.tolerances.axis;
    (!nodes.as_ref().is_ok_and(|nodes| nodes.iter().any(leans))).then_some(nodes)
}

/// The node at a share of a piece: on the exact inverse solution, unless the axes jump there. `holds` says whether
/// the tool axis stays within tolerance on the axes' own straight line.
pub(super) fn put_in(
    piece: &NodeMove<'_>,
    share: f64,
    holds: impl FnOnce() -> bool,
) -> Result<PathNode, PlacementError> {
    let (from, to, placer) = (piece.from, piece.to, piece.placer);
    let t = from.t * (1.0 - share) + to.t * share;
    let (first, last) = (&from.trace.joints, &to.trace.joints);
    let target = piece.target(share);
    let exact = placer.place_between(target, t, first, last);
    let even = between(first, last, share);
    let straight = exact.as_ref().is_ok_and(|node| {
        let joints = placer.solver().chain().joints();
        (0..joints.len()).filter(|joint| joints[*joint].rotary).all(|joint| {
            let turn = libm::fabs(last[joint] - first[joint]);
            let off = libm::fabs(node.trace.joints[joint] - even[joint]);
            off <= turn / 4.0 + placer.axis_rounding()
        })
    });
    if straight || !placer.solver().places_tip() {
        return exact;
    }
    // A point that is off by all of the tolerance leaves nothing to the pieces beside it.
    let room = ROOM * piece.tolerances.axis;
    if holds()
        && let Ok(node) = placer.settled(target, t, &even)
        && node.axis_error <= room
    {
        return Ok(node);
    }
    // A pole joint is turned evenly, the others keep the tool axis as well as they can.
    match placer.place_evenly(target, t, &even) {
        Some(node) if node.axis_error <= room => Ok(node),
        _ => exact,
    }
}
