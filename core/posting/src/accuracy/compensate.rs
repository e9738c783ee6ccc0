//! `compensate` (the harmonic paper, Li 2024, eqs. 3.3 and 3.4): points on the straight line of the axes, moved by
//! minus the model's curve.
//!
//! A point at the share t of a move has the rotary axes where linear interpolation has them, and its tip where they
//! would bring it less what the model says it strays by: nothing is solved but the linear axes. What the model
//! misses stays in the point, and the certificate counts it. The tool axis is not compensated (the paper moves
//! positions alone), and a move whose tool axis strays too far is linearised.

use nalgebra::Vector3;
use post_plugin::{Curve, ModelSession};

use super::deviation::{NodeMove, between};
use super::even::pieces;
use super::linearise::{Lineariser, PieceAssessment};
use super::node::{PathNode, PlacementError};

impl Lineariser {
    /// Compensates a move whose predicted peak exceeds the tolerance. False where what comes out is not within it:
    /// nothing is kept then.
    pub(super) fn compensate(
        &mut self,
        whole: &NodeMove<'_>,
        judged: &PieceAssessment,
        model: &dyn ModelSession,
    ) -> bool {
        let Some(curve) = &judged.curve else {
            return false;
        };
        // Half of the tolerance for what a piece bows by, half for what the model misses.
        let needed = pieces(2.0 * judged.peak.tip / whole.tolerances.tip);
        let made =
            self.equal(whole, needed.max(self.points + 1), |t| compensated(whole, curve, model, t));
        let good = made.is_ok_and(|good| good);
        self.overruled += u64::from(!good);
        good
    }
}

/// The node at the share `t` of a move.
fn compensated(
    whole: &NodeMove<'_>,
    curve: &Curve,
    model: &dyn ModelSession,
    t: f64,
) -> Result<PathNode, PlacementError> {
    let target = whole.target(t);
    let strays = Vector3::from(whole.deviation(t).tip) - Vector3::from(model.value(curve, t).tip);
    let joints = between(&whole.from.trace.joints, &whole.to.trace.joints, t);
    let place = target.tip + strays;
    let t = whole.from.t * (1.0 - t) + whole.to.t * t;
    let mut node = PathNode::default();
    whole.placer.settle_at(&mut node, target, place, t, &joints)?;
    Ok(node)
}
