//! What the points of a program leave to the mount of the part, gathered point by point.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use nalgebra::Vector3;

use super::half_space::HalfSpace;
use crate::description::Machine;
use crate::kinematics::{Joints, NoClosedForm, Second, Solver, Turns};

/// Normals that are no farther apart are told apart no more, in parts of one: of those at the mount in hand the one that
/// binds most is kept. What that loses, a further pass at the mount that was found makes up for.
const CELLS: f64 = 32.0;

/// An end of the travel of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TravelEnd {
    /// The axis, its place in the chain.
    pub joint: usize,
    /// The end where its values are largest, else the one where they are least.
    pub largest: bool,
}

/// Where travel ends on an opened machine, mm: beyond any program, and short of what rounding would be seen in.
const OPEN: f64 = 1e6;

/// What bounds the mount: for each end of travel the points of the program that come nearest to it, whichever way the
/// part is turned there. Memory does not grow with the program.
#[derive(Clone, Debug)]
pub struct MountRoom {
    solver: Solver,
    mount: Vector3<f64>,
    /// Linear axes with an end, and their travel.
    slides: Vec<(usize, [f64; 2])>,
    /// How each linear axis goes with the mount, at the rotary angles behind it.
    rates: Option<(Joints, Vec<Vector3<f64>>)>,
    found: BTreeMap<(TravelEnd, [i32; 3]), TravelConstraint>,
}

/// An end of travel, and what a point of the program leaves to the mount because of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MountConstraint {
    /// The end.
    pub side: TravelEnd,
    /// Line of the CL file that the point stands on.
    pub line: u64,
    /// The mounts (mm, machine frame) with which the axis stays before it.
    pub body: HalfSpace,
}

/// One end of travel at one point of the program, at the mount in hand.
#[derive(Clone, Copy, Debug)]
struct TravelConstraint {
    body: HalfSpace,
    room: f64,
    line: u64,
}

impl MountRoom {
    /// For a machine as its file describes it; its ends of travel are those that bound.
    ///
    /// # Errors
    /// What its chain lacks. Where the linear axes do not place the tip alone ([`Solver::places_tip`]), the values of an
    /// axis are no straight function of the mount, and nothing is gathered.
    pub fn new(machine: &Machine) -> Result<Self, NoClosedForm> {
        let solver = opened(machine).solver(0.0)?;
        let axes = machine.axes.iter().enumerate();
        let slides = axes
            .filter(|(_, axis)| !axis.joint.rotary)
            .filter(|(_, axis)| axis.indexed.is_none())
            .filter(|(_, axis)| !matches!(axis.second, Some(Second::Reserve { .. })))
            .filter_map(|(joint, axis)| Some((joint, with_reserve(machine, joint, axis.travel?))))
            .collect();
        Ok(Self {
            mount: machine.mount,
            slides: if solver.places_tip() { slides } else { Vec::new() },
            solver,
            rates: None,
            found: BTreeMap::new(),
        })
    }

    /// Some linear axis has an end, and its values are a straight function of the mount.
    pub fn bounds(&self) -> bool {
        !self.slides.is_empty()
    }

    /// Takes a point of the program: the axis values there, with the part where the machine has it, and the line of the
    /// CL file.
    pub fn take(&mut self, joints: &Joints, line: u64) {
        // Where the machine was opened, what goes to the end of travel on purpose says nothing.
        let mut slides = self.slides.iter();
        if slides.any(|(joint, _)| libm::fabs(joints[*joint]) > OPEN / 2.0) {
            return;
        }
        if self.rates.as_ref().is_none_or(|(at, _)| self.turned(at, joints)) {
            let turns = self.solver.chain().turns(joints);
            let Some(rates) = self.rates_at(joints, &turns) else {
                return;
            };
            self.rates = Some((*joints, rates));
        }
        let Some((_, rates)) = &self.rates else {
            return;
        };
        for ((joint, [least, most]), rate) in self.slides.iter().zip(rates) {
            let value = joints[*joint];
            for (largest, sign, end) in [(false, -1.0, -least), (true, 1.0, *most)] {
                let normal = rate * sign;
                let room = end - value * sign;
                let bound = TravelConstraint {
                    body: HalfSpace { normal, most: room + normal.dot(&self.mount) },
                    room,
                    line,
                };
                let side = TravelEnd { joint: *joint, largest };
                let cell = [normal.x, normal.y, normal.z];
                let cell = cell.map(|part| libm::rint(part * CELLS) as i32);
                match self.found.entry((side, cell)) {
                    Entry::Vacant(entry) => {
                        entry.insert(bound);
                    }
                    Entry::Occupied(mut entry) if bound.room < entry.get().room => {
                        entry.insert(bound);
                    }
                    Entry::Occupied(_) => {}
                }
            }
        }
    }

    /// The way of the axes between two points of the program, given by their axis values and tips (mm, part frame), if
    /// the control keeps the tip on a straight line in between: some places on it, as many as the rotary axes turn by
    /// steps of two degrees.
    pub fn take_between(&mut self, [from, to]: [(&Joints, &Vector3<f64>); 2], line: u64) {
        const STEP: f64 = 2.0 * std::f64::consts::PI / 180.0;
        let chain = self.solver.chain();
        let joints = chain.joints().iter().enumerate();
        let turn = joints
            .filter(|(_, joint)| joint.rotary)
            .map(|(joint, _)| libm::fabs(to.0[joint] - from.0[joint]))
            .sum::<f64>();
        let steps = libm::ceil(turn / STEP).min(180.0) as u32;
        if steps < 2 || self.slides.is_empty() {
            return;
        }
        // The tool of this solver ends at the gauge point: the tip lies below it by the length of the tool in use.
        let gauge = chain.forward(to.0);
        let length = (gauge.tip - to.1).dot(&gauge.axis);
        for step in 1..steps {
            let t = f64::from(step) / f64::from(steps);
            let mut joints = *from.0;
            for (value, last) in joints.iter_mut().zip(to.0) {
                *value = *value * (1.0 - t) + last * t;
            }
            let chain = self.solver.chain();
            let axis = chain.forward(&joints).axis;
            let tip = from.1 * (1.0 - t) + to.1 * t;
            let turns = chain.turns(&joints);
            let placed = self.solver.place(tip + axis * length, &mut joints, &turns);
            if placed.is_ok() {
                self.take(&joints, line);
            }
        }
    }

    /// Do the rotary axes stand elsewhere?
    fn turned(&self, at: &Joints, joints: &Joints) -> bool {
        let chain = self.solver.chain().joints().iter().enumerate();
        let mut rotary = chain.filter(|(_, joint)| joint.rotary);
        rotary.any(|(joint, _)| at[joint] != joints[joint])
    }

    /// How far each axis of `slides` goes for one mm of the mount along each axis of the machine.
    fn rates_at(&self, joints: &Joints, turns: &Turns) -> Option<Vec<Vector3<f64>>> {
        let at = |tip: Vector3<f64>| {
            let mut placed = *joints;
            self.solver.place(tip, &mut placed, turns).ok()?;
            Some(placed)
        };
        // The mount moves the tip as a step of the tip in the part does.
        let tip = self.solver.chain().forward(joints).tip;
        let rest = at(tip)?;
        let mut rates = vec![Vector3::zeros(); self.slides.len()];
        for axis in 0..3 {
            let mut moved = tip;
            moved[axis] += 1.0;
            let moved = at(moved)?;
            for (rate, (joint, _)) in rates.iter_mut().zip(&self.slides) {
                rate[axis] = moved[*joint] - rest[*joint];
            }
        }
        Some(rates)
    }

    /// What was gathered.
    pub fn ends(&self) -> impl Iterator<Item = MountConstraint> {
        self.found.iter().map(|((side, _), bound)| MountConstraint {
            side: *side,
            line: bound.line,
            body: bound.body,
        })
    }

    /// The axes go with the mount alike wherever the part stands: no rotary axis turns the part under them.
    pub fn goes_evenly(&self) -> bool {
        let mut sides: Vec<TravelEnd> = self.found.keys().map(|(side, _)| *side).collect();
        let all = sides.len();
        sides.dedup();
        sides.len() == all
    }
}

/// The travel of an axis with that of the one that moves where it ends, if both go the same way.
fn with_reserve(machine: &Machine, joint: usize, [least, most]: [f64; 2]) -> [f64; 2] {
    let mut reserves = machine.axes.iter().filter(|axis| {
        axis.second == Some(Second::Reserve { of: joint })
            && axis.joint.direction.dot(&machine.axes[joint].joint.direction) > 1.0 - 1e-9
    });
    match reserves.next().and_then(|axis| axis.travel) {
        Some([first, last]) => [least + first.min(0.0), most + last.max(0.0)],
        None => [least, most],
    }
}

/// The machine with linear axes that end nowhere near: what it is asked for shows how far they would have to go.
pub fn opened(machine: &Machine) -> Machine {
    let mut opened = machine.clone();
    // They bind linear axes, which the mount moves.
    opened.limits.clear();
    for head in &mut opened.heads {
        head.machine = self::opened(&head.machine);
    }
    let slides = opened.axes.iter_mut().filter(|axis| !axis.joint.rotary);
    for axis in slides.filter(|axis| axis.indexed.is_none()) {
        axis.travel = axis.travel.map(|_| [-OPEN, OPEN]);
    }
    opened
}
