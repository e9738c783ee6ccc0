//! The arm of six rotary axes in closed form: eight solutions for a whole frame (tip, tool axis, edge).
//!
//! Of two kinds, both with a shoulder whose second and third axes are parallel (k2, k3). A spherical wrist has its last
//! three axes through one point (ABB, Fanuc, KUKA, Stäubli); else the fourth axis is parallel too, and the last two meet in
//! a point (Universal Robots). Either point, the centre, keeps its place along k2 whatever the axes behind the first do:
//! that gives the first angle. The next two are those of a triangle; the other three turn the tool as three rotary axes of
//! any machine do. Nothing else is assumed: offsets and zero positions are what the chain says.

use nalgebra::Vector3;

use super::chain::{Chain, Joint, Joints, Pose, square, turn};
use super::orientation::{Orientation, RotarySet, angle_about};

/// Lines that pass one another by more do not meet, mm.
const MEETS: f64 = 1e-6;

/// Directions are parallel if the sine between them is less.
const PARALLEL: f64 = 1e-9;

/// A triangle that lacks no more than this share of reaching is stretched.
const STRETCHED: f64 = 1e-12;

/// The last six joints of a chain as such an arm.
#[derive(Clone, Debug)]
pub(super) struct Arm {
    /// Place of the first joint.
    first: usize,
    /// Where the last axes meet, all axes at zero, mm.
    centre: Vector3<f64>,
    /// The point that the third axis carries: the centre of a spherical wrist, else a point of the fourth axis.
    elbow: Vector3<f64>,
    /// Three joints that turn the tool: of a spherical wrist its own, else k2, k5 and k6.
    turning: Orientation,
    spherical: bool,
    /// The edge with all axes at zero; of a tool that turns some direction across its axis.
    edge: Vector3<f64>,
}

/// The point nearest to two lines, if they meet.
fn meeting(a: &Joint, b: &Joint) -> Option<Vector3<f64>> {
    let cross = a.direction.cross(&b.direction);
    let square = cross.norm_squared();
    if square < PARALLEL {
        return None;
    }
    let between = b.point - a.point;
    let along = between.cross(&b.direction).dot(&cross) / square;
    (libm::fabs(between.dot(&cross)) < MEETS * square.sqrt()).then(|| a.point + a.direction * along)
}

/// How far a point is from a joint's line, mm.
fn beside(joint: &Joint, point: Vector3<f64>) -> f64 {
    joint.direction.cross(&(point - joint.point)).norm()
}

fn parallel(a: &Joint, b: &Joint) -> bool {
    a.direction.cross(&b.direction).norm() < PARALLEL
}

/// Turns a point about a joint by `angle`.
fn about(joint: &Joint, point: Vector3<f64>, angle: f64) -> Vector3<f64> {
    joint.point + aim(joint, point - joint.point, angle)
}

/// Turns a direction about a joint by `angle`.
fn aim(joint: &Joint, direction: Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (sine, cosine) = libm::sincos(angle);
    turn(direction, joint.direction, sine, cosine)
}

impl Arm {
    /// None where the last six joints are no such arm, or not all of them are `free`.
    pub(super) fn new(chain: &Chain, free: &[usize]) -> Option<Self> {
        let joints = chain.joints();
        let first = joints.len().checked_sub(6)?;
        let arm: [Joint; 6] = joints[first..].try_into().ok()?;
        let whole = (first..joints.len()).all(|place| free.contains(&place));
        if !whole || arm.iter().any(|joint| !joint.rotary) || !parallel(&arm[1], &arm[2]) {
            return None;
        }
        let centre = meeting(&arm[4], &arm[5])?;
        let spherical = beside(&arm[3], centre) < MEETS && !parallel(&arm[3], &arm[1]);
        if parallel(&arm[0], &arm[1]) || !(spherical || parallel(&arm[3], &arm[1])) {
            return None;
        }
        let edge = chain.edge().unwrap_or_else(|| square(Vector3::x(), chain.axis()));
        let leading = if spherical { arm[3] } else { arm[1] };
        let turning =
            Chain::new(vec![leading, arm[4], arm[5]], Vector3::zeros(), chain.tip(), chain.axis());
        let turning = turning.with_edge(Some(edge));
        let (turning, _) = Orientation::new(&turning, &[0, 1, 2], &Joints::default()).ok()?;
        let elbow = if spherical { centre } else { arm[3].point };
        Some(Self { first, centre, elbow, turning, spherical, edge })
    }

    /// Place of its first joint in the chain.
    pub(super) fn first(&self) -> usize {
        self.first
    }

    /// The edge with all axes at zero, some direction across the axis of a tool that turns.
    pub(super) fn edge(&self) -> Vector3<f64> {
        self.edge
    }

    /// On which side of shoulder, elbow and wrist the axes stand, a bit each: solutions that differ in one do not go on from
    /// one another.
    pub(super) fn branch(&self, chain: &Chain, joints: &Joints) -> u8 {
        let arm = &chain.joints()[self.first..];
        let q = &joints[self.first..];
        let carriers = if self.spherical { 1..3 } else { 1..4 };
        let centre = carriers.rev().fold(self.centre, |at, place| about(&arm[place], at, q[place]));
        let k = arm[1].direction;
        let across = |way: Vector3<f64>| way - k * k.dot(&way);
        let upper = across(arm[2].point - arm[1].point);
        let fore = across(aim(&arm[2], self.elbow - arm[2].point, q[2]));
        let leading = if self.spherical { arm[3].direction } else { k };
        let wrist = arm[4].direction.cross(&aim(&arm[4], arm[5].direction, q[4]));
        let sides = [
            arm[0].direction.cross(&(centre - arm[0].point)).dot(&k),
            upper.cross(&fore).dot(&k),
            leading.dot(&wrist),
        ];
        sides
            .iter()
            .enumerate()
            .fold(0, |bits, (place, side)| bits | u8::from(*side > 0.0) << place)
    }

    /// Adds to `found` the solutions for a whole frame, the joints in front of the arm standing as in `last`; angles in -π
    /// to π. They are not verified.
    pub(super) fn solutions(
        &self,
        chain: &Chain,
        pose: &Pose,
        last: &Joints,
        found: &mut Vec<Joints>,
    ) {
        let (front, arm) = chain.joints().split_at(self.first);
        let mut tip = pose.tip + chain.mount();
        let [mut axis, mut edge] = [pose.axis, pose.edge_across()];
        for (joint, value) in front.iter().zip(last) {
            if joint.rotary {
                tip = about(joint, tip, -value);
                [axis, edge] = [axis, edge].map(|way| aim(joint, way, -value));
            } else {
                tip -= joint.direction * *value;
            }
        }
        // The centre seen from the tip, in the coordinates of the tool's frame.
        let (tool_axis, arm_of) = (chain.axis(), self.centre - chain.tip());
        let centre = tip
            + axis * tool_axis.dot(&arm_of)
            + edge * self.edge.dot(&arm_of)
            + axis.cross(&edge) * tool_axis.cross(&self.edge).dot(&arm_of);
        for turned in first_angles(arm, self.centre, centre) {
            let centre = about(&arm[0], centre, -turned);
            let [axis, edge] = [axis, edge].map(|way| aim(&arm[0], way, -turned));
            let mut joints = *last;
            joints[self.first] = turned;
            let pose = Pose { tip: centre, axis, edge };
            match self.spherical {
                true => self.with_wrist(arm, &pose, &joints, found),
                false => self.with_parallel_wrist(arm, &pose, &joints, found),
            }
        }
    }

    /// A spherical wrist: the triangle to its centre first. `pose` has the centre in the place of the tip, behind the
    /// first joint.
    fn with_wrist(&self, arm: &[Joint], pose: &Pose, joints: &Joints, found: &mut Vec<Joints>) {
        for [second, third] in self.triangle(arm, pose.tip) {
            let back = |way| aim(&arm[2], aim(&arm[1], way, -second), -third);
            let (axis, edge) = (back(pose.axis), back(pose.edge));
            for [fourth, fifth, sixth] in self.turns(axis, edge) {
                let angles = [second, third, fourth, fifth, sixth];
                found.push(self.with(joints, angles));
            }
        }
    }

    /// A fourth axis that is parallel to the third: how the tool is turned first.
    fn with_parallel_wrist(
        &self,
        arm: &[Joint],
        pose: &Pose,
        joints: &Joints,
        found: &mut Vec<Joints>,
    ) {
        let sense = [2, 3].map(|place| arm[1].direction.dot(&arm[place].direction).signum());
        for [all, fifth, sixth] in self.turns(pose.axis, pose.edge) {
            let elbow = pose.tip + aim(&arm[1], self.elbow - self.centre, all);
            for [second, third] in self.triangle(arm, elbow) {
                let fourth = sense[1] * (all - second - sense[0] * third);
                let angles = [second, third, fourth, fifth, sixth];
                found.push(self.with(joints, angles));
            }
        }
    }

    /// `joints` with the angles of the arm behind its first joint.
    fn with(&self, joints: &Joints, angles: [f64; 5]) -> Joints {
        let mut joints = *joints;
        for (joint, angle) in joints[self.first + 1..].iter_mut().zip(angles) {
            *joint = libm::remainder(angle, std::f64::consts::TAU);
        }
        joints
    }

    /// Angles of the second and third joint that bring the elbow's far end to `place`.
    fn triangle(&self, arm: &[Joint], place: Vector3<f64>) -> Vec<[f64; 2]> {
        let k = arm[1].direction;
        let across = |way: Vector3<f64>| way - k * k.dot(&way);
        let upper = across(arm[2].point - arm[1].point);
        let fore = across(self.elbow - arm[2].point);
        let way = across(place - arm[1].point);
        let product = 2.0 * upper.norm() * fore.norm();
        let cosine = (way.norm_squared() - upper.norm_squared() - fore.norm_squared()) / product;
        if cosine.is_nan() || libm::fabs(cosine) > 1.0 + STRETCHED {
            return Vec::new();
        }
        let bend = libm::acos(cosine.clamp(-1.0, 1.0));
        let at_zero = angle_about(k, upper, fore);
        let sense = k.dot(&arm[2].direction).signum();
        let solution = |bend: f64| {
            let third = sense * (bend - at_zero);
            let reached = upper + aim(&arm[2], fore, third);
            [angle_about(k, reached, way), third]
        };
        if bend == 0.0 { vec![solution(0.0)] } else { vec![solution(bend), solution(-bend)] }
    }

    /// Angles of the three joints that turn the tool.
    fn turns(&self, axis: Vector3<f64>, edge: Vector3<f64>) -> Vec<[f64; 3]> {
        let pose = Pose { tip: Vector3::zeros(), axis, edge };
        let Ok(branches) = self.turning.orient(&pose, 0.0) else {
            return Vec::new();
        };
        let angles = |index| {
            let mut set = RotarySet::default();
            self.turning.angles(&branches, index, &mut set);
            [set.joints[0], set.joints[1], set.joints[2]]
        };
        (0..branches.count()).map(angles).collect()
    }
}

/// Angles of the first joint that bring the centre to where it belongs along the second axis.
fn first_angles(arm: &[Joint], at_zero: Vector3<f64>, centre: Vector3<f64>) -> Vec<f64> {
    let (k, second) = (arm[0].direction, arm[1].direction);
    let v = centre - arm[0].point;
    let along = k.dot(&v) * k.dot(&second);
    let cosine = v.dot(&second) - along;
    let sine = -k.cross(&v).dot(&second);
    let wanted = (at_zero - arm[0].point).dot(&second) - along;
    let radius = libm::hypot(cosine, sine);
    if libm::fabs(wanted) > radius * (1.0 + STRETCHED) || radius < MEETS {
        return Vec::new();
    }
    let middle = libm::atan2(sine, cosine);
    let apart = libm::acos((wanted / radius).clamp(-1.0, 1.0));
    if apart == 0.0 { vec![middle] } else { vec![middle + apart, middle - apart] }
}
