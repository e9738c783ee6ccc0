//! What a planned feed keeps on a machine, as the planner's limits.

use post_feed::limits::{
    AxisAcceleration, AxisJerk, AxisVelocity, BlockTime, ChordError, Collocation, Limit,
    TipAcceleration, TipFeed, TipJerk,
};
use post_machine::description::{Machine, PlanRules};
use post_machine::diagnostic::Diagnostic;
use post_motion::limits::AxisLimits;

use super::contour::contour_error;

/// The axes of a sample of a path: those of the chain by their places and, where the machine's limits hold for the
/// programmed coordinates, those three after them.
#[derive(Clone, Copy, Debug)]
pub struct SampledAxes {
    pub(super) of_chain: usize,
    pub(super) programmed: bool,
}

impl SampledAxes {
    /// Those of a machine.
    pub fn new(machine: &Machine) -> Self {
        PlanAxes::new(machine).sampled()
    }

    /// How many they are.
    pub(super) fn count(self) -> usize {
        self.of_chain + if self.programmed { 3 } else { 0 }
    }
}

/// The limits of a machine's axes in the order of [`SampledAxes`].
#[derive(Clone, Debug)]
pub(super) struct PlanAxes {
    limits: AxisLimits,
    /// Number of axes of the chain.
    pub(super) count: usize,
}

impl PlanAxes {
    pub(super) fn new(machine: &Machine) -> Self {
        Self { limits: AxisLimits::new(machine), count: machine.axes.len() }
    }

    /// The axes of a sample.
    pub(super) fn sampled(&self) -> SampledAxes {
        SampledAxes { of_chain: self.count, programmed: self.limits.programmed.is_some() }
    }

    /// Velocities, accelerations and jerks of the axes of the chain.
    pub(super) fn of_joints(&self) -> [Vec<f64>; 3] {
        let limits = &self.limits;
        [&limits.velocity, &limits.acceleration, &limits.jerk].map(|of| of[..self.count].to_vec())
    }

    /// Limits by place in the chain, those of the coordinates after them.
    fn each(&self, of: &[f64]) -> Vec<f64> {
        let mut each = of[..self.count].to_vec();
        if let Some(coordinates) = &self.limits.programmed {
            let mut programmed = [f64::INFINITY; 3];
            for (place, coordinate) in coordinates[..self.count].iter().enumerate() {
                if let Some(coordinate) = coordinate {
                    programmed[*coordinate] = of[place];
                    each[place] = f64::INFINITY;
                }
            }
            each.extend(programmed);
        }
        each
    }

    /// What the velocity may jump by where a path has a corner: by axis, mm/s or rad/s.
    pub(super) fn jumps(&self) -> Vec<f64> {
        self.each(&self.limits.jump)
    }

    /// Largest accelerations by axis.
    pub(super) fn accelerations(&self) -> Vec<f64> {
        self.each(&self.limits.acceleration)
    }

    pub(super) fn tip_jump(&self) -> f64 {
        self.limits.tip_jump
    }

    pub(super) fn tip_acceleration(&self) -> f64 {
        self.limits.tip_acceleration
    }
}

/// What a plan keeps on `machine`: the feed of each block, velocity, acceleration and jerk of axes and tip, the errors that
/// `rules` limit, and the time that the control takes for a block. Everywhere along the path, between samples too.
pub fn limits(machine: &Machine, rules: &PlanRules) -> Vec<Box<dyn Limit>> {
    let axes = PlanAxes::new(machine);
    let collocation = Collocation::Throughout;
    let finite = |all: &[f64]| all.iter().any(|one| one.is_finite());
    let mut limits: Vec<Box<dyn Limit>> =
        vec![Box::new(TipFeed { most: f64::INFINITY, collocation })];
    limits.push(Box::new(AxisVelocity { limits: axes.each(&axes.limits.velocity), collocation }));
    let accelerations = axes.accelerations();
    if finite(&accelerations) {
        limits.push(Box::new(AxisAcceleration { limits: accelerations, collocation }));
    }
    if axes.limits.tip_acceleration.is_finite() {
        limits.push(Box::new(TipAcceleration { limit: axes.limits.tip_acceleration, collocation }));
    }
    let jerks = axes.each(&axes.limits.jerk);
    if finite(&jerks) {
        limits.push(Box::new(AxisJerk { limits: jerks }));
    }
    if axes.limits.tip_jerk.is_finite() {
        limits.push(Box::new(TipJerk { limit: axes.limits.tip_jerk }));
    }
    let contour = |tolerance| {
        contour_error(machine, tolerance, collocation).map(|limit| Box::new(limit) as _)
    };
    limits.extend(rules.contour_error.and_then(contour));
    if let Some(tolerance) = rules.chord_error {
        limits.push(Box::new(ChordError { tolerance, period: machine.motion.period, collocation }));
    }
    if machine.motion.block_time > 0.0 {
        limits.push(Box::new(BlockTime { seconds: machine.motion.block_time, collocation }));
    }
    limits
}

/// What a plan on `machine` cannot keep, or need not.
pub(super) fn warnings(machine: &Machine) -> Vec<Diagnostic> {
    let mut warnings = Vec::new();
    let axes = &machine.axes;
    if machine.plan.contour_error.is_some() && axes.iter().all(|axis| axis.servo.is_none()) {
        let message = format!(
            "[plan] contour_error limits nothing: no axis of {} has a servo, and all are where they are commanded",
            machine.name
        );
        warnings.push(Diagnostic::warning("plan", message).help("describe them in [servo.X] …"));
    }
    let without: Vec<&str> = axes
        .iter()
        .filter(|axis| axis.max_accel.is_infinite())
        .map(|axis| axis.name.as_str())
        .collect();
    if !without.is_empty() {
        let message = format!(
            "the planned feed keeps no acceleration of {}: the machine file gives no max_accel",
            without.join(", ")
        );
        warnings.push(
            Diagnostic::warning("plan", message).help("max_accel of each [axis.X], mm/s² or °/s²"),
        );
    }
    warnings
}
