//! The part of a window's plan that was not handed on: a way to a stop, and where the next window's rounds begin.

use super::rounds::SectionPlan;
use super::spline::StartState;
use super::{IntervalLaw, Law};

/// The smallest tangent, as a share of the plan without jerk limits: a plan may have three times its tangent.
const SMALL: f64 = 1e-4;

/// A plan that ends at rest, an entry an interval.
#[derive(Clone, Debug, Default)]
pub(super) struct StopPlan {
    pub(super) law: Law,
    middles: Vec<f64>,
    tangents: Vec<f64>,
}

impl StopPlan {
    pub(super) fn new(planned: SectionPlan) -> Self {
        Self { law: planned.law, middles: planned.middles, tangents: planned.tangents }
    }

    pub(super) fn len(&self) -> usize {
        self.law.pieces.len()
    }

    pub(super) fn drop_first(&mut self, count: usize) {
        self.law.steps.drain(..count);
        self.law.pieces.drain(..count);
        self.middles.drain(..count);
        self.tangents.drain(..count);
    }

    /// The state that it goes on from; rest at its end.
    pub(super) fn state(&self) -> StartState {
        match self.law.pieces.first() {
            Some(&IntervalLaw::Quadratic([q, middle, _])) => StartState { q, middle },
            _ => StartState::default(),
        }
    }

    /// A small part of what is left, so that the rest goes on from a state; all of it if there is none.
    pub(super) fn next_part(&self) -> usize {
        let part = (self.len() / 8).max(1);
        match self.law.pieces.get(part) {
            Some(IntervalLaw::Quadratic(_)) => part,
            _ => self.len(),
        }
    }

    /// Tangents as near the plan to come as is known: those of this one until it begins to stop, and then `fast`, the
    /// plan without jerk limits, slowed down evenly.
    pub(super) fn guess(&self, fast: &[f64]) -> Vec<f64> {
        let ratios = self.middles.iter().zip(fast);
        let ratios: Vec<f64> = ratios.map(|(own, fast)| own / fast).collect();
        let most = ratios.iter().copied().fold(0.0, f64::max);
        let stops = ratios.iter().rposition(|&ratio| ratio >= 0.5 * most);
        let stops = stops.unwrap_or(0);
        let share = ratios.get(stops).map_or(1.0, |ratio| ratio.min(1.0));
        let behind = fast.iter().skip(stops + 1).map(|fast| share * fast);
        let before = self.tangents.iter().zip(fast).take(stops + 1);
        before.map(not_small).chain(behind).collect()
    }

    /// Tangents with which this plan is known to keep its rows, up to where it stops.
    pub(super) fn known(&self, fast: &[f64]) -> Vec<f64> {
        let known = self.tangents.iter().zip(fast).map(not_small);
        known.chain(fast.iter().skip(self.tangents.len()).copied()).collect()
    }
}

fn not_small((known, fast): (&f64, &f64)) -> f64 {
    known.max(SMALL * fast)
}
