//! What the page derives from other columns, so that only what is left of it need be packed.
//!
//! Tip and tool axis follow from the axis values by the chain. What is packed is how far the values told by posting or
//! reading are from that: nothing, where the chain is the whole story, and never nothing where it is not.

use nalgebra::Vector3;
use post_machine::description::Machine;
use post_machine::kinematics::{Chain, Joints, Pose};
use post_report::meta::Check;

/// Decimals of linear and rotary axis values: mm, degrees.
pub const DECIMALS: [u8; 2] = [4, 5];

/// So many poses are told with all their digits, for the page to hold its own chain against.
const MOST_CHECKS: usize = 12;

/// The chain of a machine whose tool has no length.
pub struct Derived<'m> {
    machine: &'m Machine,
    chain: Option<Chain>,
    checks: Vec<Check>,
    /// Rows to the next check.
    next: u64,
}

impl<'m> Derived<'m> {
    /// Of a machine. What it cannot solve, and heads that are swapped, goes as it is.
    pub fn new(machine: &'m Machine) -> Self {
        let solver = machine.solver(0.0).ok();
        let solver = solver.filter(|_| machine.heads.is_empty());
        Self {
            machine,
            chain: solver.map(|solver| solver.chain().clone()),
            checks: Vec::new(),
            next: 0,
        }
    }

    /// Columns are derived.
    pub fn is_known(&self) -> bool {
        self.chain.is_some()
    }

    /// Tip and tool axis by the chain, from axis values as they are packed; none where they are not derived.
    pub fn pose(&self, joints: &Joints, length: f64) -> Option<[Vector3<f64>; 2]> {
        let chain = self.chain.as_ref()?;
        let mut packed = *joints;
        for (value, axis) in packed.iter_mut().zip(&self.machine.axes) {
            let scale = [1e4, 1e5][usize::from(axis.joint.rotary)];
            let reading = (axis.reading(*value) * scale).round_ties_even() / scale;
            *value = (reading - axis.zero / axis.unit()) * axis.unit();
        }
        let length = (length * 1e4).round_ties_even() / 1e4;
        let Pose { tip, axis, .. } = chain.forward(&packed);
        Some([tip - axis * length, axis])
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
        self.checks.push(Check {
            row,
            joints: axes.map(|(axis, value)| axis.reading(*value)).collect(),
            tool_length: length,
            tip: (tip - axis * length).into(),
            axis: axis.into(),
        });
    }

    /// What was kept.
    pub fn checks(self) -> Vec<Check> {
        self.checks
    }
}
