//! The inverse of chains with two linear axes: lathes with a C axis and no Y, drills on two axes.
//!
//! While the rotary axes stand, such a chain moves the tip in a plane. A rotary axis that carries the part in front of
//! both linear ones (the carrier) turns this plane about the part: where it does not point the tool, it brings the
//! wanted tip into the plane, in two ways (X and C, -X and C + 180°) but for where the ways meet, on the centre line.
//! Where it does point the tool, the tip must lie in the plane as it stands; what it misses by is told.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::chain::{AxisBits, Chain, Joint, Joints, Pose, Turns, turn};
use super::fault::{POLE, Unreachable};
use super::inverse::{SolutionMethod, Solver, VERIFIED};
use super::linear::FLAT;
use super::numeric;
use super::orientation::{Orientation, RotarySet, angle};

/// The carrier points the tool no farther off than this share of what the tool axis may miss, if it is to place the tip.
const POINTS: f64 = 0.25;

/// The carrier turns the tool off by no more than this share of what the tool axis may miss, if it is to bring the tip in:
/// the words are rounded too.
const LEANS: f64 = 0.9;

/// Closer to where its ways meet than this share of what the tip may miss, mm of mm, the carrier stands as it stood.
const MEETS: f64 = 0.1;

/// Errors of axes displace a tip by no more than this, mm: what lies farther across the plane is no error of theirs.
const LARGEST_ERROR: f64 = 10.0;

/// Steps in which errors of axes are taken out, and what is left of them, mm and radians.
const MOST_STEPS: usize = 12;
const PLACED: f64 = 1e-10;

/// How two linear axes and up to two rotary ones reach a pose.
#[derive(Clone, Debug)]
pub(super) struct Planar {
    orientation: Orientation,
    /// Free rotary axes along the tool, which turn nothing: one bit each.
    idle: AxisBits,
    linear: [usize; 2],
    /// The free rotary joint in front of both linear ones; none where no rotary joint is free.
    carrier: Option<usize>,
    /// The chain without the errors of its axes, where it has any.
    nominal: Option<Box<Chain>>,
}

/// How far a solution may miss the pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct AllowedMiss {
    /// Tip, mm.
    pub(super) tip: f64,
    /// Tool axis, radians.
    pub(super) axis: f64,
}

/// One way to stand at a pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlanarSolution {
    pub(super) joints: Joints,
    /// 1 or -1: on which side of where the ways of the carrier meet; 0 where they do. None where the carrier points the
    /// tool.
    side: Option<f64>,
}

/// How a cut can go on to a pose.
#[derive(Clone, Copy, Debug)]
pub struct NextSolution {
    /// Axis values, each angle on the turn next to where the cut comes from.
    pub joints: Joints,
    /// Its place among the solutions of [`Solver::inverse`]; where both ways of the carrier are one, that of where the cut
    /// comes from.
    pub branch: u8,
    /// The way there stays on one side of where two ways meet; else it has to be tried.
    pub sure: bool,
}

/// Where on a straight way the two ways of the carrier come nearest to one another.
#[derive(Clone, Copy, Debug)]
pub struct Meeting {
    /// Share of the way, 0 to 1.
    pub share: f64,
    /// Distance of the tip from where they meet, mm; zero where the plane passes by it.
    pub gap: f64,
    /// Distance at which the plane passes by the tip, mm; zero where it does not.
    pub miss: f64,
    /// The joint that can be turned there while the tip stands.
    pub joint: usize,
}

/// The carrier brings a tip into the plane where `a·cos + b·sin = e`, mm.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    a: f64,
    b: f64,
    e: f64,
}

impl Crossing {
    /// Square of the distance from where the two ways meet, mm²; negative where the plane passes by the tip.
    fn square(&self) -> f64 {
        self.a * self.a + self.b * self.b - self.e * self.e
    }

    fn side(&self, angle: f64) -> f64 {
        let (sine, cosine) = libm::sincos(angle);
        libm::copysign(1.0, self.b * cosine - self.a * sine)
    }
}

/// The plane of the two linear axes, seen from the carrier.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: Vector3<f64>,
    /// Distance from the carrier's point along the normal, mm.
    height: f64,
}

impl Planar {
    /// None where it is no such chain: it is solved numerically, if at all.
    pub(super) fn new(
        chain: &Chain,
        linear: &[usize],
        rotary: &[usize],
        held: &Joints,
    ) -> Option<Self> {
        let linear: [usize; 2] = linear.try_into().ok()?;
        let carrier = rotary.first().copied();
        let behind = carrier.is_none_or(|carrier| carrier < linear[0].min(linear[1]));
        if chain.edge().is_some() || !behind {
            return None;
        }
        let directions = linear.map(|joint| chain.joints()[joint].direction);
        let (orientation, idle) = Orientation::new(chain, rotary, held).ok()?;
        let spans = directions[0].cross(&directions[1]).norm() > FLAT;
        let without = || Box::new(chain.clone().with_errors(&Vec::new().into()));
        let nominal = (!chain.errors().is_empty()).then(without);
        spans.then_some(Self { orientation, idle, linear, carrier, nominal })
    }

    /// All solutions; joints that turn nothing stand as in `last`. Angles lie in -π to π.
    ///
    /// # Errors
    /// By how much the nearest misses.
    pub(super) fn solutions(
        &self,
        chain: &Chain,
        held: &Joints,
        pose: &Pose,
        last: &Joints,
        allowed: AllowedMiss,
    ) -> Result<Vec<PlanarSolution>, Unreachable> {
        match &self.nominal {
            None => self.exact_solutions(chain, held, pose, last, allowed),
            Some(nominal) => self.erring_solutions([chain, nominal], held, pose, last, allowed),
        }
    }

    /// [`Planar::solutions`] with errors of axes: a fixed point for each. A step aims beside the pose by what the one before
    /// missed it by; what lies across the plane the carrier takes away, or nothing does, and it is told.
    #[cold]
    fn erring_solutions(
        &self,
        [chain, nominal]: [&Chain; 2],
        held: &Joints,
        pose: &Pose,
        last: &Joints,
        allowed: AllowedMiss,
    ) -> Result<Vec<PlanarSolution>, Unreachable> {
        // What errors displace is no miss of what the axes aim at.
        let widened = AllowedMiss {
            tip: allowed.tip + LARGEST_ERROR,
            axis: allowed.axis + chain.largest_error_turn(),
        };
        let mut found = Vec::with_capacity(2);
        let mut fault = Unreachable::Linear;
        for mut way in self.exact_solutions(nominal, held, pose, last, widened)? {
            let mut aim = *pose;
            for _ in 0..MOST_STEPS {
                let miss = pose.tip - chain.forward(&way.joints).tip;
                aim.tip += miss;
                let ways = self.exact_solutions(nominal, held, &aim, last, widened);
                let near = |other: &PlanarSolution| {
                    turned(chain, &unwound(chain, &other.joints, &way.joints), &way.joints)
                };
                let next =
                    ways.unwrap_or_default().into_iter().min_by(|a, b| near(a).total_cmp(&near(b)));
                let Some(next) = next else {
                    break;
                };
                let moved =
                    next.joints.iter().zip(&way.joints).any(|(a, b)| libm::fabs(a - b) > PLACED);
                way = next;
                if !moved || miss.norm() < PLACED {
                    break;
                }
            }
            let axis = allowed.axis + chain.largest_error_turn();
            match missed(chain, pose, &way.joints, AllowedMiss { axis, ..allowed }) {
                Some(unreachable) => fault = unreachable,
                None => found.push(way),
            }
        }
        if found.is_empty() { Err(fault) } else { Ok(found) }
    }

    /// [`Planar::solutions`] without errors of axes.
    fn exact_solutions(
        &self,
        chain: &Chain,
        held: &Joints,
        pose: &Pose,
        last: &Joints,
        allowed: AllowedMiss,
    ) -> Result<Vec<PlanarSolution>, Unreachable> {
        let branches = self.orientation.orient(pose, allowed.axis)?;
        let points = self.orientation.points_by(&branches) > POLE.max(POINTS * allowed.axis);
        let mut found = Vec::with_capacity(2);
        let mut fault = Unreachable::Linear;
        for index in 0..branches.count() {
            let mut set = RotarySet { joints: *held, free: self.idle, ..RotarySet::default() };
            self.orientation.angles(&branches, index, &mut set);
            set.keep(last);
            let ways = match self.carrier.filter(|_| !points) {
                Some(carrier) => {
                    self.carried(chain, pose, &mut set.joints, (carrier, last), allowed)
                }
                None => Ok(vec![self.pointing(chain, pose, set.joints, last, allowed)]),
            };
            let placed = ways.map(|ways| {
                for mut way in ways {
                    numeric::approach(chain, &self.linear, pose.tip, &mut way.joints);
                    match missed(chain, pose, &way.joints, allowed) {
                        Some(unreachable) => fault = unreachable,
                        None => found.push(way),
                    }
                }
            });
            if let Err(unreachable) = placed {
                fault = unreachable;
            }
            if !points && self.carrier.is_some() {
                // The branches of the other axes are one here.
                break;
            }
        }
        if found.is_empty() { Err(fault) } else { Ok(found) }
    }

    /// The axes where they point the tool as in `joints`. Between two points that the chain reaches the tip lies beside the
    /// plane then: where the tool axis may be off by as much, the carrier brings it in by the shorter turn.
    fn pointing(
        &self,
        chain: &Chain,
        pose: &Pose,
        joints: Joints,
        last: &Joints,
        allowed: AllowedMiss,
    ) -> PlanarSolution {
        let plain = PlanarSolution { joints, side: None };
        let placed = |mut joints: Joints| {
            numeric::approach(chain, &self.linear, pose.tip, &mut joints);
            chain.forward(&joints)
        };
        let beside = (placed(joints).tip - pose.tip).norm();
        let Some(carrier) = self.carrier.filter(|_| beside > POLE.max(MEETS * allowed.tip)) else {
            return plain;
        };
        let mut pointed = joints;
        let ways = self.carried(chain, pose, &mut pointed, (carrier, last), allowed);
        let turn = |way: &PlanarSolution| {
            libm::fabs(libm::remainder(way.joints[carrier] - joints[carrier], TAU))
        };
        let nearest =
            ways.unwrap_or_default().into_iter().min_by(|a, b| turn(a).total_cmp(&turn(b)));
        let within = |way: &PlanarSolution| {
            let reached = placed(way.joints);
            angle(reached.axis, pose.axis) < LEANS * allowed.axis
                && (reached.tip - pose.tip).norm() < beside
        };
        match nearest {
            Some(way) if within(&way) => PlanarSolution { side: None, ..way },
            _ => plain,
        }
    }

    /// The ways to bring the tip into the plane by the carrier, the others standing as in `joints`.
    fn carried(
        &self,
        chain: &Chain,
        pose: &Pose,
        joints: &mut Joints,
        (carrier, last): (usize, &Joints),
        allowed: AllowedMiss,
    ) -> Result<Vec<PlanarSolution>, Unreachable> {
        let turns = chain.turns(joints);
        let plane = self.plane(chain, carrier, joints, &turns).ok_or(Unreachable::Linear)?;
        let at = plane.crossing(chain, carrier, &turns, pose.tip);
        let radius = libm::hypot(at.a, at.b);
        let miss = libm::fabs(at.e) - radius;
        if miss > allowed.tip + POLE {
            return Err(Unreachable::Plane { miss });
        }
        let stand = |angle: f64, side: f64| {
            let mut joints = *joints;
            joints[carrier] = libm::remainder(angle, TAU);
            self.orientation.follow(pose, &mut joints);
            PlanarSolution { joints, side: Some(side) }
        };
        let square = at.square();
        let close = POLE.max(MEETS * allowed.tip);
        if radius < close && square < close * close {
            return Ok(vec![stand(last[carrier], 0.0)]);
        }
        let middle = libm::atan2(at.b, at.a);
        if square <= 0.0 {
            let turned = if at.e < 0.0 { PI } else { 0.0 };
            return Ok(vec![stand(middle + turned, 0.0)]);
        }
        let apart = libm::atan2(square.sqrt(), at.e);
        Ok(vec![stand(middle + apart, -1.0), stand(middle - apart, 1.0)])
    }

    /// The plane, the joints behind the carrier standing as in `joints`. None where the linear axes span none.
    fn plane(
        &self,
        chain: &Chain,
        carrier: usize,
        joints: &Joints,
        turns: &Turns,
    ) -> Option<Plane> {
        let axes = chain.joints();
        let mut at = chain.tip();
        let mut ways = [Vector3::zeros(); 2];
        for (index, joint) in axes.iter().enumerate().skip(carrier + 1).rev() {
            if joint.rotary {
                let (sine, cosine) = turns.of(index);
                at = joint.point + turn(at - joint.point, joint.direction, sine, cosine);
                ways = ways.map(|way| turn(way, joint.direction, sine, cosine));
            } else if let Some(place) = self.linear.iter().position(|linear| *linear == index) {
                ways[place] = joint.direction;
            } else {
                at += joint.direction * joints[index];
            }
        }
        let normal = ways[0].cross(&ways[1]).try_normalize(FLAT)?;
        Some(Plane { normal, height: normal.dot(&(at - axes[carrier].point)) })
    }

    /// On which side of where the two ways of the carrier meet the axes stand.
    fn side(&self, chain: &Chain, joints: &Joints) -> f64 {
        let turns = chain.turns(joints);
        let side = |carrier: usize| {
            let plane = self.plane(chain, carrier, joints, &turns)?;
            let tip = chain.pose(joints, &turns).tip;
            Some(plane.crossing(chain, carrier, &turns, tip).side(joints[carrier]))
        };
        self.carrier.and_then(side).unwrap_or(0.0)
    }

    /// Where on the straight way of the tip the two ways of the carrier come nearest to one another, the other rotary
    /// joints standing as in `joints`. None where nothing carries the plane.
    pub(super) fn meeting(
        &self,
        chain: &Chain,
        way: [Vector3<f64>; 2],
        joints: &Joints,
    ) -> Option<Meeting> {
        let carrier = self.carrier?;
        let turns = chain.turns(joints);
        let plane = self.plane(chain, carrier, joints, &turns)?;
        let [from, to] = way.map(|tip| plane.crossing(chain, carrier, &turns, tip));
        // All three go evenly along the way: the square of the distance is a parabola.
        let (a, b, e) = (to.a - from.a, to.b - from.b, to.e - from.e);
        let bend = a * a + b * b - e * e;
        let slope = from.a * a + from.b * b - from.e * e;
        let share = if bend > 0.0 { (-slope / bend).clamp(0.0, 1.0) } else { 0.0 };
        let at = |share: f64| Crossing {
            a: from.a + a * share,
            b: from.b + b * share,
            e: from.e + e * share,
        };
        let square = at(share).square().min(from.square()).min(to.square());
        let nearest = at(share);
        let miss = libm::fabs(nearest.e) - libm::hypot(nearest.a, nearest.b);
        let gap = square.max(0.0).sqrt();
        Some(Meeting { share, gap, miss: miss.max(0.0), joint: carrier })
    }

    /// The solutions that a cut from `from`, where it stands at the first pose, can go on to at the second.
    ///
    /// # Errors
    /// By how much the nearest misses.
    pub(super) fn next(
        &self,
        chain: &Chain,
        held: &Joints,
        [start, end]: [&Pose; 2],
        from: &Joints,
        allowed: AllowedMiss,
    ) -> Result<Vec<NextSolution>, Unreachable> {
        let solutions = self.solutions(chain, held, end, from, allowed)?;
        let side = self.side(chain, from);
        let meeting = self.meeting(chain, [start.tip, end.tip], from);
        let apart = meeting.is_none_or(|meeting| meeting.gap > allowed.tip);
        let carried = solutions.iter().any(|way| way.side.is_some_and(|side| side != 0.0));
        let alone = solutions.len() == 1 && (apart || !carried);
        let goes_on = |way: &PlanarSolution| !apart || !carried || way.side == Some(side);
        let branch = |place: usize, way: &PlanarSolution| match way.side {
            None => place as u8,
            Some(own) => u8::from(if own == 0.0 { side } else { own } > 0.0),
        };
        let mut next: Vec<NextSolution> = solutions
            .iter()
            .enumerate()
            .filter(|(_, way)| goes_on(way))
            .map(|(place, way)| NextSolution {
                joints: unwound(chain, &way.joints, from),
                branch: branch(place, way),
                sure: alone || (apart && carried),
            })
            .collect();
        let turn = |way: &NextSolution| turned(chain, &way.joints, from);
        next.sort_by(|a, b| turn(a).total_cmp(&turn(b)));
        Ok(next)
    }
}

impl Plane {
    /// How the carrier brings `tip` (mm, part frame) into the plane, the joints in front of it standing.
    fn crossing(
        &self,
        chain: &Chain,
        carrier: usize,
        turns: &Turns,
        tip: Vector3<f64>,
    ) -> Crossing {
        let axes = chain.joints();
        let back = |at: Vector3<f64>, (index, joint): (usize, &Joint)| {
            let (sine, cosine) = turns.of(index);
            joint.point + turn(at - joint.point, joint.direction, -sine, cosine)
        };
        let front = axes[..carrier].iter().enumerate();
        let tip = front.fold(tip + chain.mount(), back);
        let Joint { direction: k, point, .. } = axes[carrier];
        let arm = tip - point;
        let along = self.normal.dot(&k) * k.dot(&arm);
        Crossing {
            a: self.normal.dot(&arm) - along,
            b: -self.normal.dot(&k.cross(&arm)),
            e: self.height - along,
        }
    }
}

impl Solver {
    /// What solves two linear axes without a search.
    pub(super) fn planar_form(&self) -> Option<&Planar> {
        match &self.form {
            SolutionMethod::Numeric { planar, .. } => planar.as_deref(),
            SolutionMethod::Closed { .. } => None,
        }
    }

    /// Two linear axes move the tip in a plane, and formulas say how rotary axes turn it: not every way of the tip can be
    /// followed.
    pub fn planar(&self) -> bool {
        self.planar_form().is_some()
    }

    fn allowed(&self, axis: f64) -> AllowedMiss {
        AllowedMiss { tip: self.tip_tolerance, axis: axis.max(VERIFIED) }
    }

    pub(super) fn solutions(
        &self,
        planar: &Planar,
        pose: &Pose,
        last: &Joints,
        tolerance: f64,
    ) -> Result<Vec<PlanarSolution>, Unreachable> {
        planar.solutions(&self.chain, &self.held, pose, last, self.allowed(tolerance))
    }

    /// The solution over which the way from one set of axis values to another is shortest.
    pub(super) fn in_plane(
        &self,
        planar: &Planar,
        pose: &Pose,
        [first, last]: [&Joints; 2],
        tolerance: f64,
    ) -> Result<Joints, Unreachable> {
        let ways = self.solutions(planar, pose, first, tolerance)?;
        let halfway: Joints = std::array::from_fn(|joint| (first[joint] + last[joint]) / 2.0);
        let ways = ways.iter().map(|way| unwound(&self.chain, &way.joints, &halfway));
        let turn = |joints: &Joints| {
            let turned = |end: &Joints| turned(&self.chain, joints, end);
            turned(first) + turned(last)
        };
        let shortest = ways.min_by(|a, b| turn(a).total_cmp(&turn(b)));
        shortest.ok_or(Unreachable::Linear)
    }

    /// For a chain without a closed form: the solution between two sets of axis values, over which the way from the first
    /// to the last is shortest; of a numeric search the one next to the first, or next to halfway between the two where
    /// joints are beyond what a pose needs.
    ///
    /// # Errors
    /// By how much the nearest pose misses.
    pub fn search_between(
        &self,
        pose: &Pose,
        ends: [&Joints; 2],
        tolerance: f64,
    ) -> Result<Joints, Unreachable> {
        match self.planar_form() {
            Some(planar) => self.in_plane(planar, pose, ends, tolerance),
            None if self.surplus().is_empty() => self.search(pose, ends[0], tolerance),
            // The joints that stand at both ends stand between them.
            None => {
                let halfway = std::array::from_fn(|joint| (ends[0][joint] + ends[1][joint]) / 2.0);
                self.search(pose, &halfway, tolerance)
            }
        }
    }

    /// For a chain without a closed form: the solutions that a cut from the first pose, where it stands at `from`, can go
    /// on to at the second, the one that turns least first; of a numeric search the one next to `from`.
    ///
    /// # Errors
    /// By how much the nearest pose misses.
    pub fn next(
        &self,
        poses: [&Pose; 2],
        from: &Joints,
        tolerance: f64,
    ) -> Result<Vec<NextSolution>, Unreachable> {
        match self.planar_form() {
            Some(planar) => {
                planar.next(&self.chain, &self.held, poses, from, self.allowed(tolerance))
            }
            None => {
                let joints = self.search(poses[1], from, tolerance)?;
                Ok(vec![NextSolution { joints, branch: 0, sure: true }])
            }
        }
    }

    /// `joints` with the rotary joints behind the carrier as the tool axis of `pose` asks for, on the turns next to theirs: the
    /// carrier turns on the spot, and the tool stays. Of other chains `joints` as they are.
    pub fn turned_on_the_spot(&self, pose: &Pose, joints: &Joints) -> Joints {
        let Some(planar) = self.planar_form() else {
            return *joints;
        };
        let mut turned = *joints;
        planar.orientation.follow(pose, &mut turned);
        unwound(&self.chain, &turned, joints)
    }

    /// Where on a straight way of the tip (mm, part frame) two solutions come nearest to one another, of a chain whose two
    /// linear axes a rotary one carries; the other rotary joints stand as in `joints`.
    pub fn meeting(&self, way: [Vector3<f64>; 2], joints: &Joints) -> Option<Meeting> {
        self.planar_form()?.meeting(&self.chain, way, joints)
    }
}

/// By how much more than is allowed the axes miss a pose; none where they do not.
fn missed(
    chain: &Chain,
    pose: &Pose,
    joints: &Joints,
    allowed: AllowedMiss,
) -> Option<Unreachable> {
    let reached = chain.forward(joints);
    let [tip, axis] = [(reached.tip - pose.tip).norm(), angle(reached.axis, pose.axis)];
    if axis > allowed.axis.max(2.0 * POLE) {
        Some(Unreachable::Axis { miss: axis })
    } else if tip > allowed.tip + POLE {
        Some(Unreachable::Plane { miss: tip })
    } else {
        None
    }
}

/// Each angle on the turn next to that of `near`.
fn unwound(chain: &Chain, joints: &Joints, near: &Joints) -> Joints {
    let mut joints = *joints;
    for (index, _) in chain.joints().iter().enumerate().filter(|(_, joint)| joint.rotary) {
        joints[index] += TAU * libm::rint((near[index] - joints[index]) / TAU);
    }
    joints
}

/// The sum of all turns between two sets of axis values, radians.
fn turned(chain: &Chain, joints: &Joints, other: &Joints) -> f64 {
    let axes = chain.joints().iter().enumerate().filter(|(_, joint)| joint.rotary);
    axes.map(|(index, _)| libm::fabs(joints[index] - other[index])).sum()
}
