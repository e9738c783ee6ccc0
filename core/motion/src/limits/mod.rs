//! What the machine allows on a move: how far the axes and the tip go, bend and jerk along it, and how fast that may be
//! run through.
//!
//! A move is run through by some law `t(τ)` of time, `t` its own parameter from 0 to 1. With `q` an axis value over
//! `t`, its velocity is `q'·ṫ`, its acceleration `q'·ẗ + q''·ṫ²` and its jerk `q'·t⃛ + 3·q''·ṫ·ẗ + q'''·ṫ³`: bounds of
//! `q'`, `q''` and `q'''` over the move, once, are all that a planner needs of chain and path.

mod fit;

use nalgebra::Vector3;
use post_machine::description::{BlendRule, LimitsActOn, Machine};
use post_machine::kinematics::{Joints, MAX_AXES, Unreachable};

use crate::Move;
use crate::path::{Curve, Interpolation};

/// How fast, and how suddenly, axes and tip may move: of a machine, once.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisLimits {
    /// Largest velocities by place in the chain, mm/s or rad/s; infinite where the machine file names none.
    pub velocity: Joints,
    /// Largest accelerations, mm/s² or rad/s²; infinite where the machine file names none.
    pub acceleration: Joints,
    /// Largest jerks, mm/s³ or rad/s³; infinite where the machine file names none.
    pub jerk: Joints,
    /// Largest jumps of the velocity where one move passes into the next, mm/s or rad/s: what the machine file says,
    /// else what the acceleration makes of it in one period of the control.
    pub jump: Joints,
    /// Largest acceleration of the tip, mm/s²; infinite if none is named.
    pub tip_acceleration: f64,
    /// Largest jerk of the tip, mm/s³; infinite if none is named.
    pub tip_jerk: f64,
    /// Largest jump of the tip's velocity where one move passes into the next, mm/s.
    pub tip_jump: f64,
    /// Where the control keeps the tip they hold for the programmed coordinates: the coordinate of the tip, X, Y or Z,
    /// that stands for each place; none for an axis that is programmed itself.
    pub programmed: Option<[Option<usize>; MAX_AXES]>,
}

/// The share of an acceleration that a jump of the velocity may take where moves overlap by rule and the machine file
/// says nothing of it: LinuxCNC's kink ratio. Joined moves have the rest.
pub(crate) const KINK: f64 = 0.1;

impl AxisLimits {
    /// Limits of a machine.
    pub fn new(machine: &Machine) -> Self {
        let rules = &machine.motion;
        let instant = rules.period
            * match rules.blend {
                BlendRule::Overlap => KINK,
                BlendRule::Round => 1.0,
            };
        let jump = |said: Option<f64>, acceleration: f64| {
            said.map_or(acceleration * instant, |jump| jump / 60.0)
        };
        let mut limits = Self {
            velocity: [f64::INFINITY; MAX_AXES],
            acceleration: [f64::INFINITY; MAX_AXES],
            jerk: [f64::INFINITY; MAX_AXES],
            jump: [f64::INFINITY; MAX_AXES],
            tip_acceleration: rules.tip_accel,
            tip_jerk: rules.tip_jerk,
            tip_jump: jump(rules.tip_jump, rules.tip_accel),
            programmed: None,
        };
        let mut coordinates = [None; MAX_AXES];
        for (place, axis) in machine.axes.iter().enumerate() {
            limits.velocity[place] = axis.max_feed / 60.0;
            limits.acceleration[place] = axis.max_accel;
            limits.jerk[place] = axis.max_jerk;
            limits.jump[place] = jump(axis.max_jump, axis.max_accel);
            if !axis.joint.rotary {
                coordinates[place] = ["X", "Y", "Z"].iter().position(|name| *name == axis.word());
            }
        }
        if rules.limits == LimitsActOn::Programmed {
            limits.programmed = Some(coordinates);
        }
        limits
    }

    /// Some jerk is limited.
    pub fn limits_jerk(&self) -> bool {
        self.tip_jerk.is_finite() || self.jerk.iter().any(|jerk| jerk.is_finite())
    }
}

/// How axes and tip go along a move, over its own parameter from 0 to 1. What `AxisLimits` hold for stands in the
/// places: the axes, or the programmed coordinates instead of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MoveLimits {
    /// Bounds of the magnitude of the first derivatives by place in the chain, mm or radians.
    pub first: Joints,
    /// Bounds of the second derivatives.
    pub second: Joints,
    /// Bounds of the third derivatives.
    pub third: Joints,
    /// First derivatives where the move begins and ends.
    pub ends: [Joints; 2],
    /// Second derivatives there.
    pub bends: [Joints; 2],
    /// Bounds of the length of the first, second and third derivative of the tip, mm, part frame.
    pub tip: [f64; 3],
    /// First derivative of the tip where it begins and ends, mm, part frame.
    pub tip_ends: [Vector3<f64>; 2],
    /// Largest first derivatives on the whole circle, for an arc on which no rotary axis turns.
    pub circle: Option<Joints>,
}

/// What the limits ask for on a move.
///
/// Where axes and tip go straight in the parameter, it is exact. Elsewhere it is summed from the Chebyshev series of
/// what they do over pieces of at most half a radian of turn: never less than what the series does anywhere, and what
/// the series leaves out is below a thousandth of that.
///
/// # Errors
/// The axes cannot follow the way: see [`Interpolation::stance_at`].
pub fn of(task: &Move, limits: &AxisLimits) -> Result<MoveLimits, Unreachable> {
    let mut found = MoveLimits::default();
    let turns = crate::path::turns(task.solver.chain(), [&task.from, &task.to]);
    let (straight_tip, straight_axes) = match task.way {
        Interpolation::Axes => (!turns, true),
        Interpolation::Tip(Curve::Straight) => {
            (true, !turns || coordinates(task, limits).is_some())
        }
        Interpolation::Tip(_) => (false, false),
        Interpolation::TipAndAxis | Interpolation::TipAndFrame(_) => (true, !turns),
    };
    if straight_axes {
        found.straight(task, coordinates(task, limits));
    }
    if straight_tip {
        let way = task.to.pose.tip - task.from.pose.tip;
        found.tip = [way.norm(), 0.0, 0.0];
        found.tip_ends = [way; 2];
    }
    if !straight_axes || !straight_tip {
        fit::over(task, coordinates(task, limits), [!straight_axes, !straight_tip], &mut found)?;
    }
    if let Curve::Arc { centre, normal, sweep } = task.way.curve()
        && !turns
    {
        let (arm, _) = crate::path::arm_and_height(task.from.pose.tip, *centre, *normal);
        let ways = [arm, normal.cross(&arm)].map(|arm| arm * *sweep);
        found.circle = Some(circle(task, ways, coordinates(task, limits))?);
    }
    Ok(found)
}

/// The coordinates of the tip that stand for axes on this move; none on one whose axes are led by themselves.
fn coordinates<'l>(task: &Move, limits: &'l AxisLimits) -> Option<&'l [Option<usize>; MAX_AXES]> {
    limits.programmed.as_ref().filter(|_| task.keeps_tip && task.way != Interpolation::Axes)
}

/// How large what is limited gets for each place where the tip goes round an ellipse of these half-axes, the rotary
/// axes standing where the move begins.
fn circle(
    task: &Move,
    [first, second]: [Vector3<f64>; 2],
    coordinates: Option<&[Option<usize>; MAX_AXES]>,
) -> Result<Joints, Unreachable> {
    let from = &task.from;
    let turns = task.solver.chain().turns(&from.joints);
    let place = |way: Vector3<f64>| {
        let mut joints = from.joints;
        task.solver.place(from.pose.tip + way, &mut joints, &turns).map(|()| joints)
    };
    // Where nothing turns the axes go linearly with the tip.
    let [rest, first_at, second_at] = [place(Vector3::zeros())?, place(first)?, place(second)?];
    Ok(std::array::from_fn(|index| {
        let [a, b] = match coordinates.and_then(|coordinates| coordinates[index]) {
            Some(coordinate) => [first[coordinate], second[coordinate]],
            None => [first_at, second_at].map(|joints| joints[index] - rest[index]),
        };
        (a * a + b * b).sqrt()
    }))
}

impl MoveLimits {
    /// All that is limited goes linearly.
    fn straight(&mut self, task: &Move, coordinates: Option<&[Option<usize>; MAX_AXES]>) {
        let tip = task.to.pose.tip - task.from.pose.tip;
        for place in 0..task.solver.chain().joints().len() {
            let way = match coordinates.and_then(|coordinates| coordinates[place]) {
                Some(coordinate) => tip[coordinate],
                None => task.to.joints[place] - task.from.joints[place],
            };
            self.first[place] = libm::fabs(way);
            self.ends[0][place] = way;
            self.ends[1][place] = way;
        }
    }
}
