//! The inverse of chains without a closed form (fewer than three linear axes): Levenberg's damped Newton steps
//! from a known point, verified by the forward product.
//!
//! Residual: the tip (mm) and the tool axis, whose error in radians counts as an arm of [`ARM`] mm. Where the
//! chain has more axes than the pose needs, each step is the shortest that there is.

use nalgebra::{SMatrix, SVector, Vector3};

use super::chain::{Chain, Joints, MAX_AXES, Pose, turn};

/// mm that a radian of the tool axis counts as.
const ARM: f64 = 300.0;

/// Steps from one start; quadratic convergence needs a handful.
pub(super) const STEPS: usize = 60;

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
    let mut joints = *start;
    let (mut residual, mut jacobian) = linearised(chain, free, pose, &joints);
    let mut damping = 1e-6;
    while *left > 0 {
        let size = residual.norm();
        if size < SOLVED {
            break;
        }
        *left -= 1;
        // Square in the joints, whose number never exceeds eight; unused rows are the identity.
        let mut normal: SMatrix<f64, MAX_AXES, MAX_AXES> = jacobian.transpose() * jacobian;
        let scale = normal.diagonal().max();
        for index in 0..MAX_AXES {
            normal[(index, index)] += if index < free.len() {
                // Each joint by its own measure: a radian moves the tip by far more than a millimetre does.
                damping * normal[(index, index)].max(1e-9 * scale)
            } else {
                1.0
            };
        }
        let Some(factor) = normal.cholesky() else {
            break;
        };
        let step = factor.solve(&(jacobian.transpose() * residual));
        let mut next = joints;
        for (index, joint) in free.iter().enumerate() {
            next[*joint] -= step[index];
        }
        let (next_residual, next_jacobian) = linearised(chain, free, pose, &next);
        if next_residual.norm() < size {
            joints = next;
            residual = next_residual;
            jacobian = next_jacobian;
            damping = (damping * 0.1).max(1e-15);
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    (joints, residual.norm())
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

/// A velocity is nothing where it is less than this share of the largest, or of what is left of it.
const NOTHING: f64 = 1e-7;

/// Counts the ways in which tip and tool move, the free joints standing at `joints`.
pub(super) fn ways(chain: &Chain, free: &[usize], joints: &Joints) -> Ways {
    let (_, jacobian) = linearised(chain, free, &Pose::default(), joints);
    let rank = |from: usize, rows: usize| {
        let column = |place: usize| {
            let mut column = Rows::zeros();
            let part = jacobian.column(place);
            column.rows_mut(from, rows).copy_from(&part.rows(from, rows));
            column
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

/// Puts the linear joints of `linear` (fewer than three) where the tip comes closest to `tip`: least squares,
/// exact in one step since the tip is linear in them.
pub(super) fn approach(chain: &Chain, linear: &[usize], tip: Vector3<f64>, joints: &mut Joints) {
    if linear.is_empty() {
        return;
    }
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
        _ => return,
    };
    for (joint, value) in linear.iter().zip(values) {
        joints[*joint] += value;
    }
}

/// Residual at `joints`, and how it changes with each free joint.
///
/// One way along the chain, from the workpiece to the tool, takes the frame of each joint to the part: a joint turns
/// all that lies behind it about its line as it stands there.
fn linearised(
    chain: &Chain,
    free: &[usize],
    pose: &Pose,
    joints: &Joints,
) -> (Rows, SMatrix<f64, 9, MAX_AXES>) {
    let mut frame = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut origin = -chain.mount();
    let out = |frame: &[Vector3<f64>; 3], v: Vector3<f64>| {
        frame[0] * v.x + frame[1] * v.y + frame[2] * v.z
    };
    // Of each joint a point of its line and its direction, part frame.
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
    let reached = Pose {
        tip: origin + out(&frame, chain.tip()),
        axis: out(&frame, chain.axis()),
        edge: chain.edge().map_or_else(Vector3::zeros, |edge| out(&frame, edge)),
    };
    let edged = chain.edge().is_some();
    let mut residual = Rows::zeros();
    let mut jacobian = SMatrix::<f64, 9, MAX_AXES>::zeros();
    let tip = reached.tip - pose.tip;
    let axis = (reached.axis - pose.axis) * ARM;
    residual.fixed_rows_mut::<3>(0).copy_from(&tip);
    residual.fixed_rows_mut::<3>(3).copy_from(&axis);
    if edged {
        let edge = (reached.edge - pose.edge_across()) * ARM;
        residual.fixed_rows_mut::<3>(6).copy_from(&edge);
    }
    for (column, index) in free.iter().enumerate() {
        let (point, k) = lines[*index];
        if !chain.joints()[*index].rotary {
            jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&k);
            continue;
        }
        let tip = k.cross(&(reached.tip - point));
        let axis = k.cross(&reached.axis) * ARM;
        jacobian.fixed_view_mut::<3, 1>(0, column).copy_from(&tip);
        jacobian.fixed_view_mut::<3, 1>(3, column).copy_from(&axis);
        if edged {
            let edge = k.cross(&reached.edge) * ARM;
            jacobian.fixed_view_mut::<3, 1>(6, column).copy_from(&edge);
        }
    }
    (residual, jacobian)
}
