//! The inverse: axis values for a pose. Rotary axes first, since only they turn the tool, then the linear ones;
//! all in closed form wherever three linear axes place the tip, numerically else.

use nalgebra::Vector3;

use super::arm::Arm;
use super::batch::{AxisBatch, LANES, Lanes, VectorLanes};
use super::chain::{AxisBits, Chain, Joints, MAX_AXES, Pose, Turns};
use super::derivatives::{self, JointDerivatives, ORDERS};
use super::fault::{NoClosedForm, POLE, Unreachable};
use super::linear::{Linear, Second};
use super::numeric;
use super::orientation::{Branches, LatitudeLanes, Orientation, RotarySet, angle};
use super::planar::Planar;
use super::{surplus, turning_axis};

/// How far a returned solution may miss the pose when it is put through the forward product: mm per metre
/// of reach, and radians.
pub(super) const VERIFIED: f64 = 1e-9;

/// Angles that a numeric search begins at, for each rotary axis, radians.
const SEEDS: [f64; 3] = [-2.1, 0.1, 2.2];

/// A numeric search begins at no more places than this.
const MOST_SEEDS: usize = 243;

/// Numeric solutions of which every axis is closer than this to another's are the same: mm or radians.
const SAME: f64 = 1e-4;

/// An axis as near to where it is held stands there, mm.
const STANDS: f64 = 1e-6;

/// Settings of the axes at which the ways of the tip are counted: a single one may happen to be singular.
pub(super) const SETTINGS: [f64; 3] = [0.31, 0.57, 0.83];

/// Which joints are solved for, and what becomes of the others.
#[derive(Clone, Debug, Default)]
pub struct Freedom {
    /// Rotary joints that are solved for.
    pub rotary: Vec<usize>,
    /// Linear joints that stand still.
    pub still: Vec<usize>,
    /// Values of the joints that stand still, mm or radians.
    pub held: Joints,
    /// Linear joints that move along with another one, and the travel of that one, mm.
    pub seconds: Vec<(usize, Second, [f64; 2])>,
}

/// How a chain is solved: prepared once a machine, tool and index position.
#[derive(Clone, Debug)]
pub struct Solver {
    pub(super) chain: Chain,
    /// Values of the axes that are not free (indexed), mm or radians.
    pub(super) held: Joints,
    pub(super) form: SolutionMethod,
    /// How far two linear axes may miss the tip, mm.
    pub(super) tip_tolerance: f64,
    /// With linear axes that stand: the chain of which they are parts that do not move.
    standing: Option<Box<(Chain, Linear)>>,
}

/// How a chain is solved by a search: fewer than three linear axes, so that rotary ones have to place the tip as well, or
/// rotary axes that no formula knows.
fn numeric_form(
    chain: &Chain,
    freedom: &Freedom,
    quills: bool,
    sliding: Option<Box<Linear>>,
) -> Result<SolutionMethod, NoClosedForm> {
    let Freedom { rotary, still, held, .. } = freedom;
    let slides = |joint: &usize| !chain.joints()[*joint].rotary;
    let moves = |joint: &usize| match slides(joint) {
        true => !still.contains(joint),
        false => rotary.contains(joint),
    };
    let free: Vec<usize> = (0..chain.joints().len()).filter(moves).collect();
    let linear: Vec<usize> = free.iter().copied().filter(slides).collect();
    let planar = Planar::new(chain, &linear, rotary, held).filter(|_| !quills).map(Box::new);
    // One or two axes are for what lies on their line or in their plane, if one goes along it.
    let flat = free.len() < 3;
    let beside = linear.len() == 2 && rotary.is_empty() && planar.is_none();
    if quills || linear.is_empty() && flat || beside {
        let (linear, rotary) = (linear.len(), rotary.len());
        return Err(NoClosedForm::FewAxes { linear, rotary, quills });
    }
    let ways = SETTINGS
        .iter()
        .map(|share| numeric::ways(chain, &free, &numeric::spread(&free, held, *share)))
        .map(|ways| ways.of_tip);
    let ways = ways.max().unwrap_or(0);
    if ways < 3 && !flat {
        return Err(NoClosedForm::FlatTip { ways });
    }
    let surplus = match planar {
        Some(_) => Vec::new(),
        None => surplus::surplus(chain, &free, held),
    };
    let linear = linear.into_iter().filter(|joint| !surplus.contains(joint)).collect();
    let arm = Arm::new(chain, &free).map(Box::new);
    let framed = surplus::framed(chain, &surplus).map(Box::new);
    Ok(SolutionMethod::Numeric { linear, sliding, free, planar, surplus, framed, arm })
}

/// No formula knows these rotary axes: more than two that point a tool which turns, or other than three of one with a
/// leading edge.
fn searched(chain: &Chain, rotary: &[usize]) -> bool {
    match chain.edge() {
        Some(_) => !rotary.is_empty() && rotary.len() != 3,
        None => rotary.len() > 2,
    }
}

/// The way to the solution.
#[derive(Clone, Debug)]
pub(super) enum SolutionMethod {
    Closed {
        orientation: Orientation,
        /// Free rotary axes along the tool, which turn nothing: one bit each.
        idle: AxisBits,
        linear: Linear,
    },
    /// All joints that move; the linear ones among them that place the tip; what solves two of these without a search; and
    /// joints beyond what a pose needs.
    Numeric {
        free: Vec<usize>,
        linear: Vec<usize>,
        /// The three linear axes that place the tip, wherever the rotary ones stand, if nothing else slides.
        sliding: Option<Box<Linear>>,
        planar: Option<Box<Planar>>,
        surplus: Vec<usize>,
        /// The chain with an edge on its tool, where the turn about a tool that turns is one of them.
        framed: Option<Box<Chain>>,
        /// What gives the solutions of a robot's arm by formulas.
        arm: Option<Box<Arm>>,
    },
}

impl Solver {
    /// Prepares a chain. `free` tells which rotary joints move in a cut; the others stand at `held` (radians).
    ///
    /// # Errors
    /// What the chain lacks.
    pub fn new(chain: Chain, free: &[usize], held: Joints) -> Result<Self, NoClosedForm> {
        let freedom = Freedom { rotary: free.to_vec(), held, ..Freedom::default() };
        Self::with(chain, &freedom)
    }

    /// Prepares a chain of which some linear axes stand still or move along with others.
    ///
    /// # Errors
    /// What the chain lacks.
    pub fn with(chain: Chain, freedom: &Freedom) -> Result<Self, NoClosedForm> {
        let held = freedom.held;
        let form = match Linear::new(&chain, &freedom.still, &freedom.seconds) {
            Ok(linear) if searched(&chain, &freedom.rotary) => {
                if !freedom.seconds.is_empty() {
                    return Err(NoClosedForm::RotaryAxes { joints: freedom.rotary.clone() });
                }
                let sliding = Some(linear).filter(|linear| !linear.more).map(Box::new);
                numeric_form(&chain, freedom, false, sliding)?
            }
            Ok(linear) => {
                let (orientation, idle) = Orientation::new(&chain, &freedom.rotary, &held)?;
                SolutionMethod::Closed { orientation, idle, linear }
            }
            // Rotary axes have to place the tip as well.
            Err(NoClosedForm::FewAxes { quills, .. }) => {
                numeric_form(&chain, freedom, quills, None)?
            }
            Err(lack) => return Err(lack),
        };
        let standing = match freedom.seconds.is_empty() && !freedom.still.is_empty() {
            true => {
                let chain = chain.standing(&freedom.still, &held);
                let linear = Linear::new(&chain, &freedom.still, &[]);
                linear.ok().map(|linear| Box::new((chain, linear.alone())))
            }
            false => None,
        };
        Ok(Self { chain, held, form, tip_tolerance: 0.0, standing })
    }

    /// The solver, two linear axes of which may miss a tip by `tip` mm: what they cannot reach in its plane is reached as
    /// nearly as they come, and who asks counts what is missing.
    pub fn within(self, tip: f64) -> Self {
        Self { tip_tolerance: tip, ..self }
    }

    /// The solver, in which quills in reserve rest and begin to move inside the travel that `ends` gives of a joint, mm: where
    /// the words of the program can say that they do.
    pub fn with_ends(mut self, ends: impl Fn(usize) -> Option<[f64; 2]>) -> Self {
        if let SolutionMethod::Closed { linear, .. } = &mut self.form {
            linear.keep_quills(ends);
        }
        self
    }

    /// Linear axes beside the three that place the tip stand in `joints` where they are held.
    pub(super) fn stands_as_held(&self, joints: &Joints) -> bool {
        let Some(standing) = &self.standing else {
            return true;
        };
        let mut all = standing.0.joints().iter().zip(joints.iter().zip(&self.held));
        all.all(|(joint, (value, held))| {
            joint.rotary || joint.direction != Vector3::zeros() || (value - held).abs() < STANDS
        })
    }

    /// The chain that is solved.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// Three linear axes place the tip, wherever the rotary ones stand; else rotary axes have to help, by formulas
    /// ([`Solver::planar`]) or by a numeric search that is verified.
    pub fn closed_form(&self) -> bool {
        matches!(self.form, SolutionMethod::Closed { .. })
    }

    /// Three linear axes put the tip on its place wherever the rotary ones stand, whether these are solved in closed form or
    /// not.
    pub fn places_tip(&self) -> bool {
        match &self.form {
            SolutionMethod::Closed { .. } => true,
            SolutionMethod::Numeric { linear, .. } => linear.len() == 3,
        }
    }

    /// The ways to point the tool along the axis (and with the edge) of `pose` within `tolerance` (radians; it
    /// matters only where the axes cannot reach every direction).
    ///
    /// # Errors
    /// By how much the nearest orientation misses.
    #[inline]
    pub fn orient(&self, pose: &Pose, tolerance: f64) -> Result<Branches, Unreachable> {
        match &self.form {
            SolutionMethod::Closed { orientation, .. } => orientation.orient(pose, tolerance),
            SolutionMethod::Numeric { .. } => Err(Unreachable::Numeric { miss: f64::INFINITY }),
        }
    }

    /// The three linear axes that place the tip, if they do it alone or beside others that stand.
    #[inline]
    pub(super) fn linear(&self) -> Option<&Linear> {
        self.sliding_chain().map(|(_, linear)| linear)
    }

    /// [`Solver::linear`], and the chain in which they move: for axis values that leave others where they are held.
    #[inline]
    pub(super) fn sliding_chain(&self) -> Option<(&Chain, &Linear)> {
        match &self.form {
            SolutionMethod::Closed { linear, .. } if !linear.more => Some((&self.chain, linear)),
            SolutionMethod::Closed { .. } => {
                self.standing.as_ref().map(|standing| (&standing.0, &standing.1))
            }
            SolutionMethod::Numeric { sliding, .. } => {
                sliding.as_deref().map(|linear| (&self.chain, linear))
            }
        }
    }

    /// The three linear joints that place the tip alone, in the order of the chain.
    #[inline]
    pub fn sliding(&self) -> Option<[usize; 3]> {
        self.linear().map(|linear| linear.joints)
    }

    /// No linear axis goes farther than this times the way of the tip, where the rotary axes stand; infinite where they
    /// stand between the linear ones, or there are more than three of these.
    pub fn linear_reach(&self) -> f64 {
        self.linear().map_or(f64::INFINITY, |linear| linear.reach)
    }

    /// The rotary angles of a branch.
    #[inline]
    pub fn angles(&self, branches: &Branches, index: usize) -> RotarySet {
        let mut set = RotarySet { joints: self.held, ..RotarySet::default() };
        if let SolutionMethod::Closed { orientation, idle, .. } = &self.form {
            set.free = *idle;
            orientation.angles(branches, index, &mut set);
        }
        set
    }

    /// Sines and cosines of a set whose free joints were put where they are.
    #[inline]
    pub fn turns(&self, set: &RotarySet) -> Turns {
        match set.turns {
            Some(turns) if set.free == 0 => turns,
            _ => self.chain.turns(&set.joints),
        }
    }

    /// The free joint nearest to the tool.
    pub fn last_rotary(&self) -> usize {
        match &self.form {
            SolutionMethod::Closed { orientation, .. } => orientation.last(),
            SolutionMethod::Numeric { free, .. } => free.last().copied().unwrap_or(0),
        }
    }

    /// The rotary joint whose angle is free on the pole, if two or three of them point the tool.
    pub fn pole_joint(&self) -> Option<usize> {
        match &self.form {
            SolutionMethod::Closed { orientation, .. } => orientation.first(),
            SolutionMethod::Numeric { .. } => None,
        }
    }

    /// Angles from the pole joint's axis between which there are two branches, radians; where they end the
    /// branches meet. None where nothing turns so.
    pub fn band(&self) -> Option<[f64; 2]> {
        match &self.form {
            SolutionMethod::Closed { orientation, .. } => orientation.band(),
            SolutionMethod::Numeric { .. } => None,
        }
    }

    /// With the [`Solver::pole_joint`] where `joints` has it, puts the other rotary joints so that the tool
    /// axis comes as near as it can to that of `pose`; their angles in -π to π.
    pub fn follow(&self, pose: &Pose, joints: &mut Joints) {
        if let SolutionMethod::Closed { orientation, .. } = &self.form {
            orientation.follow(pose, joints);
        }
    }

    /// Puts the linear axes of `joints` where the tip stands on `tip` (mm, part frame), the rotary ones
    /// being where `joints` and `turns` have them.
    ///
    /// # Errors
    /// [`Unreachable::Linear`] if the linear axes span no volume at these angles.
    #[inline]
    pub fn place(
        &self,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        match &self.form {
            SolutionMethod::Closed { linear, .. } => linear.place(&self.chain, tip, joints, turns),
            SolutionMethod::Numeric { linear, .. } => {
                // There may be too few of them to reach the tip alone; they make up for what they can.
                numeric::approach(&self.chain, linear, tip, joints);
                Ok(())
            }
        }
    }

    /// [`Solver::place`] by the three linear axes that do it alone ([`Solver::sliding`]); elsewhere by all there are.
    ///
    /// # Errors
    /// [`Unreachable::Linear`] if the linear axes span no volume at these angles.
    pub(super) fn slide(
        &self,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        match &self.form {
            SolutionMethod::Numeric { sliding: Some(linear), .. } => {
                linear.place(&self.chain, tip, joints, turns)
            }
            _ => self.place(tip, joints, turns),
        }
    }

    /// How the axes go along a path on which the tip goes as `tip` says (value and derivatives by the parameter, mm, part
    /// frame) and the rotary axes as the joints of `course`: fills in its linear joints, their derivatives and the rates
    /// of the tip.
    ///
    /// # Errors
    /// [`Unreachable::Linear`] if the linear axes span no volume at these angles, or do not place the tip alone.
    pub fn course(
        &self,
        tip: &[Vector3<f64>; ORDERS],
        course: &mut JointDerivatives,
    ) -> Result<(), Unreachable> {
        let SolutionMethod::Closed { linear, .. } = &self.form else {
            return Err(Unreachable::Linear);
        };
        let turns = self.chain.turns(&course.joints[0]);
        self.place(tip[0], &mut course.joints[0], &turns)?;
        let ways = linear.ways(&course.joints[0]);
        derivatives::follow(&self.chain, &ways, tip, course)
    }

    /// How the joints `rotary` (up to two) go along a path on which the tool axis goes as `axis` says (a unit vector and its derivatives by
    /// the parameter, part frame): fills in their derivatives in `course`, whose values are given.
    /// [`Solver::course`] goes on from there.
    ///
    /// # Errors
    /// [`Unreachable::Axis`] on the pole, and where fewer than two rotary axes cannot follow; how much is missing.
    pub fn turn_along(
        &self,
        rotary: &[usize],
        axis: &[Vector3<f64>; ORDERS],
        course: &mut JointDerivatives,
    ) -> Result<(), Unreachable> {
        turning_axis::follow(&self.chain, rotary, axis, course)
    }

    /// [`Solver::place`] of a batch: puts the linear axes of `at` where the tips stand on the first `count` of `tips`
    /// (mm, part frame), the rotary ones being where its sines and cosines have them. False, and nothing done, where the
    /// chain asks for more than that: its points are left to [`Solver::place`].
    pub fn place_all(&self, tips: &VectorLanes, count: usize, at: &mut AxisBatch) -> bool {
        match &self.form {
            SolutionMethod::Closed { linear, .. } => {
                linear.place_batch(&self.chain, tips, count, at)
            }
            SolutionMethod::Numeric { .. } => false,
        }
    }

    /// The rotary angles of a branch that point the tool along the first `count` of `axes` (unit vectors, part frame),
    /// into `at`, and how far each is from the poles. False where an angle is free, the branches meet or the machine
    /// may miss a direction by more than `tolerance` (radians), or where more than two axes point the tool: these points are
    /// left to [`Solver::orient`].
    pub fn angles_all(
        &self,
        axes: [&Lanes; 3],
        branch: usize,
        tolerance: f64,
        count: usize,
        at: &mut AxisBatch,
        latitudes: &mut LatitudeLanes,
    ) -> bool {
        let SolutionMethod::Closed { orientation, idle: 0, .. } = &self.form else {
            return false;
        };
        for (index, joint) in self.chain.joints().iter().enumerate() {
            if joint.rotary {
                at.joints[index][..count.min(LANES)].fill(self.held[index]);
            }
        }
        orientation.angles_all(axes, branch, tolerance, count, at, latitudes)
    }

    /// Values of the joints that stand still, mm or radians.
    pub fn held(&self) -> &Joints {
        &self.held
    }

    /// For a chain without a closed form: in how many independent ways the tip can be moved from `joints` while the tool
    /// axis keeps its direction (3 for any path), and the tool axis while the tip stays (2 for any).
    /// `rests` tells which joints no cut moves.
    pub fn ways(&self, joints: &Joints, rests: impl Fn(usize) -> bool) -> Option<[usize; 2]> {
        let SolutionMethod::Numeric { free, .. } = &self.form else {
            return None;
        };
        let free: Vec<usize> = free.iter().copied().filter(|joint| !rests(*joint)).collect();
        let ways = numeric::ways(&self.chain, &free, joints);
        Some([ways.with_axis_kept, ways.of_axis_with_tip_kept])
    }

    /// For a chain without a closed form: the solution next to `from`, verified.
    ///
    /// # Errors
    /// By how much the nearest pose misses.
    pub fn search(
        &self,
        pose: &Pose,
        from: &Joints,
        tolerance: f64,
    ) -> Result<Joints, Unreachable> {
        self.search_within(pose, from, tolerance, &mut { numeric::STEPS })
    }

    /// [`Solver::search`] in no more steps than `left`, from which it takes those that it needed.
    ///
    /// # Errors
    /// By how much the nearest pose that was come to misses.
    pub fn search_within(
        &self,
        pose: &Pose,
        from: &Joints,
        tolerance: f64,
        left: &mut usize,
    ) -> Result<Joints, Unreachable> {
        if let Some(planar) = self.planar_form() {
            return self.in_plane(planar, pose, [from, from], tolerance);
        }
        self.search_surplus(pose, from, tolerance, left)
    }

    /// For a chain without a closed form: all solutions that searches from many places find.
    fn searches(
        &self,
        pose: &Pose,
        last: &Joints,
        tolerance: f64,
    ) -> Result<Vec<Joints>, Unreachable> {
        let rotary = self.rotary();
        let count = SEEDS.len().pow(rotary.len() as u32).min(MOST_SEEDS);
        let starts = (0..=count).map(|seed| {
            let mut start = *last;
            if seed > 0 {
                let mut digits = seed - 1;
                for joint in &rotary {
                    start[*joint] = SEEDS[digits % SEEDS.len()];
                    digits /= SEEDS.len();
                }
            }
            start
        });
        self.inverse_from(pose, starts, tolerance, &mut { usize::MAX })
    }

    /// Rotary joints that a numeric search moves.
    fn rotary(&self) -> Vec<usize> {
        let SolutionMethod::Numeric { free, .. } = &self.form else {
            return Vec::new();
        };
        let free = free.iter().copied();
        free.filter(|joint| self.chain.joints()[*joint].rotary).collect()
    }

    /// For a chain without a closed form: all solutions that searches from `starts` find, in no more steps than `left`,
    /// from which it takes those that it needed. Angles lie in -π to π.
    ///
    /// # Errors
    /// By how much the nearest pose that was come to misses.
    pub fn inverse_from(
        &self,
        pose: &Pose,
        starts: impl IntoIterator<Item = Joints>,
        tolerance: f64,
        left: &mut usize,
    ) -> Result<Vec<Joints>, Unreachable> {
        let SolutionMethod::Numeric { free, .. } = &self.form else {
            return Err(Unreachable::Linear);
        };
        let rotary = self.rotary();
        let mut found: Vec<Joints> = Vec::new();
        let mut least = (f64::INFINITY, Unreachable::Numeric { miss: f64::INFINITY });
        for start in starts {
            let mut steps = numeric::STEPS.min(*left);
            *left -= steps;
            let searched = self.search_within(pose, &start, tolerance, &mut steps);
            *left += steps;
            match searched {
                Ok(mut joints) => {
                    for joint in &rotary {
                        joints[*joint] = libm::remainder(joints[*joint], std::f64::consts::TAU);
                    }
                    let same = |known: &Joints| {
                        free.iter().all(|joint| libm::fabs(known[*joint] - joints[*joint]) < SAME)
                    };
                    if !found.iter().any(same) {
                        found.push(joints);
                    }
                }
                Err(fault @ (Unreachable::Numeric { miss } | Unreachable::Axis { miss })) => {
                    if miss < least.0 {
                        least = (miss, fault);
                    }
                }
                Err(_) => {}
            }
            if *left == 0 {
                break;
            }
        }
        if found.is_empty() {
            return Err(least.1);
        }
        Ok(found)
    }

    /// All solutions for a pose, each verified by the forward product; a free angle is put at `last`.
    /// Angles lie in -π to π; turns and travel are for the stage that chooses. Where there is no closed form,
    /// those that searches from `last` and from places all over the turns find.
    ///
    /// # Errors
    /// Why there is none.
    pub fn inverse(
        &self,
        pose: &Pose,
        last: &Joints,
        tolerance: f64,
    ) -> Result<Vec<Joints>, Unreachable> {
        if let Some(planar) = self.planar_form() {
            let ways = self.solutions(planar, pose, last, tolerance)?;
            return Ok(ways.into_iter().map(|way| way.joints).collect());
        }
        let SolutionMethod::Closed { idle, .. } = &self.form else {
            let found = self.of_arm(pose, last, tolerance);
            return match found.is_empty() {
                true => self.searches(pose, last, tolerance),
                false => Ok(found),
            };
        };
        let mut solutions = Vec::with_capacity(2);
        let mut fault = Unreachable::Linear;
        let branches = self.orient(pose, tolerance)?;
        for index in 0..branches.count() {
            let mut set = self.angles(&branches, index);
            set.keep(last);
            let mut joints = set.joints;
            let turns = self.chain.turns(&joints);
            if let Err(unreachable) = self.place(pose.tip, &mut joints, &turns) {
                fault = unreachable;
                continue;
            }
            let allowed = if set.free != *idle { 2.0 * POLE } else { VERIFIED };
            if self.verified(&joints, pose, allowed.max(tolerance)) {
                solutions.push(joints);
            }
        }
        if solutions.is_empty() {
            return Err(fault);
        }
        Ok(solutions)
    }

    /// The forward product of `joints` stands behind them.
    pub(super) fn verified(&self, joints: &Joints, pose: &Pose, allowed: f64) -> bool {
        self.verified_within(joints, pose, [0.0, allowed])
    }

    /// [`Solver::verified`], the tip within `tip` mm beside rounding, the tool axis within `axis` radians.
    pub(super) fn verified_within(
        &self,
        joints: &Joints,
        pose: &Pose,
        [tip, axis]: [f64; 2],
    ) -> bool {
        let reached = self.chain.forward(joints);
        let axis = axis + self.chain.largest_error_turn();
        let reach =
            1000.0 + pose.tip.norm() + joints[..MAX_AXES].iter().fold(0.0, |sum, q| sum + q.abs());
        (reached.tip - pose.tip).norm() < VERIFIED * reach / 1000.0 + tip
            && angle(reached.axis, pose.axis) < axis
            && (self.chain.edge().is_none() || angle(reached.edge, pose.edge_across()) < axis)
    }
}
