//! The rotary part of the inverse: axes that point the tool, in closed form, in any direction.
//!
//! With two rotary axes k1 (nearer the workpiece) and k2, tool axis a at zero and wanted axis u, the vector z
//! between the two turns satisfies k1·z = k1·u, k2·z = k2·a, |z| = 1; k2 turns a into z and k1 turns z into u
//! (the second Paden–Kahan subproblem, with the axes on lines of any kind since directions alone matter here).
//!
//! Three axes follow a whole tool frame: with R the turn from the tool's frame to the wanted one, k3 must come
//! to lie along R·k3, which the first two do as above with k3 in the place of a; k3 then turns the rest.

use std::f64::consts::FRAC_PI_4;

use nalgebra::{Matrix3, Vector3};

use super::batch::{AxisBatch, LANES, Lanes, groups, largest, least, widely};
use super::chain::{AxisBits, Chain, Joints, Pose, Turns, square, turn};
use super::fault::{NoClosedForm, POLE, Unreachable};
use super::lane_math::atan2_all;

/// Tool axes farther apart are those of two faces of the part, radians: half of what is between two sides of a block. Off a
/// way between two of them that nobody gave, the tool is retracted.
const OTHER_FACE: f64 = FRAC_PI_4;

/// Whether two tool axes, unit vectors in the part frame, are those of two faces of the part: the straight way from one to the
/// other may lead through it.
pub fn on_two_faces(one: &Vector3<f64>, other: &Vector3<f64>) -> bool {
    one.dot(other) < libm::cos(OTHER_FACE)
}

/// The one or two ways to point the tool along one axis. Their angles are worked out when asked for: where
/// solutions are far apart, the nearer one is all that is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Branches {
    count: usize,
    /// The first free joint turns nothing here.
    pole: bool,
    /// Sine of the angle between the wanted axis and the first free joint.
    sine: f64,
    /// The wanted axis behind the held turns in front of the first free joint. With two free axes, in
    /// coordinates: along k1, along `towards`, along `aside`.
    u: Vector3<f64>,
    /// The tool axis between the two turns: the coordinate along k1 is that of u, these are along `towards`
    /// and, up to the sign that tells the branches apart, along `aside`.
    x: f64,
    y: f64,
    /// With three free axes: where a vector across k3 is to point, behind the held turns in front of k1.
    ahead: Vector3<f64>,
}

/// One set of rotary angles.
#[derive(Clone, Copy, Debug, Default)]
pub struct RotarySet {
    /// The angles, radians, in -π to π; places of linear axes are zero.
    pub joints: Joints,
    /// Joints whose angle is free here (on the pole, or an axis along the tool), one bit each: they keep
    /// their last value.
    pub free: AxisBits,
    /// Sines and cosines of the angles, if they came with them.
    pub(super) turns: Option<Turns>,
}

impl RotarySet {
    /// Puts the free joints where they were.
    #[inline]
    pub fn keep(&mut self, last: &Joints) {
        if self.free == 0 {
            return;
        }
        for (joint, value) in self.joints.iter_mut().enumerate() {
            if self.free & (1 << joint) != 0 {
                *value = last[joint];
            }
        }
    }
}

/// How far the tool axes of many points are from the poles: see [`Branches::latitude`].
#[derive(Clone, Debug)]
pub struct LatitudeLanes {
    /// Sines of the angles from the first of two free axes.
    pub sines: Lanes,
    /// Cosines of the angles.
    pub cosines: Lanes,
}

impl Default for LatitudeLanes {
    fn default() -> Self {
        Self { sines: [0.0; LANES], cosines: [0.0; LANES] }
    }
}

/// Sines and cosines of the two turns of many points, not of unit length.
#[derive(Default)]
struct TwoTurns([LatitudeLanes; 2]);

/// A wanted axis as the two turns share it out: see the head of this file.
#[derive(Clone, Copy, Debug)]
struct SharedTurn {
    /// Coordinate along k1 of the wanted axis, and what is across k1 of it.
    cosine: f64,
    across: Vector3<f64>,
    sine_squared: f64,
    /// The vector between the two turns along `towards`, and the square of its part along `aside`.
    x: f64,
    square: f64,
}

/// The rotary axes that are solved for.
#[derive(Clone, Debug)]
pub(super) enum Orientation {
    /// No free rotary axis: the tool axis is constant.
    Fixed { axis: Vector3<f64> },
    /// One free rotary axis.
    One { joint: usize, before: Option<Matrix3<f64>>, k: Vector3<f64>, a: Vector3<f64> },
    /// Two, or the first two of three.
    Two(Box<Two>),
}

/// Two rotary axes. Directions are taken as they stand behind the held axes in front of them.
#[derive(Clone, Debug)]
pub(super) struct Two {
    joints: [usize; 2],
    /// Inverse of the held turns in front of k1, if there are any.
    before: Option<Matrix3<f64>>,
    k1: Vector3<f64>,
    k2: Vector3<f64>,
    /// What is pointed: the tool axis, or the third rotary axis.
    a: Vector3<f64>,
    /// Across k1, towards k2; and k1 × `towards`.
    towards: Vector3<f64>,
    aside: Vector3<f64>,
    /// k1·k2, and one over the sine of the angle between them.
    dot: f64,
    per_sine: f64,
    /// k2·a.
    cone: f64,
    /// The part of a across k2, and k2 × that, in the coordinates k1, `towards`, `aside`.
    across: Vector3<f64>,
    ahead: Vector3<f64>,
    /// One over the square of the part of a across k2.
    per_square: f64,
    /// Sines and cosines of the held joints.
    held: Turns,
    third: Option<Third>,
}

/// The third of three rotary axes.
#[derive(Clone, Debug)]
struct Third {
    joint: usize,
    /// Inverse of the frame of the tool at zero: axis, edge and their product as columns.
    frame: Matrix3<f64>,
    /// The edge at zero.
    edge: Vector3<f64>,
    /// k3, and of tool axis and edge the one farther from it.
    k: Vector3<f64>,
    p: Vector3<f64>,
}

impl Branches {
    const ONE: Self = Self {
        count: 1,
        pole: false,
        sine: 1.0,
        u: Vector3::new(0.0, 0.0, 0.0),
        x: 0.0,
        y: 0.0,
        ahead: Vector3::new(0.0, 0.0, 0.0),
    };

    /// How many there are: one or two.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The axis nearer the tool stands at least so far apart in the two branches, radians.
    #[inline]
    pub fn apart(&self) -> f64 {
        // The chord of a turn is no longer than its arc.
        2.0 * self.y
    }

    /// Sine and cosine of the angle between what is pointed and the first of two free axes: how far the poles are.
    #[inline]
    pub fn latitude(&self) -> (f64, f64) {
        (self.sine, self.u.x)
    }
}

impl Orientation {
    /// The rotary part, and which free joints are idle.
    pub(super) fn new(
        chain: &Chain,
        free: &[usize],
        held: &Joints,
    ) -> Result<(Self, AxisBits), NoClosedForm> {
        let turns = chain.turns(held);
        // Rotation of the held joints in `range`, as one matrix.
        let hold = |range: std::ops::Range<usize>| {
            let mut columns = [Vector3::x(), Vector3::y(), Vector3::z()];
            for index in range.rev() {
                let joint = &chain.joints()[index];
                if joint.rotary && !free.contains(&index) {
                    let (sine, cosine) = turns.of(index);
                    for column in &mut columns {
                        *column = turn(*column, joint.direction, sine, cosine);
                    }
                }
            }
            Matrix3::from_columns(&columns)
        };
        let count = chain.joints().len();
        let direction = |joint: usize| chain.joints()[joint].direction;
        // Inverse of the held turns in front of a joint, if there are any.
        let in_front = |joint: usize| {
            let turns = hold(0..joint);
            (turns != Matrix3::identity()).then(|| turns.transpose())
        };
        match *free {
            [] => Ok((Self::Fixed { axis: hold(0..count) * chain.axis() }, 0)),
            [joint] => Ok((
                Self::One {
                    joint,
                    before: in_front(joint),
                    k: direction(joint),
                    a: hold(joint + 1..count) * chain.axis(),
                },
                0,
            )),
            [first, second] => {
                let between = hold(first + 1..second);
                let k1 = direction(first);
                let k2 = between * direction(second);
                let a = between * hold(second + 1..count) * chain.axis();
                let apart = k1.cross(&k2).norm_squared() >= 1e-6;
                if apart && k2.cross(&a).norm() < POLE {
                    let one = Self::One { joint: first, before: in_front(first), k: k1, a };
                    return Ok((one, 1 << second));
                }
                let mut two = Two::new([first, second], in_front(first), k1, k2, a)?;
                two.held = turns;
                Ok((Self::Two(Box::new(two)), 0))
            }
            [first, second, third] if chain.edge().is_some() => {
                let between = hold(first + 1..second);
                let behind = between * hold(second + 1..third);
                let tool = behind * hold(third + 1..count);
                let k3 = behind * direction(third);
                let mut two = Two::new(
                    [first, second],
                    in_front(first),
                    direction(first),
                    between * direction(second),
                    k3,
                )?;
                let axis = tool * chain.axis();
                let edge = tool * chain.edge().unwrap_or_default();
                two.third = Some(Third {
                    joint: third,
                    frame: frame(axis, edge).transpose(),
                    edge,
                    k: k3,
                    p: if k3.dot(&axis).abs() < k3.dot(&edge).abs() { axis } else { edge },
                });
                Ok((Self::Two(Box::new(two)), 0))
            }
            _ => Err(NoClosedForm::RotaryAxes { joints: free.to_vec() }),
        }
    }

    /// See [`super::Solver::orient`].
    #[inline]
    pub(super) fn orient(&self, pose: &Pose, tolerance: f64) -> Result<Branches, Unreachable> {
        let within = |miss: f64| {
            if miss > tolerance { Err(Unreachable::Axis { miss }) } else { Ok(()) }
        };
        match self {
            Self::Fixed { axis } => {
                within(angle(*axis, pose.axis))?;
                Ok(Branches::ONE)
            }
            Self::One { before, k, a, .. } => {
                let u = before.map_or(pose.axis, |before| before * pose.axis);
                let pole = k.cross(a).norm() < POLE || k.cross(&u).norm() < POLE;
                within(if pole { angle(*a, u) } else { (angle(*k, u) - angle(*k, *a)).abs() })?;
                Ok(Branches { u, pole, ..Branches::ONE })
            }
            Self::Two(two) => two.orient(pose, tolerance),
        }
    }

    /// The rotary angles of a branch, put into `set`.
    #[inline]
    pub(super) fn angles(&self, branches: &Branches, index: usize, set: &mut RotarySet) {
        match self {
            Self::Fixed { .. } => {}
            Self::One { joint, k, a, .. } => {
                if branches.pole {
                    set.free |= 1 << joint;
                } else {
                    set.joints[*joint] = angle_about(*k, *a, branches.u);
                }
            }
            Self::Two(two) => two.angles(branches, index, set),
        }
    }

    /// See [`super::Solver::angles_all`].
    pub(super) fn angles_all(
        &self,
        axes: [&Lanes; 3],
        branch: usize,
        tolerance: f64,
        count: usize,
        at: &mut AxisBatch,
        latitudes: &mut LatitudeLanes,
    ) -> bool {
        match self {
            Self::Two(two) => two.angles_all(axes, branch, count, at, latitudes),
            // Nothing turns: the axis of the tool is wanted, to the bit.
            Self::Fixed { axis } => {
                let count = count.min(LANES);
                let wanted = axes.map(|part| &part[..count]);
                let same = |part: usize| wanted[part].iter().all(|value| *value == axis[part]);
                latitudes.sines[..count].fill(Branches::ONE.sine);
                latitudes.cosines[..count].fill(Branches::ONE.u.x);
                same(0) && same(1) && same(2)
            }
            Self::One { joint, before, k, a } => {
                let pointer = Pointer { k: *k, from: across(*k, *a), a: *a, tolerance };
                let mut turns = LatitudeLanes::default();
                let [x, y, z] = axes;
                let wanted = |lane: usize| Vector3::new(x[lane], y[lane], z[lane]);
                let reached = widely(
                    #[inline(always)]
                    || match before {
                        None => pointer.turn_lanes(wanted, count, &mut turns, latitudes),
                        Some(before) => {
                            let wanted = |lane: usize| before * wanted(lane);
                            pointer.turn_lanes(wanted, count, &mut turns, latitudes)
                        }
                    },
                );
                if reached {
                    atan2_all(&turns.sines, &turns.cosines, count, &mut at.joints[*joint]);
                }
                reached
            }
        }
    }

    /// The free joint nearest to the tool.
    pub(super) fn last(&self) -> usize {
        match self {
            Self::Fixed { .. } => 0,
            Self::One { joint, .. } => *joint,
            Self::Two(two) => two.joints[1],
        }
    }

    /// The first of two or three free joints: the one that turns nothing on the pole.
    pub(super) fn first(&self) -> Option<usize> {
        match self {
            Self::Two(two) => Some(two.joints[0]),
            _ => None,
        }
    }

    /// How far the tool axis goes while the first free joint turns by a radian, radians; infinite without one.
    pub(super) fn points_by(&self, branches: &Branches) -> f64 {
        match self {
            Self::Fixed { .. } => f64::INFINITY,
            Self::One { k, a, .. } => k.cross(a).norm(),
            Self::Two(_) => branches.sine,
        }
    }

    /// Latitudes (angles from the first of two free axes) between which two branches are, radians: where they
    /// end the branches meet. None with fewer free axes.
    pub(super) fn band(&self) -> Option<[f64; 2]> {
        match self {
            Self::Two(two) => Some(two.band()),
            _ => None,
        }
    }

    /// With the first free joint where `joints` has it, puts the others so that the tool axis comes as near as
    /// it can to that of `pose`.
    pub(super) fn follow(&self, pose: &Pose, joints: &mut Joints) {
        if let Self::Two(two) = self {
            two.follow(pose, joints);
        }
    }
}

/// What a single rotary axis points.
struct Pointer {
    /// The axis, what is pointed, and its part across the axis.
    k: Vector3<f64>,
    a: Vector3<f64>,
    from: Vector3<f64>,
    /// How far what is pointed may miss, radians.
    tolerance: f64,
}

impl Pointer {
    /// Fills in sines and cosines of the turns to many directions, not of unit length; false where one is free, or
    /// perhaps missed by more than the tolerance.
    #[inline(always)]
    fn turn_lanes(
        &self,
        wanted: impl Fn(usize) -> Vector3<f64>,
        count: usize,
        turns: &mut LatitudeLanes,
        latitudes: &mut LatitudeLanes,
    ) -> bool {
        let Self { k, a, from, tolerance } = *self;
        // Of a unit vector as seen from the axis: what is along it, and what is across.
        let (along, beside) = (k.dot(&a), from.norm());
        let [mut sines_squared, mut misses] = [[0.0; LANES]; 2];
        for lane in 0..groups(count) {
            let u = wanted(lane);
            let to = across(k, u);
            turns.sines[lane] = k.dot(&from.cross(&to));
            turns.cosines[lane] = from.dot(&to);
            let sine_squared = k.cross(&u).norm_squared();
            sines_squared[lane] = sine_squared;
            let (off, up) = (sine_squared.sqrt() - beside, k.dot(&u) - along);
            misses[lane] = off * off + up * up;
            latitudes.sines[lane] = Branches::ONE.sine;
            latitudes.cosines[lane] = u.x;
        }
        let count = count.min(LANES);
        // An angle below a fifth is no larger than 1.01 chords; rounding is far below 1e-9.
        let miss = 1.01 * largest(&misses[..count]).sqrt() + 1e-9;
        let far = POLE * (1.0 + 1e-6);
        miss <= tolerance.min(0.2)
            && k.cross(&a).norm() >= POLE
            && least(&sines_squared[..count]) >= far * far
    }
}

impl Two {
    fn new(
        joints: [usize; 2],
        before: Option<Matrix3<f64>>,
        k1: Vector3<f64>,
        k2: Vector3<f64>,
        a: Vector3<f64>,
    ) -> Result<Self, NoClosedForm> {
        let cross = k1.cross(&k2);
        let sine_squared = cross.norm_squared();
        if sine_squared < 1e-6 {
            return Err(NoClosedForm::Parallel { joints });
        }
        let towards = (k2 - k1 * k1.dot(&k2)).normalize();
        let aside = cross.normalize();
        let coordinates =
            |v: Vector3<f64>| Vector3::new(k1.dot(&v), towards.dot(&v), aside.dot(&v));
        let across = a - k2 * k2.dot(&a);
        Ok(Self {
            joints,
            before,
            k1,
            k2,
            a,
            towards,
            aside,
            across: coordinates(across),
            ahead: coordinates(k2.cross(&across)),
            dot: k1.dot(&k2),
            per_sine: 1.0 / sine_squared.sqrt(),
            cone: k2.dot(&a),
            per_square: 1.0 / across.norm_squared(),
            held: Turns::default(),
            third: None,
        })
    }

    /// What is to be pointed where, and where the vector across k3 goes.
    #[inline]
    fn wanted(&self, pose: &Pose) -> (Vector3<f64>, Vector3<f64>) {
        let before = |v: Vector3<f64>| self.before.as_ref().map_or(v, |before| before * v);
        match &self.third {
            None => (before(pose.axis), Vector3::zeros()),
            Some(third) => {
                // Nothing said: as it is with all axes at zero, as nearly as the axis allows.
                let edge = if pose.edge == Vector3::zeros() {
                    square(third.edge, pose.axis)
                } else {
                    pose.edge_across()
                };
                let turn = frame(pose.axis, edge) * third.frame;
                (before(turn * third.k), before(turn * third.p))
            }
        }
    }

    /// Shares the way to the wanted axis out between the two turns.
    #[inline(always)]
    fn shared(&self, u: Vector3<f64>) -> SharedTurn {
        // z = k1·cosine + towards·x ± aside·y keeps k1·z = k1·u and |z| = 1; x follows from
        // k2·z = k2·a. Beside a pole cosines say little: the sine is taken from the part of u across
        // k1, and 1 - |cosine| from the sine.
        let cosine = self.k1.dot(&u);
        let across = u - self.k1 * cosine;
        let sine_squared = across.norm_squared();
        let rest = sine_squared / (1.0 + cosine.abs());
        let x = if cosine >= 0.0 {
            (self.cone - self.dot) + self.dot * rest
        } else {
            (self.cone + self.dot) - self.dot * rest
        } * self.per_sine;
        SharedTurn { cosine, across, sine_squared, x, square: sine_squared - x * x }
    }

    /// See [`super::Solver::angles_all`].
    fn angles_all(
        &self,
        axes: [&Lanes; 3],
        branch: usize,
        count: usize,
        at: &mut AxisBatch,
        latitudes: &mut LatitudeLanes,
    ) -> bool {
        if self.third.is_some() {
            return false;
        }
        let mut turns = TwoTurns::default();
        let reached = widely(
            #[inline(always)]
            || match &self.before {
                None => self.turn_lanes(axes, branch, count, |axis| axis, &mut turns, latitudes),
                Some(before) => self.turn_lanes(
                    axes,
                    branch,
                    count,
                    |axis| before * axis,
                    &mut turns,
                    latitudes,
                ),
            },
        );
        if !reached {
            return false;
        }
        for (joint, turn) in self.joints.into_iter().zip(&turns.0) {
            atan2_all(&turn.sines, &turn.cosines, count, &mut at.joints[joint]);
        }
        true
    }

    /// Fills in the turns of a branch and the latitudes; false where an angle is free, the branches meet or the machine
    /// does not reach.
    #[inline(always)]
    fn turn_lanes(
        &self,
        axes: [&Lanes; 3],
        branch: usize,
        count: usize,
        before: impl Fn(Vector3<f64>) -> Vector3<f64>,
        turns: &mut TwoTurns,
        latitudes: &mut LatitudeLanes,
    ) -> bool {
        let [x, y, z] = axes;
        let [first, second] = &mut turns.0;
        let [mut squares, mut sines_squared] = [[0.0; LANES]; 2];
        let side = if branch == 0 { 1.0 } else { -1.0 };
        for lane in 0..groups(count) {
            let shared = self.shared(before(Vector3::new(x[lane], y[lane], z[lane])));
            let SharedTurn { cosine, across, sine_squared, x, square } = shared;
            let y = if square > 0.0 { square } else { 0.0 }.sqrt() * side;
            let u = Vector3::new(cosine, self.towards.dot(&across), self.aside.dot(&across));
            let [of_first, of_second] = self.sines(u, x, y);
            (first.sines[lane], first.cosines[lane]) = of_first;
            (second.sines[lane], second.cosines[lane]) = of_second;
            squares[lane] = square;
            sines_squared[lane] = sine_squared;
            latitudes.sines[lane] = sine_squared.sqrt();
            latitudes.cosines[lane] = cosine;
        }
        let count = count.min(LANES);
        least(&squares[..count]) > 0.0 && least(&sines_squared[..count]) >= POLE * POLE
    }

    /// Sines and cosines of the two turns, not of unit length: `u` is the wanted axis, and `x` and `y` are those of the
    /// vector between the turns.
    #[inline(always)]
    fn sines(&self, u: Vector3<f64>, x: f64, y: f64) -> [(f64, f64); 2] {
        let z = Vector3::new(u.x, x, y);
        // k2 takes a, which lies along `across`, into z; k1 takes z into u, seen along k1.
        let second = (self.ahead.dot(&z), self.across.dot(&z));
        [(x * u.z - y * u.y, x * u.y + y * u.z), second]
    }

    #[inline]
    fn orient(&self, pose: &Pose, tolerance: f64) -> Result<Branches, Unreachable> {
        let (u, ahead) = self.wanted(pose);
        let SharedTurn { mut cosine, across, sine_squared, mut x, square } = self.shared(u);
        // A tangent solution may come out a rounding error below zero.
        if square < -POLE * POLE {
            let (miss, latitude) = self.miss(u);
            if miss > tolerance.max(POLE) {
                return Err(Unreachable::Axis { miss });
            }
            // The nearest that there is: z where k2's cone touches the latitude.
            cosine = libm::cos(latitude);
            x = (self.cone - self.dot * cosine) * self.per_sine;
        }
        let y = square.max(0.0).sqrt();
        Ok(Branches {
            // Both roots are one at the edge of reach, and at a pole that k2 meets.
            count: if y == 0.0 { 1 } else { 2 },
            pole: sine_squared < POLE * POLE,
            sine: sine_squared.sqrt(),
            u: Vector3::new(cosine, self.towards.dot(&across), self.aside.dot(&across)),
            x,
            y,
            ahead,
        })
    }

    #[inline]
    fn angles(&self, branches: &Branches, index: usize, set: &mut RotarySet) {
        let [first, second] = self.joints;
        let Branches { u, x, y, .. } = branches;
        let y = if index == 0 { *y } else { -y };
        let [(first_sine, first_cosine), (sine, cosine)] = self.sines(*u, *x, y);
        let turn = libm::atan2(sine, cosine);
        set.joints[second] = turn;
        if branches.pole && self.third.is_some() {
            // The third turns against the first here: one of the two has to be said.
            set.joints[first] = 0.0;
        } else if branches.pole {
            set.free |= 1 << first;
        } else {
            set.joints[first] = libm::atan2(first_sine, first_cosine);
            if self.third.is_none() {
                // Of vectors whose lengths are known: the turns need no further sines and cosines.
                let mut turns = self.held;
                turns.set(second, sine * self.per_square, cosine * self.per_square);
                let per_square = 1.0 / (x * x + y * y);
                turns.set(first, first_sine * per_square, first_cosine * per_square);
                set.turns = Some(turns);
            }
        }
        if let Some(third) = &self.third {
            set.joints[third.joint] =
                self.third_angle(third, branches.ahead, set.joints[first], turn);
        }
    }

    /// The angle of k3 that takes its vector to `ahead`, the others standing at `q1` and `q2`.
    fn third_angle(&self, third: &Third, ahead: Vector3<f64>, q1: f64, q2: f64) -> f64 {
        let back = |v: Vector3<f64>, k: Vector3<f64>, angle: f64| {
            let (sine, cosine) = libm::sincos(angle);
            turn(v, k, -sine, cosine)
        };
        let ahead = back(back(ahead, self.k1, q1), self.k2, q2);
        angle_about(third.k, third.p, ahead)
    }

    fn follow(&self, pose: &Pose, joints: &mut Joints) {
        let (u, ahead) = self.wanted(pose);
        let [first, second] = self.joints;
        let (sine, cosine) = libm::sincos(joints[first]);
        let behind = turn(u, self.k1, -sine, cosine);
        joints[second] = angle_about(self.k2, self.a, behind);
        if let Some(third) = &self.third {
            joints[third.joint] = self.third_angle(third, ahead, joints[first], joints[second]);
        }
    }

    /// Least and largest angle from k1 that can be reached.
    fn band(&self) -> [f64; 2] {
        let (tilt, cone) = (angle(self.k1, self.k2), angle(self.k2, self.a));
        let sum = tilt + cone;
        [libm::fabs(tilt - cone), sum.min(2.0 * std::f64::consts::PI - sum)]
    }

    /// By how much the nearest orientation misses `u`, and at which angle from k1 it lies: k2 keeps a on a cone
    /// about itself, and k1 sweeps that cone over a band of latitudes about k1.
    fn miss(&self, u: Vector3<f64>) -> (f64, f64) {
        let latitude = angle(self.k1, u);
        let [least, most] = self.band();
        if least - latitude > latitude - most {
            ((least - latitude).max(0.0), least)
        } else {
            ((latitude - most).max(0.0), most)
        }
    }
}

/// Axis, edge and their product as columns.
fn frame(axis: Vector3<f64>, edge: Vector3<f64>) -> Matrix3<f64> {
    Matrix3::from_columns(&[axis, edge, axis.cross(&edge)])
}

/// Angle between two unit vectors, radians, exact for small angles too.
pub fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b))
}

/// The angle about the unit vector `k` that turns the part of `from` across `k` into that of `to`.
#[inline]
pub(super) fn angle_about(k: Vector3<f64>, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    // Across k first: beside a pole little is left of either, and differences of products would lose it.
    let (from, to) = (across(k, from), across(k, to));
    libm::atan2(k.dot(&from.cross(&to)), from.dot(&to))
}

/// The part of a vector across the unit vector `k`.
#[inline(always)]
fn across(k: Vector3<f64>, vector: Vector3<f64>) -> Vector3<f64> {
    vector - k * k.dot(&vector)
}
