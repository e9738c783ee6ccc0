//! Where the axes stand on the way, as well as the tool.

use nalgebra::{UnitQuaternion, Vector3};
use post_machine::kinematics::{Joints, Pose, Solver, Turns, Unreachable};

use super::{Interpolation, Stance, joints_between};

/// How far the tool axis may miss where the control leads it by vectors, radians: the axes of the ends reach theirs, so
/// that more than rounding means that the great circle between them leaves what the axes can reach.
const MISS: f64 = 1e-7;

/// How far a tool that is led as a whole may miss, mm, its frame on the arm of the search.
const STANDS: f64 = 1e-6;

impl Interpolation {
    /// Axis values at `t` from 0 to 1 of the way's own parameter, mm and radians: [`Interpolation::stance_at`] without its pose.
    ///
    /// # Errors
    /// As [`Interpolation::stance_at`].
    pub fn joints_at(
        &self,
        solver: &Solver,
        ends: [&Stance; 2],
        t: f64,
        near: &Joints,
    ) -> Result<Joints, Unreachable> {
        let Some(tip) = self.tip(ends, t) else {
            return Ok(joints_between(ends, t));
        };
        if let Some(pose) = self.led(ends, tip, t) {
            return self.follow(solver, ends, &pose, t, near);
        }
        placed(solver, ends, tip, t).map(|(joints, _)| joints)
    }

    /// Axis values, tip and tool axis at `t` from 0 to 1 of the way's own parameter.
    ///
    /// Where the control leads the axes all go linearly. Where it leads the tip, the rotary axes go linearly and the
    /// linear ones follow from the tip; where it leads the tool axis or the whole tool too, the axes are the solution
    /// nearest to `near`, the axis values a little before, which nothing else asks for.
    ///
    /// # Errors
    /// The axes cannot follow: a great circle leads out of what they reach, or they span no volume there.
    pub fn stance_at(
        &self,
        solver: &Solver,
        ends: [&Stance; 2],
        t: f64,
        near: &Joints,
    ) -> Result<Stance, Unreachable> {
        let chain = solver.chain();
        let Some(tip) = self.tip(ends, t) else {
            let joints = joints_between(ends, t);
            let pose = chain.forward(&joints);
            return Ok(Stance { joints, pose });
        };
        if let Some(pose) = self.led(ends, tip, t) {
            let joints = self.follow(solver, ends, &pose, t, near)?;
            return Ok(Stance { joints, pose });
        }
        let (joints, turns) = placed(solver, ends, tip, t)?;
        let pose = chain.pose(&joints, &turns);
        Ok(Stance { joints, pose })
    }

    /// The axis values next to `near` at a pose of a way on which the control leads the directions of the tool.
    fn follow(
        &self,
        solver: &Solver,
        ends: [&Stance; 2],
        pose: &Pose,
        t: f64,
        near: &Joints,
    ) -> Result<Joints, Unreachable> {
        let Self::TipAndFrame(turn) = self else {
            return nearest(solver, pose, near);
        };
        let [axis, across] = solver.stand(&ends[0].joints).ok_or(Unreachable::Linear)?;
        let turned = UnitQuaternion::from_scaled_axis(turn * t);
        let stand = Pose { tip: pose.tip, axis: turned * axis, edge: turned * across };
        let missed = Unreachable::Numeric { miss: STANDS };
        // A rail goes evenly beside the arm.
        let evenly = joints_between(ends, t);
        let mut near = *near;
        let front = solver.before_arm();
        near[..front].copy_from_slice(&evenly[..front]);
        solver.search_stand(&stand, &near, STANDS).ok_or(missed)
    }

    /// [`Interpolation::stance_at`] of each of `shares`, one after the other, the first `near` those axis values and the
    /// others near those before them: where all axes go linearly their poses are found together.
    ///
    /// # Errors
    /// As [`Interpolation::stance_at`].
    pub fn stances_at<const N: usize>(
        &self,
        solver: &Solver,
        ends: [&Stance; 2],
        shares: &[f64; N],
        near: &Joints,
    ) -> Result<[Stance; N], Unreachable> {
        let mut stances = [Stance { joints: *near, pose: Pose::default() }; N];
        if matches!(self, Self::Axes) && N > 1 {
            let joints = shares.map(|share| joints_between(ends, share));
            let mut poses = Vec::with_capacity(N);
            solver.chain().forward_all(&joints, &mut poses);
            for ((stance, joints), pose) in stances.iter_mut().zip(joints).zip(poses) {
                *stance = Stance { joints, pose };
            }
            return Ok(stances);
        }
        let mut near = *near;
        for (stance, share) in stances.iter_mut().zip(shares) {
            *stance = self.stance_at(solver, ends, *share, &near)?;
            near = stance.joints;
        }
        Ok(stances)
    }
}

/// The rotary axes `t` of the way between `ends`, and the linear ones such that the tip stands on `tip`.
#[inline]
fn placed(
    solver: &Solver,
    ends: [&Stance; 2],
    tip: Vector3<f64>,
    t: f64,
) -> Result<(Joints, Turns), Unreachable> {
    let mut joints = joints_between(ends, t);
    let turns = solver.chain().turns(&joints);
    solver.place(tip, &mut joints, &turns)?;
    Ok((joints, turns))
}

/// The solution nearest to `near`, travel not regarded: that of the ends was found good.
fn nearest(solver: &Solver, pose: &Pose, near: &Joints) -> Result<Joints, Unreachable> {
    if !solver.closed_form() {
        return solver.search(pose, near, MISS);
    }
    let branches = solver.orient(pose, MISS)?;
    let mut best: Option<(f64, Joints)> = None;
    for index in 0..branches.count() {
        let mut set = solver.angles(&branches, index);
        set.keep(near);
        let mut way = 0.0;
        for (place, joint) in solver.chain().joints().iter().enumerate() {
            if joint.rotary {
                let off = libm::remainder(set.joints[place] - near[place], std::f64::consts::TAU);
                set.joints[place] = near[place] + off;
                way += libm::fabs(off);
            }
        }
        if best.is_none_or(|(least, _)| way < least) {
            best = Some((way, set.joints));
        }
    }
    let Some((_, mut joints)) = best else {
        return Ok(*near);
    };
    let turns = solver.chain().turns(&joints);
    solver.place(pose.tip, &mut joints, &turns)?;
    Ok(joints)
}
