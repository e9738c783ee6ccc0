//! `compensate` (the harmonic paper, Li 2024, eqs. 3.3 and 3.4): points on the straight line of the axes, moved by
//! minus the model's curve.
//!
//! A point at the share t of a move has the rotary axes where linear interpolation has them, and its tip where they
//! would bring it less what the model says it strays by: nothing is solved but the linear axes. What the model
//! misses stays in the point, and the certificate counts it. The tool axis is not compensated (the paper moves
//! positions alone), and a move whose tool axis strays too far is linearised.

use nalgebra::Vector3;
use post_plugin::{Curve, ModelSession};

use super::deviation::{Move, between};
use super::linearise::{Linearise, Stuck};
use super::node::{Node, Refused};

/// No number of points helps a move that strays by more than this times the tolerance.
const LIMIT: f64 = 1e6;

impl Linearise {
    /// Compensates a move if its predicted peak exceeds the tolerance. Where what comes out is not within it, the
    /// move is linearised instead.
    ///
    /// # Errors
    /// Why it cannot be done.
    pub(super) fn compensate(
        &mut self,
        whole: &Move<'_>,
        model: &mut dyn ModelSession,
    ) -> Result<(), Stuck> {
        let judged = self.judge(whole, model)?;
        let Some(curve) = judged.curve.filter(|_| !judged.good) else {
            self.keep(*whole.to, judged.bound);
            return Ok(());
        };
        // Half of the tolerance for what a piece bows by, half for what the model misses.
        let times = 2.0 * judged.peak.tip / whole.tolerances.tip;
        let needed = libm::ceil(libm::sqrt(times.min(LIMIT))) as u32;
        let count = needed.max(self.points + 1);
        let before = self.count();
        let good = self
            .moved(whole, count, &curve, model)
            .map_err(Stuck::Refused)?;
        if good || self.trust_model {
            return Ok(());
        }
        self.take_back(before);
        self.overruled += 1;
        self.halve(whole, model)
    }

    /// Makes `count` pieces; says whether all pieces are within tolerance.
    fn moved(
        &mut self,
        whole: &Move<'_>,
        count: u32,
        curve: &Curve,
        model: &dyn ModelSession,
    ) -> Result<bool, Refused> {
        let mut from = *whole.from;
        let mut good = true;
        for step in 1..=count {
            let to = if step == count {
                *whole.to
            } else {
                compensated(whole, curve, model, f64::from(step) / f64::from(count))?
            };
            let piece = Move {
                from: &from,
                to: &to,
                ..*whole
            };
            let bound = piece.certify();
            good &= whole.tolerances.hold(bound);
            self.keep(to, bound);
            from = to;
        }
        Ok(good)
    }
}

/// The node at the share `t` of a move.
fn compensated(
    whole: &Move<'_>,
    curve: &Curve,
    model: &dyn ModelSession,
    t: f64,
) -> Result<Node, Refused> {
    let target = whole.target(t);
    let strays = Vector3::from(whole.deviation(t).tip) - Vector3::from(model.value(curve, t).tip);
    let joints = between(&whole.from.trace.joints, &whole.to.trace.joints, t);
    let place = target.tip + strays;
    let t = whole.from.t * (1.0 - t) + whole.to.t * t;
    let mut node = Node::default();
    whole
        .placer
        .settle_at(&mut node, target, place, t, &joints)?;
    Ok(node)
}
