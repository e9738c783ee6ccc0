//! Hills: a double S from knot to knot.

use super::knots::EnvelopeKnot;
use super::{JerkStep, SAME, SmoothPlan};
use crate::trajectory::block::VelocityLimit;
use crate::trajectory::envelope::VelocityEnvelope;

/// Blocks are unlike from this ratio of their accelerations or jerks on.
const UNLIKE: f64 = 2.0;

impl SmoothPlan {
    /// Lays a hill from each knot to the next.
    pub(super) fn lay_hills(&mut self, ahead: &VelocityEnvelope) {
        self.steps.clear();
        for index in 0..self.knots.len() - 1 {
            self.lay(ahead, self.knots[index], self.knots[index + 1]);
        }
    }

    /// One hill, or several where these are gone over sooner.
    fn lay(&mut self, ahead: &VelocityEnvelope, knot: EnvelopeKnot, next: EnvelopeKnot) {
        let profile = knot.profile(next.velocity);
        if let Some((knot, middle)) = self.split(ahead, &knot, &next, profile.seconds()) {
            self.lay(ahead, knot, middle);
            return self.lay(ahead, middle, next);
        }
        if let Some(knots) = self.split_everywhere(ahead, [&knot, &next], profile.seconds()) {
            for pair in knots.windows(2) {
                self.lay(ahead, pair[0], pair[1]);
            }
            return;
        }
        let why = |corner: bool| match corner {
            true => VelocityLimit::Corner,
            false => VelocityLimit::Change,
        };
        let [up, cruise, _] = profile.counts();
        let phases = profile.phases();
        for (place, phase) in phases.iter().enumerate() {
            let reached = phase.velocity >= knot.top * (1.0 - 1e-6);
            let why = match place {
                _ if place < up => why(knot.corner),
                _ if place >= up + cruise => why(next.corner),
                _ if reached => VelocityLimit::Velocity,
                _ => why(knot.corner || next.corner),
            };
            let last = place + 1 == phases.len();
            self.steps.push(JerkStep {
                phase: *phase,
                why,
                rests: last || place + 1 == up || place + 1 == up + cruise,
                ends: last.then_some(next.place),
            });
        }
    }

    /// A hill in two where its blocks are least alike, if that takes less than `seconds`.
    fn split(
        &self,
        ahead: &VelocityEnvelope,
        knot: &EnvelopeKnot,
        next: &EnvelopeKnot,
        seconds: f64,
    ) -> Option<(EnvelopeKnot, EnvelopeKnot)> {
        let places = (knot.place + 1..next.place).map(|place| (place, unlike(ahead, place)));
        let (place, unlike) = places.max_by(|one, other| one.1.total_cmp(&other.1))?;
        if unlike < UNLIKE {
            return None;
        }
        let first = self.up_to(ahead, *knot, place);
        let middle = EnvelopeKnot {
            place,
            velocity: ahead.squares[place].sqrt(),
            ..EnvelopeKnot::default()
        };
        let mut middle = self.up_to(ahead, middle, next.place);
        let reached = [
            first.ramp.reach(first.velocity, first.length),
            middle.ramp.reach(next.velocity, middle.length),
        ];
        middle.velocity = middle.velocity.min(reached[0]).min(reached[1]);
        let possible = first.covers(middle.velocity) && middle.covers(next.velocity);
        let both =
            || first.profile(middle.velocity).seconds() + middle.profile(next.velocity).seconds();
        (possible && both() < seconds * (1.0 - SAME)).then_some((first, middle))
    }

    /// A hill between two knots cut wherever its blocks are unlike, if that takes less than `seconds`: where several
    /// of them are slow to speed up, one cut leaves such a block on either side.
    fn split_everywhere(
        &self,
        ahead: &VelocityEnvelope,
        [knot, next]: [&EnvelopeKnot; 2],
        seconds: f64,
    ) -> Option<Vec<EnvelopeKnot>> {
        let mut knots = vec![*knot];
        for place in (knot.place + 1..next.place).filter(|place| unlike(ahead, *place) >= UNLIKE) {
            let velocity = ahead.squares[place].sqrt();
            knots.push(EnvelopeKnot { place, velocity, ..EnvelopeKnot::default() });
        }
        if knots.len() < 3 {
            return None;
        }
        knots.push(*next);
        let count = knots.len();
        for index in (0..count - 1).rev() {
            let next = knots[index + 1];
            let mut own = self.up_to(ahead, knots[index], next.place);
            if index > 0 {
                own.velocity = own.velocity.min(own.ramp.reach(next.velocity, own.length));
            }
            knots[index] = own;
        }
        for index in 1..count - 1 {
            let last = knots[index - 1];
            let reached = last.ramp.reach(last.velocity, last.length);
            knots[index].velocity = knots[index].velocity.min(reached);
        }
        let mut together = 0.0;
        for pair in knots.windows(2) {
            if !pair[0].covers(pair[1].velocity) {
                return None;
            }
            together += pair[0].profile(pair[1].velocity).seconds();
        }
        (together < seconds * (1.0 - SAME)).then_some(knots)
    }
}

/// The larger ratio of accelerations and of jerks of the block at `place` and the one before.
fn unlike(ahead: &VelocityEnvelope, place: usize) -> f64 {
    let [last, next] = [&ahead.blocks[place - 1], &ahead.blocks[place]];
    let ratio = |one: f64, other: f64| (one / other).max(other / one);
    ratio(last.acceleration, next.acceleration).max(ratio(last.jerk, next.jerk))
}
