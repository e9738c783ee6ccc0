//! The linear part of the inverse: once the rotary axes stand, the tip is put on its place by one small
//! linear system, whatever side of the rotaries the linear axes stand on and however skewed.

use nalgebra::{Matrix3, Vector3};

use super::batch::{AxisBatch, LANES, TurnLanes, VectorLanes, replace, turn_lanes, vector, widely};
use super::chain::{Chain, Joints, MAX_AXES, Turns, turn};
use super::derivatives::LinearShare;
use super::fault::{NoClosedForm, Unreachable};

/// A linear axis beside the three that place the tip: a quill.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Second {
    /// It takes this share of the way of axis `of` (a place in the chain).
    Share {
        /// The other axis.
        of: usize,
        /// Share, 0 to 1.
        share: f64,
    },
    /// It moves where the travel of axis `of` ends.
    Reserve {
        /// The other axis.
        of: usize,
    },
}

/// Which linear joints place the tip, and what the others do.
#[derive(Clone, Debug)]
pub(super) struct Linear {
    pub(super) joints: [usize; 3],
    /// Places of the first and the last linear joint.
    pub(super) first: usize,
    pub(super) last: usize,
    /// Inverse of the three directions, if no rotary axis stands between them and there is no further one.
    pub(super) inverse: Option<Matrix3<f64>>,
    /// Length of its longest row: no axis goes farther than this times what they go together. Infinite without it.
    pub(super) reach: f64,
    seconds: Vec<Quill>,
    /// Set where there are linear axes beside the three.
    pub(super) more: bool,
}

/// A linear axis that moves along with another.
#[derive(Clone, Debug)]
struct Quill {
    joint: usize,
    /// Which of the three.
    beside: usize,
    /// Share of the way; none if it moves where the other's travel ends.
    share: Option<f64>,
    /// Travel of the other, mm.
    travel: [f64; 2],
    /// Where it stands while the other can go on alone, mm.
    rest: f64,
}

/// Steps to a place that errors of axes have part in; two or three are needed.
const MOST_STEPS: usize = 20;

/// A tip that is missed by less stands on its place, mm.
const PLACED: f64 = 1e-9;

/// The volume that three directions must span.
pub(super) const FLAT: f64 = 1e-6;

impl Linear {
    /// `held` tells which linear joints stand still, `seconds` which move along with another, and the travel
    /// of that one.
    pub(super) fn new(
        chain: &Chain,
        held: &[usize],
        seconds: &[(usize, Second, [f64; 2])],
    ) -> Result<Self, NoClosedForm> {
        let all: Vec<usize> =
            (0..chain.joints().len()).filter(|index| !chain.joints()[*index].rotary).collect();
        let places: Vec<usize> = all
            .iter()
            .copied()
            .filter(|index| !held.contains(index))
            .filter(|index| seconds.iter().all(|(joint, ..)| joint != index))
            .collect();
        let joints: [usize; 3] = match *places.as_slice() {
            [first, second, third] => [first, second, third],
            [_, _, _, ..] => return Err(NoClosedForm::ManyLinearAxes { joints: places }),
            _ => {
                return Err(NoClosedForm::FewAxes {
                    linear: places.len(),
                    rotary: 0,
                    quills: !seconds.is_empty(),
                });
            }
        };
        let columns = joints.map(|index| chain.joints()[index].direction);
        let between = chain.joints()[joints[0]..joints[2]].iter().any(|joint| joint.rotary);
        let matrix = Matrix3::from_columns(&columns);
        if !between && libm::fabs(matrix.determinant()) < FLAT {
            return Err(NoClosedForm::FlatLinearAxes);
        }
        let more = all.len() > 3;
        let alone =
            all.iter().filter(|index| chain.joints()[**index].direction.norm() > 0.0).count();
        let inverse = if between || alone > 3 { None } else { matrix.try_inverse() };
        let seconds = seconds
            .iter()
            .filter_map(|(joint, second, travel)| {
                let (of, share) = match *second {
                    Second::Share { of, share } => (of, Some(share)),
                    Second::Reserve { of } => (of, None),
                };
                Some(Quill {
                    joint: *joint,
                    beside: joints.iter().position(|joint| *joint == of)?,
                    share,
                    travel: *travel,
                    rest: 0.0,
                })
            })
            .collect();
        Ok(Self {
            joints,
            first: joints[0],
            last: joints[2],
            reach: inverse.as_ref().map_or(f64::INFINITY, longest_row),
            inverse,
            seconds,
            more,
        })
    }

    /// With others that are parts of their chain and do not move.
    pub(super) fn alone(mut self) -> Self {
        self.more = false;
        self
    }

    /// Puts the ends at which a quill takes the place of the axis beside it, and where it rests, on the travel that `ends`
    /// gives of a joint.
    pub(super) fn keep_quills(&mut self, ends: impl Fn(usize) -> Option<[f64; 2]>) {
        let joints = self.joints;
        for quill in self.seconds.iter_mut().filter(|quill| quill.share.is_none()) {
            quill.travel = ends(joints[quill.beside]).unwrap_or(quill.travel);
            if let Some([least, most]) = ends(quill.joint) {
                quill.rest = quill.rest.max(least).min(most);
            }
        }
    }

    /// Puts the linear axes of `joints` where the tip stands on `tip` (mm, part frame).
    #[inline]
    pub(super) fn place(
        &self,
        chain: &Chain,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        if !chain.errors().is_empty() {
            return self.place_erring(chain, tip, joints, turns);
        }
        self.place_exact(chain, tip, joints, turns)
    }

    /// [`Linear::place`] with errors of axes: a fixed point. Each step takes away all of a miss but what errors change over
    /// its length.
    #[cold]
    fn place_erring(
        &self,
        chain: &Chain,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        let mut target = tip;
        for _ in 0..MOST_STEPS {
            self.place_exact(chain, target, joints, turns)?;
            let miss = tip - chain.pose(joints, turns).tip;
            if miss.norm() < PLACED {
                return Ok(());
            }
            target += miss;
        }
        Err(Unreachable::Linear)
    }

    /// [`Linear::place`] without errors of axes.
    #[inline]
    fn place_exact(
        &self,
        chain: &Chain,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        if self.more {
            return self.place_all(chain, tip, joints, turns);
        }
        let axes = chain.joints();
        // The target, taken through the rotary joints in front of the first linear one …
        let mut target = tip + chain.mount();
        for (index, joint) in axes[..self.first].iter().enumerate() {
            let (sine, cosine) = turns.of(index);
            target = joint.point + turn(target - joint.point, joint.direction, -sine, cosine);
        }
        // … and the tip through those behind the last.
        let mut tip = chain.tip();
        for index in (self.last + 1..axes.len()).rev() {
            let joint = &axes[index];
            let (sine, cosine) = turns.of(index);
            tip = joint.point + turn(tip - joint.point, joint.direction, sine, cosine);
        }
        let values = if let Some(inverse) = &self.inverse {
            inverse * (target - tip)
        } else {
            let mut columns = [Vector3::zeros(); 3];
            let mut filled = 3;
            for index in (self.first..=self.last).rev() {
                let joint = &axes[index];
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
            solve(&columns, target - tip)?
        };
        for (value, joint) in values.iter().zip(self.joints) {
            joints[joint] = *value;
        }
        Ok(())
    }

    /// Which joints each of the three ways is made of, the linear axes standing where `joints` has them.
    pub(super) fn ways(&self, joints: &Joints) -> [[LinearShare; 2]; 3] {
        std::array::from_fn(|place| {
            let joint = self.joints[place];
            let mut way = [LinearShare { joint, share: 1.0 }, LinearShare { joint, share: 0.0 }];
            for quill in self.seconds.iter().filter(|quill| quill.beside == place) {
                // Where the other stands at the end of its travel, the quill goes in its place.
                let at_end = || quill.travel.contains(&joints[joint]);
                let share = quill.share.unwrap_or_else(|| f64::from(u8::from(at_end())));
                way[0].share -= share;
                way[1] = LinearShare { joint: quill.joint, share };
            }
            way
        })
    }

    /// [`Linear::place`] of a batch: the linear axes of `at` for the first `count` of `tips`. False, and nothing done,
    /// where the linear axes do not stand side by side, or there are more than three.
    pub(super) fn place_batch(
        &self,
        chain: &Chain,
        tips: &VectorLanes,
        count: usize,
        at: &mut AxisBatch,
    ) -> bool {
        let Some(inverse) = self.inverse.filter(|_| !self.more && chain.errors().is_empty()) else {
            return false;
        };
        widely(
            #[inline(always)]
            || self.place_lanes(chain, tips, count, at, inverse),
        );
        true
    }

    /// [`Linear::place_batch`], with the inverse of the directions of the linear axes.
    #[inline(always)]
    fn place_lanes(
        &self,
        chain: &Chain,
        tips: &VectorLanes,
        count: usize,
        at: &mut AxisBatch,
        inverse: Matrix3<f64>,
    ) {
        let axes = chain.joints();
        let (mount, tip) = (chain.mount(), chain.tip());
        let mut targets = *tips;
        replace(&mut targets, count, |tip, _| tip + mount);
        for (index, joint) in axes[..self.first].iter().enumerate() {
            let (sines, cosines) = (&at.sines[index], &at.cosines[index]);
            let by = TurnLanes { sines, cosines, sense: -1.0 };
            turn_lanes(&mut targets, count, joint.direction, Some(joint.point), by);
        }
        if self.last + 1 < axes.len() {
            let mut ends = [[tip.x; LANES], [tip.y; LANES], [tip.z; LANES]];
            for (index, joint) in axes.iter().enumerate().skip(self.last + 1).rev() {
                let (sines, cosines) = (&at.sines[index], &at.cosines[index]);
                let by = TurnLanes { sines, cosines, sense: 1.0 };
                turn_lanes(&mut ends, count, joint.direction, Some(joint.point), by);
            }
            replace(&mut targets, count, |target, lane| inverse * (target - vector(&ends, lane)));
        } else {
            replace(&mut targets, count, |target, _| inverse * (target - tip));
        }
        for (values, joint) in targets.iter().zip(self.joints) {
            at.joints[joint] = *values;
        }
    }

    /// [`Linear::place`] with more than three linear axes; those that are held stand where `joints` has them.
    fn place_all(
        &self,
        chain: &Chain,
        tip: Vector3<f64>,
        joints: &mut Joints,
        turns: &Turns,
    ) -> Result<(), Unreachable> {
        // Everything in the part frame: where the tip stands with the moving axes at zero, and how each moves it.
        for joint in self.joints {
            joints[joint] = 0.0;
        }
        for quill in &self.seconds {
            joints[quill.joint] = if quill.share.is_some() { 0.0 } else { quill.rest };
        }
        let mut columns = [Vector3::zeros(); MAX_AXES];
        let mut from = chain.tip();
        for (index, joint) in chain.joints().iter().enumerate().rev() {
            if joint.rotary {
                let (sine, cosine) = turns.of(index);
                from = joint.point + turn(from - joint.point, joint.direction, sine, cosine);
                for column in &mut columns[index + 1..] {
                    *column = turn(*column, joint.direction, sine, cosine);
                }
            } else {
                columns[index] = joint.direction;
                from += joint.direction * joints[index];
            }
        }
        let mut way = tip + chain.mount() - from;
        let mut main = self.joints.map(|joint| columns[joint]);
        for quill in &self.seconds {
            if let Some(share) = quill.share {
                let beside = &mut main[quill.beside];
                *beside = *beside * (1.0 - share) + columns[quill.joint] * share;
            }
        }
        let mut moving = self.joints;
        let mut values = solve(&main, way)?;
        // A quill takes the place of an axis that stands at its end, which moves what the others are asked for.
        while let Some((quill, end)) = self.beyond(&moving, &values) {
            joints[moving[quill.beside]] = end;
            moving[quill.beside] = quill.joint;
            way += columns[quill.joint] * quill.rest - main[quill.beside] * end;
            main[quill.beside] = columns[quill.joint];
            values = solve(&main, way)?;
        }
        for (joint, value) in moving.iter().zip(values.iter()) {
            joints[*joint] = *value;
        }
        for quill in &self.seconds {
            if let Some(share) = quill.share {
                let value = values[quill.beside];
                joints[quill.joint] = value * share;
                joints[self.joints[quill.beside]] = value * (1.0 - share);
            }
        }
        Ok(())
    }

    /// A quill whose axis would pass its travel, and the end at which that stands; `moving` are the axes that go to `values`.
    fn beyond(&self, moving: &[usize; 3], values: &Vector3<f64>) -> Option<(&Quill, f64)> {
        self.seconds.iter().filter(|quill| quill.share.is_none()).find_map(|quill| {
            let place = quill.beside;
            let value = values[place];
            let end = value.max(quill.travel[0]).min(quill.travel[1]);
            (moving[place] == self.joints[place] && end != value).then_some((quill, end))
        })
    }
}

/// The length of the longest row.
pub(super) fn longest_row(matrix: &Matrix3<f64>) -> f64 {
    let square = |row: usize| matrix.row(row).norm_squared();
    square(0).max(square(1)).max(square(2)).sqrt()
}

fn solve(columns: &[Vector3<f64>; 3], way: Vector3<f64>) -> Result<Vector3<f64>, Unreachable> {
    let matrix = Matrix3::from_columns(columns);
    if libm::fabs(matrix.determinant()) < FLAT {
        return Err(Unreachable::Linear);
    }
    Ok(matrix.try_inverse().ok_or(Unreachable::Linear)? * way)
}
