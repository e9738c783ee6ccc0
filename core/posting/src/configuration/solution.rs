//! The ways to stand at a point: every branch of the inverse on every full turn inside travel.

use std::f64::consts::TAU;

use super::metric::wrong_side;
use post_machine::dependent_limit::DependentLimit;
use post_machine::description::{Machine, Positions, Side};
use post_machine::kinematics::choose::RotaryTravel;
use post_machine::kinematics::orientation::{Branches, angle};
use post_machine::kinematics::travel::{OverTravel, over, passed};
use post_machine::kinematics::{AxisBits, Joints, Pose, Solver, Unreachable};

/// One solution, its angles on the turn around zero.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AxisSolution {
    /// Axis values: pointing angles in -π to π.
    pub joints: Joints,
    /// Which branch of the inverse; stands of one branch at neighbouring points go on from one another.
    pub branch: u8,
    /// Joints that turn nothing here and keep their last value, one bit each.
    pub free: AxisBits,
}

/// What the choice needs to know of the axes.
#[derive(Clone, Debug)]
pub(crate) struct ChoiceAxes {
    pub(super) turning: Vec<RotaryAxis>,
    /// Axes among them whose full turns are nothing to the machine, one bit each: they have no travel, and no side of
    /// zero counts.
    pub(super) endless: AxisBits,
    /// Off the part axes without travel may be turned the longer way round as well.
    pub(super) both_ways: bool,
    pub(super) linear: Vec<RotaryTravel>,
    /// What must hold between the axes.
    limits: Vec<DependentLimit>,
    /// Joints that move off the part alone.
    pub(super) indexed: Vec<usize>,
    pub(super) axis_tolerance: f64,
    /// What a pole joint may be off by, as an angle of the tool axis, radians.
    freedom: f64,
    /// Band of [`Solver::band`]; and the cosines of the two.
    band: Option<[f64; 2]>,
    cosines: Option<[f64; 2]>,
}

/// A rotary axis that is solved for.
#[derive(Clone, Debug)]
pub(super) struct RotaryAxis {
    pub(super) joint: usize,
    pub(super) travel: Option<[f64; 2]>,
    pub(super) positions: Option<Positions>,
    /// What the control shows must lie on this side, and what it shows at zero.
    pub(super) require: Option<Side>,
    pub(super) zero: f64,
    /// Whether this is the pole joint.
    pub(super) first: bool,
}

impl RotaryAxis {
    #[inline]
    pub(super) fn forbids(&self, value: f64) -> bool {
        self.require.is_some_and(|side| wrong_side(value + self.zero, side))
    }

    /// It goes on towards an end of its travel that is nearer than `way`.
    pub(super) fn ends_towards(&self, from: &Joints, to: &Joints, way: f64) -> bool {
        let (from, to) = (from[self.joint], to[self.joint]);
        self.travel.is_some_and(|[least, most]| {
            (to < from && to - least < way) || (to > from && most - to < way)
        })
    }

    /// Inside travel, and on no side that is forbidden.
    #[inline]
    pub(super) fn allows(&self, value: f64) -> bool {
        passed(self.travel, value, 0.0).is_none() && !self.forbids(value)
    }
}

/// What was found at a point beside the stands themselves.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SolutionSummary {
    /// Sine and cosine of [`Branches::latitude`].
    pub latitude: (f64, f64),
    /// Solutions, inside travel or not.
    pub solutions: usize,
    /// Why the solution that fails least is no stand.
    pub over: Option<OverTravel>,
}

impl SolutionSummary {
    /// Records the number of solutions of a chain without a closed form, whose poles are not known.
    pub(super) fn by_search(solutions: usize) -> Self {
        Self { latitude: (1.0, 0.0), solutions, over: None }
    }
}

/// A cosine beyond this is that of a pole.
const AT_POLE: f64 = 1.0 - 1e-12;

/// All branches are asked for.
pub(crate) fn both(_: &Branches) -> [bool; 2] {
    [true; 2]
}

/// Linear positions are checked before they are rounded: so far beyond the end is left to the rounding, mm.
const SLACK: f64 = 2e-3;

impl ChoiceAxes {
    /// `printed` gives the values of a rotary joint that are printed inside its travel, radians.
    pub(crate) fn new(
        machine: &Machine,
        solver: &Solver,
        freedom: f64,
        printed: impl Fn(usize, [f64; 2]) -> [f64; 2],
    ) -> Self {
        let pointing = machine.pointing();
        let side = |joint: usize| {
            let require = &machine.solution.require;
            require.iter().find(|(place, _)| *place == joint).map(|(_, side)| *side)
        };
        let turning = pointing
            .iter()
            .map(|&joint| {
                let axis = &machine.axes[joint];
                let positions = axis.indexed.as_ref().map(|indexed| indexed.positions.clone());
                RotaryAxis {
                    joint,
                    travel: axis.travel.map(|travel| printed(joint, travel)),
                    positions: positions.filter(|positions| *positions != Positions::Any),
                    require: side(joint),
                    zero: axis.zero,
                    first: solver.pole_joint() == Some(joint),
                }
            })
            .collect();
        let linear = machine
            .axes
            .iter()
            .enumerate()
            .filter(|(_, axis)| !axis.joint.rotary)
            .filter_map(|(joint, axis)| axis.travel.map(|travel| RotaryTravel { joint, travel }))
            .collect();
        let sides = machine.solution.prefer.iter();
        let sides = sides.chain(&machine.solution.require);
        let sided = sides.fold(0, |sided: AxisBits, (joint, _)| sided | 1 << joint);
        let endless = pointing
            .iter()
            .filter(|joint| machine.axes[**joint].travel.is_none())
            .fold(0, |endless: AxisBits, joint| endless | 1 << joint);
        let indexed = (0..machine.axes.len())
            .filter(|joint| machine.axes[*joint].indexed.is_some())
            .collect();
        Self {
            turning,
            endless: endless & !sided,
            both_ways: false,
            linear,
            limits: machine.limits.clone(),
            indexed,
            axis_tolerance: machine.accuracy.axis_tolerance,
            freedom,
            band: solver.band(),
            cosines: solver.band().map(|band| band.map(libm::cos)),
        }
    }

    /// How far the tool axis is from where the branches meet, radians; infinite where they never do.
    pub(crate) fn margin(&self, (sine, cosine): (f64, f64)) -> f64 {
        let Some([least, most]) = self.band else {
            return f64::INFINITY;
        };
        let latitude = libm::atan2(sine, cosine);
        (latitude - least).min(most - latitude).max(0.0)
    }

    /// Is the tool axis certainly farther than `way` from where the branches meet? Cheap, and nearly always enough.
    #[inline]
    pub(crate) fn far(&self, (sine, cosine): (f64, f64), way: f64) -> bool {
        let Some([least, most]) = self.cosines else {
            return true;
        };
        // An angle is no smaller than its sine, and no smaller than what the cosine changes by.
        let from_least =
            if least > AT_POLE { sine > way || cosine < 0.0 } else { cosine < least - way };
        let from_most =
            if most < -AT_POLE { sine > way || cosine > 0.0 } else { cosine > most + way };
        from_least && from_most
    }

    /// [`ChoiceAxes::far`] of many points, their least sine and the ends of their cosines being these; none of which is in
    /// doubt.
    pub(super) fn all_far(
        &self,
        sine: f64,
        [least_cosine, most_cosine]: [f64; 2],
        way: f64,
    ) -> bool {
        let Some([least, most]) = self.cosines else {
            return true;
        };
        let from_least = if least > AT_POLE { sine > way } else { most_cosine < least - way };
        let from_most = if most < -AT_POLE { sine > way } else { least_cosine > most + way };
        from_least && from_most
    }

    /// Full turns and travel alone tell a solution from others: no axis has positions, or a side that counts.
    pub(super) fn turns_freely(&self) -> bool {
        self.indexed.is_empty()
            && self.turning.iter().all(|axis| axis.positions.is_none() && axis.require.is_none())
    }

    /// Keeps what fails least of two solutions: a length, which mount and tool may mend, before an angle.
    pub(super) fn keep_least(&self, kept: &mut Option<OverTravel>, over: OverTravel) {
        let by = |over: &OverTravel| {
            let angle = self.linear.iter().all(|limit| limit.joint != over.joint);
            (angle, libm::fabs(over.value - over.limit))
        };
        if kept.as_ref().is_none_or(|kept| by(&over) < by(kept)) {
            *kept = Some(over);
        }
    }

    /// Adds the stands at `pose` to `stands`; `last` is kept by joints that are free there, and `going` says
    /// which branches are asked for.
    ///
    /// # Errors
    /// Why there is no solution at all.
    #[inline]
    pub(crate) fn stands(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        going: &dyn Fn(&Branches) -> [bool; 2],
        stands: &mut Vec<AxisSolution>,
    ) -> Result<SolutionSummary, Unreachable> {
        if !solver.surplus().is_empty() {
            return self.surplus_stands(solver, pose, last, stands);
        }
        if !solver.closed_form() {
            return self.searched(solver, pose, last, stands);
        }
        let branches = solver.orient(pose, self.axis_tolerance)?;
        let going = going(&branches);
        self.branches(solver, pose, &branches, last, going, stands)
    }

    #[inline]
    fn branches(
        &self,
        solver: &Solver,
        pose: &Pose,
        branches: &Branches,
        last: &Joints,
        going: [bool; 2],
        stands: &mut Vec<AxisSolution>,
    ) -> Result<SolutionSummary, Unreachable> {
        let mut found = SolutionSummary {
            latitude: branches.latitude(),
            solutions: branches.count(),
            over: None,
        };
        let mut flat = None;
        for index in (0..branches.count()).filter(|index| going[*index]) {
            let mut set = solver.angles(branches, index);
            if set.free != 0 {
                set.keep(last);
            }
            if let Err(over) = self.at_rest(&mut set.joints) {
                self.keep_least(&mut found.over, over);
                continue;
            }
            // Where an angle was brought onto a position its sine is not that of the set: a little off, and
            // the place is settled later.
            let turns = solver.turns(&set);
            let mut joints = set.joints;
            if let Err(unreachable) = solver.place(pose.tip, &mut joints, &turns) {
                flat = Some(unreachable);
                continue;
            }
            if let Some(over) = self.beyond(&joints) {
                self.keep_least(&mut found.over, over);
                continue;
            }
            stands.push(AxisSolution { joints, branch: index as u8, free: set.free });
        }
        match flat {
            Some(unreachable) if stands.is_empty() && found.over.is_none() => Err(unreachable),
            _ => Ok(found),
        }
    }

    /// Where the axes stand at `pose` on one branch, going on from `last` in a cut that turns the tool axis by no more
    /// than half of `way`. None on any doubt: an angle that is free, an axis beyond its travel or near its end, an
    /// index axis that would have to move.
    #[inline]
    pub(crate) fn carried_on(
        &self,
        solver: &Solver,
        pose: &Pose,
        (branches, branch): (&Branches, u8),
        last: &Joints,
        way: f64,
    ) -> Option<Joints> {
        let mut set = solver.angles(branches, usize::from(branch));
        if set.free != 0 {
            return None;
        }
        self.at_rest(&mut set.joints).ok()?;
        let turns = solver.turns(&set);
        let mut stand = AxisSolution { joints: set.joints, branch, free: 0 };
        solver.place(pose.tip, &mut stand.joints, &turns).ok()?;
        if self.beyond(&stand.joints).is_some() {
            return None;
        }
        let mut joints = self.carried(&stand, last).ok()?;
        let still = !self.near_end(last, &joints, way)
            && self.stand_still(last, &mut joints)
            && self.within_limits(&joints);
        still.then_some(joints)
    }

    /// The stands of a chain without a closed form.
    fn searched(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        stands: &mut Vec<AxisSolution>,
    ) -> Result<SolutionSummary, Unreachable> {
        let solutions = solver.inverse(pose, last, self.axis_tolerance)?;
        let mut found = SolutionSummary::by_search(solutions.len());
        for (branch, mut joints) in solutions.into_iter().enumerate() {
            let over = match self.at_rest(&mut joints) {
                Ok(()) => self.beyond(&joints),
                Err(over) => Some(over),
            };
            match over {
                None => stands.push(AxisSolution { joints, branch: branch as u8, free: 0 }),
                Some(over) => {
                    self.keep_least(&mut found.over, over);
                }
            }
        }
        Ok(found)
    }

    /// Brings angles onto the positions of index axes, and checks that every axis can stand there at all.
    #[inline]
    pub(super) fn at_rest(&self, joints: &mut Joints) -> Result<(), OverTravel> {
        for axis in &self.turning {
            let joint = axis.joint;
            if let Some(positions) = &axis.positions {
                let value = joints[joint];
                // Full turns make other positions of a list: the nearest of all.
                let nearest = (-1..=1)
                    .map(|turn| f64::from(turn) * TAU)
                    .map(|turn| positions.nearest(value + turn, axis.travel.is_none()) - turn)
                    .min_by(|a, b| libm::fabs(a - value).total_cmp(&libm::fabs(b - value)))
                    .unwrap_or(value);
                if libm::fabs(nearest - value) > self.axis_tolerance {
                    return Err(OverTravel { joint, value, limit: nearest });
                }
                joints[joint] = nearest;
            }
            if let Some([least, most]) = axis.travel {
                // Angles lie around zero, so few turns lead to the least value inside travel; a loop costs less
                // than a call.
                let mut first = joints[joint];
                while first < least {
                    first += TAU;
                }
                while first - TAU >= least {
                    first -= TAU;
                }
                if first > most {
                    let middle = (least + most) / 2.0;
                    let asked = unwound(joints[joint], middle);
                    return Err(OverTravel {
                        joint,
                        value: asked,
                        limit: if asked > most { most } else { least },
                    });
                }
            }
        }
        Ok(())
    }

    /// Every axis may stand there.
    pub(super) fn reaches(&self, joints: &Joints) -> bool {
        let mut turning = self.turning.iter();
        turning.all(|axis| axis.allows(joints[axis.joint]))
            && self.beyond(joints).is_none()
            && self.within_limits(joints)
    }

    /// What must hold between the axes holds; travel is not asked for.
    pub(super) fn within_limits(&self, joints: &Joints) -> bool {
        self.limits.iter().all(|limit| limit.holds(joints))
    }

    /// Something must hold between the axes.
    pub(super) fn has_limits(&self) -> bool {
        !self.limits.is_empty()
    }

    #[inline]
    pub(super) fn beyond(&self, joints: &Joints) -> Option<OverTravel> {
        for limit in &self.linear {
            let value = joints[limit.joint];
            if let Err(over) = over(limit.joint, Some(limit.travel), value, SLACK) {
                return Some(over);
            }
        }
        None
    }

    /// Holds the pole joint where `last` has it: the solution that misses the wanted axis least.
    /// `turned` is how far that joint was turned from where the others of `last` belong to it, radians.
    pub(crate) fn held(
        &self,
        solver: &Solver,
        pose: &Pose,
        last: &Joints,
        turned: f64,
    ) -> Option<AxisSolution> {
        let pole = solver.pole_joint()?;
        let mut joints = *solver.held();
        for axis in &self.turning {
            joints[axis.joint] = last[axis.joint];
        }
        solver.follow(pose, &mut joints);
        // Of three axes the third turns against the first, or with it if it points the other way.
        let third = self.turning.get(2).map(|axis| axis.joint);
        let sense = match third {
            Some(_) if turned != 0.0 => {
                let branches = solver.orient(pose, self.axis_tolerance).ok()?;
                branches.latitude().1.signum()
            }
            _ => 0.0,
        };
        let against = |joint: usize| {
            if third == Some(joint) { sense * turned } else { 0.0 }
        };
        for axis in &self.turning {
            if axis.joint != pole {
                let near = last[axis.joint] - against(axis.joint);
                joints[axis.joint] = unwound(joints[axis.joint], near);
            }
            if axis.positions.is_some() {
                return None;
            }
        }
        // One that would tilt to the other side of the pole and cannot stays at its end, if that is near enough.
        let mut at_end = false;
        for axis in &self.turning {
            let value = joints[axis.joint];
            if let Some([least, most]) = axis.travel.filter(|_| !axis.first) {
                let inside = value.max(least).min(most);
                if inside != value && (inside - value).abs() < self.axis_tolerance {
                    joints[axis.joint] = inside;
                    at_end = true;
                }
            }
        }
        if at_end {
            let reached = solver.chain().forward(&joints);
            if angle(reached.axis, pose.axis) > self.freedom {
                return None;
            }
        }
        let turns = solver.chain().turns(&joints);
        solver.place(pose.tip, &mut joints, &turns).ok()?;
        let stand = AxisSolution { joints, branch: 0, free: 0 };
        self.reaches(&joints).then_some(stand)
    }

    /// Where there is no closed form: the solution next to `last`, inside travel or not.
    pub(crate) fn next(&self, solver: &Solver, pose: &Pose, last: &Joints) -> Option<Joints> {
        solver.search(pose, last, self.axis_tolerance).ok()
    }

    /// Travel of a rotary axis that is solved for.
    pub(crate) fn travel(&self, joint: usize) -> [f64; 2] {
        self.turning
            .iter()
            .find(|axis| axis.joint == joint)
            .and_then(|axis| axis.travel)
            .unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
    }
}

/// `angle` on the turn nearest to `last`.
pub(super) fn unwound(angle: f64, last: f64) -> f64 {
    angle + TAU * f64::round((last - angle) / TAU)
}
