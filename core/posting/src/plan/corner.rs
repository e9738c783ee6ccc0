//! How fast the tool may go through a corner of the path.

use post_feed::limits::ChordError;
use post_machine::description::{CornerRule, Machine};

use super::limits::PlanAxes;
use super::samples::PathDerivatives;

/// What a corner allows: the control passes it with a jump of the velocity, or along a curve that leaves the path.
#[derive(Clone, Debug)]
pub(super) struct Corner {
    jumps: Vec<f64>,
    tip_jump: f64,
    accelerations: Vec<f64>,
    tip_acceleration: f64,
    /// Distance by which the curve may leave the path, mm; none where there is no curve.
    tolerance: Option<f64>,
    chord: Option<ChordError>,
}

impl Corner {
    pub(super) fn new(machine: &Machine, axes: &PlanAxes, chord: Option<ChordError>) -> Self {
        let rules = &machine.motion;
        let tolerance = machine.accuracy.tolerance;
        Self {
            jumps: axes.jumps(),
            tip_jump: axes.tip_jump(),
            accelerations: axes.accelerations(),
            tip_acceleration: axes.tip_acceleration(),
            tolerance: (rules.corner == CornerRule::Blend)
                .then(|| rules.corner_tolerance.map_or(tolerance, |said| said.min(tolerance))),
            chord,
        }
    }

    /// The largest squared speed of the parameter where the path goes on from `before` as `behind`, its legs at least
    /// `length` long to both sides.
    ///
    /// A curve that is a parabola over the length `l` leaves the corner by `l·|ΔP'|/8` and bends by `ΔQ'/l`.
    pub(super) fn allows(
        &self,
        before: &PathDerivatives,
        behind: &PathDerivatives,
        length: f64,
    ) -> f64 {
        let count = self.jumps.len();
        let turn: f64 = norm(std::array::from_fn(|axis| behind.tip[0][axis] - before.tip[0][axis]));
        let kinks = (0..count).map(|axis| (behind.axes[axis][0] - before.axes[axis][0]).abs());
        let jump = kinks
            .clone()
            .zip(&self.jumps)
            .map(|(kink, jump)| jump / kink)
            .fold(self.tip_jump / turn, f64::min);
        let jumped = jump * jump;
        let Some(tolerance) = self.tolerance else {
            return jumped;
        };
        let curve = (8.0 * tolerance / turn).min(length);
        let rounded = kinks
            .zip(&self.accelerations)
            .map(|(kink, most)| most * curve / kink)
            .fold(self.tip_acceleration * curve / turn, f64::min);
        let curvature = turn / curve;
        let chord = self.chord.as_ref().map_or(f64::INFINITY, |chord| chord.feed(curvature));
        jumped.max(rounded.min(chord * chord))
    }
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|part| part * part).sum::<f64>().sqrt()
}
