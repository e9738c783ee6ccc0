//! The inverse of chains without a closed form (fewer than three linear axes, or rotary axes other than the closed form
//! knows): Levenberg's damped Newton steps
//! from a known point, verified by the forward product.
//!
//! Residual: the tip (mm) and the tool axis, whose error in radians counts as an arm of [`ARM`] mm. Where the
//! chain has more axes than the pose needs, each step is the shortest that there is.

use nalgebra::{Matrix3, SVector, Vector3};

use super::chain::{Chain, Joints, MAX_AXES, Pose, turn};

/// mm that a radian of the tool axis counts as.
const ARM: f64 = 300.0;

/// Steps from one start; quadratic convergence needs a handful.
pub(super) const STEPS: usize = 60;

/// Steps in which linear axes come to a tip with their errors: each leaves what these change by over its length, less than a
/// fiftieth.
const ERRING_STEPS: usize = 8;

/// Residuals below this are taken as none, mm.
const SOLVED: f64 = 1e-10;

type Rows = SVector<f64, 9>;

/// Axis values near `start` that reach `pose`, moving the joints of `free` alone. The best that was found, and
/// by how much it misses (mm, the axis on its arm). In no more steps than `left`, from which it takes those that it
/// needed.
pub(super) fn solve(
    chain: &Chain,
    free: &[usize],
    pose: &Pose,
    start: &Joints,
    left: &mut usize,
) -> (Joints, f64) {
    let sized = if chain.edge().is_some() { sized::<9> } else { sized::<6> };
    sized(chain, free, pose, start, left)
}

/// [`solve`] with `R` rows of the residual. A step costs as the cube of the number of joints: each number of them has a
/// step of its own.
fn sized<const R: usize>(
    chain: &Chain,
    free: &[usize],
    pose: &Pose,
    start: &Joints,
    left: &mut usize,
) -> (Joints, f64) {
    let stepping = match free.len() {
        1 => stepping::<1, R>,
        2 => stepping::<2, R>,
        3 => stepping::<3, R>,
        4 => stepping::<4, R>,
        5 => stepping::<5, R>,
        6 => stepping::<6, R>,
        7 => stepping::<7, R>,
        8 => stepping::<8, R>,
        _ => stepping::<MAX_AXES, R>,
    };
    stepping(chain, free, pose, start, left)
}

/// [`solve`] with `R` rows of the residual and at most `N` free joints.
fn stepping<const N: usize, const R: usize>(
    chain: &Chain,
    free: &[usize],
    pose: &Pose,
    start: &Joints,
    left: &mut usize,
) -> (Joints, f64) {
    let mut joints = *start;
    let stand = Stand::<R>::of(chain, pose, &joints);
    let mut size = stand.size();
    let mut equations = NormalEquations::<N>::of(&stand.jacobian(chain, free), &stand.residual);
    let mut damping = 1e-6;
    while *left > 0 {
        if size < SOLVED {
            break;
        }
        *left -= 1;
        let Some(step) = equations.step(free.len(), damping) else {
            break;
        };
        let mut next = joints;
        for (joint, step) in free.iter().zip(step) {
            next[*joint] -= step;
        }
        // What changes with the joints is asked for where it is gone on from.
        let there = Stand::<R>::of(chain, pose, &next);
        let next_size = there.size();
        if next_size < size {
            (joints, size) = (next, next_size);
            equations = NormalEquations::of(&there.jacobian(chain, free), &there.residual);
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    (joints, size)
}

/// What moves with the free joints, at one setting of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ways {
    /// Independent directions of the tip.
    pub of_tip: usize,
    /// Ways that are left while the tool axis keeps its direction.
    pub with_axis_kept: usize,
    /// Independent ways of the tool axis to turn while the tip stays.
    pub of_axis_with_tip_kept: usize,
}

/// How many freedoms of the whole pose (tip, tool axis and leading edge) the free joints have, standing at `joints`.
pub(super) fn freedoms(chain: &Chain, free: &[usize], joints: &Joints) -> usize {
    let stand = Stand::<9>::of(chain, &Pose::default(), joints);
    let jacobian: [[f64; MAX_AXES]; 9] = stand.jacobian(chain, free);
    rank((0..free.len()).map(|place| Rows::from_fn(|row, _| jacobian[row][place])).collect())
}

/// A velocity is nothing where it is less than this share of the largest, or of what is left of it.
const NOTHING: f64 = 1e-7;

/// Counts the ways in which tip and tool move, the free joints standing at `joints`.
pub(super) fn ways(chain: &Chain, free: &[usize], joints: &Joints) -> Ways {
    let stand = Stand::<9>::of(chain, &Pose::default(), joints);
    let jacobian: [[f64; MAX_AXES]; 9] = stand.jacobian(chain, free);
    let rank = |from: usize, rows: usize| {
        let column = |place: usize| {
            Rows::from_fn(|row, _| match (from..from + rows).contains(&row) {
                true => jacobian[row][place],
                false => 0.0,
            })
        };
        rank((0..free.len()).map(column).collect())
    };
    let (all, tip) = (rank(0, 6), rank(0, 3));
    Ways {
        of_tip: tip,
        with_axis_kept: all.saturating_sub(rank(3, 3)),
        of_axis_with_tip_kept: all.saturating_sub(tip),
    }
}

/// How many of these vectors are independent: the longest that is left is taken out of the others, until nothing is.
fn rank(mut columns: Vec<Rows>) -> usize {
    // A radian moves the tip by far more than a millimetre does: each in its own measure.
    for column in &mut columns {
        *column = column.try_normalize(1e-9).unwrap_or_default();
    }
    let mut rank = 0;
    while let Some(longest) = columns
        .iter()
        .max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))
        // One that is no number, of a machine file whose faults are still looked for, is nothing either.
        .filter(|longest| longest.norm() > NOTHING)
        .and_then(|longest| longest.try_normalize(NOTHING))
    {
        rank += 1;
        for column in &mut columns {
            *column -= longest * longest.dot(column);
        }
    }
    rank
}

/// The free joints somewhere in their turns, no two alike; the others as in `held`.
pub(super) fn spread(free: &[usize], held: &Joints, share: f64) -> Joints {
    let mut joints = *held;
    for (index, joint) in free.iter().enumerate() {
        joints[*joint] = 5.0 * (share + 0.37 * index as f64) % std::f64::consts::TAU;
    }
    joints
}

/// Puts the linear joints of `linear` (up to three) where the tip comes closest to `tip`: least squares,
/// exact in one step since the tip is linear in them, in a few where their errors bend its way.
pub(super) fn approach(chain: &Chain, linear: &[usize], tip: Vector3<f64>, joints: &mut Joints) {
    if linear.is_empty() {
        return;
    }
    let steps = if chain.errors().is_empty() { 1 } else { ERRING_STEPS };
    for _ in 0..steps {
        approach_by_a_step(chain, linear, tip, joints);
    }
}

fn approach_by_a_step(chain: &Chain, linear: &[usize], tip: Vector3<f64>, joints: &mut Joints) {
    let from = chain.forward(joints).tip;
    let mut columns = [Vector3::zeros(); MAX_AXES];
    for (column, joint) in columns.iter_mut().zip(linear) {
        let mut moved = *joints;
        moved[*joint] += 1.0;
        *column = chain.forward(&moved).tip - from;
    }
    let columns = &columns[..linear.len()];
    let way = tip - from;
    let values = match *columns {
        [a] => vec![a.dot(&way) / a.norm_squared()],
        [a, b] => {
            let (aa, ab, bb) = (a.dot(&a), a.dot(&b), b.dot(&b));
            let determinant = aa * bb - ab * ab;
            if determinant < 1e-9 {
                return;
            }
            let (aw, bw) = (a.dot(&way), b.dot(&way));
            vec![(bb * aw - ab * bw) / determinant, (aa * bw - ab * aw) / determinant]
        }
        [a, b, c] => match Matrix3::from_columns(&[a, b, c]).try_inverse() {
            Some(inverse) => (inverse * way).iter().copied().collect(),
            None => return,
        },
        _ => return,
    };
    for (joint, value) in linear.iter().zip(values) {
        joints[*joint] += value;
    }
}

/// Where tool and joints stand at one setting of the joints, part frame, and `R` rows of the residual: tip, tool axis and, of
/// nine, the leading edge.
struct Stand<const R: usize> {
    residual: [f64; R],
    tip: Vector3<f64>,
    axis: Vector3<f64>,
    edge: Option<Vector3<f64>>,
    /// Of each joint a point of its line and its direction.
    lines: [(Vector3<f64>, Vector3<f64>); MAX_AXES],
}

impl<const R: usize> Stand<R> {
    /// One way along the chain, from the workpiece to the tool, takes the frame of each joint to the part: a joint turns
    /// all that lies behind it about its line as it stands there.
    fn of(chain: &Chain, pose: &Pose, joints: &Joints) -> Self {
        let mut frame = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut origin = -chain.mount();
        let out = |frame: &[Vector3<f64>; 3], v: Vector3<f64>| {
            frame[0] * v.x + frame[1] * v.y + frame[2] * v.z
        };
        let mut lines = [(Vector3::zeros(), Vector3::zeros()); MAX_AXES];
        for ((joint, line), value) in chain.joints().iter().zip(&mut lines).zip(joints) {
            let k = out(&frame, joint.direction);
            if !joint.rotary {
                *line = (origin, k);
                origin += k * *value;
                continue;
            }
            let point = origin + out(&frame, joint.point);
            *line = (point, k);
            let (sine, cosine) = libm::sincos(*value);
            for column in &mut frame {
                *column = turn(*column, k, sine, cosine);
            }
            origin = point + turn(origin - point, k, sine, cosine);
        }
        let mut tip = origin + out(&frame, chain.tip());
        let mut axis = out(&frame, chain.axis());
        let mut edge = chain.edge().map(|edge| out(&frame, edge));
        if !chain.errors().is_empty() {
            // What they change with the joints is too little to be counted in a step.
            let stands = chain.forward(joints);
            (tip, axis, edge) = (stands.tip, stands.axis, edge.map(|_| stands.edge));
        }
        let mut residual = [0.0; R];
        put(&mut residual, 0, tip - pose.tip);
        put(&mut residual, 3, (axis - pose.axis) * ARM);
        if let Some(edge) = edge {
            put(&mut residual, 6, (edge - pose.edge_across()) * ARM);
        }
        Self { residual, tip, axis, edge, lines }
    }

    /// How the residual changes with each joint of `free`, a column each; those behind them are zero.
    fn jacobian<const N: usize>(&self, chain: &Chain, free: &[usize]) -> [[f64; N]; R] {
        let mut jacobian = [[0.0; N]; R];
        for (column, index) in free.iter().enumerate() {
            let mut put = |row: usize, change: Vector3<f64>| {
                for (row, value) in jacobian[row..].iter_mut().zip(&change) {
                    row[column] = *value;
                }
            };
            let (point, k) = self.lines[*index];
            if !chain.joints()[*index].rotary {
                put(0, k);
                continue;
            }
            put(0, k.cross(&(self.tip - point)));
            put(3, k.cross(&self.axis) * ARM);
            if let Some(edge) = self.edge {
                put(6, k.cross(&edge) * ARM);
            }
        }
        jacobian
    }

    /// By how much the pose is missed, mm, the axis on its arm.
    fn size(&self) -> f64 {
        Rows::from_fn(|row, _| self.residual.get(row).copied().unwrap_or_default()).norm()
    }
}

/// The normal equations of a residual: the matrix by columns, what stands on the right, and the largest of the diagonal.
struct NormalEquations<const N: usize> {
    matrix: [[f64; N]; N],
    right: [f64; N],
    scale: f64,
}

impl<const N: usize> NormalEquations<N> {
    fn of<const R: usize>(jacobian: &[[f64; N]; R], residual: &[f64; R]) -> Self {
        let mut matrix = [[0.0; N]; N];
        let mut right = [0.0; N];
        for (row, residual) in jacobian.iter().zip(residual) {
            for (column, by) in matrix.iter_mut().zip(row) {
                for (sum, value) in column.iter_mut().zip(row) {
                    *sum += value * by;
                }
            }
            for (sum, value) in right.iter_mut().zip(row) {
                *sum += value * residual;
            }
        }
        let scale = (0..N).map(|index| matrix[index][index]).fold(0.0, f64::max);
        Self { matrix, right, scale }
    }

    /// The damped step of the first `free` joints that takes the residual away, by Cholesky's factors. None where there
    /// are none.
    fn step(&self, free: usize, damping: f64) -> Option<[f64; N]> {
        let (mut normal, mut step, scale) = (self.matrix, self.right, self.scale);
        for (index, column) in normal.iter_mut().enumerate() {
            let diagonal = &mut column[index];
            *diagonal += if index < free {
                // Each joint by its own measure: a radian moves the tip by far more than a millimetre does.
                damping * diagonal.max(1e-9 * scale)
            } else {
                1.0
            };
        }
        factor(&mut normal)?;
        for index in 0..N {
            step[index] /= normal[index][index];
            for row in index + 1..N {
                step[row] -= step[index] * normal[index][row];
            }
        }
        for index in (0..N).rev() {
            let known = (index + 1..N).fold(0.0, |sum, row| sum + normal[index][row] * step[row]);
            step[index] = (step[index] - known) / normal[index][index];
        }
        Some(step)
    }
}

/// Puts the factor of a symmetric matrix in the place of its lower half, column by column; none where it is not positive
/// definite.
fn factor<const N: usize>(matrix: &mut [[f64; N]; N]) -> Option<()> {
    for index in 0..N {
        let (known, rest) = matrix.split_at_mut(index);
        let column = rest.first_mut()?;
        for other in known {
            let by = other[index];
            for row in index..N {
                column[row] -= by * other[row];
            }
        }
        if column[index].is_nan() || column[index] <= 0.0 {
            return None;
        }
        let root = column[index].sqrt();
        column[index] = root;
        for value in &mut column[index + 1..] {
            *value /= root;
        }
    }
    Some(())
}

fn put(rows: &mut [f64], row: usize, vector: Vector3<f64>) {
    for (place, value) in rows[row..].iter_mut().zip(&vector) {
        *place = *value;
    }
}
