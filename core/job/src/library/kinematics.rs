//! Where the tool goes, and how the axes get there, of many points at once: mm and degrees, as the control shows them.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::diagnostic::Diagnostic;
use post_machine::kinematics::orientation::angle;
use post_machine::kinematics::travel::{AT_END, passed};
use post_machine::kinematics::{Joints, Pose, Solver};

use super::{Refusal, StopSignal};

/// What is known of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisFacts {
    /// Its address, `X`, `C`.
    pub name: String,
    /// It turns; else it slides.
    pub rotary: bool,
    /// It carries the workpiece; else the tool.
    pub carries_part: bool,
    /// `mm`, or `deg` of a rotary axis.
    pub unit: &'static str,
    /// Least and largest value, as the control shows them; none for an axis without ends.
    pub travel: Option<[f64; 2]>,
}

/// Points that the tool shall come to, three numbers each.
#[derive(Clone, Copy, Debug)]
pub struct ToolPoses<'a> {
    /// Tips, mm, part frame.
    pub tip: &'a [f64],
    /// Tool axes, part frame, of any length but zero.
    pub axis: &'a [f64],
    /// Leading edges, part frame, of a machine whose tool has one.
    pub edge: Option<&'a [f64]>,
}

/// All ways to reach points.
#[derive(Clone, Debug, PartialEq)]
pub struct Solutions {
    /// Places for solutions that each point has: as many as the point with the most, at least one.
    pub width: usize,
    /// Axis values, by point, solution and axis; what a point has no solution for is no number.
    pub q: Vec<f64>,
    /// Solutions of each point.
    pub counts: Vec<i64>,
}

/// How far the tool strays, by move and share of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviations {
    /// Where the tip is off, mm, part frame, three numbers each.
    pub tip: Vec<f64>,
    /// By how much the tool axis is off, degrees.
    pub axis: Vec<f64>,
}

/// The chain of a machine, with a tool in it.
#[derive(Clone, Debug)]
pub struct MachineKinematics {
    machine: Machine,
    solver: Solver,
    /// Of each axis the units of the chain (mm, radians) in one of the control's (mm, degrees), and what the control shows
    /// at the chain's zero, in units of the chain.
    scales: Vec<[f64; 2]>,
}

impl ToolPoses<'_> {
    /// Every point, tool axis and edge of unit length.
    ///
    /// # Errors
    /// The first that is none, or has numbers that are none.
    pub(super) fn poses(&self, needs_edge: bool) -> Result<Vec<Pose>, Refusal> {
        let mut poses = Vec::with_capacity(self.tip.len() / 3);
        let mut edges = self.edge.map(|edges| edges.chunks_exact(3));
        if needs_edge && edges.is_none() {
            let message = "the tool of this machine has a leading edge, and no edge is given";
            let help = "give `edge`, a direction for each point, part frame";
            return Err(vec![Diagnostic::error("edge", message).help(help)]);
        }
        let axes = self.axis.chunks_exact(3);
        for (index, (tip, axis)) in self.tip.chunks_exact(3).zip(axes).enumerate() {
            let unit = |what: &str, vector: &[f64]| {
                let vector = Vector3::from_column_slice(vector);
                let length = vector.norm();
                if length.is_finite() && length > 1e-9 {
                    return Ok(vector / length);
                }
                let [x, y, z] = [vector.x, vector.y, vector.z];
                let message = format!("point {index}: {what} ({x}, {y}, {z}) is no direction");
                Err(vec![Diagnostic::error("point", message)])
            };
            let tip = Vector3::from_column_slice(tip);
            if !tip.iter().all(|value| value.is_finite()) {
                let message = format!("point {index}: the tip is not finite");
                return Err(vec![Diagnostic::error("point", message)]);
            }
            let edge = match edges.as_mut().and_then(Iterator::next) {
                Some(edge) if needs_edge => unit("the edge", edge)?,
                _ => Vector3::zeros(),
            };
            let axis = unit("the tool axis", axis)?;
            poses.push(Pose { tip, axis, edge });
        }
        Ok(poses)
    }
}

impl MachineKinematics {
    /// Of a machine with a tool of `length` mm in it, its indexed axes where they start.
    ///
    /// # Errors
    /// What its chain lacks.
    pub fn new(machine: &Machine, length: f64) -> Result<Self, Refusal> {
        let solver = machine.solver(length);
        let solver = solver.map_err(|lack| vec![machine.unsolvable(&lack)])?;
        let axes = machine.axes.iter();
        Ok(Self {
            scales: axes.map(|axis| [axis.unit(), axis.zero]).collect(),
            machine: machine.clone(),
            solver,
        })
    }

    /// The axes, from the workpiece to the tool: the order of all axis values.
    pub fn axes(&self) -> Vec<AxisFacts> {
        let axes = self.machine.axes.iter();
        axes.map(|axis| AxisFacts {
            name: axis.name.clone(),
            rotary: axis.joint.rotary,
            carries_part: axis.carries_part,
            unit: axis.unit_name(),
            travel: axis.travel.map(|travel| travel.map(|end| told(axis.reading(end)))),
        })
        .collect()
    }

    /// How many axes there are.
    pub fn count(&self) -> usize {
        self.scales.len()
    }

    /// The tool has a leading edge.
    pub fn has_edge(&self) -> bool {
        self.machine.edge.is_some()
    }

    /// Where the axes stand before anything moves.
    pub fn start(&self) -> Vec<f64> {
        let mut start = vec![0.0; self.count()];
        self.readings(&self.machine.solution.start, &mut start);
        start
    }

    /// The values of the chain for those that the control shows.
    #[inline]
    fn joints(&self, q: &[f64]) -> Joints {
        let mut joints = Joints::default();
        for ((joint, value), [unit, zero]) in joints.iter_mut().zip(q).zip(&self.scales) {
            *joint = value * unit - zero;
        }
        joints
    }

    /// What the control shows for values of the chain.
    #[inline]
    pub(super) fn readings(&self, joints: &Joints, q: &mut [f64]) {
        for ((reading, value), [unit, zero]) in q.iter_mut().zip(joints).zip(&self.scales) {
            *reading = (value + zero) / unit;
        }
    }

    /// Where tip and tool axis stand (mm and unit vectors, part frame, three numbers a point) for axis values `q`
    /// ([`MachineKinematics::count`] numbers a point).
    pub fn forward(&self, q: &[f64], tip: &mut [f64], axis: &mut [f64]) {
        let chain = self.solver.chain();
        let points = q.chunks_exact(self.count());
        let places = tip.chunks_exact_mut(3).zip(axis.chunks_exact_mut(3));
        for (q, (tip, axis)) in points.zip(places) {
            let pose = chain.forward(&self.joints(q));
            tip.copy_from_slice(pose.tip.as_slice());
            axis.copy_from_slice(pose.axis.as_slice());
        }
    }

    /// All ways to reach points, each held against the forward product; axes that a point leaves free stand as in
    /// `near`. A tool axis that the machine cannot point exactly is reached within its tolerance. Angles are between
    /// -180 and 180 degrees from the chain's zero; or, `within_travel`, on the turn nearest to `near`, and solutions
    /// outside travel are left out.
    ///
    /// # Errors
    /// A point that is none, or that it was stopped.
    pub fn inverse(
        &self,
        stop: &StopSignal,
        wanted: &ToolPoses<'_>,
        near: &[f64],
        within_travel: bool,
    ) -> Result<Solutions, Refusal> {
        let near = self.joints(near);
        let tolerance = self.machine.accuracy.axis_tolerance;
        let poses = wanted.poses(self.has_edge())?;
        let mut all: Vec<Joints> = Vec::with_capacity(2 * poses.len());
        let mut counts = Vec::with_capacity(poses.len());
        for (index, pose) in poses.iter().enumerate() {
            if stop() {
                let message = format!("interrupted at point {index}");
                return Err(vec![Diagnostic::error("input", message)]);
            }
            let solved = self.solver.inverse(pose, &near, tolerance);
            let solved = solved.unwrap_or_default().into_iter();
            let before = all.len();
            all.extend(solved.filter_map(|joints| match within_travel {
                true => self.inside(joints, &near),
                false => Some(joints),
            }));
            counts.push((all.len() - before) as i64);
        }
        let width = counts.iter().copied().max().unwrap_or(1).max(1) as usize;
        let count = self.count();
        let mut q = vec![f64::NAN; poses.len() * width * count];
        let mut solutions = all.iter();
        for (rows, found) in q.chunks_exact_mut(width * count).zip(&counts) {
            for row in rows.chunks_exact_mut(count).take(*found as usize) {
                if let Some(joints) = solutions.next() {
                    self.readings(joints, row);
                }
            }
        }
        Ok(Solutions { width, q, counts })
    }

    /// The same solution on the turns nearest to `near` that are inside travel and the limits of the machine; none if there are none.
    fn inside(&self, mut joints: Joints, near: &Joints) -> Option<Joints> {
        for ((axis, value), near) in self.machine.axes.iter().zip(&mut joints).zip(near) {
            if axis.joint.rotary {
                *value -= TAU * libm::rint((*value - near) / TAU);
                if let Some([least, most]) = axis.travel {
                    if *value > most + AT_END {
                        *value -= TAU * libm::ceil((*value - most - AT_END) / TAU);
                    } else if *value < least - AT_END {
                        *value += TAU * libm::ceil((least - AT_END - *value) / TAU);
                    }
                }
            }
            if passed(axis.travel, *value, AT_END).is_some() {
                return None;
            }
        }
        let within = self.machine.limits.iter().all(|limit| limit.holds(&joints));
        within.then_some(joints)
    }

    /// How far the tool is, at `shares` of moves that take all axes linearly from and to axis values, from the straight
    /// line of the tip and the great circle of the tool axis between the same ends.
    pub fn deviation(&self, [from, to]: [&[f64]; 2], shares: &[f64]) -> Deviations {
        let chain = self.solver.chain();
        let moves = from.len() / self.count();
        let mut found = Deviations {
            tip: Vec::with_capacity(3 * moves * shares.len()),
            axis: Vec::with_capacity(moves * shares.len()),
        };
        let ends = from.chunks_exact(self.count());
        for (from, to) in ends.zip(to.chunks_exact(self.count())) {
            let [from, to] = [self.joints(from), self.joints(to)];
            let [first, last] = [chain.forward(&from), chain.forward(&to)];
            for share in shares {
                let mut joints = from;
                for (value, to) in joints.iter_mut().zip(&to) {
                    *value += share * (to - *value);
                }
                let pose = chain.forward(&joints);
                let off = pose.tip - first.tip.lerp(&last.tip, *share);
                found.tip.extend_from_slice(off.as_slice());
                let axis = between(first.axis, last.axis, *share);
                found.axis.push(angle(pose.axis, axis).to_degrees());
            }
        }
        found
    }
}

/// An end of travel as the file has it: degrees go through radians and come back a little off.
fn told(end: f64) -> f64 {
    libm::rint(end * 1e9) / 1e9
}

/// The unit vector at a share of the great circle between two others.
fn between(from: Vector3<f64>, to: Vector3<f64>, share: f64) -> Vector3<f64> {
    let whole = angle(from, to);
    let sine = libm::sin(whole);
    if sine < 1e-12 {
        return from;
    }
    from * (libm::sin((1.0 - share) * whole) / sine) + to * (libm::sin(share * whole) / sine)
}
