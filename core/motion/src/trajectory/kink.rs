//! Where one move passes into the next in another direction, its parameter scaled such that the speed stays.

use nalgebra::Vector3;
use post_machine::description::BlendRule;
use post_machine::kinematics::{Joints, MAX_AXES, Unreachable};

use super::side::CornerSide;
use crate::Move;
use crate::limits::{AxisLimits, MoveLimits};
use crate::path::Interpolation;

/// Changes of the derivatives below this share of them are rounding.
const NONE: f64 = 1e-9;

/// What jumps where two moves meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kink {
    /// How much faster the parameter of the second move runs.
    pub ratio: f64,
    /// How the derivatives over the first move's parameter change: of what is limited, and of the tip.
    pub change: Joints,
    pub tip: Vector3<f64>,
    /// More of them changes than rounding.
    seen: bool,
}

impl Kink {
    /// The kink between two moves; none where they cannot be compared.
    pub fn new(sides: [CornerSide; 2], rules: &AxisLimits) -> Option<Self> {
        let ratio = ratio(sides, rules)?;
        let [out, into] = [&sides[0].found.ends[1], &sides[1].found.ends[0]];
        let mut change = [0.0; MAX_AXES];
        let mut seen = false;
        for (change, (out, into)) in change.iter_mut().zip(out.iter().zip(into)) {
            *change = into * ratio - out;
            seen |= libm::fabs(*change) > NONE * (libm::fabs(into * ratio) + libm::fabs(*out));
        }
        let [out, into] = [sides[0].found.tip_ends[1], sides[1].found.tip_ends[0]];
        let tip = into * ratio - out;
        Some(Self { ratio, change, tip, seen })
    }

    /// More changes than rounding makes.
    pub fn is_seen(&self) -> bool {
        self.seen
    }

    /// The largest rate of the first move's parameter with which it may be passed, 1/s.
    pub fn rate(&self, rules: &AxisLimits, blend: BlendRule) -> f64 {
        // The longer of the two blocks takes so long at rate 1.
        let longer = (1.0 / self.ratio).max(1.0);
        let mut rate = f64::INFINITY;
        let mut bound = |jump: f64, acceleration: f64, change: f64| {
            rate = rate.min(jump / change);
            if blend == BlendRule::Round {
                rate = rate.min((acceleration * longer / change).sqrt());
            }
        };
        for (place, change) in self.change.iter().enumerate() {
            let change = libm::fabs(*change);
            bound(rules.jump[place], rules.acceleration[place], change);
        }
        bound(rules.tip_jump, rules.tip_acceleration, self.tip.norm());
        rate
    }
}

/// How much faster the parameter of the second move runs than that of the first where they meet, such that the
/// velocities of what is limited, each weighed by its acceleration, keep their length; none where they cannot be
/// compared.
fn ratio(sides: [CornerSide; 2], rules: &AxisLimits) -> Option<f64> {
    // Between coordinates of the tip and of the axes there is no comparison.
    let coordinates = sides.map(|side| side.task.keeps_tip && side.task.way != Interpolation::Axes);
    if rules.programmed.is_some() && coordinates[0] != coordinates[1] {
        return None;
    }
    let weight = |place: usize| {
        [rules.acceleration[place], rules.velocity[place], 1.0]
            .into_iter()
            .find(|limit| limit.is_finite())
            .map_or(1.0, f64::recip)
    };
    let size = |derivatives: &Joints| {
        let squares = derivatives.iter().enumerate().map(|(place, value)| {
            let weighed = value * weight(place);
            weighed * weighed
        });
        squares.sum::<f64>().sqrt()
    };
    let [out, into] = [&sides[0].found.ends[1], &sides[1].found.ends[0]].map(size);
    let ratio = out / into;
    (out > 0.0 && into > 0.0 && ratio.is_finite() && ratio > 0.0).then_some(ratio)
}

/// How first and second derivatives of the axes, over the first of two moves' parameter, change where the second one,
/// whose parameter runs faster by `ratio`, follows it.
///
/// # Errors
/// As [`Interpolation::stance_at`].
pub(super) fn of_axes(
    moves: [&Move; 2],
    found: [&MoveLimits; 2],
    rules: &AxisLimits,
    ratio: f64,
) -> Result<[Joints; 2], Unreachable> {
    let [out, into] = match rules.programmed {
        None => [[found[0].ends[1], found[0].bends[1]], [found[1].ends[0], found[1].bends[0]]],
        // What is limited are not the axes.
        Some(_) => [slopes(moves[0], true)?, slopes(moves[1], false)?],
    };
    let scales = [ratio, ratio * ratio];
    Ok(std::array::from_fn(|order| {
        std::array::from_fn(|place| into[order][place] * scales[order] - out[order][place])
    }))
}

/// Step of a difference, of the move's parameter.
const STEP: f64 = 1e-3;

/// First and second derivatives of the axes where a move begins or ends, over its parameter: by one-sided differences
/// that are exact for cubics.
fn slopes(task: &Move, ends: bool) -> Result<[Joints; 2], Unreachable> {
    let (at, sense) = match ends {
        true => (1.0, -STEP),
        false => (0.0, STEP),
    };
    let stance = if ends { &task.to } else { &task.from };
    let mut near = stance.joints;
    let mut joints = |steps: f64| -> Result<Joints, Unreachable> {
        let stands = [&task.from, &task.to];
        near = task.way.joints_at(&task.solver, stands, at + steps * sense, &near)?;
        Ok(near)
    };
    let points = [joints(0.0)?, joints(1.0)?, joints(2.0)?, joints(3.0)?];
    let weighed = |weights: [f64; 4], by: f64| {
        std::array::from_fn(|place| {
            let parts = weights.iter().zip(&points);
            parts.map(|(weight, joints)| weight * joints[place]).sum::<f64>() / by
        })
    };
    Ok([
        weighed([-11.0, 18.0, -9.0, 2.0], 6.0 * sense),
        weighed([2.0, -5.0, 4.0, -1.0], sense * sense),
    ])
}
