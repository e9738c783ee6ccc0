//! Joints beyond what a pose needs: the turn about a tool that turns (its spin), rails, positioners.
//!
//! As many joints as a chain has freedoms too many stand where they stood, and the others reach the pose: so nothing
//! wanders, and a joint that does next to nothing for the pose (the flange of a robot whose spindle lies along it) is never
//! asked for a large turn. Which of them gives way where that does not do is for the stage that knows travels.

use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::chain::{Chain, Joints, Pose, Turns, square, turn};
use super::fault::Unreachable;
use super::inverse::{SETTINGS, SolutionMethod, Solver, VERIFIED};
use super::numeric;
use super::orientation::{angle, angle_about};

/// A joint that turns by more from one pose to the next, radians, has perhaps gone over to another solution.
const FAR: f64 = 0.35;

/// Joints to spare stand still without more ado where no other goes farther from one pose to the next, radians. Close to a
/// fold (the others cannot go on one way) they go far for little.
const LITTLE: f64 = 0.05;

/// Beyond [`LITTLE`] joints to spare give way where all go less than this share of what the others would go.
const WORTH: f64 = 0.5;

/// mm of a joint that slides count as a radian.
const ARM: f64 = 1000.0;

/// Joints of `free` that stand while the others reach any pose: the rotary one nearest to the tool, if that turns, then
/// those farthest from it. In the order of the chain.
pub(super) fn surplus(chain: &Chain, free: &[usize], held: &Joints) -> Vec<usize> {
    let freedoms = |moving: &[usize]| {
        let at = SETTINGS.map(|share| numeric::spread(free, held, share));
        at.iter().map(|at| numeric::freedoms(chain, moving, at)).max().unwrap_or(0)
    };
    let needed = freedoms(free);
    let last = free.iter().rev().find(|joint| chain.joints()[**joint].rotary);
    let spin = last.filter(|_| chain.edge().is_none());
    let mut moving = free.to_vec();
    for joint in spin.into_iter().chain(free) {
        if moving.len() == needed {
            break;
        }
        let without: Vec<usize> = moving.iter().copied().filter(|other| other != joint).collect();
        if without.len() < moving.len() && freedoms(&without) == needed {
            moving = without;
        }
    }
    free.iter().copied().filter(|joint| !moving.contains(joint)).collect()
}

/// The chain with some edge on its tool, where the turn about a tool that turns is beyond what a pose needs.
pub(super) fn framed(chain: &Chain, surplus: &[usize]) -> Option<Chain> {
    let turns = surplus.iter().any(|joint| chain.joints()[*joint].rotary);
    let framed = || chain.clone().with_edge(Some(square(Vector3::x(), chain.axis())));
    (turns && chain.edge().is_none()).then(framed)
}

/// Turns about the tool at which an arm is solved, where they are free.
const SPINS: usize = 12;

impl Solver {
    /// The solutions of a robot's arm by formulas, each verified, the joints in front of it standing as in `last`; of a
    /// tool that turns those at turns about it all around. None where the chain is no such arm.
    pub(super) fn of_arm(&self, pose: &Pose, last: &Joints, tolerance: f64) -> Vec<Joints> {
        self.all_around(pose, last, tolerance, SPINS)
    }

    /// The solutions of a robot's arm by formulas, each verified, the joints in front of it standing as in `last`; of a tool
    /// that turns those at `spins` turns about it, evenly all around. None where the chain is no such arm.
    pub fn all_around(
        &self,
        pose: &Pose,
        last: &Joints,
        tolerance: f64,
        spins: usize,
    ) -> Vec<Joints> {
        let SolutionMethod::Numeric { arm: Some(arm), .. } = &self.form else {
            return Vec::new();
        };
        let edge = square(arm.edge(), pose.axis);
        let mut found = Vec::with_capacity(8);
        match self.chain.edge() {
            Some(_) if pose.edge == Vector3::zeros() => {
                arm.solutions(&self.chain, &Pose { edge, ..*pose }, last, &mut found);
            }
            Some(_) => arm.solutions(&self.chain, pose, last, &mut found),
            None => {
                for spin in 0..spins {
                    let angle = TAU * spin as f64 / spins as f64;
                    let (sine, cosine) = libm::sincos(angle);
                    let edge = turn(edge, pose.axis, sine, cosine);
                    arm.solutions(&self.chain, &Pose { edge, ..*pose }, last, &mut found);
                }
            }
        }
        found.retain_mut(|joints| {
            // Close to where two solutions meet rounding is large: a step of the search takes it away.
            if !self.verified(joints, pose, tolerance.max(VERIFIED)) {
                match self.search_holding(pose, joints, self.surplus(), tolerance) {
                    Ok(next) => *joints = next,
                    Err(_) => return false,
                }
            }
            true
        });
        found
    }

    /// Puts all linear axes that are solved for, rails among them, where they bring the tip nearest to the part origin: from
    /// there their words count.
    ///
    /// # Errors
    /// [`Unreachable::Linear`] if three linear axes span no volume at these angles.
    pub fn place_zero(&self, joints: &mut Joints, turns: &Turns) -> Result<(), Unreachable> {
        let SolutionMethod::Numeric { linear, surplus, .. } = &self.form else {
            return self.place(Vector3::zeros(), joints, turns);
        };
        let rails = surplus.iter().filter(|joint| !self.chain.joints()[**joint].rotary);
        let all: Vec<usize> = linear.iter().chain(rails).copied().collect();
        numeric::approach(&self.chain, &all, Vector3::zeros(), joints);
        Ok(())
    }

    /// Six rotary axes are an arm whose solutions come from formulas.
    pub fn has_arm(&self) -> bool {
        matches!(&self.form, SolutionMethod::Numeric { arm: Some(_), .. })
    }

    /// Joints of the chain in front of a robot's arm, rails among them; none of another chain.
    pub fn before_arm(&self) -> usize {
        match &self.form {
            SolutionMethod::Numeric { arm: Some(arm), .. } => arm.first(),
            _ => 0,
        }
    }

    /// Whether [`Solver::inverse`] gives solutions all around for the turn about the tool.
    pub fn spins(&self) -> bool {
        self.chain.edge().is_none() && self.has_arm()
    }

    /// The branch of a robot's arm on which the axes stand; 0 of other chains.
    pub fn branch_of_arm(&self, joints: &Joints) -> u8 {
        match &self.form {
            SolutionMethod::Numeric { arm: Some(arm), .. } => arm.branch(&self.chain, joints),
            _ => 0,
        }
    }

    /// The tool axis, and the direction that lies on the X of the machine frame laid across it where all joints are at zero:
    /// unit vectors, part frame. None where a tool that turns has no turn about itself to spare.
    pub fn stand(&self, joints: &Joints) -> Option<[Vector3<f64>; 2]> {
        let SolutionMethod::Numeric { framed: Some(framed), .. } = &self.form else {
            return None;
        };
        let stands = framed.forward(joints);
        Some([stands.axis, stands.edge])
    }

    /// The solution next to `from` at which the tool stands as a whole: `pose` has the second direction of
    /// [`Solver::stand`] for its edge. The joints in front of a robot's arm stand as in `from`. None where nothing is found.
    pub fn search_stand(&self, pose: &Pose, from: &Joints, tolerance: f64) -> Option<Joints> {
        let SolutionMethod::Numeric { framed: Some(framed), free, .. } = &self.form else {
            return None;
        };
        let first = self.before_arm();
        let moving = &free[free.partition_point(|joint| *joint < first)..];
        let mut left = numeric::STEPS;
        let (joints, miss) = numeric::solve(framed, moving, pose, from, &mut left);
        (miss < tolerance && self.verified(&joints, pose, tolerance.max(VERIFIED)))
            .then_some(joints)
    }

    /// Joints beyond what a pose needs, in the order of the chain: each solution has them wherever they stand. None of a
    /// chain with a closed form.
    pub fn surplus(&self) -> &[usize] {
        match &self.form {
            SolutionMethod::Numeric { surplus, .. } => surplus,
            SolutionMethod::Closed { .. } => &[],
        }
    }

    /// For a chain without a closed form: the solution next to `from`, verified, the joints of `holding` standing as they
    /// stand there.
    ///
    /// # Errors
    /// By how much the nearest pose misses.
    pub fn search_holding(
        &self,
        pose: &Pose,
        from: &Joints,
        holding: &[usize],
        tolerance: f64,
    ) -> Result<Joints, Unreachable> {
        self.holding_within(pose, from, holding, tolerance, &mut { numeric::STEPS })
    }

    /// The solution next to `from` at which the tool has the same heading: what is fixed on it keeps its angle against the X
    /// of the part, laid across the tool axis. None where a tool does not turn, or nothing is found.
    pub fn search_heading(&self, pose: &Pose, from: &Joints, tolerance: f64) -> Option<Joints> {
        let SolutionMethod::Numeric { framed: Some(framed), free, surplus, .. } = &self.form else {
            return None;
        };
        let stood = framed.forward(from);
        let across = |axis| square(Vector3::x(), axis);
        let heading = angle_about(stood.axis, across(stood.axis), stood.edge);
        let (sine, cosine) = libm::sincos(heading);
        let edge = turn(across(pose.axis), pose.axis, sine, cosine);
        let spin = surplus.iter().rev().find(|joint| self.chain.joints()[**joint].rotary);
        let moves = |joint: &usize| Some(joint) == spin || !surplus.contains(joint);
        let moving: Vec<usize> = free.iter().copied().filter(moves).collect();
        let mut left = numeric::STEPS;
        let (joints, _) = numeric::solve(framed, &moving, &Pose { edge, ..*pose }, from, &mut left);
        self.verified(&joints, pose, tolerance.max(VERIFIED)).then_some(joints)
    }

    fn holding_within(
        &self,
        pose: &Pose,
        from: &Joints,
        holding: &[usize],
        tolerance: f64,
        left: &mut usize,
    ) -> Result<Joints, Unreachable> {
        let SolutionMethod::Numeric { free, .. } = &self.form else {
            return Err(Unreachable::Linear);
        };
        let mut start = self.held;
        for joint in free {
            start[*joint] = from[*joint];
        }
        let mut moving = [0; super::MAX_AXES];
        let mut count = 0;
        for joint in free.iter().filter(|joint| !holding.contains(joint)) {
            moving[count] = *joint;
            count += 1;
        }
        let (mut joints, miss) = numeric::solve(&self.chain, &moving[..count], pose, &start, left);
        if let SolutionMethod::Numeric { linear, .. } = &self.form
            && linear.len() == 3
            && !self.chain.errors().is_empty()
        {
            // A lean that no axis takes out hides what is left of the tip in its rounding.
            numeric::approach(&self.chain, linear, pose.tip, &mut joints);
        }
        let tip = if count < 3 { self.tip_tolerance } else { 0.0 };
        match self.verified_within(&joints, pose, [tip, tolerance.max(VERIFIED)]) {
            true => Ok(joints),
            // Linear axes put the tip wherever it is wanted: what is missed is how the tool stands.
            false if self.places_tip() => {
                let reached = self.chain.forward(&joints);
                let axis = angle(reached.axis, pose.axis);
                Err(Unreachable::Axis { miss: axis.max(angle(reached.edge, pose.edge_across())) })
            }
            false => Err(Unreachable::Numeric { miss }),
        }
    }

    /// The solution next to `from`: with the surplus joints where they stand as long as the others go little so, or else
    /// the one over which all joints move least.
    pub(super) fn search_surplus(
        &self,
        pose: &Pose,
        from: &Joints,
        tolerance: f64,
        left: &mut usize,
    ) -> Result<Joints, Unreachable> {
        let all = *left;
        let held = self.holding_within(pose, from, self.surplus(), tolerance, left);
        let way = held.as_ref().map_or(f64::INFINITY, |held| self.largest_way(from, held));
        if way <= LITTLE || self.surplus().is_empty() {
            return held;
        }
        let mut again = numeric::STEPS.min(all);
        let freed = self.holding_within(pose, from, &[], tolerance, &mut again);
        match (held, freed) {
            (Ok(held), Ok(freed)) => {
                let turn = self.largest_turn(from, &held);
                let nearer = match turn > FAR {
                    true => self.largest_turn(from, &freed) < turn,
                    false => self.largest_way(from, &freed) < WORTH * way,
                };
                Ok(if nearer { freed } else { held })
            }
            (Err(_), freed) => freed,
            (held, Err(_)) => held,
        }
    }

    /// The largest way of a joint, radians, mm of one that slides on its arm.
    fn largest_way(&self, from: &Joints, to: &Joints) -> f64 {
        let joints = self.chain.joints().iter().enumerate();
        let unit = |rotary: bool| if rotary { 1.0 } else { ARM };
        let ways =
            joints.map(|(place, joint)| libm::fabs(to[place] - from[place]) / unit(joint.rotary));
        ways.fold(0.0, f64::max)
    }

    /// The largest turn of a joint, radians.
    pub fn largest_turn(&self, from: &Joints, to: &Joints) -> f64 {
        let joints = self.chain.joints().iter().enumerate().filter(|(_, joint)| joint.rotary);
        joints.map(|(joint, _)| libm::fabs(to[joint] - from[joint])).fold(0.0, f64::max)
    }
}
