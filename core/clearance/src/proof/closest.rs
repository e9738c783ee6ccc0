//! How near any two bodies come on each motion, for who shows that along the path.

use super::{Body, Look, Move, Proof, Trial};
use crate::ALLOWANCE;

impl Proof {
    /// The distance that all pairs that `looks` wants keep from one another on a motion, mm: proven, and mostly no less than
    /// the truth by more than five in a hundred. 0 where two touch, or nothing is proven; none where no pair is looked at. A
    /// cutter that is spared is as near to the stock as it is, and where it is in it that is not told.
    ///
    /// What was found of a pair that is not near holds for later motions, so that most cost nothing. The results of
    /// [`Proof::results`] are none then.
    pub fn closest(
        &mut self,
        motion: &Move<'_>,
        looks: impl Fn(&Body, &Body) -> Look,
    ) -> Option<f64> {
        let [from, to] = motion.way.ends.map(|stance| stance.joints);
        if self.last.is_some_and(|last| last != from) {
            self.forget();
        }
        self.last = Some(to);
        let whole = motion.way.whole();
        self.lately.take(&to);
        self.sleep.end();
        // Who was nearest is so again mostly: the others need not be told as closely then.
        self.pairs.sort_by(|one, other| one.result.nearest.0.total_cmp(&other.result.nearest.0));
        let Self { bodies, pairs, rules, distances, lately, .. } = self;
        let (keep, within, spans) = (ALLOWANCE, rules.within, &lately.spans);
        let (yields, closely) = (false, true);
        let trial = Trial { bodies, motion, keep, yields, most: keep, within, closely, spans };
        let (mut nearest, mut clear_by) = (f64::INFINITY, f64::INFINITY);
        for pair in pairs {
            let [one, other] = pair.result.bodies.map(|place| &bodies[place]);
            let look = looks(one, other);
            if look == Look::LeaveOut {
                pair.forget();
                continue;
            }
            let result = &mut pair.result;
            (result.nearest, result.clear_by, result.faults) = ((nearest, 0), f64::INFINITY, 0);
            *distances += pair.take(&trial, whole.as_ref());
            let result = &mut pair.result;
            let touches = result.faults > 0;
            if !touches || look == Look::Prove {
                clear_by = clear_by.min(if touches { 0.0 } else { result.clear_by });
            }
            nearest = nearest.min(result.nearest.0);
            // Of who was not looked at closely it is known that the others were nearer.
            result.nearest.0 = result.clear_by;
        }
        clear_by.is_finite().then_some(clear_by)
    }
}
