//! A machine ready to be asked: its solver, where its axes stand at rest, and its travel.

use std::cell::Cell;
use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::settings;
use crate::dependent_limit::DependentLimit;
use crate::description::{Machine, Pole, Positions, SHARE_AT_POLES};
use crate::halton;
use crate::kinematics::orientation::angle;
use crate::kinematics::travel::passed;
use crate::kinematics::{Chain, Joint, Joints, MAX_AXES, NoClosedForm, Pose, Solver, Unreachable};

/// Searches for one pose of a chain without a closed form, and the steps that they take together at most.
pub(super) const STARTS: u32 = 32;
const STEPS: usize = 1200;

/// A value is inside travel if it passes an end by no more than this, mm or radians.
const GRACE: f64 = 1e-9;

/// A direction that is missed by no more than this is made, where borders are looked for: radians.
pub(super) const EXACT: f64 = 1e-7;

/// Where in their travel the axes stand for a look at what moves: shares of it.
const SETTINGS: [f64; 4] = [0.31, 0.47, 0.62, 0.83];

/// What was asked of the inverse, so that a check has an end by design on every chain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InverseWork {
    /// Poses that the inverse was asked for.
    pub poses: usize,
    /// Steps of numeric searches; none where there is a closed form.
    pub steps: usize,
}

/// Step of a difference quotient, radians.
const STEP: f64 = 1e-5;

/// A machine with a tool in it.
#[derive(Clone, Debug)]
pub struct Probe<'a> {
    machine: &'a Machine,
    /// See [`settings::solvers`].
    solvers: Vec<Solver>,
    length: f64,
    work: Cell<InverseWork>,
    /// Axis values at rest: the drawing's zero, or the nearest value inside travel; an indexed axis where it starts.
    home: Joints,
    freedom: usize,
}

impl<'a> Probe<'a> {
    /// `machine` with a tool of `length` mm.
    ///
    /// # Errors
    /// What the chain lacks.
    pub fn new(machine: &'a Machine, length: f64) -> Result<Self, NoClosedForm> {
        let mut home = [0.0; MAX_AXES];
        for (value, axis) in home.iter_mut().zip(&machine.axes) {
            if let Some(indexed) = &axis.indexed {
                *value = indexed.start;
            } else if let Some([least, most]) = axis.travel {
                *value = 0f64.clamp(least, most);
            }
        }
        let mut probe = Self {
            machine,
            solvers: settings::solvers(machine, length)?,
            length,
            work: Cell::default(),
            home,
            freedom: 0,
        };
        probe.freedom = probe.measure_freedom();
        Ok(probe)
    }

    /// The machine.
    pub fn machine(&self) -> &'a Machine {
        self.machine
    }

    /// Length of the tool, mm.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// The machine's chain with the tool in it.
    pub fn chain(&self) -> &Chain {
        self.solver().chain()
    }

    /// The machine's solver with the index axes where they start.
    pub(super) fn solver(&self) -> &Solver {
        // There is always one.
        &self.solvers[0]
    }

    /// What was asked of the inverse up to now.
    pub fn work(&self) -> InverseWork {
        self.work.get()
    }

    pub(super) fn count(&self, poses: usize, steps: usize) {
        let work = self.work.get();
        self.work.set(InverseWork { poses: work.poses + poses, steps: work.steps + steps });
    }

    /// Axis values at rest.
    pub fn home(&self) -> &Joints {
        &self.home
    }

    /// Number of independent ways in which the tool axis can move: 0, 1 (along a curve) or 2 (over an area).
    pub fn freedom(&self) -> usize {
        self.freedom
    }

    /// Places of the rotary axes that point the tool.
    pub fn free(&self) -> Vec<usize> {
        self.machine.pointing()
    }

    /// The solutions come from formulas.
    pub fn closed_form(&self) -> bool {
        self.solver().closed_form()
    }

    /// Least and largest value of an axis; of one that turns without end, half a turn to both sides.
    pub fn span(&self, place: usize) -> [f64; 2] {
        let axis = &self.machine.axes[place];
        match (&axis.indexed, axis.travel) {
            (Some(indexed), _) if self.machine.redundant().contains(&place) => [indexed.start; 2],
            (_, Some(travel)) => travel,
            (_, None) => [-PI, PI],
        }
    }

    /// Where a search begins: at rest first, then at places spread over the travels.
    pub fn start(&self, number: u32) -> Joints {
        let mut joints = self.home;
        if number > 0 {
            let moving = self.machine.axes.iter().enumerate();
            let moving = moving.filter(|(_, axis)| axis.indexed.is_none());
            for ((place, _), share) in moving.zip(halton::place(number)) {
                let [least, most] = self.span(place);
                joints[place] = least + (most - least) * share;
            }
        }
        joints
    }

    /// All ways to put the tip on `tip` with the tool axis along `axis` (part frame), the index axes where they start;
    /// turns and travel left aside. Without a closed form: those that a bounded search finds.
    ///
    /// # Errors
    /// Why there is none.
    pub fn inverse(
        &self,
        tip: Vector3<f64>,
        axis: Vector3<f64>,
    ) -> Result<Vec<Joints>, Unreachable> {
        self.solved(self.solver(), tip, axis, EXACT)
    }

    fn solved(
        &self,
        solver: &Solver,
        tip: Vector3<f64>,
        axis: Vector3<f64>,
        tolerance: f64,
    ) -> Result<Vec<Joints>, Unreachable> {
        let pose = Pose { tip, axis, ..Pose::default() };
        if !solver.closed_form() && !solver.planar() {
            let mut left = STEPS;
            let starts = (0..STARTS).map(|number| self.start(number));
            let found = solver.inverse_from(&pose, starts, tolerance, &mut left);
            self.count(1, STEPS - left);
            return found;
        }
        self.count(1, 0);
        solver.inverse(&pose, &self.home, tolerance)
    }

    /// The ways of posting to put the tip on the part origin with the tool axis along `axis` (part frame): within the
    /// machine's `axis_tolerance`, index axes at one of their positions, angles inside travel and on the turns nearest
    /// to rest.
    pub fn stands(&self, axis: Vector3<f64>) -> Vec<Joints> {
        let tolerance = self.machine.accuracy.axis_tolerance;
        let mut stands = Vec::new();
        for solver in &self.solvers {
            let found = self.solved(solver, Vector3::zeros(), axis, tolerance);
            for joints in found.unwrap_or_default() {
                if let Some(joints) = self.at_positions(solver, &joints, tolerance) {
                    let inside = self.inside(&joints);
                    stands.extend(inside.or_else(|| self.at_ends(solver, &joints, axis)));
                }
            }
        }
        stands
    }

    /// `joints` with the index axes that are solved for on their positions; none if one is farther from each of them
    /// than `tolerance`, radians.
    fn at_positions(&self, solver: &Solver, joints: &Joints, tolerance: f64) -> Option<Joints> {
        let mut at = *joints;
        for place in self.free() {
            at[place] = self.position(place, joints[place]);
            if libm::fabs(at[place] - joints[place]) > tolerance {
                return None;
            }
        }
        if at != *joints {
            let turns = solver.chain().turns(&at);
            solver.place(Vector3::zeros(), &mut at, &turns).ok()?;
        }
        Some(at)
    }

    /// The position next to `value` of an axis that stands at some alone; of any other `value` itself.
    fn position(&self, place: usize, value: f64) -> f64 {
        let axis = &self.machine.axes[place];
        let Some(indexed) = &axis.indexed else {
            return value;
        };
        // Full turns make other positions of a list: the nearest of all.
        let endless = axis.travel.is_none();
        let positions =
            [0.0, TAU, -TAU].map(|turn| indexed.positions.nearest(value + turn, endless) - turn);
        let away = |position: &f64| libm::fabs(position - value);
        let nearest = positions.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)));
        nearest.unwrap_or(value)
    }

    /// Every index axis of `places` has a position where `joints` has it, within the machine's `axis_tolerance`.
    pub fn has_positions(&self, places: &[usize], joints: &Joints) -> bool {
        places.iter().all(|place| {
            let away = self.position(*place, joints[*place]) - joints[*place];
            libm::fabs(away) <= self.machine.accuracy.axis_tolerance
        })
    }

    /// Close to a pole an axis that would tilt beyond its end stays there, if the tool axis keeps its tolerance.
    fn at_ends(&self, solver: &Solver, joints: &Joints, wanted: Vector3<f64>) -> Option<Joints> {
        let pole = solver.pole_joint()?;
        if self.machine.solution.pole != Pole::Blend {
            return None;
        }
        let tolerance = self.machine.accuracy.axis_tolerance;
        let mut at = *joints;
        for place in self.free().into_iter().filter(|place| *place != pole) {
            if let Some([least, most]) = self.machine.axes[place].travel {
                let value = at[place].clamp(least, most);
                if libm::fabs(value - at[place]) < tolerance {
                    at[place] = value;
                }
            }
        }
        let turns = solver.chain().turns(&at);
        solver.place(Vector3::zeros(), &mut at, &turns).ok()?;
        if angle(solver.chain().forward(&at).axis, wanted) > SHARE_AT_POLES * tolerance {
            return None;
        }
        self.inside(&at)
    }

    /// Index axes that are solved for and stand at positions alone: places in the chain.
    pub fn at_positions_alone(&self) -> Vec<usize> {
        let mut places = self.free();
        places.retain(|place| {
            let indexed = self.machine.axes[*place].indexed.as_ref();
            indexed.is_some_and(|indexed| indexed.positions != Positions::Any)
        });
        places
    }

    /// How many full turns of the rotary values of `joints` lie inside travel; an axis that turns without end
    /// counts once. None where a limit between rotary axes alone does not hold.
    pub fn turns(&self, joints: &Joints) -> usize {
        let mut limits = self.rotary_limits().peekable();
        if limits.peek().is_some()
            && let Some(inside) = self.inside(joints)
            && !limits.all(|limit| limit.holds(&inside))
        {
            return 0;
        }
        let mut count = 1;
        for place in self.free() {
            if let Some([least, most]) = self.machine.axes[place].travel {
                let first = libm::ceil((least - joints[place] - GRACE) / TAU);
                let last = libm::floor((most - joints[place] + GRACE) / TAU);
                count *= (last - first + 1.0).max(0.0) as usize;
            }
        }
        count
    }

    /// Limits that name rotary axes alone: they say where the tool can point, wherever the tip is.
    pub(super) fn rotary_limits(&self) -> impl Iterator<Item = &'a DependentLimit> {
        let axes = &self.machine.axes;
        let rotary = |limit: &&DependentLimit| limit.joints().all(|joint| axes[joint].joint.rotary);
        self.machine.limits.iter().filter(rotary)
    }

    /// The rotary values of `joints` on the turns inside travel that are nearest to rest; none if an axis has
    /// no such turn.
    pub fn inside(&self, joints: &Joints) -> Option<Joints> {
        let mut inside = *joints;
        for place in self.free() {
            let home = self.home[place];
            let nearest = joints[place] - TAU * libm::rint((joints[place] - home) / TAU);
            let travel = self.machine.axes[place].travel;
            let within = |value: f64| passed(travel, value, GRACE).is_none();
            inside[place] =
                [nearest, nearest + TAU, nearest - TAU].into_iter().find(|value| within(*value))?;
        }
        Some(inside)
    }

    /// Ways to point the tool along `axis` (part frame) inside the travel of the rotary axes, whichever positions index
    /// axes have there: those that are not solved for are tried at each of theirs, the others taken to stand anywhere.
    pub fn ways(&self, axis: Vector3<f64>) -> usize {
        let solved = self
            .solvers
            .iter()
            .map(|solver| self.solved(solver, Vector3::zeros(), axis, EXACT).unwrap_or_default());
        solved.flatten().map(|joints| self.turns(&joints)).sum()
    }

    /// Some way makes the tool axis `axis`.
    pub fn makes(&self, axis: Vector3<f64>) -> bool {
        self.solvers.iter().any(|solver| {
            self.solved(solver, Vector3::zeros(), axis, EXACT)
                .is_ok_and(|found| found.iter().any(|joints| self.turns(joints) > 0))
        })
    }

    /// See [`Solver::ways`], the most over some settings: a setting may happen to be singular.
    pub(super) fn ways_by_search(&self) -> Option<[usize; 2]> {
        let settings = SETTINGS.map(|share| self.somewhere(share));
        settings
            .iter()
            .chain([&self.home])
            .filter_map(|joints| {
                self.solver().ways(joints, |place| self.machine.axes[place].indexed.is_some())
            })
            .reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
    }

    /// The axes that point the tool somewhere in their travel, the others at rest.
    fn somewhere(&self, share: f64) -> Joints {
        let mut joints = self.home;
        for (index, place) in self.free().iter().enumerate() {
            let [least, most] = self.span(*place);
            let share = share + 0.07 * index as f64;
            joints[*place] = least + (most - least) * (share - libm::floor(share));
        }
        // On the line of the rotary axis it moves nothing.
        let slides = self.machine.axes.iter().map(|axis| !axis.joint.rotary).enumerate();
        for (place, _) in slides.filter(|(_, slides)| *slides && self.solver().planar()) {
            let [least, most] = self.span(place);
            joints[place] = least + (most - least) * share;
        }
        joints
    }

    /// `vector` as a given run of the chain's rotary axes turns it, the axes standing at `values`.
    pub fn turned(
        &self,
        places: impl Iterator<Item = usize>,
        values: &Joints,
        vector: Vector3<f64>,
    ) -> Vector3<f64> {
        let mut run: Vec<Joint> = Vec::new();
        let mut angles = [0.0; MAX_AXES];
        for place in places {
            let joint = self.chain().joints()[place];
            if joint.rotary {
                angles[run.len()] = values[place];
                run.push(joint);
            }
        }
        Chain::new(run, Vector3::zeros(), Vector3::zeros(), vector).forward(&angles).axis
    }

    /// The rank of what the free rotary axes do to the tool axis, the largest over some settings: a setting may
    /// happen to be singular.
    fn measure_freedom(&self) -> usize {
        let free = self.free();
        let mut freedom = 0;
        for share in SETTINGS {
            let joints = self.somewhere(share);
            let slopes: Vec<Vector3<f64>> = free
                .iter()
                .map(|place| {
                    let (mut ahead, mut behind) = (joints, joints);
                    ahead[*place] += STEP;
                    behind[*place] -= STEP;
                    let chain = self.chain();
                    (chain.forward(&ahead).axis - chain.forward(&behind).axis) / (2.0 * STEP)
                })
                .collect();
            for (index, slope) in slopes.iter().enumerate() {
                if slope.norm() > 1e-4 {
                    freedom = freedom.max(1);
                }
                if slopes[..index].iter().any(|other| other.cross(slope).norm() > 1e-4) {
                    return 2;
                }
            }
        }
        freedom
    }
}

/// A direction in words: `+X` within half a degree of an axis of the frame, else its three numbers.
pub fn named(direction: Vector3<f64>) -> String {
    match principal(direction) {
        Some((index, sign)) => {
            format!("{}{}", if sign > 0.0 { '+' } else { '-' }, ["X", "Y", "Z"][index])
        }
        None => {
            let [x, y, z] = [direction.x, direction.y, direction.z]
                .map(|number| format!("{:.3}", number + 0.0).replace("-0.000", "0.000"));
            format!("({x}, {y}, {z})")
        }
    }
}

/// Which axis of the frame a direction lies along within half a degree, and on which side.
pub fn principal(direction: Vector3<f64>) -> Option<(usize, f64)> {
    let index = direction.iamax();
    let along = direction[index];
    let across = libm::sqrt((direction.norm_squared() - along * along).max(0.0));
    (across < 0.0087 * direction.norm()).then_some((index, if along > 0.0 { 1.0 } else { -1.0 }))
}
