//! What the page derives from other columns, so that only what is left of it need be packed.
//!
//! Where the program has axis positions, tip and tool axis follow from them by the chain. Where the control keeps the tip,
//! the program has the tip and the rotary axes: the tool axis follows from these, and the linear axes from both. What is
//! packed is how far the values told by posting or reading are from that: nothing, where the chain is the whole story, and
//! never nothing where it is not.

use nalgebra::{Matrix3, Vector3};
use post_machine::description::{Machine, Tcp};
use post_machine::kinematics::chain::turn;
use post_machine::kinematics::{Chain, Joints, Pose};
use post_report::meta::PoseCheck;

use crate::axes::{self, AxisColumn};
use crate::columns::Column;

/// Decimals of linear and rotary axis values: mm, degrees.
pub const DECIMALS: [u8; 2] = [4, 5];

/// So many poses are told with all their digits, for the page to hold its own chain against.
const MOST_CHECKS: usize = 12;

/// Slides nearer to a plane than this do not reach all of space: nothing is derived by them. The page has the same number.
const FLAT: f64 = 1e-3;

/// Which columns follow from which.
#[derive(Clone, Copy, PartialEq)]
enum Derivation {
    /// Tip and tool axis from the axes.
    FromAxes,
    /// The tool axis from the rotary axes, the linear axes from these and the tip.
    FromTip,
    /// None: heads are swapped, or the machine cannot be solved.
    Nothing,
}

/// The chain of a machine whose tool has no length.
pub struct Derived<'m> {
    machine: &'m Machine,
    chain: Option<Chain>,
    way: Derivation,
    checks: Vec<PoseCheck>,
    /// Rows to the next check.
    next: u64,
}

/// Values of a row as they are packed.
#[derive(Clone, Debug)]
pub struct PackedValues {
    /// Those of the axes, by columns, as the control shows them.
    pub axes: Vec<Option<f64>>,
    /// Tip and tool axis.
    pub pose: [Vector3<f64>; 2],
    /// The tip as the page will have it.
    pub tip: Vector3<f64>,
}

fn rounded(value: f64, scale: f64) -> f64 {
    (value * scale).round_ties_even() / scale
}

impl<'m> Derived<'m> {
    /// Of a machine.
    pub fn new(machine: &'m Machine) -> Self {
        let solver = machine.solver(0.0).ok();
        let solver = solver.filter(|_| machine.heads.is_empty());
        let linear = machine.axes.iter().filter(|axis| !axis.joint.rotary);
        let way = match (&solver, machine.control.tcp) {
            (None, _) => Derivation::Nothing,
            // The page has the chain as it is drawn, without the errors of its axes.
            _ if machine.errs() => Derivation::Nothing,
            (_, Tcp::Control) if linear.count() == 3 => Derivation::FromTip,
            _ => Derivation::FromAxes,
        };
        Self {
            machine,
            chain: solver.map(|solver| solver.chain().clone().with_errors(&[].into())),
            way,
            checks: Vec::new(),
            next: 0,
        }
    }

    /// The columns of these axes, of the tip and of the tool axis; `left` is what of a row is packed in them.
    pub fn columns<R: 'static>(
        &self,
        axes: &[AxisColumn],
        left: fn(&R) -> &PackedValues,
    ) -> Vec<Column<R>> {
        let axes = axes.iter().enumerate().map(|(place, axis)| {
            let (unit, decimals) = match axis.rotary {
                true => ("deg", DECIMALS[1]),
                false => ("mm", DECIMALS[0]),
            };
            let value = move |row: &R| left(row).axes[place];
            let column = Column::new(format!("q.{}", axis.name), unit, decimals, value);
            match (self.way, axis.rotary) {
                (Derivation::FromTip, false) => column.from("tips"),
                _ => column,
            }
        });
        let tip = ["tip.x", "tip.y", "tip.z"].into_iter().enumerate().map(|(place, name)| {
            let column = Column::new(name, "mm", 4, move |row| left(row).pose[0][place]);
            match self.way {
                Derivation::FromAxes => column.from("chain"),
                _ => column,
            }
        });
        let axis = ["axis.i", "axis.j", "axis.k"].into_iter().enumerate().map(|(place, name)| {
            let column = Column::new(name, "", 6, move |row| left(row).pose[1][place]);
            match self.way {
                Derivation::Nothing => column,
                _ => column.from("chain"),
            }
        });
        axes.chain(tip).chain(axis).collect()
    }

    /// What is left of a row to pack. `machine` is that with the head in use, whose axes stand in these columns, and the
    /// control shows them as `shown`.
    pub fn left(
        &self,
        machine: &Machine,
        columns: &[AxisColumn],
        shown: Vec<Option<f64>>,
        joints: &Joints,
        [tip, axis]: [Vector3<f64>; 2],
        length: f64,
    ) -> PackedValues {
        let whole = PackedValues {
            axes: shown,
            pose: [tip, axis],
            tip: tip.map(|value| rounded(value, 1e4)),
        };
        let Some(chain) = &self.chain else {
            return whole;
        };
        let packed = self.packed(joints);
        let length = rounded(length, 1e4);
        let pose = chain.forward(&packed);
        match self.way {
            Derivation::FromAxes => {
                let from = pose.tip - pose.axis * length;
                let left = tip - from;
                PackedValues {
                    pose: [left, axis - pose.axis],
                    tip: from + left.map(|value| rounded(value, 1e4)),
                    ..whole
                }
            }
            _ => {
                let mut readings = axes::readings(machine, joints);
                if let Some(linear) = self.linear(chain, &packed, whole.tip, length) {
                    for (reading, (axis, value)) in
                        readings.iter_mut().zip(self.machine.axes.iter().zip(linear))
                    {
                        if !axis.joint.rotary {
                            *reading -= value + axis.zero / axis.unit();
                        }
                    }
                }
                let axes = axes::in_columns(columns, machine, &readings);
                PackedValues { axes, pose: [tip, axis - pose.axis], ..whole }
            }
        }
    }

    /// Where the page has the tip halfway between two rows, if all follows from the axes.
    pub fn middle(&self, from: &Joints, to: &Joints, length: f64) -> Option<Vector3<f64>> {
        let chain = self.chain.as_ref().filter(|_| self.way == Derivation::FromAxes)?;
        let mut half = self.packed(from);
        for (value, to) in half.iter_mut().zip(self.packed(to)) {
            *value = 0.5 * (*value + to);
        }
        let pose = chain.forward(&half);
        Some(pose.tip - pose.axis * rounded(length, 1e4))
    }

    /// Positions as the page will have them.
    fn packed(&self, joints: &Joints) -> Joints {
        let mut packed = *joints;
        for (value, axis) in packed.iter_mut().zip(&self.machine.axes) {
            let scale = [1e4, 1e5][usize::from(axis.joint.rotary)];
            let reading = rounded(axis.reading(*value), scale);
            *value = (reading - axis.zero / axis.unit()) * axis.unit();
        }
        packed
    }

    /// The positions of the linear axes that bring the tip there, the rotary ones standing as they are; of those zero.
    fn linear(
        &self,
        chain: &Chain,
        joints: &Joints,
        tip: Vector3<f64>,
        length: f64,
    ) -> Option<Joints> {
        let mut at = chain.tip() - chain.axis() * length;
        let mut slides: Vec<(usize, Vector3<f64>)> = Vec::with_capacity(3);
        for (place, joint) in chain.joints().iter().enumerate().rev() {
            if !joint.rotary {
                slides.push((place, joint.direction));
                continue;
            }
            let (sine, cosine) = libm::sincos(joints[place]);
            at = joint.point + turn(at - joint.point, joint.direction, sine, cosine);
            for (_, slide) in &mut slides {
                *slide = turn(*slide, joint.direction, sine, cosine);
            }
        }
        let columns: Vec<Vector3<f64>> = slides.iter().map(|(_, slide)| *slide).collect();
        let far = tip - (at - chain.mount());
        let [one, two, three] = columns.as_slice() else {
            return None;
        };
        let volume = Matrix3::from_columns(&columns).determinant();
        if libm::fabs(volume) < FLAT {
            return None;
        }
        let ways =
            [far.dot(&two.cross(three)), one.dot(&far.cross(three)), one.dot(&two.cross(&far))];
        let mut found = Joints::default();
        for ((place, _), way) in slides.iter().zip(ways) {
            found[*place] = way / volume;
        }
        Some(found)
    }

    /// Keeps a pose with all its digits, now and then.
    pub fn check(&mut self, row: u64, joints: &Joints, length: f64) {
        let Some(chain) = &self.chain else {
            return;
        };
        if row < self.next || self.checks.len() >= MOST_CHECKS {
            return;
        }
        // Rows 0, 1, 3, 7, 15, …
        self.next = 2 * row + 1;
        let axes = self.machine.axes.iter().zip(joints);
        let Pose { tip, axis, .. } = chain.forward(joints);
        self.checks.push(PoseCheck {
            row,
            joints: axes.map(|(axis, value)| axis.reading(*value)).collect(),
            tool_length: length,
            tip: (tip - axis * length).into(),
            axis: axis.into(),
        });
    }

    /// What was kept.
    pub fn checks(self) -> Vec<PoseCheck> {
        self.checks
    }
}
