//! Where the control keeps the tip: how the machine's linear axes go between the words.
//!
//! Along a block such a control turns the rotary axes linearly in t and keeps the tip on the straight line between
//! its words; the linear axes follow, and not in a straight line. With `A` their directions, `u` the tip seen through
//! the rotary axes in front of them and `v` the tool's end seen through those behind, they stand at `A·q = u - v`. All
//! of that is made of straight lines and of turns linear in t, so that its derivatives are known at every place and
//! bounded between two places, joint by joint.

use nalgebra::{Matrix3, Vector3};

use super::arm_bend::ArmBend;
use super::batch::{Column, LANES, Lanes, VectorColumn, groups, steps, vector, widely};
use super::chain::{Chain, Joints, MAX_AXES, Trace, Turns, turn};
use super::inverse::Solver;
use super::linear::{FLAT, Linear, longest_row};

/// Ends of a range that was looked into are known so well, mm.
const STRAY: f64 = 5e-5;

/// A largest speed that was looked into is known so well.
const CLOSE: f64 = 1.002;

/// No piece of a block is halved that is as short as this; what is said of it holds for pieces of any length.
const SHORTEST: f64 = 1.0 / 4096.0;

/// Arms alone say nothing of a block on which the part turns by more, radians.
const MOST_TURNS: f64 = 0.5;

/// Takes [`TcpBlock::quick`] of many blocks beyond a rotary joint.
#[inline(always)]
fn pass_lanes(
    joints: &Column,
    rates: &VectorColumn,
    count: usize,
    slopes: &mut Lanes,
    bends: &mut Lanes,
) {
    for lane in 0..groups(count) {
        let w = (joints[lane + 1] - joints[lane]).abs();
        let first = vector(rates, lane).norm_squared();
        let last = vector(rates, lane + 1).norm_squared();
        // A joint that stands adds zeros.
        let radius = if first > last { first } else { last }.sqrt() + bends[lane] / 8.0;
        bends[lane] += w * (w * radius + 2.0 * slopes[lane]);
        slopes[lane] += w * radius;
    }
}

/// A block along which the control keeps the tip on a straight line.
#[derive(Clone, Copy, Debug)]
pub struct TcpBlock<'a> {
    chain: &'a Chain,
    linear: &'a Linear,
    from: &'a Trace,
    to: &'a Trace,
    /// Way of each joint over the block, mm or radians; of the linear ones it is not asked.
    steps: Joints,
    /// The tip at both ends, mm, part frame.
    tips: [Vector3<f64>; 2],
    /// The tip with all axes at zero, mm, machine frame.
    end: Vector3<f64>,
    /// How far the point of the solver's chain stands above the tip, mm.
    along: f64,
}

/// What the linear axes do along a block: bounds that hold at every t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearMotion {
    /// Least value of each joint, mm; of those that do not slide, infinite.
    pub least: Joints,
    /// Largest value of each joint, mm; of those that do not slide, infinitely small.
    pub most: Joints,
    /// Way of each joint to and fro, mm; of those that do not slide, zero.
    pub way: Joints,
    /// The least time in which no joint passes its largest feed, minutes.
    pub minutes: f64,
    /// The joint that asks for it.
    pub slowest: usize,
    /// A time that it takes in any case, minutes.
    certain: f64,
    /// A time that is too short to matter, minutes.
    enough: f64,
}

/// The linear axes at one place of a block, and how fast they go there.
#[derive(Clone, Copy, Debug)]
struct LinearAxisState {
    t: f64,
    values: Vector3<f64>,
    slope: Vector3<f64>,
    /// How far what each rotary joint carries is from its line, mm.
    radii: Joints,
    /// Length of `u - v`, mm.
    offset: f64,
    /// Longest row of the inverse of `A`, and root of the sum of the squares of all of them.
    inverse: [f64; 2],
}

impl<'a> TcpBlock<'a> {
    /// From `from` to `to`, both solved by `solver`, whose point stands `along` mm above the tip. None for a chain
    /// whose linear axes alone do not place the tip.
    #[inline]
    pub fn new(solver: &'a Solver, along: f64, from: &'a Trace, to: &'a Trace) -> Option<Self> {
        let (chain, linear) = solver.sliding_chain()?;
        if !(solver.stands_as_held(&from.joints) && solver.stands_as_held(&to.joints)) {
            return None;
        }
        let steps = std::array::from_fn(|index| to.joints[index] - from.joints[index]);
        let tip = |trace: &Trace| trace.pose.tip - trace.pose.axis * along;
        Some(Self {
            chain,
            linear,
            from,
            to,
            steps,
            tips: [tip(from), tip(to)],
            end: chain.tip() - chain.axis() * along,
            along,
        })
    }

    /// The joints that slide, in the order of the chain.
    pub fn sliding(&self) -> [usize; 3] {
        self.linear.joints
    }

    /// Axis values at a share of the block, mm and radians; none where the linear axes cannot follow. `solver` is that of
    /// [`TcpBlock::new`].
    pub fn joints_at(&self, solver: &Solver, share: f64) -> Option<Joints> {
        let mut joints: Joints =
            std::array::from_fn(|index| self.from.joints[index] + share * self.steps[index]);
        let turns = self.chain.turns(&joints);
        let axis = self.chain.pose(&joints, &turns).axis;
        let tip = self.tips[0] + (self.tips[1] - self.tips[0]) * share;
        solver.slide(tip + axis * self.along, &mut joints, &turns).ok()?;
        Some(joints)
    }

    /// A bound on the second derivative of every linear axis, mm: from norms, cheap. Infinite where rotary axes stand
    /// between the linear ones.
    ///
    /// With r the arm of what a joint turns by w in all, and s a bound on how fast that goes by itself,
    /// `|(R r)''| <= w²·|k×r| + 2·w·s + |r''|`; r strays from its chord by at most an eighth of `|r''|`.
    #[inline]
    pub fn quick(&self) -> f64 {
        if self.linear.inverse.is_none() {
            return f64::INFINITY;
        }
        let radius = |index: usize| {
            let k = self.chain.joints()[index].direction;
            let of = |trace: &Trace| {
                let rate = trace.tip_rates[index];
                if self.along == 0.0 {
                    return rate.norm_squared();
                }
                (rate - k.cross(&trace.axes[index]) * self.along).norm_squared()
            };
            let (first, last) = (of(self.from), of(self.to));
            // [`f64::max`] asks besides whether one of them is none, at three times the cost.
            if first > last { first } else { last }.sqrt()
        };
        let pass = |index: usize, slope: &mut f64, bend: &mut f64| {
            let w = self.steps[index].abs();
            if w > 0.0 {
                let radius = radius(index) + *bend / 8.0;
                *bend += w * (w * radius + 2.0 * *slope);
                *slope += w * radius;
            }
        };
        let (mut slope, mut front) = ((self.tips[1] - self.tips[0]).norm(), 0.0);
        for index in 0..self.linear.first {
            pass(index, &mut slope, &mut front);
        }
        let (mut slope, mut behind) = (0.0, 0.0);
        for index in (self.linear.last + 1..self.chain.joints().len()).rev() {
            pass(index, &mut slope, &mut behind);
        }
        self.linear.reach * (front + behind)
    }

    /// [`TcpBlock::quick`] of the first `count` blocks of a run, whose point is the tip: `joints` (mm, radians), `rates` of
    /// the tip by rotary joint and `tips` (mm, part frame) are those of their ends. False, and nothing done, where that
    /// is infinite.
    pub fn quick_all(
        solver: &Solver,
        joints: &[Column; MAX_AXES],
        rates: &[VectorColumn; MAX_AXES],
        tips: &VectorColumn,
        count: usize,
        bends: &mut Lanes,
    ) -> bool {
        let Some(linear) = solver.linear().filter(|linear| linear.inverse.is_some()) else {
            return false;
        };
        let joints_of = solver.chain().joints().len();
        widely(
            #[inline(always)]
            || {
                let [mut slopes, mut front, mut behind] = [[0.0; LANES]; 3];
                steps(tips, count, &mut slopes);
                for index in 0..linear.first {
                    pass_lanes(&joints[index], &rates[index], count, &mut slopes, &mut front);
                }
                slopes = [0.0; LANES];
                for index in (linear.last + 1..joints_of).rev() {
                    pass_lanes(&joints[index], &rates[index], count, &mut slopes, &mut behind);
                }
                for lane in 0..groups(count) {
                    bends[lane] = linear.reach * (front[lane] + behind[lane]);
                }
            },
        );
        true
    }

    /// A bound as [`TcpBlock::quick`] has, and no less than that where the axes stray by less than metres, from the lengths
    /// of arms alone: nothing is turned for it. `ends` are the axis values of a block, mm and radians, `tip` is where the tip stands at the last of them, mm,
    /// part frame.
    ///
    /// An arm keeps its length while it turns, and the tip is never farther from where it ends than the way that the
    /// axes make it go.
    pub fn bend_by_arms(solver: &Solver, ends: [&Joints; 2], tip: Vector3<f64>) -> f64 {
        let sliding = solver.sliding_chain().filter(|(_, linear)| linear.inverse.is_some());
        let Some((chain, linear)) = sliding else {
            return f64::INFINITY;
        };
        let axes = chain.joints();
        let step = |index: usize| (ends[1][index] - ends[0][index]).abs();
        let mut behind = ArmBend::at(chain.tip(), 0.0, 0.0);
        for index in (linear.last + 1..axes.len()).rev() {
            behind.pass(axes[index].point, step(index));
        }
        let slid: f64 = (linear.first..=linear.last).map(step).sum();
        let start = tip + chain.mount();
        let mut still = ArmBend::at(start, 0.0, 0.0);
        let mut turns = 0.0;
        for (index, joint) in axes[..linear.first].iter().enumerate() {
            still.pass(joint.point, step(index));
            turns += step(index);
        }
        if turns > MOST_TURNS {
            return f64::INFINITY;
        }
        // The way lengthens the arms that make it.
        let way = (slid + behind.slope + still.slope) / (1.0 - turns);
        let mut front = ArmBend::at(start, way, way);
        for (index, joint) in axes[..linear.first].iter().enumerate() {
            front.pass(joint.point, step(index));
        }
        linear.reach * (front.bend + behind.bend)
    }

    /// Looks into the block: the range and way of each linear axis to `STRAY`, the least time that `slowness`
    /// (minutes that each joint needs for one mm or radian) leaves it to `CLOSE`; no closer than `enough` minutes.
    /// None where the linear axes span no volume somewhere on the way, or nothing is proven of it.
    pub fn slides(&self, slowness: &Joints, enough: f64) -> Option<LinearMotion> {
        let from = self.at(0.0, &self.from.turns)?;
        let to = self.at(1.0, &self.to.turns)?;
        let mut slides = LinearMotion {
            least: [f64::INFINITY; MAX_AXES],
            most: [f64::NEG_INFINITY; MAX_AXES],
            way: Joints::default(),
            minutes: 0.0,
            slowest: self.linear.joints[0],
            certain: 0.0,
            enough,
        };
        for (index, joint) in self.chain.joints().iter().enumerate() {
            let minutes = self.steps[index].abs() * slowness[index];
            if joint.rotary && minutes > slides.minutes {
                (slides.minutes, slides.slowest) = (minutes, index);
            }
        }
        slides.certain = slides.minutes;
        self.look(&from, &to, slowness, &mut slides)?;
        slides.minutes.is_finite().then_some(slides)
    }

    /// Looks into the piece between two places, halving it where it says too little.
    ///
    /// With T the bound on the third derivative and h the length of the piece, the speed strays from the line between
    /// those at the ends by at most `T·h²/8`, and the axis from the parabola that this line makes by at most `T·h³/12`.
    fn look(
        &self,
        a: &LinearAxisState,
        b: &LinearAxisState,
        slowness: &Joints,
        slides: &mut LinearMotion,
    ) -> Option<()> {
        let joints = self.linear.joints;
        for place in [a, b] {
            for (slope, joint) in place.slope.iter().zip(joints) {
                slides.certain = slides.certain.max(slope.abs() * slowness[joint]);
            }
        }
        let third = self.third(a, b);
        let length = b.t - a.t;
        let faster = third * length * length / 8.0;
        let beyond = third * length * length * length / 12.0;
        let minutes: [f64; 3] = std::array::from_fn(|row| {
            let speed = a.slope[row].abs().max(b.slope[row].abs()) + faster;
            // An axis without a largest feed needs no time, however little is known of its speed.
            if slowness[joints[row]] > 0.0 { speed * slowness[joints[row]] } else { 0.0 }
        });
        let allowed = (CLOSE * slides.certain).max(slides.enough);
        let clear = beyond <= STRAY && minutes.iter().all(|minutes| *minutes <= allowed);
        if !clear && length > SHORTEST {
            let middle = self.between(0.5 * (a.t + b.t))?;
            self.look(a, &middle, slowness, slides)?;
            return self.look(&middle, b, slowness, slides);
        }
        if !beyond.is_finite() {
            return None;
        }
        for (row, joint) in joints.into_iter().enumerate() {
            let (first, last) = (a.values[row], b.values[row]);
            let (start, end) = (a.slope[row], b.slope[row]);
            // Where it turns back, if it does.
            let peak = if start * end < 0.0 {
                first + 0.5 * length * start * start / (start - end)
            } else {
                last
            };
            let least = first.min(last).min(peak) - beyond;
            let most = first.max(last).max(peak) + beyond;
            slides.least[joint] = slides.least[joint].min(least);
            slides.most[joint] = slides.most[joint].max(most);
            slides.way[joint] += (peak - first).abs() + (last - peak).abs();
            if minutes[row] > slides.minutes {
                (slides.minutes, slides.slowest) = (minutes[row], joint);
            }
        }
        Some(())
    }

    fn between(&self, t: f64) -> Option<LinearAxisState> {
        let joints: Joints =
            std::array::from_fn(|index| self.from.joints[index] + self.steps[index] * t);
        self.at(t, &self.chain.turns(&joints))
    }

    /// The linear axes at the share `t`, where the rotary ones have these turns.
    fn at(&self, t: f64, turns: &Turns) -> Option<LinearAxisState> {
        let axes = self.chain.joints();
        let zero = Vector3::zeros();
        let mut radii = Joints::default();
        let [from, to] = self.tips;
        // The tip, taken through the rotary joints in front of the first linear one …
        let mut front = from * (1.0 - t) + to * t + self.chain.mount();
        let mut front_slope = to - from;
        for (index, joint) in axes[..self.linear.first].iter().enumerate() {
            let (sine, cosine) = turns.of(index);
            let (k, arm) = (joint.direction, front - joint.point);
            let rate = k.cross(&arm);
            radii[index] = rate.norm();
            front_slope = turn(front_slope - rate * self.steps[index], k, -sine, cosine);
            front = joint.point + turn(arm, k, -sine, cosine);
        }
        // … the tool's end through those behind it, and the directions of the linear ones through those between.
        let (mut end, mut end_slope) = (self.end, zero);
        let (mut columns, mut slopes) = ([zero; 3], [zero; 3]);
        let mut filled = 3;
        for (index, joint) in axes.iter().enumerate().skip(self.linear.first).rev() {
            let k = joint.direction;
            if !joint.rotary {
                // One that stands is no column.
                if self.linear.joints.contains(&index) {
                    filled -= 1;
                    columns[filled] = k;
                }
                continue;
            }
            let (sine, cosine) = turns.of(index);
            let (step, arm) = (self.steps[index], end - joint.point);
            let rate = k.cross(&arm);
            radii[index] = rate.norm();
            end_slope = turn(end_slope + rate * step, k, sine, cosine);
            end = joint.point + turn(arm, k, sine, cosine);
            for (column, slope) in columns.iter_mut().zip(&mut slopes).skip(filled) {
                *slope = turn(*slope + k.cross(column) * step, k, sine, cosine);
                *column = turn(*column, k, sine, cosine);
            }
        }
        let offset = front - end;
        let mut slope = front_slope - end_slope;
        let inverse = match self.linear.inverse {
            Some(inverse) => inverse,
            None => {
                let directions = Matrix3::from_columns(&columns);
                if libm::fabs(directions.determinant()) < FLAT {
                    return None;
                }
                let inverse = directions.try_inverse()?;
                slope -= Matrix3::from_columns(&slopes) * (inverse * offset);
                inverse
            }
        };
        Some(LinearAxisState {
            t,
            values: inverse * offset,
            slope: inverse * slope,
            radii,
            offset: offset.norm(),
            inverse: [longest_row(&inverse), inverse.norm()],
        })
    }

    /// A bound on the third derivative of every linear axis between two places, by Leibniz' rule joint by joint.
    fn third(&self, a: &LinearAxisState, b: &LinearAxisState) -> f64 {
        let length = b.t - a.t;
        let square = length * length;
        let pass = |[d1, d2, d3]: [f64; 3], index: usize| {
            let w = self.steps[index].abs();
            let r = a.radii[index].max(b.radii[index]) + d2 * square / 8.0;
            [w * r + d1, w * (w * r + 2.0 * d1) + d2, w * (w * (w * r + 3.0 * d1) + 3.0 * d2) + d3]
        };
        let [from, to] = self.tips;
        let front = (0..self.linear.first).fold([(to - from).norm(), 0.0, 0.0], pass);
        let joints = self.chain.joints();
        let behind = (self.linear.first..joints.len())
            .rev()
            .filter(|index| joints[*index].rotary)
            .fold([0.0; 3], pass);
        let [r1, r2, r3]: [f64; 3] = std::array::from_fn(|order| front[order] + behind[order]);
        if self.linear.inverse.is_some() {
            return a.inverse[0] * r3;
        }
        // `A` itself turns: first the orders below, by the same rule on `A·q = u - v`. Two of its columns move, each
        // by no more than the axes between turn.
        let w: f64 = (self.linear.first..=self.linear.last)
            .filter(|index| joints[*index].rotary)
            .map(|index| self.steps[index].abs())
            .sum();
        let a1 = std::f64::consts::SQRT_2 * w;
        let (a2, a3) = (a1 * w, a1 * w * w);
        let rest = 1.0 - a.inverse[1] * a1 * length;
        if rest <= 0.0 {
            return f64::INFINITY;
        }
        let inverse = a.inverse[1] / rest;
        let q0 = inverse * (a.offset.max(b.offset) + r2 * square / 8.0);
        let q1 = inverse * (r1 + a1 * q0);
        let q2 = inverse * (r2 + 2.0 * a1 * q1 + a2 * q0);
        inverse * (r3 + 3.0 * a1 * q2 + 3.0 * a2 * q1 + a3 * q0)
    }
}
