//! A node: one point of the path with the axis values chosen for it, as they will be printed.

use std::cell::Cell;
use std::f64::consts::TAU;

use nalgebra::Vector3;

use super::bound::DeviationBound;
use super::certificate::{chord_angle, larger};
use post_plugin::Format;

use post_machine::axis_words::{AxisWords, WordValues};
use post_machine::description::{ControlPoint, Machine, Tcp};
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::batch::Column;
use post_machine::kinematics::choose::{RotaryAxes, RotaryTravel};
use post_machine::kinematics::travel::{AT_END, OverTravel, over};
use post_machine::kinematics::{Joints, MAX_AXES, Pose, Solver, Trace, Unreachable};
use post_machine::tilted_plane::TiltedPlane;
use post_machine::vector_choice::{AIMED, VectorChoice};

/// A point of the path, solved and rounded.
#[derive(Clone, Copy, Debug, Default)]
pub struct PathNode {
    /// Place within its move, 0 to 1.
    pub t: f64,
    /// What the CL file asks for.
    pub target: Pose,
    /// The printed words.
    pub words: WordValues,
    /// The chain at the printed words.
    pub trace: Trace,
    /// Where the tip stands at the end: by the chain, or by the control that keeps it.
    pub tip: Vector3<f64>,
    /// How far the tip is off its target by rounding, mm.
    pub tip_error: f64,
    /// How far the tool axis is off, radians.
    pub axis_error: f64,
}

impl PathNode {
    /// How far the tip is off its target, mm, part frame.
    #[inline]
    pub fn off(&self) -> Vector3<f64> {
        self.tip - self.target.tip
    }

    /// Fills in how far tip and tool axis are off their target.
    #[inline]
    pub(super) fn measure(&mut self) {
        let (reached, wanted) = (&self.trace.pose, &self.target);
        self.axis_error = chord_angle((reached.axis - wanted.axis).norm());
        // Zero for a tool that turns.
        if reached.edge != Vector3::zeros() {
            let edge_error = chord_angle((reached.edge - wanted.edge_across()).norm());
            self.axis_error = self.axis_error.max(edge_error);
        }
        self.tip_error = self.off().norm();
    }
}

/// A control that shows an axis over one turn takes the shorter way: no block turns it by more, radians.
pub(super) const LONGEST: f64 = 2.9;

/// Rotary axes that are farther apart stand elsewhere, radians.
const ELSEWHERE: f64 = 1e-6;

/// Sum of all that the chain is long, its linear axes at zero, mm.
fn reach(machine: &Machine, solver: &Solver) -> f64 {
    let chain = solver.chain();
    let points = chain.joints().iter().map(|joint| 2.0 * joint.point.norm());
    points.sum::<f64>() + chain.tip().norm() + machine.mount.norm()
}

/// Why a point has no node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlacementError {
    /// The chain cannot reach it.
    Unreachable(Unreachable),
    /// Every solution leaves the travel of some axis; this is the one of the nearest solution.
    OverTravel {
        /// Which axis, by how much.
        over: OverTravel,
        /// How many solutions there were; 0 on the way between two places, where one was looked for.
        tried: usize,
    },
    /// A solution does not stand up to the forward product.
    Unverified {
        /// Distance by which the tip misses, mm.
        tip: f64,
        /// Angle by which the tool axis misses, radians.
        axis: f64,
    },
}

/// Solves points one after the other.
#[derive(Clone, Debug)]
pub struct Placer {
    solver: Solver,
    pub(super) words: AxisWords,
    turning: RotaryAxes,
    pub(super) linear: Vec<RotaryTravel>,
    /// Joints that the control shows over one turn.
    pub(super) shown: Vec<usize>,
    /// How far the chain reaches beside its linear axes, mm.
    pub(super) reach: f64,
    /// The branch of the last point: most likely that of the next.
    branch: Cell<usize>,
    axis_tolerance: f64,
    control_point: ControlPoint,
    /// Rotary joints that stand still in cuts.
    indexed: Vec<usize>,
    tip_rounding: f64,
    axis_rounding: f64,
    /// What is left of the tolerance of the tip in cuts, mm.
    reserve: f64,
    /// What a control chooses that is told the tool axis as a vector; none where rotary axes have words.
    pub(super) vectors: Option<VectorChoice>,
}

impl Placer {
    /// Makes the placer of a machine with a tool of `length` mm in it, its redundant axes held at the values of `held`.
    ///
    /// # Errors
    /// What the machine lacks for being solved.
    pub fn for_machine(
        machine: &Machine,
        format: &Format,
        length: f64,
        held: &Joints,
    ) -> Result<Self, Box<Diagnostic>> {
        let fault = |message: String| Diagnostic::error("machine-chain", message).boxed();
        let solver = |length: f64, held: &Joints| {
            machine.solver_at(length, held).map_err(|lack| machine.unsolvable(&lack).boxed())
        };
        let tip = solver(length, held)?;
        let mut words = AxisWords::new(machine, format);
        // The operator measures to the tip, whichever point is guided.
        words.set_zero(&tip).ok_or_else(|| {
            fault("with every rotary axis at zero the linear axes do not span the space".to_owned())
        })?;
        let along = machine.control_point.along;
        // The word of an axis that stands is where it stands.
        let mut held = *held;
        let moved = words.print_standing(&mut held, &mut WordValues::default());
        let solver = match along == 0.0 && !moved {
            true => tip,
            false => solver(length - along, &held)?,
        };
        Ok(Self::new(machine, solver, words))
    }

    /// Makes the placer of a machine with the tool of `solver` in it.
    pub fn new(machine: &Machine, solver: Solver, words: AxisWords) -> Self {
        let ends = |joint: usize| Some(words.printed_ends(joint, machine.axes[joint].travel?));
        let solver = match machine.control.tcp {
            Tcp::Post => solver.with_ends(ends),
            // Their words are the tip's.
            Tcp::Control => solver,
        };
        let limits = |rotary: bool| {
            machine
                .axes
                .iter()
                .enumerate()
                .filter(|(_, axis)| axis.joint.rotary == rotary)
                .filter_map(|(joint, axis)| {
                    // Angles are checked before they are rounded, linear positions after it.
                    axis.travel.map(|travel| RotaryTravel {
                        joint,
                        travel: if rotary { words.printed_travel(joint, travel) } else { travel },
                    })
                })
                .collect()
        };
        let cyclic =
            (0..machine.axes.len()).filter(|joint| machine.axes[*joint].travel.is_none()).collect();
        Self {
            turning: RotaryAxes { limits: limits(true), cyclic },
            linear: limits(false),
            shown: (0..machine.axes.len())
                .filter(|joint| machine.axes[*joint].range.is_some())
                .collect(),
            reach: reach(machine, &solver),
            tip_rounding: if solver.places_tip() {
                words.rounding() + 1e-6
            } else {
                // What rounded angles do to the tip is not made up for: it stays with the tolerance.
                f64::INFINITY
            },
            axis_rounding: words.axis_rounding() + 1e-8,
            solver,
            words,
            branch: Cell::new(0),
            axis_tolerance: machine.accuracy.axis_tolerance,
            reserve: 0.0,
            vectors: None,
            control_point: machine.control_point,
            indexed: (0..machine.axes.len())
                .filter(|joint| machine.axes[*joint].joint.rotary)
                .filter(|joint| machine.axes[*joint].indexed.is_some())
                .collect(),
        }
    }

    /// What solves points inside a tilted plane, the rotary axes standing; none if the machine's words cannot.
    pub fn in_plane(&self, plane: TiltedPlane) -> Option<Self> {
        Some(Self { words: self.words.in_plane(plane)?, ..self.clone() })
    }

    /// Copies the placer, leaving so much of the tolerance of the tip in cuts, mm, to the stage that puts rounded
    /// points into blocks: what rounding makes of such a point, but a fifth of the tolerance at most.
    pub(crate) fn leaving_room(&self, tolerance: f64) -> Self {
        Self { reserve: self.tip_rounding.min(0.2 * tolerance), ..self.clone() }
    }

    /// What is left of the tolerance of the tip in cuts, mm.
    #[inline]
    pub(crate) fn reserve(&self) -> f64 {
        self.reserve
    }

    /// The point of the tool that poses and errors are those of.
    #[inline]
    pub fn control_point(&self) -> ControlPoint {
        self.control_point
    }

    /// The linear joints that end, and their travel, mm.
    pub(crate) fn linear_travel(&self) -> impl Iterator<Item = (usize, [f64; 2])> {
        let limits = self.linear.iter();
        limits.map(|limit| (limit.joint, limit.travel))
    }

    /// The solver in use.
    pub fn solver(&self) -> &Solver {
        &self.solver
    }

    /// The node of `target` nearest to `last`.
    ///
    /// # Errors
    /// Why there is none.
    pub fn place(&self, target: Pose, t: f64, last: &Joints) -> Result<PathNode, PlacementError> {
        let solver = &self.solver;
        if !solver.closed_form() {
            let joints = solver
                .search(&target, last, self.axis_tolerance)
                .map_err(PlacementError::Unreachable)?;
            // A joint to spare may give way elsewhere: here the axes follow one another.
            if let Some(over) = self.turned_beyond(&joints).filter(|_| !solver.surplus().is_empty())
            {
                return Err(PlacementError::OverTravel { over, tried: 0 });
            }
            return self.settled(target, t, &joints);
        }
        let branches =
            solver.orient(&target, self.axis_tolerance).map_err(PlacementError::Unreachable)?;
        let tried = branches.count();
        let choice = self.turning.nearest(solver, &branches, last, self.branch.get());
        match choice.joints {
            Ok(joints) => {
                self.branch.set(choice.index);
                self.settled(target, t, &joints)
            }
            Err(over) => Err(PlacementError::OverTravel { over, tried }),
        }
    }

    /// The node of `target` to which a move goes on from `last`, without a change of solution.
    ///
    /// # Errors
    /// Why there is none.
    pub fn place_on(&self, last: &PathNode, target: Pose) -> Result<PathNode, PlacementError> {
        let joints = &last.trace.joints;
        if !self.solver.planar() {
            return self.place(target, 1.0, joints);
        }
        let next = self.solver.next([&last.target, &target], joints, self.axis_tolerance);
        let next = next.map_err(PlacementError::Unreachable)?;
        let least = next.first().map_or(joints, |next| &next.joints);
        self.settled(target, 1.0, least)
    }

    /// [`Placer::settle`] into a new node.
    ///
    /// # Errors
    /// Why there is none.
    pub fn settled(
        &self,
        target: Pose,
        t: f64,
        rotary: &Joints,
    ) -> Result<PathNode, PlacementError> {
        let mut node = PathNode::default();
        self.settle(&mut node, target, t, rotary)?;
        Ok(node)
    }

    /// The node of `target` with the pole joint where `even` has it and the others as near to the wanted axis as
    /// they come, on the turns of `even`; none where the chain has no pole.
    pub fn place_evenly(&self, target: Pose, t: f64, even: &Joints) -> Option<PathNode> {
        self.solver.pole_joint()?;
        let mut joints = *even;
        self.solver.follow(&target, &mut joints);
        self.unwind(even, &mut joints);
        if !self.turns_inside(&joints) {
            return None;
        }
        self.settled(target, t, &joints).ok()
    }

    /// Leaves indexed joints where they stand at both `ends`: what a tool axis that is rounded asks of them is nothing that
    /// they may turn by. Where the pole joint is one, the others keep the tool axis as well as they can.
    fn stand_still(&self, target: &Pose, ends: [&Joints; 2], joints: &mut Joints) {
        for &joint in &self.indexed {
            let stand = ends[0][joint];
            if stand != ends[1][joint] || joints[joint] == stand {
                continue;
            }
            joints[joint] = stand;
            if self.solver.pole_joint() == Some(joint) {
                let mut following = *joints;
                self.solver.follow(target, &mut following);
                self.unwind(joints, &mut following);
                if self.turns_inside(&following) {
                    *joints = following;
                }
            }
        }
    }

    /// No rotary joint is beyond its travel.
    fn turns_inside(&self, joints: &Joints) -> bool {
        self.turned_beyond(joints).is_none()
    }

    /// The first rotary joint that is beyond its travel.
    fn turned_beyond(&self, joints: &Joints) -> Option<OverTravel> {
        let mut limits = self.turning.limits.iter();
        limits
            .find_map(|limit| over(limit.joint, Some(limit.travel), joints[limit.joint], 0.0).err())
    }

    /// Puts the joints that turn beside the pole joint on the turns of `near`.
    fn unwind(&self, near: &Joints, joints: &mut Joints) {
        let pole = self.solver.pole_joint();
        for (joint, axis) in self.solver.chain().joints().iter().enumerate() {
            if axis.rotary && pole != Some(joint) {
                joints[joint] += TAU * libm::rint((near[joint] - joints[joint]) / TAU);
            }
        }
    }

    /// The node of a `target` between two sets of axis values: the solution that makes the way from one to the
    /// other shortest.
    ///
    /// # Errors
    /// Why there is none.
    pub fn place_between(
        &self,
        target: Pose,
        t: f64,
        first: &Joints,
        last: &Joints,
    ) -> Result<PathNode, PlacementError> {
        let solver = &self.solver;
        if !solver.closed_form() {
            let joints = solver
                .search_between(&target, [first, last], self.axis_tolerance)
                .map_err(PlacementError::Unreachable)?;
            let joints = match self.turned_beyond(&joints) {
                Some(over) if !solver.surplus().is_empty() => {
                    self.at_end_between(&target, over, first, last)?
                }
                _ => joints,
            };
            return self.settled(target, t, &joints);
        }
        let branches =
            solver.orient(&target, self.axis_tolerance).map_err(PlacementError::Unreachable)?;
        match self.turning.between(solver, &branches, first, last) {
            Ok(mut joints) => {
                self.stand_still(&target, [first, last], &mut joints);
                self.settled(target, t, &joints)
            }
            Err(over) => Err(PlacementError::OverTravel { over, tried: branches.count() }),
        }
    }

    /// Between two sets of axis values the joint that would pass its travel stays at its end, and all others make up for it.
    fn at_end_between(
        &self,
        target: &Pose,
        beyond: OverTravel,
        first: &Joints,
        last: &Joints,
    ) -> Result<Joints, PlacementError> {
        let mut start: Joints = std::array::from_fn(|joint| (first[joint] + last[joint]) / 2.0);
        start[beyond.joint] = beyond.limit;
        let holding = [beyond.joint];
        let joints = self.solver.search_holding(target, &start, &holding, self.axis_tolerance);
        let joints = joints.map_err(PlacementError::Unreachable)?;
        match self.turned_beyond(&joints) {
            Some(over) => Err(PlacementError::OverTravel { over, tried: 0 }),
            None => Ok(joints),
        }
    }

    /// The node of `target` with given rotary values: the tip is put on its place, whatever they are.
    ///
    /// # Errors
    /// Why there is none.
    #[inline]
    pub fn settle(
        &self,
        node: &mut PathNode,
        target: Pose,
        t: f64,
        rotary: &Joints,
    ) -> Result<(), PlacementError> {
        self.settle_at(node, target, target.tip, t, rotary)
    }

    /// [`Placer::settle`] with the tip put at `place`, off the target on purpose.
    ///
    /// # Errors
    /// Why there is none.
    #[inline]
    pub(super) fn settle_at(
        &self,
        node: &mut PathNode,
        target: Pose,
        place: Vector3<f64>,
        t: f64,
        rotary: &Joints,
    ) -> Result<(), PlacementError> {
        let chain = self.solver.chain();
        node.t = t;
        node.target = target;
        let joints = &mut node.trace.joints;
        *joints = *rotary;
        // The rotary words first: the linear axes then make up for their rounding.
        self.words.print_rotary(joints, &mut node.words);
        node.trace.turns = chain.turns(joints);
        let along = self.control_point.along;
        let printed = self.words.print_tip(place - target.axis * along, &mut node.words);
        self.words.print_standing(joints, &mut node.words);
        let wanted = match printed {
            None => place,
            Some(tip) if along == 0.0 => tip,
            // The control keeps the tip there; the point above it goes where the tool really leans.
            Some(tip) => tip + chain.forward(joints).axis * along,
        };
        self.solver
            .place(wanted, joints, &node.trace.turns)
            .map_err(PlacementError::Unreachable)?;
        if printed.is_none() {
            self.words.print_linear(joints, &mut node.words);
        }
        for limit in &self.linear {
            let value = joints[limit.joint];
            over(limit.joint, Some(limit.travel), value, AT_END)
                .map_err(|over| PlacementError::OverTravel { over, tried: 1 })?;
        }
        chain.trace(&mut node.trace);
        node.tip = node.trace.pose.tip;
        node.measure();
        // The forward chain checks every node: what it misses by must be rounding.
        let missed = if place == target.tip { node.tip_error } else { (node.tip - place).norm() };
        // What a rounded angle does to a point above the tip that the control keeps is not made up for.
        let swung = if printed.is_some() { along.abs() * node.axis_error } else { 0.0 };
        if missed <= self.tip_rounding + swung {
            Ok(())
        } else {
            Err(PlacementError::Unverified { tip: missed, axis: node.axis_error })
        }
    }

    /// A last decimal of the linear words, mm: the coarsest.
    pub(crate) fn last_decimal(&self) -> f64 {
        2.0 * self.words.half_decimal()[0]
    }

    /// The node with its control point at another printed place (mm, part frame), the rotary axes standing.
    ///
    /// # Errors
    /// Why it cannot stand there.
    pub(crate) fn resettle(
        &self,
        node: &mut PathNode,
        place: Vector3<f64>,
    ) -> Result<(), PlacementError> {
        let rotary = node.trace.joints;
        self.settle_at(node, node.target, place, node.t, &rotary)
    }

    /// The control stands at `joints`, beside the words of `node`.
    pub(crate) fn stray(&self, node: &mut PathNode, joints: Joints) {
        node.trace.joints = joints;
        self.solver.chain().trace(&mut node.trace);
        node.tip = node.trace.pose.tip;
        node.measure();
    }

    /// Do the rotary axes of `rotary`, as printed, stand as those of `at`, which are printed?
    pub(crate) fn stand(&self, rotary: &Joints, at: &Joints) -> bool {
        self.words.stand(rotary, at)
    }

    /// The linear words of a node as a point, mm; none where they are not X, Y and Z.
    pub(crate) fn printed(&self, node: &PathNode) -> Option<Vector3<f64>> {
        self.printed_words(&node.words)
    }

    /// The linear ones of words as a point, mm; none where they are not X, Y and Z.
    pub(crate) fn printed_words(&self, words: &WordValues) -> Option<Vector3<f64>> {
        self.words.point(words)
    }

    /// Whether a linear word of a block differs from the one before it, by `most` mm at most.
    pub(crate) fn creeps(&self, words: &[Column; MAX_AXES], lane: usize, most: f64) -> bool {
        self.words.creeps(words, lane, most)
    }

    /// The words of a node with their linear ones at the printed `point`, program units.
    pub(crate) fn with_point(&self, node: &PathNode, point: [f64; 3]) -> WordValues {
        self.words.with_point(&node.words, point)
    }

    /// A number printed with as many decimals as every linear word has, rounded to them.
    pub(crate) fn printed_number(&self, number: f64) -> Option<f64> {
        self.words.printed_number(number)
    }

    /// Words of a block.
    pub(crate) fn count(&self) -> usize {
        self.words.len()
    }

    /// Rounds a point to the words' decimals: see [`AxisWords::printed_point`].
    pub(crate) fn printed_point(&self, point: Vector3<f64>) -> Option<([f64; 3], Vector3<f64>)> {
        self.words.printed_point(point)
    }

    /// Copies the placer for a control that is told the tool axis as a vector, and chooses the rotary axes itself.
    pub(crate) fn by_vector(self, machine: &Machine) -> Self {
        Self { vectors: Some(VectorChoice::of(machine)), ..self }
    }

    /// Would a control that is told the tool axis of `to` alone turn the rotary axes to another place than there?
    pub(super) fn led_elsewhere(&self, from: &Joints, to: &Joints) -> bool {
        let Some(choice) = &self.vectors else {
            return false;
        };
        let pose = self.solver.chain().forward(to);
        let found = self.solver.inverse(&pose, from, AIMED);
        let taken = found.ok().and_then(|found| choice.taken(&found, from));
        taken.is_some_and(|taken| choice.apart(&taken, to) > ELSEWHERE)
    }

    /// Does a block turn an axis that the control shows over one turn so far that it would go the other way round?
    #[inline]
    pub fn turns_too_far(&self, from: &Joints, to: &Joints) -> bool {
        let mut shown = self.shown.iter();
        shown.any(|joint| libm::fabs(to[*joint] - from[*joint]) > LONGEST)
    }

    /// What floating point rounds off a tip and a tool axis at most, anywhere between two sets of axis values: 64 ulp
    /// of the farthest that the chain reaches (up to eight joints, each a turn of a dozen operations), times the
    /// largest angle where that is over a radian, for an angle is rounded before it turns anything.
    #[inline]
    pub fn margin(&self, from: &Joints, to: &Joints) -> DeviationBound {
        let (mut reach, mut angle) = (self.reach, 1.0);
        for (index, joint) in self.solver.chain().joints().iter().enumerate() {
            let value = larger(libm::fabs(from[index]), libm::fabs(to[index]));
            if joint.rotary {
                angle = larger(angle, value);
            } else {
                reach += value;
            }
        }
        let margin = Self::margin_of(reach, angle);
        let chain = self.solver.chain();
        if chain.errors().is_empty() {
            return margin;
        }
        // Between samples errors are off the line between them by twice what they are off that of the block.
        let [tip, turned] = chain.error_bow([from, to], reach);
        DeviationBound { tip: margin.tip + 2.0 * tip, axis: margin.axis + 2.0 * turned }
    }

    /// [`Placer::margin`] of a chain that reaches so far, mm, its largest angle being `angle` (radians; one at least).
    #[inline(always)]
    pub(super) fn margin_of(reach: f64, angle: f64) -> DeviationBound {
        const ULPS: f64 = 64.0 * f64::EPSILON;
        DeviationBound { tip: ULPS * angle * reach, axis: ULPS * angle }
    }

    /// The largest error of the tip that rounding can make, mm.
    pub fn tip_rounding(&self) -> f64 {
        self.tip_rounding
    }

    /// Values of a rotary joint that are printed inside its travel, radians.
    pub fn printed_travel(&self, joint: usize, travel: [f64; 2]) -> [f64; 2] {
        self.words.printed_travel(joint, travel)
    }

    /// The largest error of the tool axis that rounding can make, radians.
    pub fn axis_rounding(&self) -> f64 {
        self.axis_rounding
    }
}
