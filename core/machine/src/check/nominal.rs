//! One machine file against another at equal words of the program: what a machine that differs from its
//! drawing does to the tip, and which axis line is to blame.
//!
//! Both get the same words. A rotary word is what the control shows; a linear word counts from where the tip
//! stands on the part origin with every rotary axis at zero, in each machine by itself, as the operator sets
//! the work offset. For given angles the difference of the two tips is linear in the linear words, so its
//! length is largest at a corner of their travel: only angles need a search.

use nalgebra::Vector3;
use serde::Serialize;

use super::pointing::AxisReadout;
use crate::description::{Axis, Machine};
use crate::kinematics::orientation::angle;
use crate::kinematics::{Chain, Joints, MAX_AXES, Pose, Solver};

/// Settings of each rotary axis on the first grid, by how many there are: a few thousand together.
const GRID: [usize; MAX_AXES + 1] = [1, 37, 37, 19, 9, 5, 4, 3, 3, 2, 2, 2, 2];

/// Times that the step is halved around the largest.
const HALVINGS: usize = 30;

/// Steps of each axis at most, of all sizes.
const MOST_STEPS: usize = 1000;

/// Two machine files compared.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name of the machine under check.
    pub machine: String,
    /// Name of the other.
    pub nominal: String,
    /// Length of the tool in both, mm.
    pub tool_length_mm: f64,
    /// Largest distance between the two tips, mm.
    pub tip_mm: f64,
    /// Tip of the machine minus tip of the other there, mm, part frame.
    pub tip: [f64; 3],
    /// Axis values there: readings of the machine under check.
    pub tip_at: Vec<AxisReadout>,
    /// What each difference contributes there, the largest first.
    pub tip_shares: Vec<DifferenceShare>,
    /// Largest angle between the two tool axes, degrees.
    pub axis_deg: f64,
    /// Values of the rotary axes there.
    pub axis_at: Vec<AxisReadout>,
    /// What each difference contributes there, the largest first.
    pub axis_shares: Vec<DifferenceShare>,
}

/// What one difference between the files does by itself.
#[derive(Clone, Debug, Serialize)]
pub struct DifferenceShare {
    /// `direction of Z`, `position of A`, `gauge point`.
    pub of: String,
    /// What the files differ by there: mm or degrees.
    pub differs_by: f64,
    /// Deviation that it makes alone, mm or degrees.
    pub size: f64,
    /// The same as a vector in the part frame: mm, or the rotation vector in degrees.
    pub vector: [f64; 3],
}

/// Why two files cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Differing {
    /// The axes have other names, or another order or kind.
    Axes {
        /// Axes of the machine, in chain order.
        machine: Vec<String>,
        /// Axes of the other, in chain order.
        nominal: Vec<String>,
    },
    /// One of the two cannot be brought to the part origin with its rotary axes at zero.
    NoZero {
        /// Name of that machine.
        machine: String,
    },
}

/// A machine with where its words count from.
struct Worded<'a> {
    machine: &'a Machine,
    solver: Solver,
    /// Axis values with the tip on the part origin and every rotary axis at zero.
    zero: Joints,
}

impl<'a> Worded<'a> {
    fn new(machine: &'a Machine, length: f64) -> Result<Self, Differing> {
        let no_zero = || Differing::NoZero { machine: machine.name.clone() };
        // Errors that depend on position are told by themselves.
        let lines = Machine { errors: [].into(), ..machine.clone() };
        let solver = lines.solver(length).map_err(|_| no_zero())?;
        // What the control shows of every rotary axis is zero, the tip on the part origin.
        let mut zero: Joints = std::array::from_fn(|place| {
            machine.axes.get(place).filter(|axis| axis.joint.rotary).map_or(0.0, |axis| -axis.zero)
        });
        let turns = solver.chain().turns(&zero);
        solver.place(Vector3::zeros(), &mut zero, &turns).map_err(|_| no_zero())?;
        Ok(Self { machine, solver, zero })
    }

    fn chain(&self) -> &Chain {
        self.solver.chain()
    }

    /// Where the tool stands at the words that `other` stands at `joints` with.
    fn at_words_of(&self, other: &Self, joints: &Joints) -> Pose {
        let mut own = *joints;
        for (place, axis) in self.machine.axes.iter().enumerate() {
            own[place] = if axis.joint.rotary {
                joints[place] + other.machine.axes[place].zero - axis.zero
            } else {
                joints[place] - other.zero[place] + self.zero[place]
            };
        }
        self.chain().forward(&own)
    }
}

/// Compares `machine` with `nominal`, both with a tool of `length` mm.
///
/// # Errors
/// Why they cannot be compared.
pub fn compare(machine: &Machine, nominal: &Machine, length: f64) -> Result<Comparison, Differing> {
    let described = |machine: &Machine| -> Vec<String> {
        let axes = machine.axes.iter();
        axes.map(|axis| {
            format!(
                "{}{} ({})",
                axis.name,
                if axis.carries_part { "'" } else { "" },
                if axis.joint.rotary { "rotary" } else { "linear" }
            )
        })
        .collect()
    };
    let (ours, theirs) = (described(machine), described(nominal));
    if ours != theirs {
        return Err(Differing::Axes { machine: ours, nominal: theirs });
    }
    let real = Worded::new(machine, length)?;
    let drawn = Worded::new(nominal, length)?;
    let tip = |joints: &Joints| {
        let [a, b] = both(&real, &drawn, joints);
        (a.tip - b.tip).norm()
    };
    let axis = |joints: &Joints| {
        let [a, b] = both(&real, &drawn, joints);
        angle(a.axis, b.axis)
    };
    let tip_worst = worst(machine, &real.zero, true, &tip);
    let axis_worst = worst(machine, &real.zero, false, &axis);
    let [a, b] = both(&real, &drawn, &tip_worst);
    Ok(Comparison {
        machine: machine.name.clone(),
        nominal: nominal.name.clone(),
        tool_length_mm: length,
        tip_mm: (a.tip - b.tip).norm(),
        tip: (a.tip - b.tip).into(),
        tip_at: readings(machine, &tip_worst, |_| true),
        tip_shares: shares(&real, &drawn, length, &tip_worst, |a, b| a.tip - b.tip)?,
        axis_deg: axis(&axis_worst).to_degrees(),
        axis_at: readings(machine, &axis_worst, |axis| axis.joint.rotary),
        axis_shares: shares(&real, &drawn, length, &axis_worst, |a, b| {
            // For so small an angle the rotation vector is the cross product, scaled to the angle.
            let turn = b.axis.cross(&a.axis);
            turn.try_normalize(0.0).unwrap_or_default() * angle(a.axis, b.axis).to_degrees()
        })?,
    })
}

fn both(real: &Worded<'_>, drawn: &Worded<'_>, joints: &Joints) -> [Pose; 2] {
    [real.chain().forward(joints), drawn.at_words_of(real, joints)]
}

fn readings(machine: &Machine, joints: &Joints, of: impl Fn(&Axis) -> bool) -> Vec<AxisReadout> {
    let axes = machine.axes.iter().zip(joints);
    axes.filter(|(axis, _)| of(axis))
        .map(|(axis, value)| AxisReadout { axis: axis.name.clone(), value: axis.reading(*value) })
        .collect()
}

/// Least and largest value of an axis over the workspace; one turn of an endless one.
fn span(machine: &Machine, place: usize) -> [f64; 2] {
    let half = std::f64::consts::PI;
    machine.axes[place].travel.unwrap_or([-half, half])
}

/// Axis values inside travel where `size` is largest: a grid over the angles (and the corners of the linear
/// travels, if they matter), then ever smaller steps around the largest.
fn worst(
    machine: &Machine,
    zero: &Joints,
    linear_matter: bool,
    size: &dyn Fn(&Joints) -> f64,
) -> Joints {
    let places = |rotary: bool| -> Vec<usize> {
        let axes = machine.axes.iter().enumerate();
        axes.filter(|(_, axis)| axis.joint.rotary == rotary).map(|(place, _)| place).collect()
    };
    let (rotary, linear) = (places(true), places(false));
    let corners = if linear_matter { 1usize << linear.len() } else { 1 };
    let at_corner = |joints: &mut Joints, corner: usize| {
        if linear_matter {
            for (bit, place) in linear.iter().enumerate() {
                joints[*place] = span(machine, *place)[corner >> bit & 1];
            }
        }
    };
    let steps = GRID[rotary.len()];
    let settings = (0..rotary.len()).fold(1, |product, _| product * steps);
    let mut best = *zero;
    let mut largest = f64::NEG_INFINITY;
    for setting in 0..settings {
        let mut joints = *zero;
        let mut rest = setting;
        for place in &rotary {
            let [least, most] = span(machine, *place);
            joints[*place] = least + (most - least) * (rest % steps) as f64 / (steps - 1) as f64;
            rest /= steps;
        }
        for corner in 0..corners {
            at_corner(&mut joints, corner);
            let value = size(&joints);
            // Equal ones keep the first, so that rounding decides nothing.
            if value > largest + 1e-12 {
                (largest, best) = (value, joints);
            }
        }
    }
    let mut share = 0.5 / (steps - 1).max(1) as f64;
    let mut halved = 0;
    // Along a ridge that lies across the axes one step of each does not get far: only where none leads up they are halved.
    for _ in 0..MOST_STEPS {
        if halved == HALVINGS {
            break;
        }
        let before = largest;
        for place in &rotary {
            let [least, most] = span(machine, *place);
            for sense in [-1.0, 1.0] {
                let mut joints = best;
                joints[*place] = (best[*place] + sense * share * (most - least)).clamp(least, most);
                for corner in 0..corners {
                    at_corner(&mut joints, corner);
                    let value = size(&joints);
                    if value > largest + 1e-12 {
                        (largest, best) = (value, joints);
                    }
                }
            }
        }
        if largest == before {
            share *= 0.5;
            halved += 1;
        }
    }
    best
}

/// The other machine with one difference after the other put into it: what each makes alone at `joints` of the
/// machine under check.
fn shares(
    real: &Worded<'_>,
    drawn: &Worded<'_>,
    length: f64,
    joints: &Joints,
    deviation: impl Fn(&Pose, &Pose) -> Vector3<f64>,
) -> Result<Vec<DifferenceShare>, Differing> {
    let (machine, nominal) = (real.machine, drawn.machine);
    let mut changed: Vec<(String, f64, Machine)> = Vec::new();
    for (place, (axis, other)) in machine.axes.iter().zip(&nominal.axes).enumerate() {
        let with = |change: &dyn Fn(&mut Machine)| {
            let mut hybrid = nominal.clone();
            change(&mut hybrid);
            hybrid
        };
        let name = &axis.name;
        let tilt = angle(axis.joint.direction, other.joint.direction);
        if tilt > 0.0 {
            changed.push((
                format!("direction of {name}"),
                tilt.to_degrees(),
                with(&|hybrid| hybrid.axes[place].joint.direction = axis.joint.direction),
            ));
        }
        let apart = other.joint.direction.cross(&(axis.joint.point - other.joint.point));
        if axis.joint.rotary && apart.norm() > 0.0 {
            changed.push((
                format!("position of {name}"),
                apart.norm(),
                with(&|hybrid| hybrid.axes[place].joint.point = axis.joint.point),
            ));
        }
        if axis.zero != other.zero {
            changed.push((
                format!("zero of {name}"),
                (axis.zero - other.zero) / axis.unit(),
                with(&|hybrid| hybrid.axes[place].zero = axis.zero),
            ));
        }
    }
    let mut whole = |of: &str, by: f64, change: &dyn Fn(&mut Machine)| {
        if by > 0.0 {
            let mut hybrid = nominal.clone();
            change(&mut hybrid);
            changed.push((of.to_owned(), by, hybrid));
        }
    };
    whole("gauge point", (machine.gauge - nominal.gauge).norm(), &|hybrid| {
        hybrid.gauge = machine.gauge;
    });
    whole("mount of the part", (machine.mount - nominal.mount).norm(), &|hybrid| {
        hybrid.mount = machine.mount;
    });
    let leans = angle(machine.tool_axis, nominal.tool_axis).to_degrees();
    whole("direction of the tool", leans, &|hybrid| {
        hybrid.tool_axis = machine.tool_axis;
    });
    let drawn_pose = drawn.at_words_of(real, joints);
    let mut shares = Vec::new();
    for (of, differs_by, hybrid) in changed {
        let pose = Worded::new(&hybrid, length)?.at_words_of(real, joints);
        let vector = deviation(&pose, &drawn_pose);
        shares.push(DifferenceShare { of, differs_by, size: vector.norm(), vector: vector.into() });
    }
    shares.sort_by(|a, b| b.size.total_cmp(&a.size));
    Ok(shares)
}
