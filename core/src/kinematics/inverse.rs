//! The inverse in closed form, for zero, one and two free rotary axes in any direction and on any line.
//!
//! Only the rotary axes turn the tool axis, so they come first; the linear axes then follow from a 3 × 3
//! system. With two rotary axes k1 (nearer the workpiece) and k2, tool axis a at zero and wanted axis u,
//! the vector z between the two turns satisfies k1·z = k1·u, k2·z = k2·a, |z| = 1; k2 turns a into z and
//! k1 turns z into u (the second Paden–Kahan subproblem, with the axes on lines of any kind since
//! directions alone matter here).

use nalgebra::{Matrix3, Vector3};

use super::chain::{Chain, Joints, Pose, Turns, turn};

/// Where the wanted axis lies closer to k1 than this, k1 turns the tool axis by nothing that a CL file
/// with seven decimals could mean, and its angle is free: radians.
pub const POLE: f64 = 1e-6;

/// How far a returned solution may miss the pose when it is put through the forward product: mm per metre
/// of reach, and radians.
const VERIFIED: f64 = 1e-9;

/// The one or two ways to point the tool along one axis. Their angles are worked out when asked for: where
/// solutions are far apart, the nearer one is all that is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Branches {
    count: usize,
    /// The first free joint turns nothing here.
    pole: bool,
    /// The wanted axis behind the held turns in front of the first free joint. With two free axes, in
    /// coordinates: along k1, along `towards`, along `aside`.
    u: Vector3<f64>,
    /// The tool axis between the two turns: the coordinate along k1 is that of u, these are along `towards`
    /// and, up to the sign that tells the branches apart, along `aside`.
    x: f64,
    y: f64,
}

/// One set of rotary angles.
#[derive(Clone, Copy, Debug, Default)]
pub struct RotarySet {
    /// The angles, radians, in -π to π; places of linear axes are zero.
    pub joints: Joints,
    /// Joints whose angle is free here (on the pole, or an axis along the tool), one bit each: they keep
    /// their last value.
    pub free: u8,
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

/// Why a pose cannot be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unreachable {
    /// No rotary angles give the tool axis; the nearest orientation misses by this angle.
    Axis {
        /// Radians.
        miss: f64,
    },
    /// The linear axes span no volume at these angles.
    Linear,
}

/// How a chain is solved: prepared once a machine, tool and index position.
#[derive(Clone, Debug)]
pub struct Solver {
    chain: Chain,
    orientation: Orientation,
    /// Free rotary axes along the tool, which turn nothing: one bit each.
    idle: u8,
    /// Values of the rotary axes that are not free (indexed), radians.
    held: Joints,
    linear: Linear,
}

/// The rotary part.
#[derive(Clone, Debug)]
enum Orientation {
    /// No free rotary axis: the tool axis is constant.
    Fixed { axis: Vector3<f64> },
    /// One free rotary axis.
    One {
        joint: usize,
        before: Option<Matrix3<f64>>,
        k: Vector3<f64>,
        a: Vector3<f64>,
    },
    /// Two. Directions are taken as they stand behind the held axes in front of them.
    Two {
        joints: [usize; 2],
        /// Inverse of the held turns in front of k1, if there are any.
        before: Option<Matrix3<f64>>,
        k1: Vector3<f64>,
        k2: Vector3<f64>,
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
    },
}

/// The linear part: which joints, and where the rotary ones stand between them.
#[derive(Clone, Debug)]
struct Linear {
    joints: [usize; 3],
    /// Joints in front of the first linear one, and behind the last.
    first: usize,
    last: usize,
    /// Inverse of the three directions, if no rotary axis stands between them.
    inverse: Option<Matrix3<f64>>,
}

/// What a chain lacks for a closed form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoClosedForm {
    /// Not three linear axes.
    LinearAxes {
        /// How many there are.
        count: usize,
    },
    /// The three linear directions lie in one plane.
    FlatLinearAxes,
    /// More than two free rotary axes.
    RotaryAxes {
        /// Their places in the chain.
        joints: Vec<usize>,
    },
    /// Two free rotary axes are parallel.
    Parallel {
        /// Their places in the chain.
        joints: [usize; 2],
    },
}

impl Branches {
    const ONE: Self = Self {
        count: 1,
        pole: false,
        u: Vector3::new(0.0, 0.0, 0.0),
        x: 0.0,
        y: 0.0,
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
}

impl Solver {
    /// Prepares a chain. `free` tells which rotary joints move in a cut; the others stand at `held` (radians).
    ///
    /// # Errors
    /// What the chain lacks for a closed form.
    pub fn new(chain: Chain, free: &[usize], held: Joints) -> Result<Self, NoClosedForm> {
        let (orientation, idle) = Orientation::new(&chain, free, &held)?;
        let linear = Linear::new(&chain)?;
        Ok(Self {
            chain,
            orientation,
            idle,
            held,
            linear,
        })
    }

    /// The chain that is solved.
    pub fn chain(&self) -> &Chain {
        &self.chain
    }

    /// The ways to point the tool along `u` (unit vector, part frame) within `tolerance` (radians; it matters
    /// only where fewer than two free axes make most axes unreachable).
    ///
    /// # Errors
    /// By how much the nearest orientation misses.
    #[inline]
    pub fn orient(&self, u: Vector3<f64>, tolerance: f64) -> Result<Branches, Unreachable> {
        let within = |miss: f64| {
            if miss > tolerance {
                Err(Unreachable::Axis { miss })
            } else {
                Ok(())
            }
        };
        match &self.orientation {
            Orientation::Fixed { axis } => {
                within(angle(*axis, u))?;
                Ok(Branches::ONE)
            }
            Orientation::One { before, k, a, .. } => {
                let u = before.map_or(u, |before| before * u);
                let pole = k.cross(a).norm() < POLE || k.cross(&u).norm() < POLE;
                within(if pole {
                    angle(*a, u)
                } else {
                    (angle(*k, u) - angle(*k, *a)).abs()
                })?;
                Ok(Branches {
                    u,
                    pole,
                    ..Branches::ONE
                })
            }
            Orientation::Two {
                before,
                k1,
                k2,
                a,
                towards,
                aside,
                dot,
                per_sine,
                cone,
                ..
            } => {
                let u = before.map_or(u, |before| before * u);
                // z = k1·cosine + towards·x ± aside·y keeps k1·z = k1·u and |z| = 1; x follows from
                // k2·z = k2·a. Beside a pole cosines say little: the sine is taken from the part of u across
                // k1, and 1 - |cosine| from the sine.
                let cosine = k1.dot(&u);
                let across = u - k1 * cosine;
                let sine_squared = across.norm_squared();
                let rest = sine_squared / (1.0 + cosine.abs());
                let x = if cosine >= 0.0 {
                    (cone - dot) + dot * rest
                } else {
                    (cone + dot) - dot * rest
                } * per_sine;
                let square = sine_squared - x * x;
                // A tangent solution may come out a rounding error below zero.
                if square < -POLE * POLE {
                    let miss = two_axis_miss(*k1, *k2, *a, u);
                    if miss > POLE {
                        return Err(Unreachable::Axis { miss });
                    }
                }
                let y = square.max(0.0).sqrt();
                Ok(Branches {
                    // Both roots are one at the edge of reach, and at a pole that k2 meets.
                    count: if y == 0.0 { 1 } else { 2 },
                    pole: sine_squared < POLE * POLE,
                    u: Vector3::new(cosine, towards.dot(&across), aside.dot(&across)),
                    x,
                    y,
                })
            }
        }
    }

    /// The rotary angles of a branch.
    #[inline]
    pub fn angles(&self, branches: &Branches, index: usize) -> RotarySet {
        let mut set = RotarySet {
            joints: self.held,
            free: self.idle,
        };
        match &self.orientation {
            Orientation::Fixed { .. } => {}
            Orientation::One { joint, k, a, .. } => {
                if branches.pole {
                    set.free |= 1 << joint;
                } else {
                    set.joints[*joint] = angle_about(*k, *a, branches.u);
                }
            }
            Orientation::Two {
                joints: [first, second],
                across,
                ahead,
                ..
            } => {
                let Branches { u, x, y, .. } = branches;
                let y = if index == 0 { *y } else { -y };
                let z = Vector3::new(u.x, *x, y);
                // k2 takes a, which lies along `across`, into z; k1 takes z into u, seen along k1.
                set.joints[*second] = libm::atan2(ahead.dot(&z), across.dot(&z));
                if branches.pole {
                    set.free |= 1 << first;
                } else {
                    set.joints[*first] = libm::atan2(x * u.z - y * u.y, x * u.y + y * u.z);
                }
            }
        }
        set
    }

    /// The free joint nearer the tool.
    pub fn last_rotary(&self) -> usize {
        match &self.orientation {
            Orientation::Fixed { .. } => 0,
            Orientation::One { joint, .. } => *joint,
            Orientation::Two { joints, .. } => joints[1],
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
        let chain = self.chain.joints();
        let linear = &self.linear;
        // The target, taken through the rotary joints in front of the first linear one …
        let mut target = tip + self.chain.mount();
        for (index, joint) in chain[..linear.first].iter().enumerate() {
            let (sine, cosine) = turns.of(index);
            target = joint.point + turn(target - joint.point, joint.direction, -sine, cosine);
        }
        // … and the tip through those behind the last.
        let mut tip = self.chain.tip();
        for index in (linear.last + 1..chain.len()).rev() {
            let joint = &chain[index];
            let (sine, cosine) = turns.of(index);
            tip = joint.point + turn(tip - joint.point, joint.direction, sine, cosine);
        }
        let values = if let Some(inverse) = &linear.inverse {
            inverse * (target - tip)
        } else {
            let mut columns = [Vector3::zeros(); 3];
            let mut filled = 3;
            for index in (linear.first..=linear.last).rev() {
                let joint = &chain[index];
                if joint.rotary {
                    let (sine, cosine) = turns.of(index);
                    tip = joint.point + turn(tip - joint.point, joint.direction, sine, cosine);
                    for column in &mut columns[filled..] {
                        *column = turn(*column, joint.direction, sine, cosine);
                    }
                } else {
                    filled -= 1;
                    columns[filled] = joint.direction;
                }
            }
            let matrix = Matrix3::from_columns(&columns);
            if libm::fabs(matrix.determinant()) < 1e-6 {
                return Err(Unreachable::Linear);
            }
            matrix.try_inverse().ok_or(Unreachable::Linear)? * (target - tip)
        };
        for (value, joint) in values.iter().zip(linear.joints) {
            joints[joint] = *value;
        }
        Ok(())
    }

    /// All solutions for a pose, each verified by the forward product; a free angle is put at `last`.
    /// Angles lie in -π to π; turns and travel are for the stage that chooses.
    ///
    /// # Errors
    /// Why there is none.
    pub fn inverse(
        &self,
        pose: &Pose,
        last: &Joints,
        tolerance: f64,
    ) -> Result<Vec<Joints>, Unreachable> {
        let mut solutions = Vec::with_capacity(2);
        let mut fault = Unreachable::Linear;
        let branches = self.orient(pose.axis, tolerance)?;
        for index in 0..branches.count() {
            let mut set = self.angles(&branches, index);
            set.keep(last);
            let mut joints = set.joints;
            let turns = self.chain.turns(&joints);
            if let Err(unreachable) = self.place(pose.tip, &mut joints, &turns) {
                fault = unreachable;
                continue;
            }
            let reached = self.chain.forward(&joints);
            let reach = 1000.0 + pose.tip.norm() + joints.iter().fold(0.0, |sum, q| sum + q.abs());
            let allowed = if set.free != self.idle {
                2.0 * POLE
            } else {
                VERIFIED
            };
            if (reached.tip - pose.tip).norm() < VERIFIED * reach / 1000.0
                && angle(reached.axis, pose.axis) < allowed.max(tolerance)
            {
                solutions.push(joints);
            }
        }
        if solutions.is_empty() {
            return Err(fault);
        }
        Ok(solutions)
    }
}

impl Orientation {
    /// The rotary part, and which free joints are idle.
    fn new(chain: &Chain, free: &[usize], held: &Joints) -> Result<(Self, u8), NoClosedForm> {
        // Rotation of the held joints in `range`, as one matrix.
        let hold = |range: std::ops::Range<usize>| {
            let turns = chain.turns(held);
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
        // Inverse of the held turns in front of a joint, if there are any.
        let in_front = |joint: usize| {
            let turns = hold(0..joint);
            (turns != Matrix3::identity()).then(|| turns.transpose())
        };
        match *free {
            [] => Ok((
                Self::Fixed {
                    axis: hold(0..count) * chain.axis(),
                },
                0,
            )),
            [joint] => Ok((
                Self::One {
                    joint,
                    before: in_front(joint),
                    k: chain.joints()[joint].direction,
                    a: hold(joint + 1..count) * chain.axis(),
                },
                0,
            )),
            [first, second] => {
                let between = hold(first + 1..second);
                let k1 = chain.joints()[first].direction;
                let k2 = between * chain.joints()[second].direction;
                let cross = k1.cross(&k2);
                let sine_squared = cross.norm_squared();
                if sine_squared < 1e-6 {
                    return Err(NoClosedForm::Parallel {
                        joints: [first, second],
                    });
                }
                let before = in_front(first);
                let a = between * hold(second + 1..count) * chain.axis();
                if k2.cross(&a).norm() < POLE {
                    let one = Self::One {
                        joint: first,
                        before,
                        k: k1,
                        a,
                    };
                    return Ok((one, 1 << second));
                }
                let towards = (k2 - k1 * k1.dot(&k2)).normalize();
                let aside = cross.normalize();
                let coordinates =
                    |v: Vector3<f64>| Vector3::new(k1.dot(&v), towards.dot(&v), aside.dot(&v));
                let across = a - k2 * k2.dot(&a);
                let two = Self::Two {
                    joints: [first, second],
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
                };
                Ok((two, 0))
            }
            _ => Err(NoClosedForm::RotaryAxes {
                joints: free.to_vec(),
            }),
        }
    }
}

impl Linear {
    fn new(chain: &Chain) -> Result<Self, NoClosedForm> {
        let places: Vec<usize> = (0..chain.joints().len())
            .filter(|index| !chain.joints()[*index].rotary)
            .collect();
        let joints: [usize; 3] =
            places
                .as_slice()
                .try_into()
                .map_err(|_| NoClosedForm::LinearAxes {
                    count: places.len(),
                })?;
        let columns = joints.map(|index| chain.joints()[index].direction);
        let between = chain.joints()[joints[0]..joints[2]]
            .iter()
            .any(|joint| joint.rotary);
        let matrix = Matrix3::from_columns(&columns);
        if !between && libm::fabs(matrix.determinant()) < 1e-6 {
            return Err(NoClosedForm::FlatLinearAxes);
        }
        let inverse = if between { None } else { matrix.try_inverse() };
        Ok(Self {
            joints,
            first: joints[0],
            last: joints[2],
            inverse,
        })
    }
}

/// Angle between two unit vectors, radians, exact for small angles too.
pub fn angle(a: Vector3<f64>, b: Vector3<f64>) -> f64 {
    libm::atan2(a.cross(&b).norm(), a.dot(&b))
}

/// The angle about the unit vector `k` that turns the part of `from` across `k` into that of `to`.
#[inline]
fn angle_about(k: Vector3<f64>, from: Vector3<f64>, to: Vector3<f64>) -> f64 {
    // Across k first: beside a pole little is left of either, and differences of products would lose it.
    let from = from - k * k.dot(&from);
    let to = to - k * k.dot(&to);
    libm::atan2(k.dot(&from.cross(&to)), from.dot(&to))
}

/// By how much the nearest orientation of two rotary axes misses `u`: k2 keeps the tool axis on a cone
/// about itself, and k1 sweeps that cone over a band of latitudes about k1.
fn two_axis_miss(k1: Vector3<f64>, k2: Vector3<f64>, a: Vector3<f64>, u: Vector3<f64>) -> f64 {
    let (tilt, cone, latitude) = (angle(k1, k2), angle(k2, a), angle(k1, u));
    let least = libm::fabs(tilt - cone);
    let sum = tilt + cone;
    let most = sum.min(2.0 * std::f64::consts::PI - sum);
    (least - latitude).max(latitude - most).max(0.0)
}
