//! What is to be small over the path: the measure of a move of the axes.

use post_machine::description::{Machine, Side, SolutionCriterion};
use post_machine::kinematics::{Chain, Joints, MAX_AXES};

use super::cycle_time::DriveLimits;

/// An axis without `max_feed` counts as one with this many mm/min or degrees/min.
const USUAL_FEED: f64 = 10_000.0;

/// Axis values this close to zero lie on both sides, mm or radians.
const NEAR_ZERO: f64 = 1e-6;

/// Measures moves of one machine.
#[derive(Clone, Debug)]
pub(crate) struct TravelMeasure {
    rule: SolutionCriterion,
    count: usize,
    rotary: [bool; MAX_AXES],
    /// Linear axes beyond what a pose needs (rails): their way counts as a turn on an arm of [`ARM`].
    rails: Vec<usize>,
    /// Axes are beyond what a pose needs.
    surplus: bool,
    /// Minutes for one mm or radian at the largest feed.
    slowness: Joints,
    prefer: Vec<(usize, Side)>,
    /// What the control shows at zero of each axis.
    zero: Joints,
    /// Drives that times are worked out with, under `cycle-time`.
    drives: Option<Box<DriveLimits>>,
}

/// Share of the time of a move that is added to the other measures: it decides between ways that are equal in them.
const TIE: f64 = 1e-6;

/// mm that a radian counts as beside the way of a rail.
pub(super) const ARM: f64 = 300.0;

impl TravelMeasure {
    pub(crate) fn new(machine: &Machine, surplus: &[usize]) -> Self {
        let mut slowness = [0.0; MAX_AXES];
        let mut rotary = [false; MAX_AXES];
        let mut zero = [0.0; MAX_AXES];
        for (place, axis) in machine.axes.iter().enumerate() {
            rotary[place] = axis.joint.rotary;
            zero[place] = axis.zero;
            slowness[place] = if axis.max_feed.is_finite() {
                1.0 / axis.max_feed
            } else {
                1.0 / (USUAL_FEED * axis.unit())
            };
        }
        Self {
            rule: machine.solution.rule,
            count: machine.axes.len(),
            rails: surplus.iter().copied().filter(|place| !rotary[*place]).collect(),
            surplus: !surplus.is_empty(),
            rotary,
            slowness,
            prefer: machine.solution.prefer.clone(),
            zero,
            drives: (machine.solution.rule == SolutionCriterion::CycleTime)
                .then(|| Box::new(DriveLimits::new(machine))),
        }
    }

    /// Axes are beyond what a pose needs.
    pub(super) fn has_surplus(&self) -> bool {
        self.surplus
    }

    /// What the time is made of, under the rule `cycle-time`.
    #[inline]
    pub(crate) fn drives(&self) -> Option<&DriveLimits> {
        self.drives.as_deref()
    }

    /// The cost of a rapid, or of a turn off the part: [`TravelMeasure::between`], or seconds under `cycle-time`.
    #[inline]
    pub(crate) fn off_part(&self, chain: &Chain, from: &Joints, to: &Joints) -> f64 {
        match self.drives() {
            Some(drives) => drives.rapid(chain, from, to) + self.between(from, to),
            None => self.between(from, to),
        }
    }

    /// The cost of a move: minutes under `time`, degrees (mm) under the other rules. Those decide by the
    /// measure alone only where it differs; the time breaks their ties. Under `cycle-time` what breaks the ties alone.
    #[inline]
    pub(crate) fn between(&self, from: &Joints, to: &Joints) -> f64 {
        self.weigh(from, to, true)
    }

    /// [`TravelMeasure::between`] of the rotary axes alone: where the tool comes from is not known.
    pub(crate) fn approach(&self, from: &Joints, to: &Joints) -> f64 {
        let turn = self
            .drives()
            .map_or(0.0, |drives| drives.rest_to_rest(from, to, 1.0, |place| self.rotary[place]));
        turn + self.weigh(from, to, false)
    }

    #[inline]
    fn weigh(&self, from: &Joints, to: &Joints, linear: bool) -> f64 {
        if linear && self.rule == SolutionCriterion::Time {
            // Unused places cost nothing.
            let mut time = 0.0;
            for index in 0..MAX_AXES {
                time += (to[index] - from[index]).abs() * self.slowness[index];
            }
            return time;
        }
        let mut time = 0.0;
        let (mut squares, mut largest): (f64, f64) = (0.0, 0.0);
        for index in 0..self.count {
            let way = (to[index] - from[index]).abs();
            if self.rotary[index] {
                squares += way * way;
                largest = largest.max(way);
            } else if !linear {
                continue;
            }
            time += way * self.slowness[index];
        }
        for rail in &self.rails {
            let way = (to[*rail] - from[*rail]) / ARM;
            squares += way * way;
            largest = largest.max(way.abs());
        }
        let tie = TIE * time;
        match self.rule {
            SolutionCriterion::Time => time,
            SolutionCriterion::CycleTime => tie,
            SolutionCriterion::Travel => squares.sqrt().to_degrees() + tie,
            SolutionCriterion::LargestAxis => largest.to_degrees() + tie,
            SolutionCriterion::Axis(place) => {
                let way = (to[place] - from[place]).abs();
                let unit = if self.rotary[place] { 1f64.to_radians() } else { 1.0 };
                way / unit + tie
            }
        }
    }

    /// How many axes stand on a side that is not preferred.
    #[inline]
    pub(crate) fn against(&self, joints: &Joints) -> u32 {
        let stands =
            |(place, side): &&(usize, Side)| wrong_side(joints[*place] + self.zero[*place], *side);
        self.prefer.iter().filter(stands).count() as u32
    }
}

/// The value that the control shows lies on the other side of zero.
pub(crate) fn wrong_side(value: f64, side: Side) -> bool {
    match side {
        Side::Positive => value < -NEAR_ZERO,
        Side::Negative => value > NEAR_ZERO,
    }
}
